//! The sources of the project as texts.

use std::fs;
use std::path::{Path, PathBuf};

pub use crate::generated::{read, root};

/// The files below a folder of the project, in ascending order.
pub fn files_below(folder: impl AsRef<Path>) -> Vec<PathBuf> {
    fn below(folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        entries.flat_map(|path| if path.is_dir() { below(&path) } else { vec![path] }).collect()
    }
    let mut files = below(&root().join(folder));
    files.sort();
    files
}

/// The manifest in a folder.
pub fn manifest(folder: &Path) -> toml::Table {
    fs::read_to_string(folder.join("Cargo.toml")).unwrap().parse().unwrap()
}

/// The path of a file from the root of the workspace, with slashes.
pub fn relative(file: &Path) -> String {
    file.strip_prefix(root()).unwrap().to_string_lossy().replace('\\', "/")
}

/// The lines of code of a source, each with its number from 1: without comments, and without the
/// tests, which by convention stand at the end of a file.
pub fn lines_of_code(source: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = source.lines().take_while(|line| !line.starts_with("mod tests {"));
    let numbered = lines.enumerate().map(|(number, line)| (number + 1, without_comment(line)));
    numbered.filter(|(_, line)| !line.starts_with("#[cfg(test)]"))
}

/// The code of a file: without comments, and without the tests at its end.
pub fn code(path: &str) -> String {
    lines_of_code(&read(path)).map(|(_, line)| line).collect::<Vec<_>>().join("\n")
}

fn without_comment(line: &str) -> &str {
    line.find("//").map_or(line, |at| &line[..at])
}
