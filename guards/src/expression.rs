//! Arithmetic over named variables.

use std::collections::BTreeSet;
use std::iter::{Product, Sum};
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

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
#[derive(Clone, Debug, PartialEq)]
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
}

/// An operator with one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOperator {
    /// −a
    Negation,
    /// |a|
    AbsoluteValue,
    /// sin a, of an angle in radians
    Sine,
    /// cos a, of an angle in radians
    Cosine,
    /// eᵃ
    Exponential,
    /// ln a, to the base e
    Logarithm,
}

/// An operator with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryOperator {
    /// a + b
    Sum,
    /// a − b
    Difference,
    /// a · b
    Product,
    /// a ÷ b
    Quotient,
    /// min(a, b)
    Minimum,
    /// max(a, b)
    Maximum,
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

impl Expression {
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
        let value = match self {
            Expression::Constant(value) => *value,
            Expression::Variable(name) => state
                .value(name)
                .ok_or_else(|| EvaluationError::UnknownVariable { variable: name.to_string() })?,
            Expression::Unary(operator, operand) => operator.apply(operand.evaluate(state)?),
            Expression::Binary(operator, left, right) => {
                operator.apply(left.evaluate(state)?, right.evaluate(state)?)
            }
            Expression::Power(base, exponent) => raise(base.evaluate(state)?, *exponent),
        };
        if value.is_nan() {
            return Err(EvaluationError::NotANumber { expression: self.to_string() });
        }
        Ok(value)
    }

    /// The names of the variables that occur, in alphabetical order.
    pub fn variables(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.collect_variables(&mut names);
        names
    }

    pub(crate) fn collect_variables<'a>(&'a self, names: &mut BTreeSet<&'a str>) {
        match self {
            Expression::Constant(_) => {}
            Expression::Variable(name) => {
                names.insert(name);
            }
            Expression::Unary(_, operand) | Expression::Power(operand, _) => {
                operand.collect_variables(names);
            }
            Expression::Binary(_, left, right) => {
                left.collect_variables(names);
                right.collect_variables(names);
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

impl UnaryOperator {
    pub(crate) fn apply(self, operand: f64) -> f64 {
        match self {
            UnaryOperator::Negation => -operand,
            UnaryOperator::AbsoluteValue => operand.abs(),
            UnaryOperator::Sine => operand.sin(),
            UnaryOperator::Cosine => operand.cos(),
            UnaryOperator::Exponential => operand.exp(),
            UnaryOperator::Logarithm => operand.ln(),
        }
    }
}

impl BinaryOperator {
    pub(crate) fn apply(self, left: f64, right: f64) -> f64 {
        match self {
            BinaryOperator::Sum => left + right,
            BinaryOperator::Difference => left - right,
            BinaryOperator::Product => left * right,
            BinaryOperator::Quotient => left / right,
            BinaryOperator::Minimum => left.min(right),
            BinaryOperator::Maximum => left.max(right),
        }
    }
}

/// Squares and roots go through operations that IEEE 754 rounds exactly, so that they are the same
/// on every machine.
pub(crate) fn raise(base: f64, exponent: f64) -> f64 {
    if exponent == 2.0 {
        base * base
    } else if exponent == 0.5 {
        base.sqrt()
    } else {
        base.powf(exponent)
    }
}

impl From<f64> for Expression {
    fn from(value: f64) -> Self {
        constant(value)
    }
}

impl From<&Expression> for Expression {
    fn from(expression: &Expression) -> Self {
        expression.clone()
    }
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

        impl $trait<Expression> for f64 {
            type Output = Expression;

            fn $method(self, right: Expression) -> Expression {
                constant(self).binary(BinaryOperator::$operator, right)
            }
        }

        impl $trait<&Expression> for f64 {
            type Output = Expression;

            fn $method(self, right: &Expression) -> Expression {
                constant(self).binary(BinaryOperator::$operator, right.clone())
            }
        }
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
