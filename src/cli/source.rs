//! What the program reads: files, for scenarios also folders of them, and the standard input.

use super::status::Failure;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::scenario_file::{self, ListedTask, ScenarioError, Setting};
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

/// The name that stands for standard input or output.
pub(super) const STANDARD: &str = "-";

/// Whether a path stands for standard input or output.
pub(super) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == STANDARD
}

/// What `path` names, to be read: a file, or for `-` the standard input.
pub(super) fn open(path: &Path) -> io::Result<Box<dyn BufRead>> {
    match is_standard(path) {
        true => Ok(Box::new(io::stdin().lock())),
        false => Ok(Box::new(BufReader::new(File::open(path)?))),
    }
}

/// The text of a scenario, and what messages call it.
#[derive(Clone, Debug)]
pub(super) struct Source {
    /// Its path, or `<stdin>`.
    pub name: PathBuf,
    text: String,
}

impl Source {
    /// The sources that the paths name: `-` the standard input, a folder its TOML files in order
    /// of their names. Beside them, those that cannot be read.
    pub(super) fn all(paths: &[PathBuf]) -> Result<(Vec<Self>, Vec<ScenarioError>), Failure> {
        let (mut sources, mut unreadable) = (Vec::new(), Vec::new());
        for path in paths {
            let found = if is_standard(path) {
                vec![Self::standard_input()]
            } else if path.is_dir() {
                files_of(path)?.into_iter().map(Self::file).collect()
            } else {
                vec![Self::file(path.clone())]
            };
            for source in found {
                match source {
                    Ok(source) => sources.push(source),
                    Err(error) => unreadable.push(error),
                }
            }
        }
        Ok((sources, unreadable))
    }

    fn file(name: PathBuf) -> Result<Self, ScenarioError> {
        let text = std::fs::read_to_string(&name);
        Self::of(name, text)
    }

    fn standard_input() -> Result<Self, ScenarioError> {
        Self::of(PathBuf::from("<stdin>"), io::read_to_string(io::stdin()))
    }

    fn of(name: PathBuf, text: io::Result<String>) -> Result<Self, ScenarioError> {
        match text {
            Ok(text) => Ok(Self { name, text }),
            Err(source) => Err(ScenarioError::Unreadable { path: name, source }),
        }
    }

    /// The scenario with these settings; if there are `tasks`, with these in the place of its own.
    pub(super) fn parse(
        &self,
        settings: &[Setting],
        tasks: Option<&[ListedTask]>,
    ) -> Result<ValidScenario, ScenarioError> {
        scenario_file::parse_with_tasks(&self.text, &self.name, settings, tasks)
    }
}

/// The scenario files directly in a folder, in order of their names.
fn files_of(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let unreadable = |source| ScenarioError::Unreadable { path: folder.into(), source };
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension == "toml") && path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    if files.is_empty() {
        return Err(Failure::NoScenarios { folder: folder.into() });
    }
    Ok(files)
}
