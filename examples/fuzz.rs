//! Has every reader read texts that are wrong in every way; see `tests/fuzzing`.
//!
//! `cargo run --release --example fuzz -- COUNT [SEED]`; COUNT is the number of inputs for all readers together.

#[path = "../tests/fuzzing/mod.rs"]
mod fuzzing;

use fuzzing::{Reader, read};
use std::error::Error;
use std::process::ExitCode;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (count, seed): (u64, u64) = match &arguments[..] {
        [count] => (count.parse()?, 1),
        [count, seed] => (count.parse()?, seed.parse()?),
        _ => return Err("usage: fuzz COUNT [SEED]".into()),
    };
    for reader in Reader::ALL {
        match read(reader, seed, count / Reader::ALL.len() as u64) {
            Ok(tally) => println!("{reader:?}: {} read, {} refused", tally.read, tally.refused),
            Err(panic) => {
                println!("{panic}");
                return Ok(ExitCode::FAILURE);
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}
