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
