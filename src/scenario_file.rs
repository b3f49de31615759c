//! Reading a scenario from its TOML file, and saying where in the file a mistake stands.

mod location;
mod shape;

use crate::automaton::network::scenario::Scenario;
use location::Located;
use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;
use toml::de::DeTable;

/// Why no mission can start from a file.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// The file is missing, may not be read or is not UTF-8 text.
    #[error("{}: cannot be read: {source}; give the path of a scenario file", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file holds nothing but blanks and comments.
    #[error(
        "{}: the file is empty; a scenario states at least name, [workspace], [link], \
         an [[access_point]] and a [[robot]]",
        path.display()
    )]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file holds mistakes.
    #[error("{}", one_per_line(path, mistakes))]
    Mistaken {
        /// The file.
        path: PathBuf,
        /// The mistakes, at least one.
        mistakes: Vec<Mistake>,
    },
}

/// A mistake in a scenario file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The line, counted from 1.
    pub line: usize,
    /// The character in the line, counted from 1.
    pub column: usize,
    /// The key, such as `robot[3].position`; empty where none is concerned.
    pub key: String,
    /// What is wrong and what would be right.
    pub message: String,
}

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}: ", self.line, self.column)?;
        if !self.key.is_empty() {
            write!(formatter, "{}: ", self.key)?;
        }
        formatter.write_str(&self.message)
    }
}

/// Reads the scenario in the file at `path`.
///
/// # Errors
/// The file cannot be read, is empty, is not TOML, does not have the shape of a scenario, or a
/// mission cannot start from it ([`Scenario::validate`]). Each mistake comes with line, column,
/// key and what would be right.
pub fn read(path: &Path) -> Result<Scenario, ScenarioError> {
    let text = std::fs::read_to_string(path)
        .map_err(|source| ScenarioError::Unreadable { path: path.into(), source })?;
    parse(&text, path)
}

/// Reads a scenario from `text`; `path` is what error messages call it.
///
/// # Errors
/// As [`read`].
///
/// ```
/// let error = pleach::scenario_file::parse("name = 3", "room.toml".as_ref()).unwrap_err();
/// assert!(error.to_string().contains(
///     "room.toml:1:8: name: the whole number 3 stands where a text in quotation marks belongs"
/// ));
/// ```
pub fn parse(text: &str, path: &Path) -> Result<Scenario, ScenarioError> {
    let mistaken = |mistakes| ScenarioError::Mistaken { path: path.into(), mistakes };
    let syntax = |error: &toml::de::Error| {
        let start = error.span().map_or(0, |span| span.start);
        let line = location::line_around(text, start);
        let message = format!("not TOML: {} in `{line}`", error.message());
        mistaken(vec![location::mistake(text, start, "", &message)])
    };

    let file = DeTable::parse(text).map_err(|error| syntax(&error))?;
    if file.get_ref().is_empty() {
        return Err(ScenarioError::Empty { path: path.into() });
    }
    let departures = shape::departures(&file);
    if !departures.is_empty() {
        let mistakes = departures.into_iter().map(|departure| {
            let key = departure.key.to_string();
            location::mistake(text, departure.span.start, &key, &departure.message)
        });
        return Err(mistaken(mistakes.collect()));
    }
    let scenario: Scenario = toml::from_str(text).map_err(|error| syntax(&error))?;
    scenario.validate().map_err(|faults| {
        let mistakes = faults.iter().map(|fault| {
            let start = file.start_of(&fault.key);
            location::mistake(text, start, &fault.key.to_string(), &fault.problem.to_string())
        });
        mistaken(mistakes.collect())
    })?;
    Ok(scenario)
}

fn one_per_line(path: &Path, mistakes: &[Mistake]) -> String {
    let lines: Vec<_> =
        mistakes.iter().map(|mistake| format!("{}:{mistake}", path.display())).collect();
    lines.join("\n")
}
