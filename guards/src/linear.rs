//! Affine expressions as coefficients.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::ops::{Add, Div, Mul};

use crate::expression::{BinaryOperator, Expression, UnaryOperator};
use crate::fold::Operands;
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

    /// As [`linear_form`](Self::linear_form), but in a given type of numbers, such as exact
    /// fractions; `number` converts a constant, or says that there is no such number.
    ///
    /// Constants that roots and other functions make of constants are converted after rounding.
    pub fn linear_form_over<N: Coefficient>(
        &self,
        number: &impl Fn(f64) -> Option<N>,
    ) -> Option<LinearForm<N>> {
        let (zero, minus_one) = (number(0.0)?, number(-1.0)?);
        let one = number(1.0)?;
        let whole = self.fold(&mut |part, operands: Operands<Affine<N>>| {
            let value = operands.values().and_then(|values| part.computed(values));
            let form = match part {
                Expression::Variable(name) => Some(LinearForm {
                    coefficients: BTreeMap::from([(name.to_string(), one.clone())]),
                    constant: zero.clone(),
                }),
                part if part.is_arithmetic() => part.affine(operands, &minus_one, &zero),
                _ => value.and_then(number).map(LinearForm::of_constant),
            };
            Ok::<_, Infallible>(Affine { form: form.map(|form| form.without(&zero)), value })
        });
        let Ok(Affine { form, .. }) = whole;
        form
    }

    /// Whether it is one of the operations that make forms of forms.
    fn is_arithmetic(&self) -> bool {
        match self {
            Expression::Unary(operator, _) => *operator == UnaryOperator::Negation,
            Expression::Power(_, exponent) => *exponent == 1.0,
            Expression::Binary(operator, ..) => matches!(
                operator,
                BinaryOperator::Sum
                    | BinaryOperator::Difference
                    | BinaryOperator::Product
                    | BinaryOperator::Quotient
            ),
            _ => false,
        }
    }

    /// The operation on forms, if that is a form.
    fn affine<N: Coefficient>(
        &self,
        operands: Operands<Affine<N>>,
        minus_one: &N,
        zero: &N,
    ) -> Option<LinearForm<N>> {
        let opposite = |form: LinearForm<N>| form.map(|number| number * minus_one.clone());
        Some(match (self, operands) {
            (Expression::Unary(UnaryOperator::Negation, _), Operands::One(operand)) => {
                opposite(operand.form?)
            }
            (Expression::Power(..), Operands::One(base)) => base.form?,
            (Expression::Binary(operator, ..), Operands::Two(left, right)) => {
                let (left, right) = (left.form?, right.form?);
                match operator {
                    BinaryOperator::Sum => left.plus(right),
                    BinaryOperator::Difference => left.plus(opposite(right)),
                    BinaryOperator::Product => left.times(right)?,
                    BinaryOperator::Quotient => {
                        let divisor = right.into_constant().filter(|divisor| divisor != zero)?;
                        left.map(|number| number / divisor.clone())
                    }
                    _ => return None,
                }
            }
            _ => return None,
        })
    }
}

/// What is known of a part: its form, if it is affine, and its value, if it is a constant.
struct Affine<N> {
    form: Option<LinearForm<N>>,
    value: Option<f64>,
}

impl<N> Operands<Affine<N>> {
    /// The values, if all operands are constants.
    fn values(&self) -> Option<Operands<f64>> {
        let all = self.listed().into_iter().flatten().all(|operand| operand.value.is_some());
        all.then(|| self.map_ref(|operand| operand.value.unwrap_or(f64::NAN)))
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

    fn without(mut self, zero: &N) -> Self {
        self.coefficients.retain(|_, coefficient| coefficient != zero);
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
