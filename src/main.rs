//! The command-line program.

use clap::Parser;
use mimalloc::MiMalloc;
use pleach::cli;
use std::process::ExitCode;

/// Large networks wait for memory most of the time, and less where their many small lists lie closer together.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    cli::carry_out(cli::Arguments::parse().command)
}
