//! Reading a scenario from its TOML file, and saying where in the file a mistake stands.

mod location;
mod setting;
mod shape;

pub use setting::{Setting, SettingError};

use crate::automaton::network::scenario::{KeyPath, KeyStep, Scenario, Task, ValidScenario};
use location::{Lines, Located};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;
use toml::de::DeTable;

/// Why no mission can start from a file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ScenarioError {
    /// The file is missing, may not be read or is not UTF-8 text.
    #[error("{}: cannot be read: {}", path.display(), told(source))]
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
    /// Where it stands.
    pub place: MistakePlace,
    /// The key, such as `robot[3].position`; empty where none is concerned.
    pub key: String,
    /// What is wrong and what would be right.
    pub message: String,
}

/// Where a mistake stands.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MistakePlace {
    /// In the text, both counted from 1.
    Text {
        /// The line.
        line: usize,
        /// The character in the line.
        column: usize,
    },
    /// In a setting that replaces a value of the text, such as `control.period=0`.
    Setting(String),
    /// In a row of a table beside the text.
    Table {
        /// The file of the table.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
    },
}

/// A task from elsewhere than the text of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedTask {
    /// The task.
    pub task: Task,
    /// Where mistakes in it stand.
    pub place: MistakePlace,
}

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.place {
            MistakePlace::Text { line, column } => write!(formatter, "{line}:{column}: ")?,
            MistakePlace::Setting(setting) => write!(formatter, "{setting}: ")?,
            MistakePlace::Table { path, line } => write!(formatter, "{}:{line}: ", path.display())?,
        }
        if !self.key.is_empty() {
            write!(formatter, "{}: ", self.key)?;
        }
        formatter.write_str(&self.message)
    }
}

/// Why a file cannot be read, and what would help.
fn told(source: &std::io::Error) -> String {
    match source.kind() {
        std::io::ErrorKind::InvalidData => "it is not UTF-8 text; save it as UTF-8".to_owned(),
        _ => format!("{source}; give the path of a scenario file"),
    }
}

/// Reads the scenario in the file at `path`.
///
/// # Errors
/// The file cannot be read, is empty, is not TOML, does not have the shape of a scenario, or a
/// mission cannot start from it ([`ValidScenario::new`]). Each mistake comes with line, column,
/// key and what would be right.
pub fn read(path: &Path) -> Result<ValidScenario, ScenarioError> {
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
pub fn parse(text: &str, path: &Path) -> Result<ValidScenario, ScenarioError> {
    parse_with(text, path, &[])
}

/// Reads a scenario from `text` with some of its values replaced, the later settings last.
///
/// # Errors
/// As [`read`]; also for a setting of something that the scenario does not have.
///
/// ```
/// let text = std::fs::read_to_string("scenarios/study-1.toml")?;
/// let settings = ["control.step_radius=0.02".parse()?, "robot[*].rate=0.05".parse()?];
/// let scenario = pleach::scenario_file::parse_with(&text, "study-1".as_ref(), &settings)?;
/// assert_eq!(scenario.settings().step_radius, 0.02);
/// assert!(scenario.robot.iter().all(|robot| robot.rate == 0.05));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn parse_with(
    text: &str,
    path: &Path,
    settings: &[Setting],
) -> Result<ValidScenario, ScenarioError> {
    parse_with_tasks(text, path, settings, None)
}

/// Reads a scenario from `text`, where there are `tasks` with these in the place of its own, and then with some of its
/// values replaced.
///
/// # Errors
/// As [`parse_with`].
pub fn parse_with_tasks(
    text: &str,
    path: &Path,
    settings: &[Setting],
    tasks: Option<&[ListedTask]>,
) -> Result<ValidScenario, ScenarioError> {
    let mistaken = |mistakes| ScenarioError::Mistaken { path: path.into(), mistakes };
    let lines = Lines::of(text);
    let syntax = |error: &toml::de::Error| {
        let start = error.span().map_or(0, |span| span.start);
        let message = format!("not TOML: {} in `{}`", error.message(), lines.around(start));
        mistaken(vec![Mistake { place: lines.place(start), key: String::new(), message }])
    };
    // A value that a setting has replaced does not stand in the text, and neither does a listed task.
    let mistake = |start: usize, key: &KeyPath, message: String| {
        let setting = settings.iter().rev().find(|setting| setting.covers(key));
        let place = setting
            .map(|setting| MistakePlace::Setting(setting.to_string()))
            .or_else(|| Some(tasks?.get(task_of(key)?)?.place.clone()))
            .unwrap_or_else(|| lines.place(start));
        Mistake { place, key: key.to_string(), message }
    };

    let mut file = DeTable::parse(text).map_err(|error| syntax(&error))?;
    if file.get_ref().is_empty() {
        return Err(ScenarioError::Empty { path: path.into() });
    }
    let listed = tasks.map(as_text).transpose().map_err(|error| {
        let (place, message) = (lines.place(0), error.to_string());
        mistaken(vec![Mistake { place, key: "task".into(), message }])
    })?;
    if let Some(listed) = &listed {
        let list = DeTable::parse(listed).map_err(|error| syntax(&error))?;
        file.get_mut().remove("task");
        file.get_mut().extend(list.into_inner());
    }
    for setting in settings {
        setting.apply(file.get_mut()).map_err(|message| {
            let place = MistakePlace::Setting(setting.to_string());
            mistaken(vec![Mistake { place, key: String::new(), message }])
        })?;
    }
    let departures = shape::departures(&file);
    if !departures.is_empty() {
        let mistakes = (departures.into_iter())
            .map(|departure| mistake(departure.span.start, &departure.key, departure.message));
        return Err(mistaken(mistakes.collect()));
    }
    let scenario = Scenario::deserialize(toml::Deserializer::from(file.clone()))
        .map_err(|error| syntax(&error))?;
    ValidScenario::new(scenario).map_err(|invalid| {
        let mistakes = (invalid.faults.iter())
            .map(|fault| mistake(file.start_of(&fault.key), &fault.key, fault.problem.to_string()));
        mistaken(mistakes.collect())
    })
}

/// Tasks as the text of a scenario states them, so that settings can replace their values, too.
fn as_text(tasks: &[ListedTask]) -> Result<String, toml::ser::Error> {
    #[derive(Serialize)]
    struct Table {
        task: Vec<Task>,
    }
    toml::to_string(&Table { task: tasks.iter().map(|listed| listed.task).collect() })
}

/// The number of the task that a key leads into.
fn task_of(key: &KeyPath) -> Option<usize> {
    match key.steps() {
        [KeyStep::Key(table), KeyStep::Index(task), ..] if table == "task" => Some(*task),
        _ => None,
    }
}

fn one_per_line(path: &Path, mistakes: &[Mistake]) -> String {
    let line = |mistake: &Mistake| match mistake.place {
        MistakePlace::Text { .. } => format!("{}:{mistake}", path.display()),
        MistakePlace::Setting(_) | MistakePlace::Table { .. } => {
            format!("{} with {mistake}", path.display())
        }
    };
    mistakes.iter().map(line).collect::<Vec<_>>().join("\n")
}
