//! The command-line program.

use clap::Parser;
use mimalloc::MiMalloc;
use pleach::cli;
use std::process::ExitCode;

/// In large networks most of a control period is spent waiting for memory. This allocator keeps small blocks of one size
/// side by side.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    cli::carry_out(cli::Arguments::parse().command)
}
