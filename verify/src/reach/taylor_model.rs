//! Polynomials in symbols from −1 to 1, with an interval for all that they are not.
//!
//! A quantity that depends on the initial state, on parameters and on errors is enclosed by a
//! polynomial in one symbol for each of these, of bounded degree, and a remainder. What products add
//! beyond the degree goes into the remainder, as do coefficients too small to matter, and rounding:
//! every operation on coefficients adds what it may be off by (Makino and Berz 2003, *Taylor models
//! and other validated functional inclusion methods*, Int. J. Pure Appl. Math. 4(4)).

mod monomial;

use pleach_guards::Interval;

use super::rounding::{UNDERFLOW, UNIT_ROUNDOFF, enclosed_sum, sum_up};
use super::vector::{around_zero, magnitude, radius};
pub(super) use monomial::Monomial;

/// Which terms are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// The largest degree, at most 6. Beyond 2, a symbol of an error counts as all but one of it: errors
    /// are small, and a product with one keeps one other factor at most.
    pub degree: usize,
    /// The number of the first symbol that is an error.
    pub first_error: usize,
    /// Smaller coefficients of products go into the remainder.
    pub least: f64,
}

/// At least what products add up to that are not kept, and what rounding may have changed of the `count`
/// that are: all magnitudes add up to `all` at most, those kept were computed to add up to `kept`.
fn left_over(all: Interval, kept: f64, count: usize) -> f64 {
    // γₙ of the sum of magnitudes, as much of the coefficients, and 4 u for what is of second order.
    let least_kept = kept * (1.0 - (2.0 * count as f64 + 4.0) * UNIT_ROUNDOFF);
    (all - Interval::point(least_kept)).upper().max(0.0)
}

/// Every sum of the polynomial and a number of the remainder.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TaylorModel {
    /// In ascending order of monomials, each once.
    terms: Vec<(Monomial, f64)>,
    rest: Interval,
    limits: Limits,
}

fn zero() -> Interval {
    Interval::point(0.0)
}

impl TaylorModel {
    pub(super) fn constant(value: Interval, limits: Limits) -> Self {
        let middle = value.midpoint();
        let terms = if middle == 0.0 { Vec::new() } else { vec![(Monomial::ONE, middle)] };
        TaylorModel { terms, rest: value - Interval::point(middle), limits }
    }

    /// c + Σ aᵢ ξᵢ.
    pub(super) fn affine(
        center: f64,
        slopes: impl IntoIterator<Item = (u8, f64)>,
        limits: Limits,
    ) -> Self {
        let slopes = slopes.into_iter().map(|(number, slope)| (Monomial::symbol(number), slope));
        let mut terms: Vec<_> = std::iter::once((Monomial::ONE, center)).chain(slopes).collect();
        terms.retain(|(_, coefficient)| *coefficient != 0.0);
        terms.sort_by_key(|(monomial, _)| *monomial);
        TaylorModel { terms, rest: zero(), limits }
    }

    pub(super) fn terms(&self) -> &[(Monomial, f64)] {
        &self.terms
    }

    pub(super) fn limits(&self) -> Limits {
        self.limits
    }

    /// All values.
    pub(super) fn range(&self) -> Interval {
        self.polynomial_range() + self.rest
    }

    /// All values of the polynomial.
    fn polynomial_range(&self) -> Interval {
        let (mut lower, mut upper, mut size) = (0.0, 0.0, 0.0);
        for (monomial, coefficient) in &self.terms {
            let spread = coefficient.abs();
            size += spread;
            if *monomial == Monomial::ONE {
                lower += coefficient;
                upper += coefficient;
            } else if monomial.is_square() {
                lower += coefficient.min(0.0);
                upper += coefficient.max(0.0);
            } else {
                lower -= spread;
                upper += spread;
            }
        }
        enclosed_sum(lower, upper, size, self.terms.len())
    }

    /// Moves the terms that `leaves` says into the remainder.
    pub(super) fn give_up(&mut self, leaves: impl Fn(Monomial, f64) -> bool) {
        let mut rest = self.rest;
        self.terms.retain(|(monomial, coefficient)| {
            let gone = leaves(*monomial, *coefficient);
            if gone {
                rest = rest + monomial.range() * Interval::point(*coefficient);
            }
            !gone
        });
        self.rest = rest;
    }

    /// Replaces the remainder by a symbol of its own; `false` if it is too small to need one.
    pub(super) fn name_rest(&mut self, symbol: u8) -> bool {
        let middle = Interval::point(self.rest.midpoint());
        let centered = TaylorModel { rest: self.rest - middle, ..self.clone() };
        *self = centered.plus(&TaylorModel::constant(middle, self.limits));
        let radius = magnitude(self.rest);
        self.rest = zero();
        if radius > 0.0 {
            self.terms.push((Monomial::symbol(symbol), radius));
            self.terms.sort_by_key(|(monomial, _)| *monomial);
        }
        radius > 0.0
    }

