//! Scenarios that are kept in files.

use pleach::automaton::network::scenario::{Scenario, ValidScenario};
use pleach::scenario_file;
use std::path::{Path, PathBuf};

/// The folder of the project.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// The files of a folder of the project, by name.
pub fn files(folder: &str) -> Vec<PathBuf> {
    let files = std::fs::read_dir(root().join(folder)).unwrap();
    let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "{folder} holds nothing");
    files
}

/// The scenario in a file of the project.
pub fn read(file: impl AsRef<Path>) -> ValidScenario {
    scenario_file::read(&root().join(file)).unwrap_or_else(|error| panic!("{error}"))
}

/// The names of the scenarios that are shipped, in ascending order.
pub fn shipped_names() -> Vec<String> {
    let name = |file: &PathBuf| file.file_stem().unwrap().to_str().unwrap().to_owned();
    files("scenarios").iter().map(name).collect()
}

/// The scenario of that name among those that are shipped.
pub fn shipped(name: &str) -> Scenario {
    read(format!("scenarios/{name}.toml")).into_scenario()
}

/// The scenario, from which a mission can start.
pub fn valid(scenario: Scenario) -> ValidScenario {
    ValidScenario::new(scenario).unwrap_or_else(|error| panic!("{error}"))
}
