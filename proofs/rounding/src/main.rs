//! Leaves out rounding outward at each place of `proofs/rounding.toml`, in a copy of the sources, and sees whether tests
//! fail: `proofs/check rounding`. `docs/proofs.md` says what came of it.

mod places;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{fs, io};

use places::{CHOICE, PlacesError, Rounding, places, with_choices};

/// Why rounding cannot be left out.
#[derive(Debug, thiserror::Error)]
enum Error {
    #[error(transparent)]
    Places(#[from] PlacesError),
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("proofs/copy: {0}")]
    Copy(String),
    #[error("`cargo test {0}` fails although rounding is left out nowhere")]
    FailsAnyway(String),
}

fn main() -> Result<ExitCode, Error> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let places = places(&root)?;
    let copy = copy(&root)?;
    for (file, source) in with_choices(&root, &places)? {
        fs::write(copy.join(file), source)?;
    }
    let tests: BTreeSet<&str> = places.iter().map(|place| &*place.test).collect();
    for test in tests {
        if !passes(&copy, test, None)? {
            return Err(Error::FailsAnyway(test.to_owned()));
        }
        println!("passes without a choice: cargo test {test}");
    }
    report(&copy, &places)
}

/// A copy of the sources as they are.
fn copy(root: &Path) -> Result<PathBuf, Error> {
    let output = Command::new(root.join("proofs/copy")).output()?;
    match output.status.success() {
        true => Ok(PathBuf::from(String::from_utf8_lossy(&output.stdout).trim_end())),
        false => Err(Error::Copy(String::from_utf8_lossy(&output.stderr).into_owned())),
    }
}

/// Whether tests pass, with rounding left out at the place of a number, if any.
fn passes(copy: &Path, test: &str, place: Option<usize>) -> io::Result<bool> {
    let mut cargo = Command::new("cargo");
    cargo.arg("test").args(test.split_whitespace()).current_dir(copy).env_remove(CHOICE);
    cargo.env("CARGO_TARGET_DIR", copy.with_file_name("built"));
    if let Some(number) = place {
        cargo.env(CHOICE, number.to_string());
    }
    Ok(cargo.output()?.status.success())
}

/// Leaves out rounding at one place after the other, and compares what becomes of the tests with the list.
fn report(copy: &Path, places: &[Rounding]) -> Result<ExitCode, Error> {
    let (mut seen, mut unseen, mut wrong) = (0, 0, 0);
    for (number, place) in places.iter().enumerate() {
        match (passes(copy, &place.test, Some(number))?, &place.unseen) {
            (false, None) => seen += 1,
            (true, Some(_)) => unseen += 1,
            (passes, _) => {
                wrong += 1;
                let what = if passes { "NOT SEEN" } else { "SEEN AFTER ALL" };
                println!("{what}: {}: {}", place.file, place.before);
            }
        }
    }
    println!("{} places: {seen} seen, {unseen} lawful, {wrong} not as the list says", places.len());
    Ok(if wrong == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
