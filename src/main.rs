//! The command-line program.

use clap::Parser;
use pleach::cli;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::carry_out(cli::Arguments::parse().command)
}
