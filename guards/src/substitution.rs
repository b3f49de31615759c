//! Expressions in the place of variables.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;

use crate::expression::Expression;
use crate::function::NamedFunction;
use crate::predicate::{Comparison, Predicate};
use crate::valuation::{EvaluationError, Valuation};

/// Which expression stands for which variable: names that a composition changes, or what a reset
/// assigns.
///
/// All variables are replaced at once, and what replaces them is left as it is:
///
/// ```
/// use pleach_guards::{Substitution, variable};
///
/// let bounce = Substitution::new([
///     ("height", variable("height")),
///     ("velocity", -0.5 * variable("velocity")),
/// ]);
/// let rising = variable("velocity").more_than(0.0);
/// assert_eq!(rising.substitute(&bounce).to_string(), "−0.5 · velocity > 0");
///
/// let turn = Substitution::new([("x", variable("y")), ("y", -variable("x"))]);
/// assert_eq!((variable("x") + variable("y")).substitute(&turn).to_string(), "y + (−x)");
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Substitution {
    replacements: BTreeMap<String, Expression>,
}

impl Substitution {
    /// These expressions for these variables; the first expression for a name counts.
    pub fn new<N: Into<String>>(replacements: impl IntoIterator<Item = (N, Expression)>) -> Self {
        let mut substitution = Substitution::default();
        for (name, expression) in replacements {
            substitution.replacements.entry(name.into()).or_insert(expression);
        }
        substitution
    }

    /// New names for variables, as pairs of old and new.
    pub fn renaming<'a>(names: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        Substitution::new(names.into_iter().map(|(old, new)| (old, crate::variable(new))))
    }

    /// What stands for `variable`, or `None` if it stays as it is.
    pub fn replacement(&self, variable: &str) -> Option<&Expression> {
        self.replacements.get(variable)
    }
}

impl Expression {
    /// The expression with each variable replaced that has a replacement.
    pub fn substitute(&self, substitution: &Substitution) -> Expression {
        let Ok(substituted) = self.fold(&mut |part, operands| {
            let replacement = match part {
                Expression::Variable(name) => substitution.replacement(name).cloned(),
                _ => None,
            };
            Ok::<_, Infallible>(replacement.unwrap_or_else(|| part.with_operands(operands)))
        });
        substituted
    }
}

impl Predicate {
    /// The predicate with each variable replaced that has a replacement.
    ///
    /// A named function keeps its name and reads the replaced variables; it is another function
    /// then, also if nothing is replaced.
    pub fn substitute(&self, substitution: &Substitution) -> Predicate {
        let replaced = |parts: &[Predicate]| -> Arc<[Predicate]> {
            parts.iter().map(|part| part.substitute(substitution)).collect()
        };
        match self {
            Predicate::Comparison(comparison) => {
                Predicate::Comparison(comparison.substitute(substitution))
            }
            Predicate::Not(inner) => Predicate::Not(Arc::new(inner.substitute(substitution))),
            Predicate::All(parts) => Predicate::All(replaced(parts)),
            Predicate::Any(parts) => Predicate::Any(replaced(parts)),
            Predicate::Proposition(_) => self.clone(),
            Predicate::Function(function) => {
                Predicate::Function(replace_in(function, substitution))
            }
        }
    }
}

impl Comparison {
    /// The comparison with each variable replaced that has a replacement.
    pub fn substitute(&self, substitution: &Substitution) -> Comparison {
        Comparison {
            left: self.left.substitute(substitution),
            relation: self.relation,
            right: self.right.substitute(substitution),
        }
    }
}

fn replace_in(function: &NamedFunction, substitution: &Substitution) -> NamedFunction {
    let (inner, substitution) = (function.clone(), substitution.clone());
    NamedFunction::new(function.name(), move |state| {
        inner.margin(&Substituted { state, substitution: &substitution })
    })
}

/// A state in which some variables have the values of their replacements.
struct Substituted<'a> {
    state: &'a dyn Valuation,
    substitution: &'a Substitution,
}

impl Valuation for Substituted<'_> {
    /// A replacement that is not a number gives NaN, which is an error wherever it is read.
    fn value(&self, variable: &str) -> Option<f64> {
        let Some(replacement) = self.substitution.replacement(variable) else {
            return self.state.value(variable);
        };
        match replacement.evaluate(self.state) {
            Ok(value) => Some(value),
            Err(EvaluationError::UnknownVariable { .. }) => None,
            Err(_) => Some(f64::NAN),
        }
    }
}
