//! Exact fractions, against which tests hold what is rounded.

use num_rational::BigRational;
use pleach_guards::Interval;

/// A number less than half a unit in the last place of 1.
pub(super) const FAINT: f64 = f64::EPSILON / 256.0;

/// A finite number as it is.
pub(super) fn fraction(value: f64) -> BigRational {
    BigRational::from_float(value).expect("a finite number")
}

/// Whether an interval with finite ends contains a number.
pub(super) fn holds(found: Interval, exact: &BigRational) -> bool {
    fraction(found.lower()) <= *exact && *exact <= fraction(found.upper())
}

/// Intervals of these numbers alone.
pub(super) fn points(values: &[f64]) -> Vec<Interval> {
    values.iter().map(|value| Interval::point(*value)).collect()
}
