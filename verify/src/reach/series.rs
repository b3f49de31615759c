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

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use pleach_guards::Expression;

    use super::*;
    use crate::reach::exact::{fraction, holds};

    /// The coefficients of x and y, from 1 and 0, for the rates 1 and `rate`.
    fn coefficients(rate: &str, order: usize) -> Vec<Interval> {
        let names = ["x", "y"].map(str::to_owned);
        let rates = ["1", rate].map(|rate| rate.parse::<Expression>().expect("a formula"));
        let program = SeriesProgram::compile(&rates, &names).expect("it is smooth");
        let start = [1.0, 0.0].map(Interval::point);
        program.solve(&start, order, ()).expect("it has values")[1].clone()
    }

    /// Thirds, sevenths and elevenths are no numbers.
    #[test]
    fn coefficients_hold_the_exact_fractions() {
        // Of ln(1 + t), integrated: (−1)ⁿ ÷ (n (n − 1)).
        for (n, found) in coefficients("ln(x)", 12).iter().enumerate().skip(2) {
            let sign = if n % 2 == 0 { 1 } else { -1 };
            let exact = BigRational::new(sign.into(), (n * (n - 1)).into());
            assert!(holds(*found, &exact), "{n}: {found}");
        }
        // Of 1 ÷ (1 + t), integrated: (−1)ⁿ⁻¹ ÷ n.
        for (n, found) in coefficients("1 / x", 12).iter().enumerate().skip(1) {
            let sign = if n % 2 == 0 { -1 } else { 1 };
            assert!(holds(*found, &BigRational::new(sign.into(), n.into())), "{n}: {found}");
        }
        // Of 0.1 · x, integrated: the number 0.1 is not the fraction.
        let found = coefficients("0.1 * (x * x * x)", 4);
        assert!(holds(found[3], &fraction(0.1)), "{}", found[3]);
    }

    /// Derivatives by factorials, at 3, where reciprocals are no numbers.
    #[test]
    fn coefficients_of_functions_hold_the_exact_fractions() {
        let three = BigRational::from_integer(3.into());
        let mut power = three.clone();
        for order in 0..6 {
            let found = Function::Reciprocal.coefficient(order, Interval::point(3.0));
            let exact = if order % 2 == 0 { power.recip() } else { -power.recip() };
            assert!(holds(found.expect("it is not 0"), &exact), "{order}");
            power *= &three;
        }
        let exponential = Function::Exponential.coefficient(3, Interval::point(0.0));
        let exponential = exponential.expect("it has values");
        assert!(holds(exponential, &BigRational::new(1.into(), 6.into())));
        // The coefficient of order 2 of x^0.5 at 1 is −1/8, and of order 3 of x^2.5 that of 5·3·1 ÷ 48.
        for (exponent, order, numerator, denominator) in [(0.5, 2, -1, 8), (2.5, 3, 15, 48)] {
            let found = Function::Power(exponent).coefficient(order, Interval::point(1.0));
            let exact = BigRational::new(numerator.into(), denominator.into());
            assert!(holds(found.expect("1 is positive"), &exact));
        }
    }
}
