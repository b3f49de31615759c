//! From keys and bytes to lines and columns.

use super::Mistake;
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

/// The line of `text` that holds byte `start`, without blanks at its ends.
pub(super) fn line_around(text: &str, start: usize) -> &str {
    let (before, after) = text.split_at(text.floor_char_boundary(start));
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line_end = before.len() + after.find('\n').unwrap_or(after.len());
    text[line_start..line_end].trim()
}

/// The mistake whose first byte in `text` is `start`.
pub(super) fn mistake(text: &str, start: usize, key: &str, message: &str) -> Mistake {
    let before = &text[..text.floor_char_boundary(start)];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Mistake {
        line: before.matches('\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
        key: key.into(),
        message: message.into(),
    }
}
