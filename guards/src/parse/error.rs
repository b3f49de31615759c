//! What is wrong with a text, and where.

use std::borrow::Cow;
use std::error::Error;
use std::fmt;

/// Text that is no expression or no predicate: where it goes wrong, what could stand there, and
/// what does.
///
/// ```
/// use pleach_guards::Predicate;
///
/// let error = "x + ≤ 3".parse::<Predicate>().unwrap_err();
/// let text = "column 5: expected a number, a name, `(`, `|`, `√` or `−`, found `≤`";
/// assert_eq!(error.to_string(), text);
/// assert_eq!(error.column(), 5);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseError {
    column: usize,
    expected: Cow<'static, str>,
    found: String,
}

impl ParseError {
    pub(super) fn new(column: usize, expected: impl Into<Cow<'static, str>>, found: &str) -> Self {
        ParseError { column, expected: expected.into(), found: found.to_owned() }
    }

    /// The number of the character at which the text goes wrong, from 1; at the end of the text it
    /// is one more than there are characters.
    pub fn column(&self) -> usize {
        self.column
    }

    /// What could stand there, in words.
    pub fn expected(&self) -> &str {
        &self.expected
    }

    /// The part of the text that stands there instead; nothing at the end of the text.
    pub fn found(&self) -> &str {
        &self.found
    }
}

impl fmt::Display for ParseError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "column {}: expected {}, found ", self.column, self.expected)?;
        if self.found.is_empty() {
            formatter.write_str("the end")
        } else {
            write!(formatter, "`{}`", self.found)
        }
    }
}

impl Error for ParseError {}
