//! Polynomials in symbols from −1 to 1, with an interval for all that they are not.
//!
//! A quantity that depends on the initial state, on parameters and on errors is enclosed by a
//! polynomial in one symbol for each of these, of bounded degree, and a remainder. What products add
//! beyond the degree goes into the remainder, as do coefficients too small to matter, and rounding:
//! every operation on coefficients adds what it may be off by (Makino and Berz 2003, *Taylor models
//! and other validated functional inclusion methods*, Int. J. Pure Appl. Math. 4(4)).

use pleach_guards::Interval;

use super::vector::{around_zero, magnitude, sum_up};

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
        let error = (size * (self.terms.len() as f64 + 2.0) * f64::EPSILON).next_up();
        Interval::new((lower - error).next_down(), (upper + error).next_up())
            .unwrap_or(Interval::WHOLE)
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

    /// Adds to the remainder what rounding each coefficient once or twice may have changed.
    fn rounded(mut self) -> Self {
        let tiny = (self.terms.len() + 1) as f64 * f64::MIN_POSITIVE;
        let error = (self.norm() * f64::EPSILON + tiny).next_up();
        self.rest = self.rest + around_zero(error);
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
        let (middle, spread) = (factor.midpoint(), super::vector::radius(factor));
        let rest = self.rest * factor + around_zero((self.norm() * spread).next_up());
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
            let large = ranked.iter().take_while(|(_, b)| (a * b).abs() >= least);
            for (right, b) in large.filter(|(right, _)| right.counted(self.limits) <= room) {
                let product = a * b;
                kept += product.abs();
                products.push((left.times(*right), product));
            }
        }
        // What is not kept, by the difference of the sums of magnitudes: an upper bound less a lower.
        let all = Interval::point(self.norm()) * Interval::point(other.norm());
        let least_kept = kept * (1.0 - (products.len() as f64 + 4.0) * f64::EPSILON);
        let left_over = (all - Interval::point(least_kept)).upper().max(0.0);
        let dropped = around_zero(left_over);
        products.sort_unstable_by_key(|(monomial, _)| *monomial);
        let (mut longest, mut length) = (1.0f64, 1.0);
        products.dedup_by(|next, sum| {
            let is_same = next.0 == sum.0;
            length = if is_same { length + 1.0 } else { 1.0 };
            longest = longest.max(length);
            if is_same {
                sum.1 += next.1;
            }
            is_same
        });
        // Each coefficient is a sum of at most `longest` rounded products.
        let rounding = around_zero((kept * (longest + 2.0) * f64::EPSILON).next_up());
        let rest = self.polynomial_range() * other.rest
            + other.polynomial_range() * self.rest
            + self.rest * other.rest;
        let rest = rest + dropped + rounding;
        TaylorModel { terms: products, rest, limits: self.limits }
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
