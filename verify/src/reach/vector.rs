//! Vectors and matrices of intervals.
//!
//! Sums of products are added in ordinary floating-point numbers, and what rounding can have done
//! is bounded afterwards: of n products it is at most γₙ₊₂ times the sum of their magnitudes
//! (Higham 2002, *Accuracy and Stability of Numerical Algorithms*, section 3.1). That is several
//! times faster than rounding each operation outward, and hardly wider.

use std::ops::{Index, IndexMut};

use pleach_guards::Interval;

/// Half the distance from 1 to the next number.
const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// From −`radius` to `radius`.
pub fn around_zero(radius: f64) -> Interval {
    let radius = radius.abs();
    Interval::new(-radius, radius).unwrap_or(Interval::WHOLE)
}

/// The largest magnitude of a number in `interval`.
pub fn magnitude(interval: Interval) -> f64 {
    interval.lower().abs().max(interval.upper().abs())
}

/// At least how far any number of `interval` is from its midpoint.
pub fn radius(interval: Interval) -> f64 {
    let middle = Interval::point(interval.midpoint());
    (interval - middle).upper().max((middle - interval).upper())
}

/// At least the sum of numbers that are not negative.
pub fn sum_up(terms: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 2.0);
    for term in terms {
        sum += term;
        count += 1.0;
    }
    inflated(sum, count)
}

/// At least what a sum of `count` terms that are not negative, computed as `sum`, is exactly.
fn inflated(sum: f64, count: f64) -> f64 {
    let bound = sum * (1.0 + 2.0 * count * UNIT_ROUNDOFF);
    if bound.is_nan() { f64::INFINITY } else { bound.next_up() }
}

/// Σ aᵢ bᵢ for vectors of intervals of one length.
pub fn dot(left: &[Interval], right: &[Interval]) -> Interval {
    let (mut lower, mut upper, mut size) = (0.0, 0.0, 0.0);
    for (a, b) in left.iter().zip(right) {
        let corners = [
            a.lower() * b.lower(),
            a.lower() * b.upper(),
            a.upper() * b.lower(),
            a.upper() * b.upper(),
        ];
        let least = corners[0].min(corners[1]).min(corners[2].min(corners[3]));
        let most = corners[0].max(corners[1]).max(corners[2].max(corners[3]));
        lower += least;
        upper += most;
        size += least.abs().max(most.abs());
    }
    rounded_outward(lower, upper, size, left.len())
}

/// Σ aᵢ bᵢ for a vector of intervals and one of numbers.
pub fn dot_numbers(left: &[Interval], right: &[f64]) -> Interval {
    let (mut lower, mut upper, mut size) = (0.0, 0.0, 0.0);
    for (a, &b) in left.iter().zip(right) {
        let (one, other) = (a.lower() * b, a.upper() * b);
        lower += one.min(other);
        upper += one.max(other);
        size += one.abs().max(other.abs());
    }
    rounded_outward(lower, upper, size, left.len())
}

/// Sums of `count` products, computed as these, with magnitudes that add up to `size`.
fn rounded_outward(lower: f64, upper: f64, size: f64, count: usize) -> Interval {
    if size == 0.0 && count == 0 {
        return Interval::point(0.0);
    }
    let count = count as f64;
    // The second term is for products too small to be numbers.
    let error = inflated(size, count) * (count + 3.0) * UNIT_ROUNDOFF + count * f64::MIN_POSITIVE;
    Interval::new((lower - error).next_down(), (upper + error).next_up()).unwrap_or(Interval::WHOLE)
}

/// A matrix of intervals: every matrix with entries in them.
#[derive(Clone, Debug, PartialEq)]
pub struct IntervalMatrix {
    rows: usize,
    columns: usize,
    /// Row by row.
    entries: Vec<Interval>,
}

impl IntervalMatrix {
    /// The matrix of zeros.
    pub fn zero(rows: usize, columns: usize) -> Self {
        IntervalMatrix { rows, columns, entries: vec![Interval::point(0.0); rows * columns] }
    }

    /// The identity.
    pub fn identity(dimension: usize) -> Self {
        let mut identity = IntervalMatrix::zero(dimension, dimension);
        for place in 0..dimension {
            identity[(place, place)] = Interval::point(1.0);
        }
        identity
    }

    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// How many columns there are.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// A row.
    pub fn row(&self, row: usize) -> &[Interval] {
        &self.entries[row * self.columns..(row + 1) * self.columns]
    }

    /// All entries, row by row.
    pub fn entries(&self) -> &[Interval] {
        &self.entries
    }

    /// Rows and columns exchanged.
    #[must_use]
    pub fn transposed(&self) -> Self {
        let mut transposed = IntervalMatrix::zero(self.columns, self.rows);
        for row in 0..self.rows {
            for column in 0..self.columns {
                transposed[(column, row)] = self[(row, column)];
            }
        }
        transposed
    }

    /// Each entry changed.
    #[must_use]
    pub fn map(&self, change: impl Fn(Interval) -> Interval) -> Self {
        let entries = self.entries.iter().map(|entry| change(*entry)).collect();
        IntervalMatrix { entries, ..*self }
    }

    /// The sum of two matrices of one shape.
    #[must_use]
    pub fn plus(&self, other: &IntervalMatrix) -> Self {
        let pairs = self.entries.iter().zip(&other.entries);
        IntervalMatrix { entries: pairs.map(|(a, b)| *a + *b).collect(), ..*self }
    }

    /// The product with a matrix that has as many rows as this one has columns.
    #[must_use]
    pub fn times(&self, other: &IntervalMatrix) -> Self {
        let columns = other.transposed();
        let mut entries = Vec::with_capacity(self.rows * other.columns);
        for row in 0..self.rows {
            entries.extend((0..other.columns).map(|at| dot(self.row(row), columns.row(at))));
        }
        IntervalMatrix { rows: self.rows, columns: other.columns, entries }
    }

    /// The product with a vector.
    pub fn apply(&self, vector: &[Interval]) -> Vec<Interval> {
        (0..self.rows).map(|row| dot(self.row(row), vector)).collect()
    }

    /// The product with a vector of numbers.
    pub fn apply_to_numbers(&self, vector: &[f64]) -> Vec<Interval> {
        (0..self.rows).map(|row| dot_numbers(self.row(row), vector)).collect()
    }

    /// At least the largest sum of magnitudes of a row.
    pub fn norm(&self) -> f64 {
        let sum = |row| sum_up(self.row(row).iter().map(|entry| magnitude(*entry)));
        (0..self.rows).map(sum).fold(0.0, f64::max)
    }
}

impl Index<(usize, usize)> for IntervalMatrix {
    type Output = Interval;

    fn index(&self, (row, column): (usize, usize)) -> &Interval {
        &self.entries[row * self.columns + column]
    }
}

impl IndexMut<(usize, usize)> for IntervalMatrix {
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut Interval {
        &mut self.entries[row * self.columns + column]
    }
}
