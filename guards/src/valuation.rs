//! What expressions are evaluated on, and how that can fail.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt;

/// A state seen through the names of its variables.
///
/// A custom state implements it with a `match`, which costs no allocation:
///
/// ```
/// use pleach_guards::{variable, Valuation};
///
/// struct Ball { height: f64, velocity: f64 }
///
/// impl Valuation for Ball {
///     fn value(&self, variable: &str) -> Option<f64> {
///         match variable {
///             "height" => Some(self.height),
///             "velocity" => Some(self.velocity),
///             _ => None,
///         }
///     }
/// }
///
/// let impact = variable("height").at_most(0.0).and(variable("velocity").less_than(0.0));
/// assert!(impact.holds(&Ball { height: 0.0, velocity: -3.0 })?);
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
pub trait Valuation {
    /// The value of `variable`, or `None` if the state has no variable of that name.
    fn value(&self, variable: &str) -> Option<f64>;

    /// Whether `proposition` is true, or `None` if the state has no proposition of that name.
    fn truth(&self, _proposition: &str) -> Option<bool> {
        None
    }
}

impl<V: Valuation + ?Sized> Valuation for &V {
    fn value(&self, variable: &str) -> Option<f64> {
        (**self).value(variable)
    }

    fn truth(&self, proposition: &str) -> Option<bool> {
        (**self).truth(proposition)
    }
}

/// The state without variables.
impl Valuation for () {
    fn value(&self, _variable: &str) -> Option<f64> {
        None
    }
}

/// Pairs of name and value; the first pair of a name counts.
impl Valuation for [(&str, f64)] {
    fn value(&self, variable: &str) -> Option<f64> {
        self.iter().find(|(name, _)| *name == variable).map(|(_, value)| *value)
    }
}

/// Pairs of name and value; the first pair of a name counts.
impl<const N: usize> Valuation for [(&str, f64); N] {
    fn value(&self, variable: &str) -> Option<f64> {
        self.as_slice().value(variable)
    }
}

impl Valuation for BTreeMap<String, f64> {
    fn value(&self, variable: &str) -> Option<f64> {
        self.get(variable).copied()
    }
}

/// Why an expression or a predicate has no value in a state.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EvaluationError {
    /// The state has no variable of this name.
    UnknownVariable {
        /// The name asked for.
        variable: String,
    },
    /// The state has no proposition of this name.
    UnknownProposition {
        /// The name asked for.
        proposition: String,
    },
    /// The state lacks the data that a location needs to be entered.
    MissingData {
        /// The location.
        location: &'static str,
    },
    /// A part of an expression is not a number, such as 0 ÷ 0, ∞ − ∞ or √−1.
    ///
    /// This is an error and not a verdict: if a comparison with such a part did "not hold", its
    /// negation would hold.
    NotANumber {
        /// The smallest such part, as text.
        expression: String,
    },
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownVariable { variable } => {
                write!(formatter, "the state has no variable `{variable}`")
            }
            Self::UnknownProposition { proposition } => {
                write!(formatter, "the state has no proposition `{proposition}`")
            }
            Self::MissingData { location } => {
                write!(formatter, "the state lacks the data that location `{location}` needs")
            }
            Self::NotANumber { expression } => {
                write!(formatter, "`{expression}` is not a number in this state")
            }
        }
    }
}

impl Error for EvaluationError {}

#[cfg(test)]
mod tests {
    use super::*;

    /// The value of `variable`, as a state behind a reference gives it.
    fn value(state: impl Valuation, variable: &str) -> Option<f64> {
        state.value(variable)
    }

    #[test]
    fn states_are_seen_through_names() {
        let pairs = [("x", 0.25), ("y", 7.0), ("x", 5.0)];
        let named = BTreeMap::from([("x".to_owned(), 0.25), ("y".to_owned(), 7.0)]);
        for (name, expected) in [("x", Some(0.25)), ("y", Some(7.0)), ("z", None)] {
            assert_eq!(value(pairs, name), expected);
            assert_eq!(value(pairs.as_slice(), name), expected);
            assert_eq!(value(&named, name), expected);
            assert_eq!(named.value(name), expected);
            assert_eq!(value((), name), None);
        }
    }

    #[test]
    fn errors_say_what_is_missing() {
        let unknown = EvaluationError::UnknownVariable { variable: "y".into() };
        assert_eq!(unknown.to_string(), "the state has no variable `y`");
        let unknown = EvaluationError::UnknownProposition { proposition: "p".into() };
        assert_eq!(unknown.to_string(), "the state has no proposition `p`");
        let undefined = EvaluationError::NotANumber { expression: "0 ÷ 0".into() };
        assert_eq!(undefined.to_string(), "`0 ÷ 0` is not a number in this state");
    }
}
