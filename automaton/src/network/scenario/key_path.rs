//! Where in a scenario a value stands: `robot[3].position`.

use std::fmt;

/// The way from the root of a scenario to one of its values, robots and the like counted from 0.
///
/// ```
/// use pleach_automaton::network::scenario::KeyPath;
///
/// let key = KeyPath::root().key("robot").index(3).key("position");
/// assert_eq!(key.to_string(), "robot[3].position");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KeyPath(Vec<KeyStep>);

/// One step of a [`KeyPath`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KeyStep {
    /// Into the value of a key.
    Key(String),
    /// Into an element of an array.
    Index(usize),
}

impl KeyPath {
    /// The scenario as a whole.
    pub fn root() -> Self {
        Self::default()
    }

    /// The value of `name` in the table that this path leads to.
    #[must_use]
    pub fn key(mut self, name: impl Into<String>) -> Self {
        self.0.push(KeyStep::Key(name.into()));
        self
    }

    /// Element `index` of the array that this path leads to.
    #[must_use]
    pub fn index(mut self, index: usize) -> Self {
        self.0.push(KeyStep::Index(index));
        self
    }

    /// The steps, from the root on.
    pub fn steps(&self) -> &[KeyStep] {
        &self.0
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, step) in self.0.iter().enumerate() {
            match step {
                KeyStep::Key(name) if place == 0 => write!(formatter, "{name}")?,
                KeyStep::Key(name) => write!(formatter, ".{name}")?,
                KeyStep::Index(index) => write!(formatter, "[{index}]")?,
            }
        }
        Ok(())
    }
}
