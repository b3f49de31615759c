//! Vectors and matrices of intervals.

use std::ops::{Index, IndexMut};

use pleach_guards::Interval;

use super::rounding::{enclosed_sum, sum_up};

/// From −`radius` to `radius`.
pub(super) fn around_zero(radius: f64) -> Interval {
    let radius = radius.abs();
    Interval::new(-radius, radius).unwrap_or(Interval::WHOLE)
}

/// The largest magnitude of a number in `interval`.
pub(super) fn magnitude(interval: Interval) -> f64 {
    interval.lower().abs().max(interval.upper().abs())
}

/// At least how far any number of `interval` is from its midpoint.
pub(super) fn radius(interval: Interval) -> f64 {
    magnitude(interval - Interval::point(interval.midpoint()))
}

/// Whether it is the number 0 alone.
pub(super) fn is_zero(interval: Interval) -> bool {
    interval.lower() == 0.0 && interval.upper() == 0.0
}

/// Σ aᵢ bᵢ for vectors of intervals of one length.
pub fn dot(left: &[Interval], right: &[Interval]) -> Interval {
    sum_of_products(left.iter().copied().zip(right.iter().copied()))
}

/// Σ a b over pairs of intervals.
pub(super) fn sum_of_products(pairs: impl Iterator<Item = (Interval, Interval)>) -> Interval {
    let (mut lower, mut upper, mut size, mut count) = (0.0, 0.0, 0.0, 0);
    let mut last = None;
    for (a, b) in pairs.filter(|(a, b)| !is_zero(*a) && !is_zero(*b)) {
        last = Some((a, b));
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
        count += 1;
    }
    match last {
        // A single product is often exact, so constant values do not widen.
        Some((a, b)) if count == 1 => a * b,
        _ => enclosed_sum(lower, upper, size, count),
    }
}

/// Σ aᵢ bᵢ for a vector of intervals and one of numbers.
pub fn dot_numbers(left: &[Interval], right: &[f64]) -> Interval {
    let (mut lower, mut upper, mut size, mut count) = (0.0, 0.0, 0.0, 0);
    let mut last = None;
    for (a, &b) in left.iter().zip(right).filter(|(a, b)| !is_zero(**a) && **b != 0.0) {
        last = Some((a, b));
        let (one, other) = (a.lower() * b, a.upper() * b);
        lower += one.min(other);
        upper += one.max(other);
        size += one.abs().max(other.abs());
        count += 1;
    }
    match last {
        Some((a, b)) if count == 1 => *a * Interval::point(b),
        _ => enclosed_sum(lower, upper, size, count),
    }
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
    pub(super) fn transposed(&self) -> Self {
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
    pub(super) fn map(&self, change: impl Fn(Interval) -> Interval) -> Self {
        let entries = self.entries.iter().map(|entry| change(*entry)).collect();
        IntervalMatrix { entries, ..*self }
    }

    /// The sum of two matrices of one shape.
    #[must_use]
    pub(super) fn plus(&self, other: &IntervalMatrix) -> Self {
        let pairs = self.entries.iter().zip(&other.entries);
        IntervalMatrix { entries: pairs.map(|(a, b)| *a + *b).collect(), ..*self }
    }

    /// The product with a matrix that has as many rows as this one has columns.
    #[must_use]
    pub(super) fn times(&self, other: &IntervalMatrix) -> Self {
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
    pub(super) fn apply_to_numbers(&self, vector: &[f64]) -> Vec<Interval> {
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
