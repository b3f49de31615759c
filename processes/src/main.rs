//! The program `pleach` with commands for real processes.

use clap::{Parser, Subcommand};
use pleach::cli;
use pleach_processes::arguments::ProcessCommand;
use std::process::ExitCode;

/// Robots grow a network of relays from fixed access points to the places where they are needed.
#[derive(Debug, Parser)]
#[command(name = "pleach", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    #[command(flatten)]
    Process(ProcessCommand),
    #[command(flatten)]
    Ordinary(cli::Command),
}

fn main() -> ExitCode {
    match Arguments::parse().command {
        Command::Process(command) => cli::exit(pleach_processes::carry_out(command)),
        Command::Ordinary(command) => cli::carry_out(command),
    }
}
