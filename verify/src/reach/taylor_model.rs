//! Polynomials in symbols from −1 to 1, with an interval for all that they are not.
//!
//! A quantity that depends on the initial state, on parameters and on errors is enclosed by a
//! polynomial in one symbol for each of these, of bounded degree, and a remainder. What products add
//! beyond the degree goes into the remainder, as do coefficients too small to matter, and rounding:
//! every operation on coefficients adds what it may be off by (Makino and Berz 2003, *Taylor models
//! and other validated functional inclusion methods*, Int. J. Pure Appl. Math. 4(4)).

use pleach_guards::Interval;

use super::rounding::{UNDERFLOW, UNIT_ROUNDOFF, enclosed_sum, sum_up};
use super::vector::{around_zero, magnitude, radius};

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

/// A product of symbols: a byte for each factor, the symbol's number and 1, in descending order from
/// the lowest byte. The empty product is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Monomial(u64);

impl Monomial {
    pub const ONE: Monomial = Monomial(0);

    pub fn symbol(number: u8) -> Self {
        Monomial(u64::from(number) + 1)
    }

    pub fn degree(self) -> usize {
        8 - self.0.leading_zeros() as usize / 8
    }

    /// Its degree, as the limits count it.
    fn counted(self, limits: Limits) -> usize {
        // The lowest byte is the symbol with the largest number.
        let has_error = (self.0 & 0xFF) as usize > limits.first_error;
        let more = if has_error { limits.degree.saturating_sub(2) } else { 0 };
        self.degree() + more
    }

    /// The numbers of its symbols, each as often as it is a factor.
    pub fn symbols(self) -> impl Iterator<Item = u8> {
        self.0.to_le_bytes().into_iter().take_while(|byte| *byte > 0).map(|byte| byte - 1)
    }

    /// Of degrees that add up to 8 at most.
    fn times(self, other: Monomial) -> Monomial {
        if self.0 == 0 || other.0 == 0 {
            return Monomial(self.0 | other.0);
        }
        let (mut left, mut right, mut product, mut shift) = (self.0, other.0, 0, 0);
        while left | right != 0 {
            let from = if left & 0xFF >= right & 0xFF { &mut left } else { &mut right };
            product |= (*from & 0xFF) << shift;
            *from >>= 8;
            shift += 8;
        }
        Monomial(product)
    }

    /// Whether every symbol occurs an even number of times, so that it is never negative.
    fn is_square(self) -> bool {
        let mut rest = self.0;
        while rest != 0 {
            if rest & 0xFF != (rest >> 8) & 0xFF {
                return false;
            }
            rest >>= 16;
        }
        true
    }

    /// Its values.
    pub fn range(self) -> Interval {
        if self == Monomial::ONE {
            return Interval::point(1.0);
        }
        let lower = if self.is_square() { 0.0 } else { -1.0 };
        Interval::new(lower, 1.0).unwrap_or(Interval::WHOLE)
    }
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
    pub fn constant(value: Interval, limits: Limits) -> Self {
        let middle = value.midpoint();
        let terms = if middle == 0.0 { Vec::new() } else { vec![(Monomial::ONE, middle)] };
        TaylorModel { terms, rest: value - Interval::point(middle), limits }
    }

