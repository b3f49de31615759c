//! Instants, kept to twice the precision of a number.
//!
//! The time of a run is a sum of many durations. If every sum were rounded, a clock of period 0.1 s
//! would be off by 10⁻⁸ s after a million periods. A [`Moment`] is an unevaluated sum of two
//! numbers instead, and every tick happens at the number nearest to its exact time (T. J. Dekker
//! 1971, [doi:10.1007/BF01397083](https://doi.org/10.1007/BF01397083)).

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use serde::{Deserialize, Serialize};

/// A time or a duration in seconds, as the sum of a number and a rest below half its last place.
///
/// ```
/// use pleach_automaton::Moment;
///
/// let tick = (0..1_000_000).fold(Moment::from(0.0), |now, _| now + Moment::from(0.1));
/// assert_eq!(tick.seconds(), 100_000.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "(f64, f64)", into = "(f64, f64)")]
pub struct Moment {
    seconds: f64,
    rest: f64,
}

impl Moment {
    /// The nearest number of seconds.
    pub fn seconds(self) -> f64 {
        self.seconds
    }

    /// What the [seconds](Self::seconds) leave, at most half a unit in their last place.
    pub fn rest(self) -> f64 {
        self.rest
    }

    /// From two numbers of which the second is at most about as large as the last place of the
    /// first.
    fn normalised(high: f64, low: f64) -> Self {
        let seconds = high + low;
        if !seconds.is_finite() {
            return Moment { seconds, rest: 0.0 };
        }
        Moment { seconds, rest: low - (seconds - high) }
    }

    /// The order of the numbers, as [`f64::total_cmp`].
    pub fn total_cmp(&self, other: &Moment) -> Ordering {
        self.seconds.total_cmp(&other.seconds).then(self.rest.total_cmp(&other.rest))
    }

    /// The exact product of two numbers.
    pub(crate) fn product(left: f64, right: f64) -> Self {
        let product = left * right;
        let rest = if product.is_finite() { left.mul_add(right, -product) } else { 0.0 };
        Moment { seconds: product, rest }
    }
}

impl From<f64> for Moment {
    fn from(seconds: f64) -> Self {
        Moment { seconds, rest: 0.0 }
    }
}

impl From<(f64, f64)> for Moment {
    fn from((seconds, rest): (f64, f64)) -> Self {
        Moment { seconds, rest }
    }
}

impl From<Moment> for (f64, f64) {
    fn from(moment: Moment) -> Self {
        (moment.seconds, moment.rest)
    }
}

impl Add for Moment {
    type Output = Moment;

    fn add(self, other: Moment) -> Moment {
        let high = self.seconds + other.seconds;
        if !high.is_finite() {
            return Moment::from(high);
        }
        // The error of the sum, by Knuth.
        let part = high - self.seconds;
        let error = (self.seconds - (high - part)) + (other.seconds - part);
        Moment::normalised(high, error + (self.rest + other.rest))
    }
}

impl Neg for Moment {
    type Output = Moment;

    fn neg(self) -> Moment {
        Moment { seconds: -self.seconds, rest: -self.rest }
    }
}

impl Sub for Moment {
    type Output = Moment;

    fn sub(self, other: Moment) -> Moment {
        self + -other
    }
}

impl Mul for Moment {
    type Output = Moment;

    fn mul(self, other: Moment) -> Moment {
        let Moment { seconds, rest } = Moment::product(self.seconds, other.seconds);
        Moment::normalised(seconds, rest + self.seconds * other.rest + self.rest * other.seconds)
    }
}

impl Div for Moment {
    type Output = Moment;

    fn div(self, other: Moment) -> Moment {
        let first = self.seconds / other.seconds;
        if !first.is_finite() {
            return Moment::from(first);
        }
        let left = self - Moment::from(first) * other;
        let second = left.seconds / other.seconds;
        let left = left - Moment::from(second) * other;
        Moment::normalised(first, second) + Moment::from(left.seconds / other.seconds)
    }
}

impl PartialOrd for Moment {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        let order = self.seconds.partial_cmp(&other.seconds)?;
        Some(order.then(self.rest.partial_cmp(&other.rest)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_thirds_of_a_tenth_do_not_drift() {
        let period = Moment::from(0.1) / Moment::from(3.0);
        let mut now = Moment::default();
        for tick in 1..=1_000_000 {
            now = now + period;
            // k · 0.1 ÷ 3: the quotient of a product that is exact.
            let exact = Moment::product(f64::from(tick), 0.1) / Moment::from(3.0);
            assert!((now - exact).seconds().abs() < 1e-20, "tick {tick}");
        }
    }

    #[test]
    fn differences_are_exact_where_numbers_cancel() {
        let late = Moment::from(1e9) + Moment::from(1e-9);
        assert_eq!((late - Moment::from(1e9)).seconds(), 1e-9);
        assert!(late > Moment::from(1e9) && late.seconds() == 1e9);
    }
}
