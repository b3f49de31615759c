//! A value of a scenario that is set from outside its file: `control.step_radius=0.02`.

use crate::automaton::network::scenario::{KeyPath, KeyStep};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// A key of a scenario with the value that it is to have, written `KEY=VALUE`.
///
/// The key is written as error messages write it, `control.period` or `robot[3].rate`; `robot[*]`
/// stands for every robot. The value is written as in the file; a text needs no quotation marks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    steps: Vec<Step>,
    value: String,
}

/// A step to the value that is set.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Step {
    Key(String),
    Index(usize),
    /// All elements of a list.
    Every,
}

/// Why a text is no [`Setting`].
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SettingError {
    /// There is no `=`.
    #[error("{0:?} is not a setting: write KEY=VALUE, such as control.step_radius=0.02")]
    NoValue(String),
    /// The key cannot be read.
    #[error(
        "{0:?} is no key: write names with dots between them and indices in brackets, such as \
         robot[3].rate, or robot[*].rate for every robot"
    )]
    NoKey(String),
}

impl FromStr for Setting {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let (key, value) =
            text.split_once('=').ok_or_else(|| SettingError::NoValue(text.into()))?;
        let steps = read_key(key.trim()).ok_or_else(|| SettingError::NoKey(key.trim().into()))?;
        Ok(Self { steps, value: value.trim().into() })
    }
}

fn read_key(key: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    for part in key.split('.') {
        let (name, brackets) = part.split_at(part.find('[').unwrap_or(part.len()));
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || !name.chars().all(is_name) {
            return None;
        }
        steps.push(Step::Key(name.into()));
        for index in brackets.split_terminator(']') {
            steps.push(match index.strip_prefix('[')? {
                "*" => Step::Every,
                number => Step::Index(number.parse().ok()?),
            });
        }
        if !(brackets.is_empty() || brackets.ends_with(']')) {
            return None;
        }
    }
    Some(steps)
}

impl fmt::Display for Setting {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}={}", self.key(), self.value)
    }
}

impl Setting {
    /// The key, as it is written.
    pub fn key(&self) -> String {
        self.steps.iter().enumerate().fold(String::new(), |key, (place, step)| match step {
            Step::Key(name) if place == 0 => name.clone(),
            Step::Key(name) => format!("{key}.{name}"),
            Step::Index(index) => format!("{key}[{index}]"),
            Step::Every => format!("{key}[*]"),
        })
    }

    /// The value, as it is written.
    pub fn value(&self) -> &str {
        &self.value
    }

    /// The same key with another value.
    #[must_use]
    pub fn with_value(&self, value: impl Into<String>) -> Self {
        Self { steps: self.steps.clone(), value: value.into() }
    }

    /// Whether the value at `key` comes from this setting.
    pub(super) fn covers(&self, key: &KeyPath) -> bool {
        let same = |(step, key_step): (&Step, &KeyStep)| match (step, key_step) {
            (Step::Key(one), KeyStep::Key(other)) => one == other,
            (Step::Index(one), KeyStep::Index(other)) => one == other,
            (Step::Every, KeyStep::Index(_)) => true,
            _ => false,
        };
        key.steps().len() >= self.steps.len() && self.steps.iter().zip(key.steps()).all(same)
    }

    /// Puts the value in its place; tables on the way to it that are missing are made.
    pub(super) fn apply<'v>(&'v self, file: &mut DeTable<'v>) -> Result<(), String> {
        // What is no value of TOML is a text without quotation marks.
        let value = DeValue::parse(&self.value)
            .unwrap_or_else(|_| Spanned::new(0..0, DeValue::String(self.value.as_str().into())));
        put_into_table(file, &self.steps, value)
    }
}

fn put_into_table<'v>(
    table: &mut DeTable<'v>,
    steps: &'v [Step],
    value: Spanned<DeValue<'v>>,
) -> Result<(), String> {
    let Some((Step::Key(name), rest)) = steps.split_first() else {
        return Err("an index stands where the name of a key belongs".into());
    };
    if rest.is_empty() {
        table.insert(Spanned::new(0..0, name.as_str().into()), value);
        return Ok(());
    }
    if !table.contains_key(name.as_str()) {
        if !matches!(rest[0], Step::Key(_)) {
            return Err(format!("the scenario has no {name}"));
        }
        let empty = Spanned::new(0..0, DeValue::Table(DeTable::new()));
        table.insert(Spanned::new(0..0, name.as_str().into()), empty);
    }
    match table.get_mut(name.as_str()).map(Spanned::get_mut) {
        Some(DeValue::Table(table)) => put_into_table(table, rest, value),
        Some(DeValue::Array(elements)) => put_into_list(name, elements, rest, value),
        _ => Err(format!("{name} is neither a table nor a list")),
    }
}

fn put_into_list<'v>(
    name: &str,
    elements: &mut DeArray<'v>,
    steps: &'v [Step],
    value: Spanned<DeValue<'v>>,
) -> Result<(), String> {
    let count = elements.len();
    let Some((step, rest)) = steps.split_first() else { return Ok(()) };
    let chosen = match step {
        Step::Every => 0..count,
        Step::Index(index) if *index < count => *index..index + 1,
        Step::Index(index) => {
            return Err(format!("there is no {name}[{index}]: the scenario has {count}"));
        }
        Step::Key(key) => {
            return Err(format!("{name} is a list: write {name}[0].{key} or {name}[*].{key}"));
        }
    };
    for index in chosen {
        let Some(element) = elements.get_mut(index) else { continue };
        if rest.is_empty() {
            *element = value.clone();
            continue;
        }
        match element.get_mut() {
            DeValue::Table(table) => put_into_table(table, rest, value.clone())?,
            DeValue::Array(inner) => put_into_list(name, inner, rest, value.clone())?,
            _ => return Err(format!("{name}[{index}] is neither a table nor a list")),
        }
    }
    Ok(())
}
