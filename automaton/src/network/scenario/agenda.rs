//! `[mission]`: which of the tasks is announced next, and what becomes of one that no robot can service.

use serde::{Deserialize, Serialize};

/// What a task that no robot can service means for the others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unreachable {
    /// The task is given up: its team is dissolved, and the mission goes on with the others.
    #[default]
    Skip,
    /// The mission ends.
    End,
}

/// Which of the tasks that the user asks for is announced next. Ties go to the task that comes first in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TaskOrder {
    /// The one that comes first in the file.
    #[default]
    File,
    /// The one with the shortest way to it from an access point or from a task that is serviced.
    Nearest,
    /// The one with the highest priority.
    Priority,
}

/// The keys of `[mission]`; a key left out takes its default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Agenda {
    /// What a task that no robot can service means for the others. Default `skip`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unreachable: Option<Unreachable>,
    /// Which of the tasks is announced next. Default `file`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<TaskOrder>,
}

/// The keys of `[mission]` with the words that may stand there, in the order of the documentation.
pub const AGENDA: &[(&str, &[&str])] =
    &[("unreachable", &["skip", "end"]), ("order", &["file", "nearest", "priority"])];

impl Agenda {
    /// Whether it states nothing.
    pub(super) fn is_default(&self) -> bool {
        *self == Agenda::default()
    }
}