    /// c + Σ aᵢ ξᵢ.
    pub fn affine(
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

    pub fn terms(&self) -> &[(Monomial, f64)] {
        &self.terms
    }

    pub fn rest(&self) -> Interval {
        self.rest
    }

    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// All values.
    pub fn range(&self) -> Interval {
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
    pub fn give_up(&mut self, leaves: impl Fn(Monomial, f64) -> bool) {
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
    pub fn name_rest(&mut self, symbol: u8) -> bool {
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
    pub fn rename(&mut self, number: impl Fn(u8) -> u8) {
        for (monomial, _) in &mut self.terms {
            let renamed = monomial.symbols().map(|symbol| Monomial::symbol(number(symbol)));
            *monomial = renamed.fold(Monomial::ONE, Monomial::times);
        }
        self.terms.sort_by_key(|(monomial, _)| *monomial);
    }

    /// At least the sum of the magnitudes of the coefficients.
    pub fn norm(&self) -> f64 {
        sum_up(self.terms.iter().map(|(_, coefficient)| coefficient.abs()))
    }

    /// Adds to the remainder what rounding each coefficient once may have changed.
    fn rounded(mut self) -> Self {
        let error = self.norm() * UNIT_ROUNDOFF;
        let underflow = (self.terms.len() + 1) as f64 * UNDERFLOW;
        self.rest = self.rest + around_zero(error) + around_zero(underflow);
        self
    }

    pub fn plus(&self, other: &TaylorModel) -> Self {
        self.merged(other, |a| a)
    }

    pub fn minus(&self, other: &TaylorModel) -> Self {
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
    pub fn scaled(&self, factor: Interval) -> Self {
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

    pub fn times(&self, other: &TaylorModel) -> Self {
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
    pub fn composed(
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
mod tests {
    use num_rational::BigRational;
    use num_traits::{One, Zero};
    use proptest::prelude::*;

    use super::*;
    use crate::reach::exact::{FAINT, fraction, holds};
    use crate::reach::series::{Coefficient, Function};

    const SYMBOLS: usize = 3;

    fn limits(degree: usize, least: f64) -> Limits {
        Limits { degree, first_error: SYMBOLS, least }
    }

    /// The polynomial where the symbols have these values.
    fn polynomial(model: &TaylorModel, at: &[f64]) -> BigRational {
        let value = |(monomial, coefficient): &(Monomial, f64)| {
            let factors = monomial.symbols().map(|symbol| fraction(at[usize::from(symbol)]));
            factors.fold(fraction(*coefficient), |product, factor| product * factor)
        };
        model.terms.iter().map(value).fold(BigRational::zero(), |sum, term| sum + term)
    }

    /// Whether the model has this value where the symbols have these.
    fn has(model: &TaylorModel, at: &[f64], value: &BigRational) -> bool {
        holds(model.rest, &(value - polynomial(model, at))) && holds(model.range(), value)
    }

    /// Numbers of different sizes, none of which has few digits.
    fn number() -> impl Strategy<Value = f64> {
        (any::<i32>(), -40i32..-20)
            .prop_map(|(digits, power)| f64::from(digits) * 2f64.powi(power) / 3.0)
    }

    /// A polynomial of degree 2 in three symbols, without a remainder.
    fn model() -> impl Strategy<Value = Vec<f64>> {
        proptest::collection::vec(number(), 7)
    }

    fn built(numbers: &[f64], limits: Limits) -> TaylorModel {
        let slopes = (0u8..).zip(&numbers[1..4]).map(|(symbol, slope)| (symbol, *slope));
        let mut model = TaylorModel::affine(numbers[0], slopes, limits);
        let squares = [(0, 0), (0, 1), (1, 2)]
            .map(|(one, other)| Monomial::symbol(one).times(Monomial::symbol(other)));
        model.terms.extend(squares.into_iter().zip(numbers[4..].iter().copied()));
        model.terms.retain(|(_, coefficient)| *coefficient != 0.0);
        model.terms.sort_by_key(|(monomial, _)| *monomial);
        model
    }

    /// Values of symbols: ends and points between them.
    fn places() -> impl Strategy<Value = Vec<f64>> {
        let corner = prop_oneof![Just(-1.0), Just(1.0), Just(0.5), Just(0.0), Just(-0.75)];
        proptest::collection::vec(corner, SYMBOLS)
    }

    proptest! {
        #[test]
        fn operations_hold_the_exact_results(
            left in model(), right in model(), factor in number(), width in 0.0..1.0f64, at in places(),
        ) {
            let limits = limits(3, 0.0);
            let (one, other) = (built(&left, limits), built(&right, limits));
            let (p, q) = (polynomial(&one, &at), polynomial(&other, &at));
            prop_assert!(has(&one, &at, &p));
            prop_assert!(has(&one.plus(&other), &at, &(p.clone() + &q)));
            prop_assert!(has(&one.minus(&other), &at, &(p.clone() - &q)));
            prop_assert!(has(&one.times(&other), &at, &(p.clone() * &q)));
            let wide = Interval::new(factor, factor + width).unwrap();
            for end in [wide.lower(), wide.upper()] {
                prop_assert!(has(&one.scaled(wide), &at, &(p.clone() * fraction(end))));
                prop_assert!(has(&TaylorModel::constant(wide, limits), &at, &fraction(end)));
            }
        }

        /// Remainders of the operands, each at an end.
        #[test]
        fn operations_hold_the_remainders(
            left in model(), right in model(), ends in (number(), number()), at in places(), factor in number(),
        ) {
            let limits = limits(2, 1e-3);
            let (mut one, mut other) = (built(&left, limits), built(&right, limits));
            (one.rest, other.rest) = (around_zero(ends.0), around_zero(ends.1));
            let p = polynomial(&one, &at) + fraction(ends.0);
            let q = polynomial(&other, &at) + fraction(ends.1);
            prop_assert!(has(&one.plus(&other), &at, &(p.clone() + &q)));
            prop_assert!(has(&one.minus(&other), &at, &(p.clone() - &q)));
            prop_assert!(has(&one.times(&other), &at, &(p.clone() * &q)));
            let factor = Interval::point(factor);
            prop_assert!(has(&one.scaled(factor), &at, &(p * fraction(factor.lower()))));
        }

        /// 1 ÷ p, which is a fraction: for polynomials that stay away from 0.
        #[test]
        fn reciprocals_hold_the_exact_ones(slopes in model(), at in places()) {
            let limits = limits(2, 0.0);
            let share = 0.5 / slopes[1..].iter().map(|slope| slope.abs()).sum::<f64>().max(1e-9);
            let numbers: Vec<f64> = slopes.iter().map(|slope| slope * share).collect();
            let model = built(&[&[1.0], &numbers[1..]].concat(), limits);
            let exact = BigRational::one() / polynomial(&model, &at);
            let found = model.function(Function::Reciprocal).expect("it is not 0");
            prop_assert!(has(&found, &at, &exact));
        }

        /// A remainder that becomes a symbol is between −1 and 1 times its coefficient.
        #[test]
        fn named_remainders_are_covered(numbers in model(), lower in number(), width in 0.0..1.0f64, at in places()) {
            let mut named = built(&numbers, limits(2, 0.0));
            let exact = polynomial(&named, &at);
            named.rest = Interval::new(lower, lower + width).unwrap();
            let ends = [named.rest.lower(), named.rest.upper()].map(fraction);
            prop_assert!(named.name_rest(SYMBOLS as u8));
            let [low, high] = [-1.0, 1.0].map(|end| polynomial(&named, &[&at[..], &[end]].concat()));
            prop_assert!(low <= exact.clone() + &ends[0] && exact + &ends[1] <= high);
        }
    }

    #[test]
    fn given_up_terms_are_in_the_remainder() {
        let mut model = built(&[1.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6], limits(2, 0.0));
        let places = [[1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]];
        let exact = places.map(|at| polynomial(&model, &at));
        model.give_up(|monomial, _| monomial.degree() == 2);
        assert_eq!(model.terms.len(), 4);
        for (at, exact) in places.iter().zip(exact) {
            assert!(has(&model, at, &exact));
        }
    }

    /// A coefficient that is too small for its digits.
    #[test]
    fn underflow_counts() {
        let limits = limits(2, 0.0);
        let small = TaylorModel::affine(0.0, [(0, 5e-324)], limits);
        let half = small.scaled(Interval::point(0.5));
        let exact = fraction(5e-324) * fraction(0.5);
        assert!(has(&half, &[1.0, 0.0, 0.0], &exact));
        let square = small.times(&small);
        assert!(has(&square, &[1.0, 0.0, 0.0], &(fraction(5e-324) * fraction(5e-324))));
        // Three products that are each rounded up, to the smallest number.
        let factor = 0.8 * 2f64.powi(-537);
        let sum = TaylorModel::affine(0.0, [0, 1, 2].map(|symbol| (symbol, factor)), limits);
        let product = sum.times(&TaylorModel::affine(factor, [], limits));
        let exact = fraction(factor) * fraction(factor) * fraction(3.0);
        assert!(has(&product, &[1.0, 1.0, 1.0], &exact));
    }

    /// Four products that add up to 1 may be off by 4 units of roundoff, and so may each coefficient.
    #[test]
    fn what_is_left_over_counts_rounding() {
        let left_over = left_over(Interval::point(1.0), 1.0, 4);
        assert!((8.0 * UNIT_ROUNDOFF..20.0 * UNIT_ROUNDOFF).contains(&left_over), "{left_over}");
    }

    /// The sum of 1 and 2⁻⁶⁰ is no number, and the remainder has what is missing.
    #[test]
    fn sums_of_coefficients_are_rounded_outward() {
        let limits = limits(2, 0.0);
        let [one, faint] = [1.0, FAINT].map(|slope| TaylorModel::affine(0.0, [(0, slope)], limits));
        let sum = one.plus(&faint);
        assert!(has(&sum, &[1.0, 0.0, 0.0], &(fraction(1.0) + fraction(FAINT))));
        assert!(has(&sum, &[-1.0, 0.0, 0.0], &-(fraction(1.0) + fraction(FAINT))));
    }
}
