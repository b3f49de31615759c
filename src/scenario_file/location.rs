//! From keys and bytes to lines and columns.

use super::MistakePlace;
use crate::automaton::network::scenario::{KeyPath, KeyStep};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A parsed file in which keys can be found again.
pub(super) trait Located {
    /// The first byte of the value at `key`, or of the deepest table or list on the way to it
    /// where the file leaves the key out.
    fn start_of(&self, key: &KeyPath) -> usize;
}

impl Located for Spanned<DeTable<'_>> {
    fn start_of(&self, key: &KeyPath) -> usize {
        let Some((KeyStep::Key(first), rest)) = key.steps().split_first() else {
            return self.span().start;
        };
        match self.get_ref().get(first.as_str()) {
            Some(value) => start_below(value, rest),
            None => self.span().start,
        }
    }
}

fn start_below(value: &Spanned<DeValue<'_>>, steps: &[KeyStep]) -> usize {
    let below = steps.split_first().and_then(|(step, rest)| {
        let next = match (value.get_ref(), step) {
            (DeValue::Table(table), KeyStep::Key(name)) => table.get(name.as_str()),
            (DeValue::Array(elements), KeyStep::Index(index)) => elements.get(*index),
            _ => None,
        };
        next.map(|next| start_below(next, rest))
    });
    below.unwrap_or(value.span().start)
}

/// A text with the starts of its lines.
pub(super) struct Lines<'t> {
    text: &'t str,
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    pub(super) fn of(text: &'t str) -> Self {
        let after_breaks = text.match_indices('\n').map(|(newline, _)| newline + 1);
        Self { text, starts: std::iter::once(0).chain(after_breaks).collect() }
    }

    /// The line that holds byte `start`, without blanks at its ends.
    pub(super) fn around(&self, start: usize) -> &'t str {
        let line = self.line_of(start);
        let end = self.starts.get(line + 1).map_or(self.text.len(), |&next| next);
        self.text[self.starts[line]..end].trim()
    }

    /// Line and column of byte `start`.
    pub(super) fn place(&self, start: usize) -> MistakePlace {
        let line = self.line_of(start);
        let before = &self.text[self.starts[line]..self.text.floor_char_boundary(start)];
        MistakePlace::Text { line: line + 1, column: before.chars().count() + 1 }
    }

    /// The index of the line that holds byte `start`.
    fn line_of(&self, start: usize) -> usize {
        self.starts.partition_point(|&line| line <= start) - 1
    }
}
