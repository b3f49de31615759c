//! Affine expressions as coefficients.

use std::collections::BTreeMap;
use std::ops::{Add, Div, Mul};

use crate::expression::{BinaryOperator, Expression, UnaryOperator};
use crate::valuation::{EvaluationError, Valuation};

/// a₁·x₁ + … + aₙ·xₙ + b: one coefficient per variable, none of them 0, and a constant.
///
/// ```
/// use pleach_guards::variable;
///
/// let (x, y) = (variable("x"), variable("y"));
/// let form = (2.0 * (&x - 3.0 * &y) - (&x + 8.0) / 4.0).linear_form().expect("this is affine");
/// assert!(form.coefficients().eq([("x", &1.75), ("y", &-6.0)]));
/// assert_eq!(form.constant(), &-2.0);
/// assert_eq!((&x * &y).linear_form(), None);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LinearForm<N = f64> {
    coefficients: BTreeMap<String, N>,
    constant: N,
}

/// Numbers that can be coefficients of a [`LinearForm`].
pub trait Coefficient:
    Clone + PartialEq + Add<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
}

impl<N> Coefficient for N where
    N: Clone + PartialEq + Add<Output = N> + Mul<Output = N> + Div<Output = N>
{
}

impl Expression {
    /// The expression as coefficients and a constant, or `None` if it is not affine or a number in
    /// the form is not finite.
    ///
    /// Products with constants and quotients by constants are affine, whatever operations make the
    /// constants; absolute values, minima and maxima of variables are not. The form equals the
    /// expression up to rounding, for it adds in another order.
    pub fn linear_form(&self) -> Option<LinearForm> {
        let form = self.linear_form_over(&|value| Some(value))?;
        let finite = form.constant.is_finite() && form.coefficients.values().all(|a| a.is_finite());
        finite.then_some(form)
    }

    /// As [`linear_form`](Self::linear_form), but in a type of numbers of one's own, such as exact
    /// fractions; `number` converts a constant, or says that there is no such number.
    ///
    /// Constants that roots and other functions make of constants are converted after rounding.
    pub fn linear_form_over<N: Coefficient>(
        &self,
        number: &impl Fn(f64) -> Option<N>,
    ) -> Option<LinearForm<N>> {
        let form = |part: &Expression| part.linear_form_over(number);
        let (zero, minus_one) = (number(0.0)?, LinearForm::of_constant(number(-1.0)?));
        let opposite = |part: &Expression| form(part)?.times(minus_one.clone());
        let mut form = match self {
            Expression::Variable(name) => LinearForm {
                coefficients: BTreeMap::from([(name.to_string(), number(1.0)?)]),
                constant: zero.clone(),
            },
            Expression::Unary(UnaryOperator::Negation, operand) => opposite(operand)?,
            Expression::Binary(BinaryOperator::Sum, left, right) => form(left)?.plus(form(right)?),
            Expression::Binary(BinaryOperator::Difference, left, right) => {
                form(left)?.plus(opposite(right)?)
            }
            Expression::Binary(BinaryOperator::Product, left, right) => {
                form(left)?.times(form(right)?)?
            }
            Expression::Binary(BinaryOperator::Quotient, left, right) => {
                let divisor = form(right)?.into_constant().filter(|divisor| *divisor != zero)?;
                form(left)?.map(|number| number / divisor.clone())
            }
            Expression::Power(base, exponent) if *exponent == 1.0 => form(base)?,
            _ => LinearForm::of_constant(number(self.folded()?)?),
        };
        form.coefficients.retain(|_, coefficient| *coefficient != zero);
        Some(form)
    }
}

impl<N: Coefficient> LinearForm<N> {
    /// The coefficients that are not 0, by variable in alphabetical order.
    pub fn coefficients(&self) -> impl Iterator<Item = (&str, &N)> {
        self.coefficients.iter().map(|(variable, coefficient)| (&**variable, coefficient))
    }

    /// The coefficient of `variable`, or `None` if it is 0.
    pub fn coefficient(&self, variable: &str) -> Option<&N> {
        self.coefficients.get(variable)
    }

    /// What is added to the variables.
    pub fn constant(&self) -> &N {
        &self.constant
    }

    /// The sum of two forms.
    pub fn plus(mut self, other: LinearForm<N>) -> LinearForm<N> {
        for (variable, coefficient) in other.coefficients {
            let sum = match self.coefficients.remove(&variable) {
                Some(present) => present + coefficient,
                None => coefficient,
            };
            self.coefficients.insert(variable, sum);
        }
        self.constant = self.constant + other.constant;
        self
    }

    fn of_constant(constant: N) -> Self {
        LinearForm { coefficients: BTreeMap::new(), constant }
    }

    fn into_constant(self) -> Option<N> {
        self.coefficients.is_empty().then_some(self.constant)
    }

    fn times(self, other: LinearForm<N>) -> Option<LinearForm<N>> {
        let (scaled, factor) =
            if self.coefficients.is_empty() { (other, self) } else { (self, other) };
        let factor = factor.into_constant()?;
        Some(scaled.map(|number| number * factor.clone()))
    }

    fn map(self, change: impl Fn(N) -> N) -> LinearForm<N> {
        let coefficients = self.coefficients.into_iter();
        LinearForm {
            coefficients: coefficients.map(|(name, number)| (name, change(number))).collect(),
            constant: change(self.constant),
        }
    }
}

impl LinearForm {
    /// The value in `state`, the constant first.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if `state` lacks a variable, and
    /// [`EvaluationError::NotANumber`] where a variable or the sum is NaN.
    pub fn evaluate(&self, state: &(impl Valuation + ?Sized)) -> Result<f64, EvaluationError> {
        let mut sum = self.constant;
        for (variable, coefficient) in &self.coefficients {
            let unknown = || EvaluationError::UnknownVariable { variable: variable.clone() };
            sum += coefficient * state.value(variable).ok_or_else(unknown)?;
            if sum.is_nan() {
                return Err(EvaluationError::NotANumber { expression: variable.clone() });
            }
        }
        Ok(sum)
    }
}
