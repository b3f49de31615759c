//! Arithmetic over named variables.

use std::collections::BTreeSet;
use std::iter::{Product, Sum};
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

use crate::fold::Operands;
use crate::operator::raise;
pub(crate) use crate::operator::{BinaryOperator, UnaryOperator};
use crate::predicate::{Comparison, Predicate};
use crate::table::Table;
use crate::valuation::{EvaluationError, Valuation};

/// An arithmetic expression over named variables, as data.
///
/// Expressions are built from [`variable`] and [`constant`] with `+`, `-`, `*`, `/`, unary `-` and
/// the methods below; a number may stand on either side of an operator. Subexpressions are shared,
/// so that a clone is cheap. Nothing is simplified, but for one thing: the negation of a constant
/// is a constant.
///
/// ```
/// use pleach_guards::variable;
///
/// let (height, velocity) = (variable("height"), variable("velocity"));
/// let energy = velocity.power(2.0) / 2.0 + 9.81 * height;
///
/// assert_eq!(energy.to_string(), "velocity² ÷ 2 + 9.81 · height");
/// assert_eq!(energy.evaluate(&[("height", 1.0), ("velocity", 2.0)])?, 11.81);
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
///
/// An expression may be as deep as memory allows; nothing here exhausts the stack.
#[derive(Clone)]
#[non_exhaustive]
pub enum Expression {
    /// A number.
    Constant(f64),
    /// The value of a variable of the state.
    Variable(Arc<str>),
    /// An operation on one operand.
    Unary(UnaryOperator, Arc<Expression>),
    /// An operation on two operands.
    Binary(BinaryOperator, Arc<Expression>, Arc<Expression>),
    /// A base raised to a fixed exponent.
    Power(Arc<Expression>, f64),
    /// The value of a table at a place.
    Lookup(Table, Arc<Expression>),
    /// One of two expressions, as a comparison holds or not.
    Choice(Arc<Choice>),
}

/// One of two expressions, as a comparison holds or not; the other one need not have a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// What decides.
    pub condition: Comparison,
    /// What it is where the condition holds.
    pub then: Expression,
    /// What it is elsewhere.
    pub otherwise: Expression,
}

/// The variable called `name`.
pub fn variable(name: &str) -> Expression {
    Expression::Variable(name.into())
}

/// The number `value`.
pub fn constant(value: f64) -> Expression {
    Expression::Constant(value)
}

/// The Euclidean norm √(a² + b² + …) of a vector with these components; of none, it is √0.
///
/// ```
/// use pleach_guards::{norm, variable};
///
/// let distance = norm([variable("x") - 1.0, variable("y")]);
/// assert_eq!(distance.to_string(), "√((x − 1)² + y²)");
/// assert_eq!(distance.evaluate(&[("x", 4.0), ("y", 4.0)])?, 5.0);
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
pub fn norm(components: impl IntoIterator<Item = Expression>) -> Expression {
    let squares = components.into_iter().map(|component| component.power(2.0));
    squares.sum::<Expression>().square_root()
}

/// The smallest of these, grouped to the left; of none, it is ∞.
pub fn minimum(operands: impl IntoIterator<Item = Expression>) -> Expression {
    let smaller = |least: Expression, next: Expression| least.min(next);
    operands.into_iter().reduce(smaller).unwrap_or(constant(f64::INFINITY))
}

/// The largest of these, grouped to the left; of none, it is −∞.
pub fn maximum(operands: impl IntoIterator<Item = Expression>) -> Expression {
    let larger = |most: Expression, next: Expression| most.max(next);
    operands.into_iter().reduce(larger).unwrap_or(constant(f64::NEG_INFINITY))
}

