//! Polynomials of the components of a piece, as polynomials in time.
//!
//! Interval arithmetic forgets that x and y belong together: of x² + y² along a circle it sees two
//! quantities that change. As a polynomial in time their sum is what it is, a constant, with a bound on
//! what rounding adds.

use pleach_guards::Ring;

use super::Piece;

/// A polynomial in the time of a piece, with a bound on its error.
///
/// ```
/// use pleach_continuous::flow::Piece;
/// use pleach_guards::{Enclosure, Ring};
///
/// // x = t and y = 1 − t: the sum rests.
/// let mut piece = Piece::new(0.0, 2.0, 0.0, 1.0);
/// piece.push([0.0, 1.0], 0.0);
/// piece.push([1.0, -1.0], 0.0);
/// let sum = piece.polynomial(0).plus(&piece.polynomial(1)).expect("it is short");
/// let mut states = Vec::new();
/// piece.composed(&sum).enclose(0.0, 2.0, &mut states);
/// assert!(states[0].range.width() < 1e-14);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    /// The constant first.
    coefficients: Vec<f64>,
    error: f64,
    /// The largest magnitude of what is raised to powers.
    farthest: f64,
}

/// Longer polynomials are not computed.
const MOST_COEFFICIENTS: usize = 160;

impl Piece {
    /// A component as a polynomial.
    pub fn polynomial(&self, component: usize) -> Polynomial {
        let coefficients = self.coefficients(component).to_vec();
        Polynomial { coefficients, error: self.error(component), farthest: self.farthest() }
    }

    /// The piece of a curve that has such a polynomial as its only component.
    #[must_use]
    pub fn composed(&self, polynomial: &Polynomial) -> Piece {
        let mut piece = self.emptied();
        piece.push(polynomial.coefficients.iter().copied(), polynomial.error);
        piece
    }
}

impl Polynomial {
    /// A bound on the magnitude of its values, without the error.
    fn most(&self) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, c| sum * self.farthest + c.abs())
    }

    /// The same without the highest powers as far as these are below rounding.
    fn shortened(mut self) -> Self {
        let least = f64::EPSILON * self.most();
        let mut rest = 0.0;
        while let Some(last) = self.coefficients.last() {
            let power = self.farthest.powi(self.coefficients.len() as i32 - 1);
            let with_last = rest + last.abs() * power;
            if with_last > least || self.coefficients.len() == 1 {
                break;
            }
            rest = with_last;
            self.coefficients.pop();
        }
        self.error += 2.0 * rest;
        self
    }
}

impl Ring for Polynomial {
    fn number(value: f64) -> Self {
        Polynomial { coefficients: vec![value], error: 0.0, farthest: 0.0 }
    }

    fn plus(&self, other: &Self) -> Option<Self> {
        let length = self.coefficients.len().max(other.coefficients.len());
        let farthest = self.farthest.max(other.farthest);
        let of = |one: &Self, power: usize| one.coefficients.get(power).copied().unwrap_or(0.0);
        let coefficients = (0..length).map(|power| of(self, power) + of(other, power)).collect();
        let sum = Polynomial { coefficients, error: self.error + other.error, farthest };
        let rounding = f64::EPSILON * sum.most();
        Some(Polynomial { error: sum.error + rounding, ..sum }.shortened())
    }

    fn times(&self, other: &Self) -> Option<Self> {
        let length = (self.coefficients.len() + other.coefficients.len()).max(1) - 1;
        if length > MOST_COEFFICIENTS {
            return None;
        }
        let mut coefficients = vec![0.0; length];
        for (power, c) in self.coefficients.iter().enumerate() {
            for (sum, d) in coefficients[power..].iter_mut().zip(&other.coefficients) {
                *sum += c * d;
            }
        }
        let farthest = self.farthest.max(other.farthest);
        let sizes = [self, other].map(|one| Polynomial { farthest, ..one.clone() }.most());
        let [one, another] = sizes;
        // Of each coefficient fewer products are summed than there are coefficients.
        let is_sign = |one: &Self| one.coefficients.len() == 1 && one.coefficients[0].abs() == 1.0;
        let sums = if is_sign(self) || is_sign(other) { 0 } else { length + 1 };
        let rounding = sums as f64 * f64::EPSILON * one * another;
        let error = one * other.error + another * self.error + self.error * other.error;
        let error = if error == 0.0 { rounding } else { (error + rounding) * (1.0 + 1e-12) };
        Some(Polynomial { coefficients, error, farthest }.shortened())
    }
}
