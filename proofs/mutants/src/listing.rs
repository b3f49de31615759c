//! The mutants: which text stands where instead of which.

use std::path::Path;
use std::process::Command;

use serde::Deserialize;

use crate::Error;

/// A deliberate change of one place of the sources, as `cargo mutants --list` describes it.
#[derive(Clone, Debug, Deserialize)]
pub struct Mutant {
    /// By which it is switched on, from one.
    #[serde(skip)]
    pub number: usize,
    /// Place and change, in words.
    pub name: String,
    /// The file, from the root of the workspace.
    pub file: String,
    pub genre: Genre,
    /// What stands at the place instead.
    pub replacement: String,
    pub span: Span,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
pub enum Genre {
    FnValue,
    BinaryOperator,
    UnaryOperator,
    MatchArm,
    MatchArmGuard,
    StructField,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub struct Span {
    pub start: Place,
    pub end: Place,
}

/// Lines and columns are counted from one, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub struct Place {
    pub line: usize,
    pub column: usize,
}

/// The mutants of a package that `.cargo/mutants.toml` does not exclude, in files whose path has one of
/// `parts` in it, or in all.
pub fn mutants(root: &Path, package: &str, parts: &[String]) -> Result<Vec<Mutant>, Error> {
    let output = Command::new("cargo")
        .current_dir(root)
        .args(["mutants", "--list", "--json", "--file", "**/*.rs", "--package", package])
        .output()?;
    if !output.status.success() {
        return Err(Error::Listing(String::from_utf8_lossy(&output.stderr).into_owned()));
    }
    let mut mutants: Vec<Mutant> = serde_json::from_slice(&output.stdout)?;
    let is_asked_for =
        |mutant: &Mutant| parts.is_empty() || parts.iter().any(|part| mutant.file.contains(part));
    mutants.retain(is_asked_for);
    mutants.iter_mut().enumerate().for_each(|(at, mutant)| mutant.number = at + 1);
    Ok(mutants)
}