/// The expression of the first case whose condition holds, and `otherwise` where none does.
///
/// Parts that are not chosen need not have a value.
///
/// ```
/// use pleach_guards::{piecewise, variable};
///
/// let x = variable("x");
/// let root = piecewise([(x.at_least(0.0), x.square_root())], 0.0).expect("comparisons");
/// assert_eq!(root.to_string(), "if(x ≥ 0, √x, 0)");
/// assert_eq!(root.evaluate(&[("x", 9.0)])?, 3.0);
/// assert_eq!(root.evaluate(&[("x", -9.0)])?, 0.0);
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
///
/// Returns `None` if a condition rests on a [function](Predicate::function) or a proposition, which
/// no formula can contain.
pub fn piecewise(
    cases: impl IntoIterator<Item = (Predicate, Expression), IntoIter: DoubleEndedIterator>,
    otherwise: impl Into<Expression>,
) -> Option<Expression> {
    let cases = cases.into_iter().rev();
    cases.into_iter().try_fold(otherwise.into(), |rest, (condition, value)| {
        Expression::chosen(&condition, value, rest)
    })
}

impl Expression {
    /// `then` where `condition` holds, else `otherwise`.
    fn chosen(condition: &Predicate, then: Expression, otherwise: Expression) -> Option<Self> {
        Some(match condition {
            Predicate::Comparison(comparison) => {
                let condition = comparison.clone();
                Expression::Choice(Arc::new(Choice { condition, then, otherwise }))
            }
            Predicate::Not(inner) => Expression::chosen(inner, otherwise, then)?,
            Predicate::All(parts) => parts.iter().rev().try_fold(then, |chosen, part| {
                Expression::chosen(part, chosen, otherwise.clone())
            })?,
            Predicate::Any(parts) => parts
                .iter()
                .rev()
                .try_fold(otherwise, |rest, part| Expression::chosen(part, then.clone(), rest))?,
            Predicate::Function(_) | Predicate::Proposition(_) => return None,
        })
    }

    /// |self|
    pub fn abs(&self) -> Expression {
        self.unary(UnaryOperator::AbsoluteValue)
    }

    /// The smaller of `self` and `other`.
    pub fn min(&self, other: impl Into<Expression>) -> Expression {
        self.binary(BinaryOperator::Minimum, other.into())
    }

    /// The larger of `self` and `other`.
    pub fn max(&self, other: impl Into<Expression>) -> Expression {
        self.binary(BinaryOperator::Maximum, other.into())
    }

    /// `self` raised to `exponent`.
    pub fn power(&self, exponent: f64) -> Expression {
        Expression::Power(Arc::new(self.clone()), exponent)
    }

    /// √self, which is the power ½.
    pub fn square_root(&self) -> Expression {
        self.power(0.5)
    }

    /// sin(self), of an angle in radians.
    pub fn sin(&self) -> Expression {
        self.unary(UnaryOperator::Sine)
    }

    /// cos(self), of an angle in radians.
    pub fn cos(&self) -> Expression {
        self.unary(UnaryOperator::Cosine)
    }

    /// tan(self), of an angle in radians.
    pub fn tan(&self) -> Expression {
        self.unary(UnaryOperator::Tangent)
    }

    /// The angle of the point (`x`, self), from −π to π radians.
    pub fn atan2(&self, x: impl Into<Expression>) -> Expression {
        self.binary(BinaryOperator::Angle, x.into())
    }

    /// tanh(self), the hyperbolic tangent, from −1 to 1.
    pub fn tanh(&self) -> Expression {
        self.unary(UnaryOperator::HyperbolicTangent)
    }

    /// −1, 0 or 1, as self is negative, 0 or positive.
    pub fn sign(&self) -> Expression {
        self.unary(UnaryOperator::Sign)
    }

    /// The largest whole number that is at most self.
    pub fn floor(&self) -> Expression {
        self.unary(UnaryOperator::Floor)
    }

    /// exp(self), the power of e.
    pub fn exp(&self) -> Expression {
        self.unary(UnaryOperator::Exponential)
    }

    /// ln(self), the logarithm to the base e: −∞ at 0, and not a number below.
    pub fn ln(&self) -> Expression {
        self.unary(UnaryOperator::Logarithm)
    }

    /// The value in `state`, possibly infinite and never NaN.
    ///
    /// Arithmetic, squares and roots are rounded exactly, the same on every machine. For sine,
    /// cosine, exponential, logarithm and other powers the last digits are up to the platform.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if `state` lacks a variable, and
    /// [`EvaluationError::NotANumber`] where any part, a variable included, is NaN.
    pub fn evaluate(&self, state: &(impl Valuation + ?Sized)) -> Result<f64, EvaluationError> {
        self.evaluate_in(&state)
    }

