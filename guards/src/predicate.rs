//! Comparisons of expressions and their logic, with verdict and margin.

use std::ops;
use std::sync::Arc;

use crate::expression::Expression;
use crate::function::NamedFunction;
use crate::valuation::{EvaluationError, Valuation};

#[cfg(any(kani, test))]
mod proofs;

mod names;
mod verdict;

pub use verdict::Verdict;

/// A statement about a state, as data: the one guard type of the project.
///
/// Predicates begin as comparisons ([`Expression::at_most`] and its kin) and combine with
/// [`and`](Predicate::and), [`or`](Predicate::or) and [`not()`], or with `&`, `|` and `!`:
///
/// ```
/// use pleach_guards::variable;
///
/// let temperature = variable("temperature");
/// let comfortable = temperature.at_least(19.0) & temperature.less_than(23.0);
///
/// let verdict = comfortable.evaluate(&[("temperature", 22.0)])?;
/// assert!(verdict.holds);
/// assert_eq!(verdict.margin, 1.0);
/// assert_eq!((!comfortable).to_string(), "¬(temperature ≥ 19 ∧ temperature < 23)");
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
///
/// Where no expression can say what is needed, [`Predicate::function`] takes a closure.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Predicate {
    /// A comparison of two expressions.
    Comparison(Comparison),
    /// The opposite of a predicate.
    Not(Arc<Predicate>),
    /// All of them hold; with none, this is [`always()`].
    All(Arc<[Predicate]>),
    /// At least one of them holds; with none, this is [`never()`].
    Any(Arc<[Predicate]>),
    /// A named statement that is true or false, without a measure of how far it is from the other.
    Proposition(Arc<str>),
    /// The margin that a function computes is at least 0.
    Function(NamedFunction),
}

/// Two expressions and how they are to compare.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What stands on the left.
    pub left: Expression,
    /// How the two are to compare.
    pub relation: Relation,
    /// What stands on the right.
    pub right: Expression,
}

/// An order between two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Relation {
    /// a ≤ b
    AtMost,
    /// a < b
    LessThan,
    /// a ≥ b
    AtLeast,
    /// a > b
    MoreThan,
}

/// The predicate that every state satisfies, with margin ∞.
pub fn always() -> Predicate {
    Predicate::All(Arc::new([]))
}

/// The predicate that no state satisfies, with margin −∞.
pub fn never() -> Predicate {
    Predicate::Any(Arc::new([]))
}

/// The atomic proposition called `name`: its truth is read off the state
/// ([`Valuation::truth`]), and its margin is ∞ where it is true and −∞ where it is false.
///
/// ```
/// use pleach_guards::{Valuation, proposition, variable};
///
/// struct Door { angle: f64, is_locked: bool }
///
/// impl Valuation for Door {
///     fn value(&self, variable: &str) -> Option<f64> {
///         (variable == "angle").then_some(self.angle)
///     }
///     fn truth(&self, proposition: &str) -> Option<bool> {
///         (proposition == "locked").then_some(self.is_locked)
///     }
/// }
///
/// let may_close = variable("angle").at_most(0.1) & !proposition("locked");
/// assert_eq!(may_close.to_string(), "angle ≤ 0.1 ∧ ¬locked");
/// let verdict = may_close.evaluate(&Door { angle: 0.0, is_locked: false })?;
/// assert_eq!((verdict.holds, verdict.margin), (true, 0.1));
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
pub fn proposition(name: &str) -> Predicate {
    Predicate::Proposition(name.into())
}

/// The predicate that holds where `predicate` does not.
pub fn not(predicate: Predicate) -> Predicate {
    Predicate::Not(Arc::new(predicate))
}

impl Expression {
    /// self ≤ `bound`, with margin `bound` − self.
    pub fn at_most(&self, bound: impl Into<Expression>) -> Predicate {
        self.compare(Relation::AtMost, bound.into())
    }

    /// self < `bound`, with margin `bound` − self.
    pub fn less_than(&self, bound: impl Into<Expression>) -> Predicate {
        self.compare(Relation::LessThan, bound.into())
    }

    /// self ≥ `bound`, with margin self − `bound`.
    pub fn at_least(&self, bound: impl Into<Expression>) -> Predicate {
        self.compare(Relation::AtLeast, bound.into())
    }

    /// self > `bound`, with margin self − `bound`.
    pub fn more_than(&self, bound: impl Into<Expression>) -> Predicate {
        self.compare(Relation::MoreThan, bound.into())
    }

    /// |self − `other`| ≤ `tolerance`, with margin `tolerance` − |self − `other`|.
    pub fn equals_within(
        &self,
        other: impl Into<Expression>,
        tolerance: impl Into<Expression>,
    ) -> Predicate {
        (self - other.into()).abs().at_most(tolerance)
    }

    fn compare(&self, relation: Relation, right: Expression) -> Predicate {
        Predicate::Comparison(Comparison { left: self.clone(), relation, right })
    }
}

