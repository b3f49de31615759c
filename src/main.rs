//! The command-line program.

#![cfg_attr(test, allow(clippy::unwrap_used))] // a test that panics has failed
#![warn(clippy::print_stdout, clippy::print_stderr)] // they panic when the stream is closed: see `cli::output`

mod cli;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::carry_out(cli::Arguments::parse())
}
