//! Operations on two numbers as the narrowest interval that is sure to enclose the exact result and
//! the rounded one. Where the rounding error is seen to be zero, that is a point.

use super::Interval;

/// By how many units in the last place the functions of the standard library may be off. Those of
/// the usual platforms stay below three: of Linux, the hyperbolic tangent below two and others below
/// one (*Known Maximum Errors in Math Functions*, manual of the GNU C Library). The rest is margin.
const LIBRARY_ERROR: usize = 4;

/// Below this magnitude the error of a product may itself be too small to be a number, so that a
/// product can no longer be seen to be exact: the smallest normal number times 2⁵³.
const FAINT: f64 = f64::MIN_POSITIVE * 9_007_199_254_740_992.0;

/// a + b; the whole line where infinities cancel.
pub(super) fn sum(left: f64, right: f64) -> Interval {
    let sum = left + right;
    if sum.is_nan() {
        return Interval::WHOLE;
    }
    // The error of a sum is again a number (Knuth), or NaN after an overflow.
    let part = sum - left;
    enclose(sum, (left - (sum - part)) + (right - part))
}

/// a · b. Where this is 0 · ∞ it is no value of an operation on intervals, but values beside it
/// come near 0.
pub(super) fn product(left: f64, right: f64) -> Interval {
    let product = left * right;
    if left == 0.0 || right == 0.0 {
        Interval::point(0.0)
    } else if product.abs() < FAINT {
        enclose(product, f64::NAN)
    } else {
        enclose(product, left.mul_add(right, -product))
    }
}

/// a ÷ b for b ≠ 0. Where this is ∞ ÷ ∞ it is no value of an operation on intervals, but values
/// beside it come near 0, as they do for any a ÷ ∞.
pub(super) fn quotient(left: f64, right: f64) -> Interval {
    let quotient = left / right;
    if left == 0.0 || right.is_infinite() {
        Interval::point(0.0)
    } else if quotient.abs() < FAINT || left.abs() < FAINT {
        enclose(quotient, f64::NAN)
    } else {
        enclose(quotient, (-quotient).mul_add(right, left) * right.signum())
    }
}

/// √a for a ≥ 0.
pub(super) fn around_root(square: f64) -> Interval {
    let root = square.sqrt();
    if square != 0.0 && square < FAINT {
        enclose(root, f64::NAN)
    } else {
        enclose(root, (-root).mul_add(root, square))
    }
}

/// The hull of a monotone operation on the ends.
pub(super) fn corners(
    left: Interval,
    right: Interval,
    operation: fn(f64, f64) -> Interval,
) -> Interval {
    operation(left.lower, right.lower)
        .hull(operation(left.lower, right.upper))
        .hull(operation(left.upper, right.lower))
        .hull(operation(left.upper, right.upper))
}

/// A number that is known up to half a unit in its last place.
pub(super) fn nearly(value: f64) -> Interval {
    if value == 0.0 { Interval::point(0.0) } else { enclose(value, f64::NAN) }
}

/// From `lower` to `upper`, as a function of the standard library gave them.
pub(super) fn loose(lower: f64, upper: f64) -> Interval {
    Interval {
        lower: (0..LIBRARY_ERROR).fold(lower, |end, _| end.next_down()),
        upper: (0..LIBRARY_ERROR).fold(upper, |end, _| end.next_up()),
    }
}

/// Around a result that was rounded to nearest, given the sign of what has to be added to make it
/// exact; NaN stands for an unknown sign.
fn enclose(rounded: f64, error: f64) -> Interval {
    Interval {
        lower: if error >= 0.0 { rounded } else { rounded.next_down() },
        upper: if error <= 0.0 { rounded } else { rounded.next_up() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_point(found: Interval, value: f64) -> bool {
        found.lower == value && found.upper == value
    }

    /// Where the sign of the error is not seen.
    fn is_widened(found: Interval, value: f64) -> bool {
        found.lower == value.next_down() && found.upper == value.next_up()
    }

    #[test]
    fn zero_and_quotients_by_infinity_are_exact() {
        for other in [3.0, -1e-300, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(is_point(product(0.0, other), 0.0));
            assert!(is_point(product(other, 0.0), 0.0));
            assert!(is_point(quotient(0.0, other), 0.0));
            assert!(is_point(quotient(other, f64::INFINITY), 0.0));
        }
        assert!(is_point(around_root(0.0), 0.0));
        assert!(is_point(nearly(0.0), 0.0));
        assert!(is_widened(nearly(std::f64::consts::TAU), std::f64::consts::TAU));
    }

    /// Twice the bound and half of it: powers of two, so that every result is exact.
    #[test]
    fn below_the_bound_no_error_is_seen() {
        for value in [FAINT, 2.0 * FAINT] {
            assert!(is_point(product(value, 1.0), value));
            assert!(is_point(quotient(value, 1.0), value));
            assert!(is_point(quotient(-value, 1.0), -value));
        }
        let faint = FAINT / 2.0;
        assert!(is_widened(product(faint, 1.0), faint));
        assert!(is_widened(product(-faint, 1.0), -faint));
        assert!(is_widened(quotient(faint, FAINT), 0.5));
        assert!(is_widened(quotient(1.0, 1.0 / faint), faint));
    }

    /// The bound is an odd power of two, and its half an even one.
    #[test]
    fn below_the_bound_no_error_of_a_root_is_seen() {
        let bound = around_root(FAINT);
        assert_eq!(bound.lower.next_up(), bound.upper);
        let root = 2f64.powi(-485);
        assert!(is_point(around_root(root * root * 4.0), 2.0 * root));
        assert!(is_widened(around_root(root * root), root));
    }
}
