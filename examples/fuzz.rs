//! Has every reader read texts that are wrong in every way; see `tests/fuzzing`.
//!
//! `cargo run --release --example fuzz -- COUNT [SEED]`; COUNT is the number of inputs for all readers together.

#[path = "../tests/fuzzing/mod.rs"]
mod fuzzing;

use clap::Parser;
use fuzzing::{Reader, read};
use std::process::ExitCode;

/// Has every reader read texts that are wrong in every way
#[derive(Parser)]
struct Arguments {
    /// The number of inputs for all readers together
    count: u64,
    /// What the inputs are drawn from
    #[arg(default_value_t = 1)]
    seed: u64,
}

fn main() -> ExitCode {
    let Arguments { count, seed } = Arguments::parse();
    for reader in Reader::ALL {
        match read(reader, seed, count / Reader::ALL.len() as u64) {
            Ok(tally) => println!("{reader:?}: {} read, {} refused", tally.read, tally.refused),
            Err(panic) => {
                println!("{panic}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}