    /// The same, built once and not for every type of state.
    fn evaluate_in(&self, state: &dyn Valuation) -> Result<f64, EvaluationError> {
        let value = self.fold(&mut |part, operands| part.value(operands, state))?;
        if value.is_nan() {
            return Err(EvaluationError::NotANumber {
                expression: self.undefined_part(state)?.to_string(),
            });
        }
        Ok(value)
    }

    /// The value, given those of the operands; NaN where one that counts is.
    fn value(
        &self,
        operands: Operands<f64>,
        state: &dyn Valuation,
    ) -> Result<f64, EvaluationError> {
        match self {
            Expression::Variable(name) => state
                .value(name)
                .ok_or_else(|| EvaluationError::UnknownVariable { variable: name.to_string() }),
            _ => Ok(self.computed(operands).unwrap_or(f64::NAN)),
        }
    }

    /// The result of the operation on these operands; of a variable, none.
    pub(crate) fn computed(&self, operands: Operands<f64>) -> Option<f64> {
        Some(match (self, operands) {
            (Expression::Constant(value), _) => *value,
            (Expression::Unary(operator, _), Operands::One(operand)) => operator.apply(operand),
            (Expression::Power(_, exponent), Operands::One(base)) => raise(base, *exponent),
            (Expression::Lookup(table, _), Operands::One(place)) => table.value(place),
            (Expression::Binary(operator, ..), Operands::Two(left, right)) => {
                operator.apply(left, right)
            }
            (Expression::Choice(choice), Operands::Four([left, right, then, otherwise])) => {
                Choice::select(choice.condition.relation, (left, right), (then, otherwise))
            }
            _ => return None,
        })
    }

    /// The smallest part that makes the value NaN, the leftmost if there are several.
    fn undefined_part(&self, state: &dyn Valuation) -> Result<&Expression, EvaluationError> {
        let whole = self.fold(&mut |part, operands: Operands<(f64, &Expression)>| {
            let inner = operands.find(|(value, _)| value.is_nan()).map(|(_, culprit)| *culprit);
            let value = part.value(operands.map(|(value, _)| value), state)?;
            Ok((value, inner.unwrap_or(part)))
        });
        whole.map(|(_, culprit)| culprit)
    }

    /// The names of the variables that occur, in alphabetical order.
    pub fn variables(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.collect_variables(&mut names);
        names
    }

    pub(crate) fn collect_variables<'a>(&'a self, names: &mut BTreeSet<&'a str>) {
        for part in self.parts() {
            if let Expression::Variable(name) = part {
                names.insert(name);
            }
        }
    }

    fn unary(&self, operator: UnaryOperator) -> Expression {
        Expression::Unary(operator, Arc::new(self.clone()))
    }

    fn binary(&self, operator: BinaryOperator, right: Expression) -> Expression {
        Expression::Binary(operator, Arc::new(self.clone()), Arc::new(right))
    }
}

impl From<f64> for Expression {
    fn from(value: f64) -> Self {
        constant(value)
    }
}

/// `x.rate(1)` is `x.rate(1.0)`.
impl From<i32> for Expression {
    fn from(value: i32) -> Self {
        constant(f64::from(value))
    }
}

impl From<&Expression> for Expression {
    fn from(expression: &Expression) -> Self {
        expression.clone()
    }
}

/// A number on the left.
macro_rules! number {
    ($trait:ident, $method:ident, $number:ty) => {
        impl $trait<Expression> for $number {
            type Output = Expression;

            fn $method(self, right: Expression) -> Expression {
                Expression::from(self).$method(right)
            }
        }

        impl $trait<&Expression> for $number {
            type Output = Expression;

            fn $method(self, right: &Expression) -> Expression {
                Expression::from(self).$method(right.clone())
            }
        }
    };
}

