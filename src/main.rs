//! The command-line program.

mod cli;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::carry_out(cli::Arguments::parse())
}
