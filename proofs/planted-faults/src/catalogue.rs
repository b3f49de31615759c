//! The faults of `proofs/faults.toml`, and where they are planted.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::{fmt, fs, io};

use serde::Deserialize;

/// A deliberate fault of the protocol.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// What it is called.
    pub name: String,
    /// What is wrong then.
    pub wrong: String,
    /// The file that it is planted in, from the root of the workspace.
    pub file: String,
    /// A text that occurs there exactly once.
    pub before: String,
    /// What stands there instead.
    pub after: String,
    /// The engine that should catch it.
    pub engine: Engine,
    /// What fails then: the arguments of `cargo`, the last of which is a part of the names of tests.
    pub command: String,
    /// A text in the output, so that it fails for the right reason.
    pub says: String,
}

/// An engine that catches faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// A Kani harness, run on concrete values.
    Harness,
    /// Exhaustive exploration.
    Exploration,
    /// The state machine test of the protocol.
    #[serde(rename = "state machine")]
    StateMachine,
    /// An ordinary test.
    Test,
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Engine::Harness => "harness",
            Engine::Exploration => "exploration",
            Engine::StateMachine => "state machine",
            Engine::Test => "test",
        })
    }
}

/// Why a fault cannot be planted.
#[derive(Debug, thiserror::Error)]
pub enum CatalogueError {
    /// A file cannot be read.
    #[error("{path}: {source}")]
    File {
        /// Which.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// The catalogue is not what it should be.
    #[error("a list in proofs: {0}")]
    Catalogue(#[from] toml::de::Error),
    /// The sources have changed under the fault.
    #[error(
        "the fault “{name}” does not apply: the text before it should occur exactly once in \
         {file}, and occurs {times} times"
    )]
    DoesNotApply {
        /// Which.
        name: String,
        /// Where.
        file: String,
        /// How often the text occurs.
        times: usize,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Catalogue {
    fault: Vec<Fault>,
}

/// Every fault of the catalogue below `root`.
///
/// # Errors
/// When it cannot be read.
pub fn faults(root: &Path) -> Result<Vec<Fault>, CatalogueError> {
    let catalogue: Catalogue = toml::from_str(&read(root, "proofs/faults.toml")?)?;
    Ok(catalogue.fault)
}

impl Fault {
    /// The file below `root` as it is with the fault.
    ///
    /// # Errors
    /// When it does not apply.
    pub fn planted(&self, root: &Path) -> Result<String, CatalogueError> {
        let source = read(root, &self.file)?;
        let times = source.matches(&self.before).count();
        if times != 1 {
            let (name, file) = (self.name.clone(), self.file.clone());
            return Err(CatalogueError::DoesNotApply { name, file, times });
        }
        Ok(source.replacen(&self.before, &self.after, 1))
    }
}

/// A file below `root`.
///
/// # Errors
/// When it cannot be read.
pub fn read(root: &Path, path: &str) -> Result<String, CatalogueError> {
    fs::read_to_string(root.join(path))
        .map_err(|source| CatalogueError::File { path: path.to_owned(), source })
}

/// Adds a function to the roots of the crates that have these sources.
///
/// # Errors
/// When a root cannot be read.
pub fn add_to_roots(
    root: &Path,
    sources: &mut BTreeMap<String, String>,
    function: &str,
) -> Result<(), CatalogueError> {
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