macro_rules! operator {
    ($trait:ident, $method:ident, $operator:ident) => {
        impl<E: Into<Expression>> $trait<E> for Expression {
            type Output = Expression;

            fn $method(self, right: E) -> Expression {
                self.binary(BinaryOperator::$operator, right.into())
            }
        }

        impl<E: Into<Expression>> $trait<E> for &Expression {
            type Output = Expression;

            fn $method(self, right: E) -> Expression {
                self.binary(BinaryOperator::$operator, right.into())
            }
        }

        number!($trait, $method, f64);
        number!($trait, $method, i32);
    };
}

operator!(Add, add, Sum);
operator!(Sub, sub, Difference);
operator!(Mul, mul, Product);
operator!(Div, div, Quotient);

impl Neg for Expression {
    type Output = Expression;

    fn neg(self) -> Expression {
        match self {
            Expression::Constant(value) => constant(-value),
            other => other.unary(UnaryOperator::Negation),
        }
    }
}

impl Neg for &Expression {
    type Output = Expression;

    fn neg(self) -> Expression {
        -self.clone()
    }
}

/// a + b + …, grouped to the left; of no terms, it is 0.
impl Sum for Expression {
    fn sum<I: Iterator<Item = Expression>>(terms: I) -> Expression {
        terms.reduce(Expression::add).unwrap_or(constant(0.0))
    }
}

/// a · b · …, grouped to the left; of no factors, it is 1.
impl Product for Expression {
    fn product<I: Iterator<Item = Expression>>(factors: I) -> Expression {
        factors.reduce(Expression::mul).unwrap_or(constant(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(expression: &Expression) -> Result<f64, EvaluationError> {
        expression.evaluate(&[("x", 3.0), ("y", -4.0), ("zero", 0.0), ("nan", f64::NAN)])
    }

    #[test]
    fn operators_compute_what_they_say() {
        let (x, y) = (variable("x"), variable("y"));
        let cases = [
            (&x + &y, -1.0),
            (&x - &y, 7.0),
            (&x * &y, -12.0),
            (&y / 2.0, -2.0),
            (1.0 - &x, -2.0),
            (-&x, -3.0),
            (y.abs(), 4.0),
            (x.min(&y), -4.0),
            (x.max(5.0), 5.0),
            (x.power(2.0), 9.0),
            (x.power(-1.0), 3f64.recip()),
            (y.abs().square_root(), 2.0),
            (x.sin(), 3f64.sin()),
            (y.cos(), 4f64.cos()),
            (variable("zero").exp(), 1.0),
            (variable("zero").ln(), f64::NEG_INFINITY),
            (norm([x.clone(), y.clone()]), 5.0),
            (norm([]), 0.0),
            ([&x, &y, &x].into_iter().cloned().sum(), 2.0),
            ([&x, &y, &x].into_iter().cloned().product(), -36.0),
            ([].into_iter().product(), 1.0),
        ];
        for (expression, expected) in cases {
            assert_eq!(value(&expression), Ok(expected), "{expression}");
        }
    }

    #[test]
    fn the_negation_of_a_constant_is_a_constant() {
        assert_eq!(-constant(2.0), constant(-2.0));
        assert_eq!(-&constant(2.0), constant(-2.0));
    }

    #[test]
    fn variables_are_listed_once_in_order() {
        let expression = (variable("b") + variable("a")) * variable("b").max(variable("c"));
        assert!(expression.variables().into_iter().eq(["a", "b", "c"]));
    }

    #[test]
    fn unknown_variables_are_named() {
        let error = EvaluationError::UnknownVariable { variable: "w".into() };
        assert_eq!(value(&(variable("x") + variable("w"))), Err(error));
    }

    #[test]
    fn what_is_not_a_number_is_an_error_that_no_minimum_hides() {
        let quotient = variable("zero") / variable("zero");
        let error = EvaluationError::NotANumber { expression: "zero ÷ zero".into() };
        assert_eq!(value(&quotient.min(1.0)), Err(error));
        let error = EvaluationError::NotANumber { expression: "nan".into() };
        assert_eq!(value(&variable("nan").max(1.0)), Err(error));
        assert!(value(&variable("y").square_root()).is_err());
        assert!(value(&variable("y").ln()).is_err());
    }
}
