//! The places of `proofs/rounding.toml`, where numbers are rounded outward.
//!
//! All of them are planted in one copy of the sources, so that it is built once: an expression gives
//! way to a choice between itself and what stands there without rounding, which a variable of the
//! environment makes when a test runs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::{fs, io};

use serde::Deserialize;

/// The variable of the environment with the number of the place at which rounding is left out.
pub const CHOICE: &str = "PLEACH_UNROUNDED";

/// A place where a number is rounded outward.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rounding {
    /// The file, from the root of the workspace.
    pub file: String,
    /// An expression that occurs there exactly once.
    pub before: String,
    /// The same without rounding outward.
    pub after: String,
    /// The tests that then fail: arguments of `cargo test`.
    pub test: String,
    /// Why no test can tell, where none can.
    pub unseen: Option<String>,
}

/// Why rounding cannot be left out.
#[derive(Debug, thiserror::Error)]
pub enum PlacesError {
    /// A file cannot be read.
    #[error("{path}: {source}")]
    File {
        /// Which.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// The list is not what it should be.
    #[error("proofs/rounding.toml: {0}")]
    List(#[from] toml::de::Error),
    /// The sources have changed under a place.
    #[error("`{before}` should occur exactly once in {file}, and occurs {times} times")]
    DoesNotApply {
        /// The expression.
        before: String,
        /// Where.
        file: String,
        /// How often it occurs.
        times: usize,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Places {
    place: Vec<Rounding>,
}

/// Every place of the list below `root`.
///
/// # Errors
/// When it cannot be read.
pub fn places(root: &Path) -> Result<Vec<Rounding>, PlacesError> {
    let places: Places = toml::from_str(&read(root, "proofs/rounding.toml")?)?;
    Ok(places.place)
}

/// The sources that have places, with a choice at each of them.
///
/// # Errors
/// When one of them does not apply.
pub fn with_choices(
    root: &Path,
    places: &[Rounding],
) -> Result<BTreeMap<String, String>, PlacesError> {
    let mut by_file: BTreeMap<&str, Vec<(usize, &Rounding)>> = BTreeMap::new();
    for (number, place) in places.iter().enumerate() {
        by_file.entry(&place.file).or_default().push((number, place));
    }
    let mut sources = BTreeMap::new();
    for (file, places) in by_file {
        let source = read(root, file)?;
        let mut found = Vec::new();
        for (number, place) in places {
            let occurrences: Vec<usize> =
                source.match_indices(&place.before).map(|(at, _)| at).collect();
            let &[at] = &occurrences[..] else {
                let (before, file, times) =
                    (place.before.clone(), file.to_owned(), occurrences.len());
                return Err(PlacesError::DoesNotApply { before, file, times });
            };
            found.push((at, number, place));
        }
        found.sort_by_key(|(at, ..)| *at);
        let (mut changed, mut end) = (String::new(), 0);
        for (at, number, Rounding { before, after, .. }) in found {
            let choice =
                format!("(if crate::is_unrounded({number}) {{ {after} }} else {{ {before} }})");
            changed = changed + &source[end..at] + &choice;
            end = at + before.len();
        }
        sources.insert(file.to_owned(), changed + &source[end..]);
    }
    add_to_roots(root, &mut sources, &decision())?;
    Ok(sources)
}

/// The function that says whether rounding is left out at a place.
fn decision() -> String {
    format!(
        "\npub(crate) fn is_unrounded(place: usize) -> bool {{\n    \
         use std::sync::LazyLock;\n    \
         static PLACE: LazyLock<Option<usize>> =\n        \
         LazyLock::new(|| std::env::var(\"{CHOICE}\").ok()?.parse().ok());\n    \
         *PLACE == Some(place)\n}}\n"
    )
}

/// Adds a function to the roots of the crates that have these sources.
fn add_to_roots(
    root: &Path,
    sources: &mut BTreeMap<String, String>,
    function: &str,
) -> Result<(), PlacesError> {
    let package = |file: &String| file.split_once("src/").map(|(package, _)| package.to_owned());
    let packages: BTreeSet<String> = sources.keys().filter_map(package).collect();
    for package in packages {
        let crate_root = format!("{package}src/lib.rs");
        let source = match sources.remove(&crate_root) {
            Some(source) => source,
            None => read(root, &crate_root)?,
        };
        sources.insert(crate_root, source + function);
    }
    Ok(())
}

fn read(root: &Path, path: &str) -> Result<String, PlacesError> {
    fs::read_to_string(root.join(path))
        .map_err(|source| PlacesError::File { path: path.to_owned(), source })
}