    /// Gives symbols other numbers, in their order.
    pub(super) fn rename(&mut self, number: impl Fn(u8) -> u8) {
        for (monomial, _) in &mut self.terms {
            let renamed = monomial.symbols().map(|symbol| Monomial::symbol(number(symbol)));
            *monomial = renamed.fold(Monomial::ONE, Monomial::times);
        }
        self.terms.sort_by_key(|(monomial, _)| *monomial);
    }

    /// At least the sum of the magnitudes of the coefficients.
    fn norm(&self) -> f64 {
        sum_up(self.terms.iter().map(|(_, coefficient)| coefficient.abs()))
    }

    /// Adds to the remainder what rounding each coefficient once may have changed.
    fn rounded(mut self) -> Self {
        let error = self.norm() * UNIT_ROUNDOFF;
        let underflow = (self.terms.len() + 1) as f64 * UNDERFLOW;
        self.rest = self.rest + around_zero(error) + around_zero(underflow);
        self
    }

    pub(super) fn plus(&self, other: &TaylorModel) -> Self {
        self.merged(other, |a| a)
    }

    pub(super) fn minus(&self, other: &TaylorModel) -> Self {
        self.merged(other, |a| -a)
    }

    fn merged(&self, other: &TaylorModel, sign: impl Fn(f64) -> f64) -> Self {
        let mut terms = Vec::with_capacity(self.terms.len() + other.terms.len());
        let (mut one, mut another) = (self.terms.iter().peekable(), other.terms.iter().peekable());
        loop {
            let term = match (one.peek(), another.peek()) {
                (Some((left, a)), Some((right, b))) if left == right => {
                    let term = (*left, a + sign(*b));
                    one.next();
                    another.next();
                    term
                }
                (Some((left, a)), Some((right, _))) if left < right => {
                    let term = (*left, *a);
                    one.next();
                    term
                }
                (_, Some((right, b))) => {
                    let term = (*right, sign(*b));
                    another.next();
                    term
                }
                (Some((left, a)), None) => {
                    let term = (*left, *a);
                    one.next();
                    term
                }
                (None, None) => break,
            };
            terms.push(term);
        }
        let negated = Interval::point(sign(1.0));
        TaylorModel { terms, rest: self.rest + other.rest * negated, limits: self.limits }.rounded()
    }

    /// The product with a number of `factor`.
    pub(super) fn scaled(&self, factor: Interval) -> Self {
        let middle = factor.midpoint();
        let spread = Interval::point(self.norm()) * around_zero(radius(factor));
        let rest = self.rest * factor + spread;
        let terms = self.terms.iter().map(|(monomial, a)| (*monomial, a * middle));
        TaylorModel { terms: terms.collect(), rest, limits: self.limits }.rounded()
    }

    /// The constant term, and all others.
    fn split(&self) -> (f64, TaylorModel) {
        let mut varying = self.clone();
        let constant = match varying.terms.first() {
            Some((Monomial::ONE, constant)) => *constant,
            _ => return (0.0, varying),
        };
        varying.terms.remove(0);
        (constant, varying)
    }

    pub(super) fn times(&self, other: &TaylorModel) -> Self {
        let Limits { degree, least, .. } = self.limits;
        let mut kept = 0.0;
        let mut products: Vec<(Monomial, f64)> = Vec::new();
        // The largest first: from the first that is too small on, all are.
        let mut ranked = other.terms.clone();
        ranked.sort_by(|(_, one), (_, another)| another.abs().total_cmp(&one.abs()));
        for (left, a) in &self.terms {
            let room = degree.saturating_sub(left.counted(self.limits));
            let large = ranked.iter().take_while(|(_, b)| (a * b).abs() >= least.max(UNDERFLOW));
            for (right, b) in large.filter(|(right, _)| right.counted(self.limits) <= room) {
                let product = a * b;
                kept += product.abs();
                products.push((left.times(*right), product));
            }
        }
        let all = Interval::point(self.norm()) * Interval::point(other.norm());
        let left_over = around_zero(left_over(all, kept, products.len()));
        products.sort_unstable_by_key(|(monomial, _)| *monomial);
        products.dedup_by(|next, sum| {
            let is_same = next.0 == sum.0;
            if is_same {
                sum.1 += next.1;
            }
            is_same
        });
        let rest = self.polynomial_range() * other.rest
            + other.polynomial_range() * self.rest
            + self.rest * other.rest;
        TaylorModel { terms: products, rest: rest + left_over, limits: self.limits }
    }

    /// f(self) = Σ cₖ (self − m)ᵏ + r (self − m)ⁿ, where m is the constant term, for a function with
    /// Taylor coefficients `coefficients(k, at)`: those at m, and one at all values for the last.
    pub(super) fn composed(
        &self,
        coefficient: impl Fn(usize, Interval) -> Option<Interval>,
    ) -> Option<Self> {
        let (middle, varying) = self.split();
        let last = self.limits.degree + 1;
        let around = self.range().hull(Interval::point(middle));
        let mut value = TaylorModel::constant(coefficient(last, around)?, self.limits);
        for order in (0..last).rev() {
            let constant = coefficient(order, Interval::point(middle))?;
            value = value.times(&varying).plus(&TaylorModel::constant(constant, self.limits));
        }
        Some(value)
    }
}

#[cfg(test)]
mod tests;