impl Predicate {
    /// The predicate that holds where `margin` is at least 0: a way out where an expression cannot
    /// say what is needed. It is printed as its name with an ellipsis.
    ///
    /// ```
    /// use pleach_guards::{Predicate, Verdict, variable};
    ///
    /// // The table has one torque per finger.
    /// let table = [0.5, 0.75, 1.0];
    /// let grasped = Predicate::function("grasped", move |state| {
    ///     let torque = variable("torque").evaluate(state)?;
    ///     Ok(table.iter().map(|least| torque - least).fold(f64::INFINITY, f64::min))
    /// });
    ///
    /// let held = grasped.and(variable("height").more_than(0.0));
    /// assert_eq!(held.to_string(), "grasped(…) ∧ height > 0");
    /// let verdict = held.evaluate(&[("torque", 1.25), ("height", 2.0)])?;
    /// assert_eq!(verdict, Verdict { margin: 0.25, holds: true });
    /// assert!(!held.is_data());
    /// # Ok::<(), pleach_guards::EvaluationError>(())
    /// ```
    pub fn function(
        name: &str,
        margin: impl Fn(&dyn Valuation) -> Result<f64, EvaluationError> + Send + Sync + 'static,
    ) -> Predicate {
        Predicate::Function(NamedFunction::new(name, margin))
    }

    /// Both hold. Conjunctions stay flat: `a.and(b).and(c)` is one conjunction of three.
    pub fn and(self, other: Predicate) -> Predicate {
        Predicate::all([self, other])
    }

    /// At least one of the two holds. Disjunctions stay flat.
    pub fn or(self, other: Predicate) -> Predicate {
        Predicate::any([self, other])
    }

    /// All of `predicates` hold; of one predicate, it is that predicate itself.
    pub fn all(predicates: impl IntoIterator<Item = Predicate>) -> Predicate {
        let mut parts = Vec::new();
        for predicate in predicates {
            match predicate {
                Predicate::All(inner) => parts.extend(inner.iter().cloned()),
                other => parts.push(other),
            }
        }
        match <[Predicate; 1]>::try_from(parts) {
            Ok([only]) => only,
            Err(parts) => Predicate::All(parts.into()),
        }
    }

    /// At least one of `predicates` holds; of one predicate, it is that predicate itself.
    pub fn any(predicates: impl IntoIterator<Item = Predicate>) -> Predicate {
        let mut parts = Vec::new();
        for predicate in predicates {
            match predicate {
                Predicate::Any(inner) => parts.extend(inner.iter().cloned()),
                other => parts.push(other),
            }
        }
        match <[Predicate; 1]>::try_from(parts) {
            Ok([only]) => only,
            Err(parts) => Predicate::Any(parts.into()),
        }
    }

    /// Verdict and margin in `state`.
    ///
    /// # Errors
    ///
    /// Those of [`Expression::evaluate`] and [`NamedFunction::margin`]. Every part is evaluated,
    /// also where the verdict is settled before, so that an error does not depend on the order of
    /// the parts.
    pub fn evaluate(&self, state: &(impl Valuation + ?Sized)) -> Result<Verdict, EvaluationError> {
        match self {
            Predicate::Comparison(comparison) => comparison.evaluate(state),
            Predicate::Not(inner) => inner.evaluate(state).map(Verdict::opposite),
            Predicate::All(parts) => parts
                .iter()
                .try_fold(Verdict::ALWAYS, |verdict, part| Ok(verdict.and(part.evaluate(state)?))),
            Predicate::Any(parts) => parts
                .iter()
                .try_fold(Verdict::NEVER, |verdict, part| Ok(verdict.or(part.evaluate(state)?))),
            Predicate::Proposition(name) => Verdict::of(name, state),
            Predicate::Function(function) => {
                let margin = function.margin(state)?;
                Ok(Verdict { margin, holds: margin >= 0.0 })
            }
        }
    }

    /// Whether the predicate holds in `state`; errors as for [`evaluate`](Self::evaluate).
    pub fn holds(&self, state: &(impl Valuation + ?Sized)) -> Result<bool, EvaluationError> {
        self.evaluate(state).map(|verdict| verdict.holds)
    }

    /// The margin in `state`; errors as for [`evaluate`](Self::evaluate).
    pub fn margin(&self, state: &(impl Valuation + ?Sized)) -> Result<f64, EvaluationError> {
        self.evaluate(state).map(|verdict| verdict.margin)
    }
}

impl Comparison {
    /// Verdict and margin in `state`; errors as for [`Expression::evaluate`].
    pub fn evaluate(&self, state: &(impl Valuation + ?Sized)) -> Result<Verdict, EvaluationError> {
        let (left, right) = (self.left.evaluate(state)?, self.right.evaluate(state)?);
        Ok(self.relation.judge(left, right))
    }
}

impl ops::Not for Predicate {
    type Output = Predicate;

    fn not(self) -> Predicate {
        not(self)
    }
}

impl ops::BitAnd for Predicate {
    type Output = Predicate;

