//! Intervals of numbers, rounded outward, so that what is computed with them encloses every value.
//!
//! Each operation returns an interval that contains the result for every choice of numbers from its
//! operands, both the exact result and the rounded one of floating-point arithmetic: a lower end is
//! rounded down and an upper end up, by one unit in the last place wherever the operation is not
//! exact (Moore, Kearfott and Cloud 2009, *Introduction to Interval Analysis*,
//! [doi:10.1137/1.9780898717716](https://doi.org/10.1137/1.9780898717716)).
//!
//! ```
//! use pleach_guards::Interval;
//!
//! let (x, y) = (Interval::new(1.0, 2.0)?, Interval::new(-1.0, 3.0)?);
//! assert_eq!(x - y, Interval::new(-2.0, 3.0)?);
//! assert_eq!(x * y, Interval::new(-2.0, 6.0)?);
//! assert_eq!(x / y, Interval::WHOLE);
//! # Ok::<(), pleach_guards::EmptyInterval>(())
//! ```

mod functions;
mod rounding;

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

use rounding::{around_root, corners, loose, nearly, product, quotient, sum};

/// All numbers from a lower end to an upper one, both included, also where they are infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lower: f64,
    upper: f64,
}

impl Interval {
    /// All numbers, from −∞ to ∞.
    pub const WHOLE: Interval = Interval { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// From `lower` to `upper`.
    ///
    /// # Errors
    ///
    /// [`EmptyInterval`] unless `lower` ≤ `upper`.
    pub fn new(lower: f64, upper: f64) -> Result<Self, EmptyInterval> {
        if lower <= upper {
            Ok(Interval { lower, upper })
        } else {
            Err(EmptyInterval { lower, upper })
        }
    }

    /// The one number `value`; of NaN, which could be any number, the whole line.
    pub fn point(value: f64) -> Self {
        if value.is_nan() { Interval::WHOLE } else { Interval { lower: value, upper: value } }
    }

    /// The lower end.
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// The upper end.
    pub fn upper(&self) -> f64 {
        self.upper
    }

    /// How far the ends are apart, ∞ if one of them is infinite and not the other.
    pub fn width(&self) -> f64 {
        if self.lower == self.upper { 0.0 } else { self.upper - self.lower }
    }

    /// A finite number in the middle; of an unbounded interval some number well inside it, and of
    /// one that holds nothing finite its end.
    pub fn midpoint(&self) -> f64 {
        match (self.lower.is_finite(), self.upper.is_finite()) {
            (true, true) => self.lower.midpoint(self.upper).clamp(self.lower, self.upper),
            (true, false) => (self.lower + self.lower.abs().max(1.0)).min(f64::MAX),
            (false, true) => (self.upper - self.upper.abs().max(1.0)).max(f64::MIN),
            (false, false) if self.lower < self.upper => 0.0,
            (false, false) => self.lower,
        }
    }

    /// Whether `value` lies in it.
    pub fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// What lies in both, if anything does.
    pub fn intersection(&self, other: Interval) -> Option<Interval> {
        Interval::new(self.lower.max(other.lower), self.upper.min(other.upper)).ok()
    }

    /// The two halves left and right of the [midpoint](Self::midpoint), which belongs to both.
    pub fn halves(&self) -> [Interval; 2] {
        let middle = self.midpoint();
        [Interval { upper: middle, ..*self }, Interval { lower: middle, ..*self }]
    }

    /// |self|
    pub fn abs(self) -> Interval {
        if self.lower >= 0.0 {
            self
        } else if self.upper <= 0.0 {
            -self
        } else {
            Interval { lower: 0.0, upper: self.upper.max(-self.lower) }
        }
    }

    /// The smaller of a number of `self` and one of `other`.
    pub fn min(self, other: Interval) -> Interval {
        Interval { lower: self.lower.min(other.lower), upper: self.upper.min(other.upper) }
    }

    /// The larger of a number of `self` and one of `other`.
    pub fn max(self, other: Interval) -> Interval {
        Interval { lower: self.lower.max(other.lower), upper: self.upper.max(other.upper) }
    }

    /// Numbers of `self` raised to `exponent`, or `None` if no such power is a number.
    pub fn power(self, exponent: f64) -> Option<Interval> {
        if exponent.is_nan() {
            return Some(Interval::WHOLE);
        }
        if exponent == 0.0 {
            return Some(Interval::point(1.0));
        }
        if exponent == 1.0 {
            return Some(self);
        }
        if exponent == 2.0 {
            let magnitude = self.abs();
            return Some((magnitude * magnitude).not_negative());
        }
        if exponent == 0.5 {
            return self.root();
        }
        if exponent.is_infinite() || exponent % 2.0 == 0.0 {
            return Some(self.abs().monotone_power(exponent));
        }
        if exponent % 1.0 == 0.0 {
            return Some(self.odd_power(exponent));
        }
        // Only −∞ has a power with a broken exponent among what is negative: that of ∞.
        let unbounded = self.lower == f64::NEG_INFINITY;
        let far = Interval::point(f64::INFINITY).monotone_power(exponent);
        let near = self.intersection(Interval { lower: 0.0, upper: f64::INFINITY });
        match near.map(|base| base.monotone_power(exponent)) {
            Some(power) if unbounded => Some(power.hull(far)),
            Some(power) => Some(power),
            None => unbounded.then_some(far),
        }
    }

    /// eˣ for the numbers x of `self`.
    pub fn exp(self) -> Interval {
        loose(self.lower.exp(), self.upper.exp()).not_negative()
    }

    /// The logarithm to the base e, or `None` where all numbers are negative.
    pub fn ln(self) -> Option<Interval> {
        let base = self.intersection(Interval { lower: 0.0, upper: f64::INFINITY })?;
        // Not −0, of which the logarithm is taken as that of 0 all the same.
        Some(loose(base.lower.abs().ln(), base.upper.abs().ln()))
    }

    /// The sine of angles in radians.
    pub fn sin(self) -> Interval {
        self.wave(f64::sin, FRAC_PI_2, -FRAC_PI_2)
    }

    /// The cosine of angles in radians.
    pub fn cos(self) -> Interval {
        self.wave(f64::cos, 0.0, PI)
    }

    /// A function of period 2π that rises and falls between −1 at `valley` and 1 at `peak`: between
    /// those it is monotone. A full turn meets both, and so may what is infinite.
    fn wave(self, function: fn(f64) -> f64, peak: f64, valley: f64) -> Interval {
        let (first, last) = (function(self.lower), function(self.upper));
        let between = loose(first.min(last), first.max(last));
        let upper = if self.may_meet(peak) { 1.0 } else { between.upper.min(1.0) };
        let lower = if self.may_meet(valley) { -1.0 } else { between.lower.max(-1.0) };
        Interval { lower, upper }
    }

    /// Whether `angle`, a multiple of π/2, could lie in it up to full turns.
    fn may_meet(self, angle: f64) -> bool {
        let turns = (self - nearly(angle)) / nearly(TAU);
        turns.lower.ceil() <= turns.upper
    }

    fn root(self) -> Option<Interval> {
        let base = self.intersection(Interval { lower: 0.0, upper: f64::INFINITY })?;
        let lower = around_root(base.lower.abs()).lower;
        Some(Interval { lower, upper: around_root(base.upper).upper }.not_negative())
    }

    /// A power of numbers that are not negative.
    fn monotone_power(self, exponent: f64) -> Interval {
        let ends = (self.lower.abs().powf(exponent), self.upper.powf(exponent));
        let (first, last) = if exponent > 0.0 { ends } else { (ends.1, ends.0) };
        loose(first, last).not_negative()
    }

    fn odd_power(self, exponent: f64) -> Interval {
        if exponent > 0.0 {
            loose(self.lower.powf(exponent), self.upper.powf(exponent))
        } else if self.contains(0.0) {
            Interval::WHOLE
        } else {
            loose(self.upper.powf(exponent), self.lower.powf(exponent))
        }
    }

    fn not_negative(self) -> Interval {
        Interval { lower: self.lower.max(0.0), ..self }
    }

    /// The narrowest interval around both.
    #[must_use]
    pub fn hull(self, other: Interval) -> Interval {
        Interval { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }
}

impl Neg for Interval {
    type Output = Interval;

    fn neg(self) -> Interval {
        Interval { lower: -self.upper, upper: -self.lower }
    }
}

impl Add for Interval {
    type Output = Interval;

    /// Where infinite ends cancel, nothing is known.
    fn add(self, other: Interval) -> Interval {
        let (lower, upper) = (sum(self.lower, other.lower), sum(self.upper, other.upper));
        Interval { lower: lower.lower, upper: upper.upper }
    }
}

impl Sub for Interval {
    type Output = Interval;

    fn sub(self, other: Interval) -> Interval {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Interval;

    fn mul(self, other: Interval) -> Interval {
        corners(self, other, product)
    }
}

impl Div for Interval {
    type Output = Interval;

    /// The whole line if `other` contains 0.
    fn div(self, other: Interval) -> Interval {
        if other.contains(0.0) { Interval::WHOLE } else { corners(self, other, quotient) }
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "[{}, {}]", self.lower, self.upper)
    }
}

/// The ends of an [`Interval`] stand in the wrong order, or one of them is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmptyInterval {
    /// The lower end given.
    pub lower: f64,
    /// The upper end given.
    pub upper: f64,
}

impl fmt::Display for EmptyInterval {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let EmptyInterval { lower, upper } = self;
        write!(formatter, "no number lies from {lower} to {upper}: ")?;
        write!(formatter, "the first must be at most the second")
    }
}

