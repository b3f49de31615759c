//! Predicates under a name.

use std::fmt;
use std::sync::Arc;

use crate::predicate::{Predicate, Verdict};
use crate::valuation::{EvaluationError, Valuation};

/// A predicate under the name by which diagrams, errors and reports refer to it.
///
/// ```
/// use pleach_guards::{variable, Guard};
///
/// let due = Guard::new("due", variable("clock").at_least(variable("period")));
/// assert_eq!(due.to_string(), "due: clock ≥ period");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Guard {
    name: Arc<str>,
    predicate: Predicate,
}

impl Guard {
    /// `predicate` under `name`.
    pub fn new(name: &str, predicate: Predicate) -> Self {
        Guard { name: name.into(), predicate }
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What must hold.
    pub fn predicate(&self) -> &Predicate {
        &self.predicate
    }

    /// Verdict and margin in `state`; errors as for [`Predicate::evaluate`].
    pub fn evaluate(&self, state: &(impl Valuation + ?Sized)) -> Result<Verdict, EvaluationError> {
        self.predicate.evaluate(state)
    }

    /// Whether the guard holds in `state`; errors as for [`Predicate::evaluate`].
    pub fn holds(&self, state: &(impl Valuation + ?Sized)) -> Result<bool, EvaluationError> {
        self.predicate.holds(state)
    }
}

/// A predicate that goes by its formula.
impl From<Predicate> for Guard {
    fn from(predicate: Predicate) -> Self {
        Guard::new(&predicate.to_string(), predicate)
    }
}

impl fmt::Display for Guard {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", self.name, self.predicate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::variable;

    #[test]
    fn a_guard_says_what_its_predicate_says() {
        let low = variable("x").less_than(1.0);
        let guard = Guard::new("low", low.clone());
        assert_eq!((guard.name(), guard.predicate()), ("low", &low));
        assert_eq!(guard.to_string(), "low: x < 1");
        assert_eq!(Guard::from(low.clone()).name(), "x < 1");
        for x in [0.5, 1.0] {
            let state = [("x", x)];
            assert_eq!(guard.evaluate(&state), low.evaluate(&state));
            assert_eq!(guard.holds(&state), Ok(x < 1.0));
        }
    }
}
