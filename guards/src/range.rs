//! What expressions and predicates can be anywhere in a box of states.
//!
//! A box gives each variable an [`Interval`]. Over it, [`Expression::range`] encloses all values
//! and [`Predicate::truth`] has three answers, of which two are proofs:
//!
//! ```
//! use pleach_guards::{Interval, Truth, norm, variable};
//!
//! let near = norm([variable("x"), variable("y")]).at_most(5.0);
//! let unit = Interval::new(0.0, 1.0)?;
//! let far = Interval::new(4.0, 6.0)?;
//!
//! assert_eq!(near.truth(&[("x", unit), ("y", unit)])?, Truth::Always);
//! assert_eq!(near.truth(&[("x", far), ("y", far)])?, Truth::Never);
//! assert_eq!(near.truth(&[("x", far), ("y", unit)])?, Truth::Undecided);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Both are statements about the states of the box in which every part has a value: where √x stands
//! somewhere, they say nothing about a negative x. Because intervals forget how variables depend on
//! each other, a range may be wider than the values, and a predicate undecided that has one truth;
//! smaller boxes are judged more sharply.

use std::collections::BTreeMap;

use crate::expression::{BinaryOperator, Expression, UnaryOperator};
use crate::fold::Operands;
use crate::interval::Interval;
use crate::predicate::{Comparison, Predicate, Relation};
use crate::valuation::EvaluationError;

/// A box of states seen through the names of its variables.
pub trait Ranges {
    /// The values of `variable`, or `None` if the states have no variable of that name.
    fn range(&self, variable: &str) -> Option<Interval>;
}

impl<R: Ranges + ?Sized> Ranges for &R {
    fn range(&self, variable: &str) -> Option<Interval> {
        (**self).range(variable)
    }
}

/// Pairs of name and interval; the first pair of a name counts.
impl Ranges for [(&str, Interval)] {
    fn range(&self, variable: &str) -> Option<Interval> {
        self.iter().find(|(name, _)| *name == variable).map(|(_, range)| *range)
    }
}

/// Pairs of name and interval; the first pair of a name counts.
impl<const N: usize> Ranges for [(&str, Interval); N] {
    fn range(&self, variable: &str) -> Option<Interval> {
        self.as_slice().range(variable)
    }
}

impl Ranges for BTreeMap<String, Interval> {
    fn range(&self, variable: &str) -> Option<Interval> {
        self.get(variable).copied()
    }
}

/// What is known about a predicate in all states of a box in which it has a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// It holds in all of them.
    Always,
    /// It holds in none of them.
    Never,
    /// It may hold in some and not in others.
    Undecided,
}

impl Expression {
    /// An interval that contains the value in every state of the box in which there is one.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if the box lacks a variable, and
    /// [`EvaluationError::NotANumber`] if a part has no value anywhere in the box.
    pub fn range(&self, states: &(impl Ranges + ?Sized)) -> Result<Interval, EvaluationError> {
        let range = self.fold(&mut |part, operands| match part {
            Expression::Variable(name) => states
                .range(name)
                .map(Ok)
                .ok_or_else(|| EvaluationError::UnknownVariable { variable: name.to_string() }),
            _ => Ok(part.range_of(operands)),
        })?;
        range.map_err(|nowhere| EvaluationError::NotANumber { expression: nowhere.to_string() })
    }

    /// Encloses the results of the operation on operands in these intervals; if there are none, the
    /// part that has no value. Of a choice only the part that is chosen need have one.
    fn range_of<'e>(
        &'e self,
        operands: Operands<Result<Interval, &'e Expression>>,
    ) -> Result<Interval, &'e Expression> {
        match (self, operands) {
            (Expression::Constant(value), _) if !value.is_nan() => Ok(Interval::point(*value)),
            (Expression::Unary(operator, _), Operands::One(operand)) => {
                operator.range(operand?).ok_or(self)
            }
            (Expression::Power(_, exponent), Operands::One(base)) => {
                base?.power(*exponent).ok_or(self)
            }
            (Expression::Lookup(table, _), Operands::One(place)) => Ok(table.range(place?)),
            (Expression::Binary(BinaryOperator::Product, left, right), Operands::Two(one, _))
                if left == right =>
            {
                one?.power(2.0).ok_or(self)
            }
            (Expression::Binary(operator, ..), Operands::Two(left, right)) => {
                Ok(operator.range(left?, right?))
            }
            (Expression::Choice(choice), Operands::Four([left, right, then, otherwise])) => {
                match choice.condition.relation.truth(left?, right?) {
                    Truth::Always => then,
                    Truth::Never => otherwise,
                    Truth::Undecided => match (then, otherwise) {
                        (Ok(then), Ok(otherwise)) => Ok(then.hull(otherwise)),
                        (then, otherwise) => then.or(otherwise),
                    },
                }
            }
            _ => Err(self),
        }
    }
}