impl Error for EmptyInterval {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole numbers that fill the significand, so that neighbours are two apart.
    const LARGE: f64 = 9_007_199_254_740_992.0;

    #[test]
    fn ends_are_rounded_away_from_what_is_not_a_number_exactly() {
        let point = Interval::point;
        let above = |value: f64| Interval { lower: value, upper: value.next_up() };
        let below = |value: f64| Interval { lower: value.next_down(), upper: value };
        let odd = 1f64.next_up();
        let cases = [
            (point(1.0) / point(4.0), point(0.25)),
            (point(2.0) / point(3.0), above(2.0 / 3.0)),
            (point(-2.0) / point(3.0), below(-2.0 / 3.0)),
            (point(2.0) / point(-3.0), below(-2.0 / 3.0)),
            (point(1.0) / point(10.0), below(0.1)),
            (point(LARGE) + point(2.0), point(LARGE + 2.0)),
            (point(LARGE) + point(1.0), above(LARGE)),
            (point(LARGE) + point(3.0), below(LARGE + 4.0)),
            (point(3.0) + point(LARGE), below(LARGE + 4.0)),
            (point(LARGE) + point(0.25), above(LARGE)),
            (point(0.25) + point(LARGE), above(LARGE)),
            (point(-0.25) + point(LARGE), below(LARGE)),
            (point(odd) * point(odd), above(odd * odd)),
            (point(3.0) * point(-7.0), point(-21.0)),
            (point(1e-200) * point(1e-200), Interval { lower: -5e-324, upper: 5e-324 }),
            (point(1e200) * point(1e200), Interval { lower: f64::MAX, upper: f64::INFINITY }),
        ];
        for (position, (found, expected)) in cases.into_iter().enumerate() {
            assert_eq!(found, expected, "case {position}");
        }
        assert_eq!(point(9.0).power(0.5), Some(point(3.0)));
        assert_eq!(point(2.0).power(0.5), Some(below(2f64.sqrt())));
        assert_eq!(point(3.0).power(0.5), Some(above(3f64.sqrt())));
    }

