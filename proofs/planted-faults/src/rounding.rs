//! The places of `proofs/rounding.toml`, where numbers are rounded outward.
//!
//! All of them are planted in one copy of the sources, so that it is built once: an expression gives
//! way to a choice between itself and what stands there without rounding, which a variable of the
//! environment makes when a test runs.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use super::catalogue::{CatalogueError, add_to_roots, read};

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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Places {
    place: Vec<Rounding>,
}

/// Every place of the list below `root`.
///
/// # Errors
/// When it cannot be read.
pub fn places(root: &Path) -> Result<Vec<Rounding>, CatalogueError> {
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
) -> Result<BTreeMap<String, String>, CatalogueError> {
    let mut by_file: BTreeMap<&str, Vec<(usize, &Rounding)>> = BTreeMap::new();
    for (number, place) in places.iter().enumerate() {
        by_file.entry(&place.file).or_default().push((number, place));
    }
    let mut sources = BTreeMap::new();
    for (file, places) in by_file {
        let source = read(root, file)?;
        let mut found = places.iter().map(|(number, place)| {
            let mut occurrences = source.match_indices(&place.before);
            match (occurrences.next(), occurrences.count()) {
                (Some((at, _)), 0) => Ok((at, *number, *place)),
                (first, further) => Err(CatalogueError::DoesNotApply {
                    name: format!("rounding left out of `{}`", place.before),
                    file: file.to_owned(),
                    times: further + usize::from(first.is_some()),
                }),
            }
        });
        let mut found = found.by_ref().collect::<Result<Vec<_>, _>>()?;
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
