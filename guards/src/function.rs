//! Functions under a name, for what no expression can say.

use std::fmt;
use std::sync::Arc;

use crate::valuation::{EvaluationError, Valuation};

/// The margin of a [`NamedFunction`] in a state.
type Margin = dyn Fn(&dyn Valuation) -> Result<f64, EvaluationError> + Send + Sync;

/// A function that measures the margin of a predicate, under the name by which it is printed.
///
/// It is opaque: what it reads, and where it holds, is known only by calling it. Analyses can
/// therefore say nothing about it and report it as unchecked. A clone equals its original; two
/// functions made apart are different, even if they have one name.
#[derive(Clone)]
pub struct NamedFunction {
    name: Arc<str>,
    margin: Arc<Margin>,
}

impl NamedFunction {
    /// The function called `name` that computes its margin by `margin`.
    pub fn new(
        name: &str,
        margin: impl Fn(&dyn Valuation) -> Result<f64, EvaluationError> + Send + Sync + 'static,
    ) -> Self {
        NamedFunction { name: name.into(), margin: Arc::new(margin) }
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The margin in `state`, possibly infinite and never NaN.
    ///
    /// # Errors
    ///
    /// Those of the function itself, and [`EvaluationError::NotANumber`] where it returns NaN.
    pub fn margin(&self, state: &(impl Valuation + ?Sized)) -> Result<f64, EvaluationError> {
        let margin = (self.margin)(&state)?;
        if margin.is_nan() {
            return Err(EvaluationError::NotANumber { expression: format!("{}(…)", self.name) });
        }
        Ok(margin)
    }
}

impl PartialEq for NamedFunction {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && Arc::ptr_eq(&self.margin, &other.margin)
    }
}

impl fmt::Debug for NamedFunction {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("NamedFunction").field("name", &self.name).finish_non_exhaustive()
    }
}