    #[test]
    fn powers_know_parity_and_domain() {
        let over = |lower, upper| Interval { lower, upper };
        let near = |found: Option<Interval>, lower: f64, upper: f64| {
            let found = found.expect("there are such powers");
            let close = |end: f64, exact: f64| end == exact || (end - exact).abs() < 1e-12;
            assert!(close(found.lower, lower) && close(found.upper, upper), "{found}");
        };
        near(over(-2.0, 1.0).power(4.0), 0.0, 16.0);
        near(over(-2.0, 1.0).power(3.0), -8.0, 1.0);
        near(over(2.0, 4.0).power(-1.0), 0.25, 0.5);
        near(over(-4.0, -2.0).power(-1.0), -0.5, -0.25);
        near(over(-4.0, 2.0).power(-2.0), 0.0625, f64::INFINITY);
        near(over(-4.0, 4.0).power(1.5), 0.0, 8.0);
        near(over(0.0, 4.0).power(-0.5), 0.5, f64::INFINITY);
        assert_eq!(over(-4.0, 4.0).power(-1.0), Some(Interval::WHOLE));
        assert_eq!(over(-4.0, -1.0).power(1.5), None);
        assert_eq!(over(-4.0, -1.0).ln(), None);
    }

    /// Of what is negative, −∞ alone has powers with a broken exponent.
    #[test]
    fn broken_powers_of_what_is_unbounded_below_include_that_of_infinity() {
        let over = |lower, upper| Interval { lower, upper };
        let found = over(f64::NEG_INFINITY, 4.0).power(-0.5).expect("there are such powers");
        assert_eq!((found.lower, found.upper), (0.0, f64::INFINITY));
        let found = over(-9.0, 4.0).power(-0.5).expect("there are such powers");
        assert!((found.lower - 0.5).abs() < 1e-12, "{found}");
        let found = over(f64::NEG_INFINITY, -1.0).power(1.5).expect("that of −∞");
        assert!(found.lower > 1e308 && found.upper == f64::INFINITY, "{found}");
    }

