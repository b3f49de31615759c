//! The matrix exponential, enclosed.

use pleach_guards::Interval;

use super::vector::{IntervalMatrix, around_zero};

/// Terms of the Taylor series beyond the first; with matrices of norm up to a half the rest is
/// below rounding.
pub(super) const TERMS: u32 = 14;

/// Every e^{M} for matrices M in `matrix`, which is square.
///
/// The matrix is halved until its norm is at most ½, its Taylor series is summed with a bound on the
/// remainder, and the result is squared as often.
pub fn exponential(matrix: &IntervalMatrix) -> IntervalMatrix {
    let norm = matrix.norm();
    if !norm.is_finite() {
        return matrix.map(|_| Interval::WHOLE);
    }
    let halvings = if norm > 0.5 { (norm.log2() + 1.0).ceil() as u32 } else { 0 };
    let scale = Interval::point(0.5f64.powi(halvings as i32));
    let mut power = series(&matrix.map(|entry| entry * scale), TERMS);
    for _ in 0..halvings {
        power = power.times(&power);
    }
    power
}

/// The series for a matrix of norm well below 1, up to the power `terms`.
fn series(matrix: &IntervalMatrix, terms: u32) -> IntervalMatrix {
    let dimension = matrix.rows();
    let mut sum = IntervalMatrix::identity(dimension);
    let mut term = IntervalMatrix::identity(dimension);
    for order in 1..=terms {
        let divisor = Interval::point(f64::from(order));
        term = term.times(matrix).map(|entry| entry / divisor);
        sum = sum.plus(&term);
    }
    let rest = remainder(matrix.norm(), terms);
    sum.map(|entry| entry + rest)
}

/// What the terms after number k, which is `terms`, add to any entry, for a matrix of this norm:
/// at most ‖M‖ᵏ⁺¹ ÷ (k + 1)! ÷ (1 − ‖M‖ ÷ (k + 2)).
pub(super) fn remainder(norm: f64, terms: u32) -> Interval {
    let norm = Interval::point(norm);
    let next = (1..=terms + 1).fold(Interval::point(1.0), |product, order| {
        product * norm / Interval::point(f64::from(order))
    });
    let ratio = norm / Interval::point(f64::from(terms + 2));
    let rest = next / (Interval::point(1.0) - ratio);
    around_zero(if ratio.upper() < 1.0 { rest.upper() } else { f64::INFINITY })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(entries: [[f64; 2]; 2]) -> IntervalMatrix {
        let mut matrix = IntervalMatrix::zero(2, 2);
        for (row, line) in entries.into_iter().enumerate() {
            for (column, entry) in line.into_iter().enumerate() {
                matrix[(row, column)] = Interval::point(entry);
            }
        }
        matrix
    }

    #[test]
    fn rotations_and_decays_are_enclosed_tightly() {
        for angle in [0.1f64, 1.0, 6.0] {
            let turned = exponential(&matrix([[0.0, angle], [-angle, 0.0]]));
            let expected = [[angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]];
            for (row, line) in expected.into_iter().enumerate() {
                for (column, exact) in line.into_iter().enumerate() {
                    let found = turned[(row, column)];
                    assert!(found.contains(exact), "{found} {exact}");
                    assert!(found.width() < 2e-13, "{found}");
                }
            }
        }
        let decayed = exponential(&matrix([[-20.0, 0.0], [0.0, -0.25]]));
        assert!(decayed[(0, 0)].contains((-20.0f64).exp()));
        assert!(decayed[(1, 1)].contains((-0.25f64).exp()));
        assert!(decayed[(0, 1)].contains(0.0) && decayed[(0, 1)].width() < 1e-12);
    }

    /// With few terms the rest of the series is large: e^½ is 1 + ½ + ⅛ + 1/48 and 0.00289.
    #[test]
    fn the_rest_of_the_series_counts() {
        let found = series(&matrix([[0.5, 0.0], [0.0, 0.0]]), 3)[(0, 0)];
        assert!(found.contains(0.5f64.exp()), "{found}");
        assert!(found.upper() - 0.5f64.exp() < 1e-4, "{found}");
    }

    #[test]
    fn uncertain_entries_give_all_exponentials() {
        let mut wide = matrix([[0.0, 0.0], [0.0, 0.0]]);
        wide[(0, 0)] = Interval::new(-1.0, 0.5).unwrap();
        let found = exponential(&wide)[(0, 0)];
        assert!(found.contains((-1.0f64).exp()) && found.contains(0.5f64.exp()));
        assert_eq!(exponential(&wide.map(|_| Interval::WHOLE))[(0, 0)], Interval::WHOLE);
    }
}