impl UnaryOperator {
    pub(crate) fn range(self, operand: Interval) -> Option<Interval> {
        match self {
            UnaryOperator::Negation => Some(-operand),
            UnaryOperator::AbsoluteValue => Some(operand.abs()),
            UnaryOperator::Sine => Some(operand.sin()),
            UnaryOperator::Cosine => Some(operand.cos()),
            UnaryOperator::Tangent => Some(operand.tan()),
            UnaryOperator::HyperbolicTangent => Some(operand.tanh()),
            UnaryOperator::Sign => Some(operand.sign()),
            UnaryOperator::Floor => Some(operand.floor()),
            UnaryOperator::Exponential => Some(operand.exp()),
            UnaryOperator::Logarithm => operand.ln(),
        }
    }
}

impl BinaryOperator {
    pub(crate) fn range(self, left: Interval, right: Interval) -> Interval {
        match self {
            BinaryOperator::Sum => left + right,
            BinaryOperator::Difference => left - right,
            BinaryOperator::Product => left * right,
            BinaryOperator::Quotient => left / right,
            BinaryOperator::Minimum => left.min(right),
            BinaryOperator::Maximum => left.max(right),
            BinaryOperator::Angle => left.atan2(right),
        }
    }
}

impl Predicate {
    /// What is known about the predicate everywhere in the box. Propositions and named functions are
    /// undecided.
    ///
    /// # Errors
    ///
    /// Those of [`Expression::range`]; where it is [`EvaluationError::NotANumber`], the predicate
    /// has a verdict in no state of the box.
    pub fn truth(&self, states: &(impl Ranges + ?Sized)) -> Result<Truth, EvaluationError> {
        match self {
            Predicate::Comparison(comparison) => comparison.truth(states),
            Predicate::Not(inner) => inner.truth(states).map(Truth::opposite),
            Predicate::All(parts) => parts
                .iter()
                .try_fold(Truth::Always, |truth, part| Ok(truth.and(part.truth(states)?))),
            Predicate::Any(parts) => {
                parts.iter().try_fold(Truth::Never, |truth, part| Ok(truth.or(part.truth(states)?)))
            }
            Predicate::Proposition(_) | Predicate::Function(_) => Ok(Truth::Undecided),
        }
    }
}

impl Comparison {
    /// What is known about the comparison everywhere in the box; errors as for
    /// [`Expression::range`].
    pub fn truth(&self, states: &(impl Ranges + ?Sized)) -> Result<Truth, EvaluationError> {
        let (left, right) = (self.left.range(states)?, self.right.range(states)?);
        Ok(self.relation.truth(left, right))
    }
}

impl Relation {
    /// What is known about it between any numbers of two intervals.
    pub(crate) fn truth(self, left: Interval, right: Interval) -> Truth {
        match self {
            Relation::AtMost => at_most(left, right),
            Relation::LessThan => at_most(right, left).opposite(),
            Relation::AtLeast => at_most(right, left),
            Relation::MoreThan => at_most(left, right).opposite(),
        }
    }
}

fn at_most(left: Interval, right: Interval) -> Truth {
    if left.upper() <= right.lower() {
        Truth::Always
    } else if left.lower() > right.upper() {
        Truth::Never
    } else {
        Truth::Undecided
    }
}

impl Truth {
    /// The truth of a conjunction of two predicates of these truths.
    pub fn and(self, other: Truth) -> Truth {
        match (self, other) {
            (Truth::Never, _) | (_, Truth::Never) => Truth::Never,
            (Truth::Always, Truth::Always) => Truth::Always,
            _ => Truth::Undecided,
        }
    }

    /// The truth of a disjunction of two predicates of these truths.
    pub fn or(self, other: Truth) -> Truth {
        self.opposite().and(other.opposite()).opposite()
    }

    /// The truth of the negation of a predicate of this truth.
    pub fn opposite(self) -> Truth {
        match self {
            Truth::Always => Truth::Never,
            Truth::Never => Truth::Always,
            Truth::Undecided => Truth::Undecided,
        }
    }
}