    fn bitand(self, other: Predicate) -> Predicate {
        self.and(other)
    }
}

impl ops::BitOr for Predicate {
    type Output = Predicate;

    fn bitor(self, other: Predicate) -> Predicate {
        self.or(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::variable;

    fn verdict(predicate: &Predicate, x: f64) -> (f64, bool) {
        let verdict = predicate.evaluate(&[("x", x)]).expect("x is the only variable");
        (verdict.margin, verdict.holds)
    }

    #[test]
    fn strictness_decides_on_the_boundary() {
        let x = variable("x");
        assert_eq!(verdict(&x.at_most(1.0), 1.0), (0.0, true));
        assert_eq!(verdict(&x.less_than(1.0), 1.0), (0.0, false));
        assert_eq!(verdict(&x.at_least(1.0), 1.0), (0.0, true));
        assert_eq!(verdict(&x.more_than(1.0), 1.0), (0.0, false));
        assert_eq!(verdict(&not(x.at_most(1.0)), 1.0), (0.0, false));
        assert_eq!(verdict(&x.equals_within(0.75, 0.25), 1.0), (0.0, true));
    }

    #[test]
    fn margins_measure_the_distance_to_the_other_verdict() {
        let x = variable("x");
        assert_eq!(verdict(&x.at_most(1.0), 0.25), (0.75, true));
        assert_eq!(verdict(&x.at_least(1.0), 0.25), (-0.75, false));
        assert_eq!(verdict(&x.at_least(0.0).and(x.at_most(1.0)), 0.25), (0.25, true));
        assert_eq!(verdict(&x.at_most(0.0).or(x.at_least(1.0)), 0.25), (-0.25, false));
        assert_eq!(verdict(&always(), 0.25), (f64::INFINITY, true));
        assert_eq!(verdict(&never(), 0.25), (f64::NEG_INFINITY, false));
    }

    #[test]
    fn variables_are_listed_once_in_order() {
        let [a, b, c] = ["a", "b", "c"].map(variable);
        let predicate = c.at_most(&a).and(not(b.at_most(&a).or(c.less_than(1.0))));
        assert!(predicate.variables().into_iter().eq(["a", "b", "c"]));
    }

    #[test]
    fn verdict_and_margin_are_parts_of_what_is_evaluated() {
        let low = variable("x").less_than(0.5);
        for x in [-2.0, 0.5, 3.0] {
            assert_eq!(low.margin(&[("x", x)]), Ok(0.5 - x));
            assert_eq!(low.holds(&[("x", x)]), Ok(x < 0.5));
        }
        assert!(Verdict { margin: 0.0, holds: false }.is_consistent());
        assert!(!Verdict { margin: 0.25, holds: false }.is_consistent());
        assert!(!Verdict { margin: -0.25, holds: true }.is_consistent());
    }

    #[test]
    fn infinity_equals_itself() {
        assert_eq!(verdict(&variable("x").at_most(f64::INFINITY), f64::INFINITY), (0.0, true));
    }

    #[test]
    fn every_part_is_evaluated() {
        let predicate = never().and(variable("y").at_most(0.0));
        assert!(predicate.evaluate(&[("x", 0.0)]).is_err());
    }

    #[test]
    fn functions_are_named_and_compared_by_identity() {
        let near = |limit: f64| {
            Predicate::function("near", move |state| {
                Ok(limit - variable("x").evaluate(state)?.abs())
            })
        };
        let (one, other) = (near(1.0), near(1.0));
        assert_eq!(verdict(&one, 1.0), (0.0, true));
        assert_eq!(verdict(&not(one.clone()), 1.0), (0.0, false));
        assert_eq!(one, one.clone());
        assert!(format!("{one:?}").contains("near"));
        assert_ne!(one, other);
        let mixed = not(one).or(variable("x").at_most(0.0));
        assert!(mixed.functions().into_iter().eq(["near"]));
        assert!(!mixed.is_data());
        assert!(variable("x").at_most(0.0).is_data());
    }

    #[test]
    fn functions_that_fail_say_so() {
        let unknown = Predicate::function("far", |state| variable("y").evaluate(state));
        let error = EvaluationError::UnknownVariable { variable: "y".into() };
        assert_eq!(unknown.evaluate(&[("x", 1.0)]), Err(error));
        let undefined = Predicate::function("odd", |_| Ok(f64::NAN));
        let error = EvaluationError::NotANumber { expression: "odd(…)".into() };
        assert_eq!(undefined.evaluate(&[("x", 1.0)]), Err(error));
    }

    #[test]
    fn conjunctions_and_disjunctions_stay_flat() {
        let [a, b, c] = ["a", "b", "c"].map(|name| variable(name).at_most(0.0));
        let left = a.clone().and(b.clone()).and(c.clone());
        assert_eq!(left, a.clone().and(b.and(c)));
        assert_eq!(always().and(a.clone()), a);
        assert_eq!(never().or(a.clone()), a);
    }
}
