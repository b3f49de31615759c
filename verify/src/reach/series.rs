//! Taylor coefficients of solutions, order by order, from the formulas of their rates.
//!
//! With x(t) = Σ xₖ tᵏ, each operation gives the coefficients of its result from those of its
//! operands, and xₖ₊₁ is the k-th coefficient of the rate, divided by k + 1 (Moore, Kearfott and
//! Cloud 2009, *Introduction to Interval Analysis*, chapter 9). The coefficients are intervals, which
//! encloses those of all solutions through a box, or [Taylor models](super::taylor_model), which keep
//! how they depend on the initial state.

mod program;
mod solution;

use pleach_guards::Interval;

use super::taylor_model::{Limits, TaylorModel};
pub(super) use program::SeriesProgram;

/// What coefficients are made of.
pub(super) trait Coefficient: Clone {
    /// What a number needs beside its value.
    type Context: Copy;
    fn number(value: Interval, context: Self::Context) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn scaled(&self, factor: Interval) -> Self;
    /// `None` where there is no value.
    fn function(&self, function: Function) -> Option<Self>;
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Function {
    Reciprocal,
    Sine,
    Cosine,
    Exponential,
    Logarithm,
    Power(f64),
    HyperbolicTangent,
}

impl Coefficient for Interval {
    type Context = ();

    fn number(value: Interval, _: ()) -> Self {
        value
    }

    fn plus(&self, other: &Self) -> Self {
        *self + *other
    }

    fn minus(&self, other: &Self) -> Self {
        *self - *other
    }

    fn times(&self, other: &Self) -> Self {
        *self * *other
    }

    fn scaled(&self, factor: Interval) -> Self {
        *self * factor
    }

    fn function(&self, function: Function) -> Option<Self> {
        match function {
            Function::Reciprocal => (!self.contains(0.0)).then(|| Interval::point(1.0) / *self),
            Function::Sine => Some(self.sin()),
            Function::Cosine => Some(self.cos()),
            Function::Exponential => Some(self.exp()),
            Function::Logarithm => (self.lower() > 0.0).then(|| self.ln()).flatten(),
            Function::Power(exponent) => {
                (self.lower() > 0.0).then(|| self.power(exponent)).flatten()
            }
            Function::HyperbolicTangent => Some(self.tanh()),
        }
    }
}

impl Coefficient for TaylorModel {
    type Context = Limits;

    fn number(value: Interval, limits: Limits) -> Self {
        TaylorModel::constant(value, limits)
    }

    fn plus(&self, other: &Self) -> Self {
        self.plus(other)
    }

    fn minus(&self, other: &Self) -> Self {
        self.minus(other)
    }

    fn times(&self, other: &Self) -> Self {
        self.times(other)
    }

    fn scaled(&self, factor: Interval) -> Self {
        self.scaled(factor)
    }

    fn function(&self, function: Function) -> Option<Self> {
        if function == Function::HyperbolicTangent {
            // tanh u = 1 − 2 ÷ (e²ᵘ + 1)
            let one = TaylorModel::constant(Interval::point(1.0), self.limits());
            let power = self.scaled(Interval::point(2.0)).function(Function::Exponential)?;
            let quotient = power.plus(&one).function(Function::Reciprocal)?;
            return Some(one.minus(&quotient.scaled(Interval::point(2.0))));
        }
        self.composed(|order, at| function.coefficient(order, at))
    }
}

impl Function {
    /// The derivative of this order, divided by the factorial of the order.
    fn coefficient(self, order: usize, at: Interval) -> Option<Interval> {
        let sign = |is_negative: bool| Interval::point(if is_negative { -1.0 } else { 1.0 });
        let factorial = (1..=order)
            .fold(Interval::point(1.0), |product, factor| product * Interval::point(factor as f64));
        Some(match self {
            Function::Reciprocal => {
                let inverse = at.function(Function::Reciprocal)?;
                let power = (0..=order).fold(Interval::point(1.0), |power, _| power * inverse);
                power * sign(order % 2 == 1)
            }
            Function::Exponential => at.exp() / factorial,
            Function::Sine => {
                let value = if order.is_multiple_of(2) { at.sin() } else { at.cos() };
                value * sign(order % 4 >= 2) / factorial
            }
            Function::Cosine => {
                let value = if order.is_multiple_of(2) { at.cos() } else { at.sin() };
                value * sign(matches!(order % 4, 1 | 2)) / factorial
            }
            Function::Logarithm if order == 0 => at.function(Function::Logarithm)?,
            Function::Logarithm => {
                let inverse = at.function(Function::Reciprocal)?;
                let power = (0..order).fold(Interval::point(1.0), |power, _| power * inverse);
                power * sign(order.is_multiple_of(2)) / Interval::point(order as f64)
            }
            Function::Power(exponent) => {
                let falling = (0..order).fold(Interval::point(1.0), |product, place| {
                    product * (Interval::point(exponent) - Interval::point(place as f64))
                });
                let lowered = exponent - order as f64;
                let power = if lowered == 0.0 {
                    Interval::point(1.0)
                } else {
                    at.function(Function::Power(lowered))?
                };
                falling * power / factorial
            }
            Function::HyperbolicTangent => return None,
        })
    }
}