    #[test]
    fn the_middle_is_inside_and_finite_where_anything_is() {
        let infinity = f64::INFINITY;
        let cases = [
            (2.0, 6.0, 4.0, 4.0),
            (-3.0, -2.0, 1.0, -2.5),
            (f64::MAX, f64::MAX, 0.0, f64::MAX),
            (5.0, infinity, infinity, 10.0),
            (0.25, infinity, infinity, 1.25),
            (f64::MAX, infinity, infinity, f64::MAX),
            (-infinity, -5.0, infinity, -10.0),
            (-infinity, 0.25, infinity, -0.75),
            (-infinity, f64::MIN, infinity, f64::MIN),
            (-infinity, infinity, infinity, 0.0),
            (infinity, infinity, 0.0, infinity),
            (-infinity, -infinity, 0.0, -infinity),
        ];
        for (lower, upper, width, middle) in cases {
            let interval = Interval { lower, upper };
            assert_eq!((interval.width(), interval.midpoint()), (width, middle), "{interval}");
            assert!(interval.contains(middle), "{interval}");
        }
    }

    #[test]
    fn halves_cover_unbounded_intervals() {
        for whole in [Interval::WHOLE, Interval { lower: 1e308, upper: f64::INFINITY }] {
            let [left, right] = whole.halves();
            assert!(left.upper.is_finite());
            assert_eq!((left.lower, right.upper), (whole.lower, whole.upper));
            assert_eq!(left.upper, right.lower);
        }
    }

    #[test]
    fn ends_in_the_wrong_order_are_refused() {
        assert!(Interval::new(1.0, 0.0).is_err());
        assert!(Interval::new(f64::NAN, 0.0).is_err());
        let error = Interval::new(1.5, 0.0).expect_err("the wrong order");
        let text = "no number lies from 1.5 to 0: the first must be at most the second";
        assert_eq!(error.to_string(), text);
    }

    #[test]
    fn intervals_print_their_ends() {
        assert_eq!(Interval { lower: -0.5, upper: f64::INFINITY }.to_string(), "[-0.5, inf]");
    }
}
