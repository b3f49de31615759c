//! Linear flows ẋ = A x of many variables, where most entries of A are 0, bounded in one direction.
//!
//! As for [affine flows](super::affine) the direction is carried and not the set: at time t it is
//! ℓ(t) = e^{Aᵀt} ℓ, and ℓ · x(t) = ℓ(t) · x(0). A direction is a vector of numbers, and a bound ε on
//! what it is off by in the sum of magnitudes. In a step the Taylor series of e^{Aᵀh} is applied to the
//! numbers in intervals; their middles go on, and what they may be off by is added to ε. What was off
//! before is off by at most e^{μh} times as much, where
//!
//! ```text
//! μ = max {aᵢᵢ + Σ |aᵢⱼ| : i},     j ≠ i,
//! ```
//!
//! is the logarithmic norm of Aᵀ (Söderlind 2006, *The logarithmic norm. History and modern theory*,
//! [doi:10.1007/s10543-006-0069-9](https://doi.org/10.1007/s10543-006-0069-9)). Where a flow evens out
//! differences it is at most 0, and errors do not grow. No matrix but A is stored.

use pleach_guards::Interval;
use thiserror::Error;

use super::exponential::{TERMS, remainder};
use super::rounding::{plus_up, sum_up};
use super::vector::{around_zero, dot_numbers, magnitude, radius, sum_of_products};

/// The flow ẋ = A x.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseFlow {
    /// The entries of each column of A that are not 0, with their rows.
    columns: Vec<Vec<(usize, Interval)>>,
    /// At least the largest sum of magnitudes of a row of A.
    norm: f64,
    /// At least μ.
    logarithmic_norm: f64,
}

/// Bounds on a quantity during a span of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// In seconds.
    pub time: Interval,
    /// Every value at any instant of the span.
    pub values: Interval,
}

/// An entry is outside of the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("row {row} has an entry in column {column}, and there are {dimension} columns, from 0")]
pub struct InvalidEntry {
    /// The row.
    pub row: usize,
    /// The column.
    pub column: usize,
    /// How many columns there are.
    pub dimension: usize,
}

impl SparseFlow {
    /// The flow of the square matrix with these rows, given as columns and entries; entries of one place
    /// add up.
    ///
    /// # Errors
    ///
    /// [`InvalidEntry`] if an entry is in a column that the matrix does not have.
    pub fn new(rows: &[Vec<(usize, Interval)>]) -> Result<Self, InvalidEntry> {
        let dimension = rows.len();
        let mut columns = vec![Vec::new(); dimension];
        let (mut norm, mut logarithmic_norm) = (0.0f64, f64::NEG_INFINITY);
        for (row, entries) in rows.iter().enumerate() {
            for &(column, entry) in entries {
                let place = columns.get_mut(column);
                place.ok_or(InvalidEntry { row, column, dimension })?.push((row, entry));
            }
            let beside = entries.iter().filter(|(column, _)| *column != row);
            let beside = sum_up(beside.map(|(_, entry)| magnitude(*entry)));
            let diagonal = entries.iter().filter(|(column, _)| *column == row);
            let diagonal = diagonal.fold(Interval::point(0.0), |sum, (_, entry)| sum + *entry);
            norm = norm.max(plus_up(beside, magnitude(diagonal)));
            logarithmic_norm = logarithmic_norm.max(plus_up(diagonal.upper(), beside));
        }
        Ok(SparseFlow { columns, norm, logarithmic_norm })
    }

    /// How many variables there are.
    pub fn dimension(&self) -> usize {
        self.columns.len()
    }

    /// Bounds on ℓ · x for flows from every state of a box, step by step without an end. `direction` is ℓ;
    /// it and the box have as many entries as there are variables. Steps last `step` > 0 seconds, or less
    /// where the series of the exponential would need too many terms.
    pub fn along<'a>(&'a self, start: &'a [Interval], direction: &[f64], step: f64) -> Along<'a> {
        // The norm of A h is at most ½.
        let halvings = (2.0 * self.norm * step).log2().ceil().max(0.0) as i32;
        let length = step * 0.5f64.powi(halvings);
        let direction = direction.to_vec();
        let value = dot_numbers(start, &direction);
        Along { flow: self, start, length, direction, error: 0.0, value, taken: 0, terms: TERMS }
    }

    /// Aᵀ v.
    fn transposed_times(&self, vector: &[Interval]) -> Vec<Interval> {
        let entry = |column: &Vec<(usize, Interval)>| {
            sum_of_products(column.iter().map(|(row, entry)| (*entry, vector[*row])))
        };
        self.columns.iter().map(entry).collect()
    }
}

/// The spans of a flow along a direction, one after the other; see [`SparseFlow::along`].
#[derive(Clone, Debug)]
pub struct Along<'a> {
    flow: &'a SparseFlow,
    start: &'a [Interval],
    /// Of a step, in seconds.
    length: f64,
    /// The direction that has been carried.
    direction: Vec<f64>,
    /// What it is off by at most, in the sum of magnitudes.
    error: f64,
    /// ℓ · x now.
    value: Interval,
    /// How many steps have been taken.
    taken: u64,
    /// Up to which power the series is summed.
    terms: u32,
}

impl Along<'_> {
    /// Carries the direction over a step; returns what it bends by on the way, at most, in the sum of
    /// magnitudes.
    fn carry(&mut self) -> Interval {
        let length = Interval::point(self.length);
        let norm = Interval::point(self.flow.norm) * length;
        let growth = (Interval::point(self.flow.logarithmic_norm) * length).exp();
        let mut term: Vec<Interval> =
            self.direction.iter().map(|it| Interval::point(*it)).collect();
        let mut sum = term.clone();
        let mut second = 0.0;
        for order in 1..=self.terms {
            let factor = length / Interval::point(f64::from(order));
            term = self.flow.transposed_times(&term).into_iter().map(|it| it * factor).collect();
            sum = sum.into_iter().zip(&term).map(|(sum, term)| sum + *term).collect();
            if order == 2 {
                second = size(&term);
            }
        }
        // Over the step the numbers differ from the straight line by h²/8 |ℓ″| at most, and the term of
        // order 2 is h²/2 times that at its begin. What they are off by grows like e^{μt}, which is below
        // its straight line.
        let bend = Interval::point(second) / Interval::point(4.0);
        let bend = bend * growth.max(Interval::point(1.0));

        let rest = remainder(norm.upper(), self.terms) * Interval::point(sizes(&self.direction));
        let rounding = Interval::point(sum_up(sum.iter().map(|entry| radius(*entry))));
        self.error = (Interval::point(self.error) * growth + rest + rounding).upper();
        self.direction = sum.iter().map(Interval::midpoint).collect();
        bend
    }
}

impl Iterator for Along<'_> {
    type Item = Span;

    fn next(&mut self) -> Option<Span> {
        let farthest = self.start.iter().map(|side| magnitude(*side)).fold(0.0, f64::max);
        let farthest = Interval::point(farthest);
        let bend = self.carry();
        let before = self.value;
        let off = around_zero((Interval::point(self.error) * farthest).upper());
        self.value = dot_numbers(self.start, &self.direction) + off;
        let between = around_zero((bend * farthest).upper());
        let values = before.hull(self.value) + between;
        let at = |step: u64| Interval::point(self.length) * Interval::point(step as f64);
        let time = at(self.taken).hull(at(self.taken + 1));
        self.taken += 1;
        Some(Span { time, values })
    }
}

/// At least the sum of magnitudes.
fn size(vector: &[Interval]) -> f64 {
    sum_up(vector.iter().map(|entry| magnitude(*entry)))
}

/// Likewise, of numbers.
fn sizes(vector: &[f64]) -> f64 {
    sum_up(vector.iter().map(|entry| entry.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::exact::{fraction, points};
    use crate::reach::exponential::exponential;
    use crate::reach::vector::IntervalMatrix;

    fn flow(rows: &[&[(usize, f64)]]) -> SparseFlow {
        let row = |row: &&[(usize, f64)]| {
            row.iter().map(|(column, entry)| (*column, Interval::point(*entry))).collect()
        };
        SparseFlow::new(&rows.iter().map(row).collect::<Vec<_>>()).expect("a square matrix")
    }

    /// ẋ = −x from 1, for ten seconds.
    #[test]
    fn a_decay_is_enclosed_tightly() {
        let decay = flow(&[&[(0, -1.0)]]);
        assert_eq!(decay.logarithmic_norm, -1.0);
        let start = points(&[1.0]);
        for span in decay.along(&start, &[1.0], 0.125).take(80) {
            for t in [span.time.lower(), span.time.midpoint(), span.time.upper()] {
                assert!(span.values.contains((-t).exp()), "{span:?} at {t}");
            }
            let (most, least) = ((-span.time.lower()).exp(), (-span.time.upper()).exp());
            assert!(span.values.width() < (most - least) * 1.1 + 1e-14, "{span:?}");
        }
    }

    /// With few terms of the series its rest is large; and so is what it has been off by before.
    #[test]
    fn the_rest_of_the_series_counts() {
        let decay = flow(&[&[(0, -1.0)]]);
        let start = points(&[1.0]);
        let along = Along { terms: 2, ..decay.along(&start, &[1.0], 0.5) };
        for span in along.take(12) {
            let t = span.time.upper();
            assert!(span.values.contains((-t).exp()), "{span:?} at {t}");
        }
    }

    /// What the direction is off by counts for the value, and grows with the flow.
    #[test]
    fn errors_of_the_direction_count() {
        let growth = flow(&[&[(0, 1.0)]]);
        let start = points(&[2.0]);
        let mut along = Along { error: 0.5, ..growth.along(&start, &[1.0], 0.5) };
        along.next();
        // From 1.5 times 2 on.
        assert!(along.value.contains(3.0 * 0.5f64.exp()), "{}", along.value);
    }

    /// A rotation from (1, 0) in direction (1, 1): 1 at both ends of a quarter turn, and √2 between.
    #[test]
    fn directions_bend_within_a_step() {
        let turn = flow(&[&[(1, -1.0)], &[(0, 1.0)]]);
        let start = points(&[1.0, 0.0]);
        let spans: Vec<Span> = turn.along(&start, &[1.0, 1.0], 0.5).take(4).collect();
        let highest = spans.iter().map(|span| span.values.upper()).fold(0.0, f64::max);
        assert!((2f64.sqrt()..1.6).contains(&highest), "{highest}");
    }

    /// ẋ₁ = x₂: the direction (1, 0) becomes (1, t), and t is no number.
    #[test]
    fn rounding_of_the_direction_counts() {
        let chain = flow(&[&[(1, 1.0)], &[]]);
        let start = points(&[0.0, 1.0]);
        let mut along = chain.along(&start, &[1.0, 0.0], 0.1);
        for number in 1..=30 {
            along.next();
            let exact = fraction(0.1) * fraction(f64::from(number));
            let off = fraction(along.direction[1]) - exact;
            let error = fraction(along.error);
            assert!(off <= error && -off <= error, "{number}");
        }
    }

    /// t a − t²/2 − t³/6 is 0 at both ends of the step, and farther from it between than the second
    /// derivative at its begin says.
    #[test]
    fn directions_bend_more_as_they_grow() {
        let chain = flow(&[&[(1, 1.0)], &[(2, 1.0)], &[(3, 1.0)], &[]]);
        let gain = 0.25 + 0.25 / 6.0;
        let start = points(&[0.0, gain, -1.0, -1.0]);
        let span = chain.along(&start, &[1.0, 0.0, 0.0, 0.0], 0.5).next().expect("it goes on");
        let value = |t: f64| gain * t - t * t / 2.0 - t * t * t / 6.0;
        assert!(span.values.contains(value(0.25)), "{span:?}");
        assert!(span.values.upper() < 2.0 * value(0.25), "{span:?}");
    }

    /// Rows with entries of both signs, against the exponential of the whole matrix.
    #[test]
    fn it_agrees_with_the_dense_exponential() {
        let rows: [&[(usize, f64)]; 4] = [
            &[(0, -1.0), (1, 0.7)],
            &[(1, -0.3), (3, -1.1)],
            &[(0, 0.2), (2, -2.0)],
            &[(2, 0.9), (3, 0.1)],
        ];
        let mut dense = IntervalMatrix::zero(4, 4);
        for (row, entries) in rows.iter().enumerate() {
            for (column, entry) in *entries {
                dense[(row, *column)] = Interval::point(*entry);
            }
        }
        let start: Vec<Interval> = [(0.9, 1.1), (-0.2, 0.1), (0.5, 0.5), (1.0, 2.0)]
            .map(|(lower, upper)| Interval::new(lower, upper).expect("in order"))
            .to_vec();
        let sparse = flow(&rows);
        for span in sparse.along(&start, &[0.0, 1.0, 0.0, -0.5], 0.1).take(30) {
            let moved = exponential(&dense.map(|entry| entry * Interval::point(span.time.upper())));
            let (one, other) = (moved.row(1), moved.row(3));
            let direction: Vec<Interval> = one
                .iter()
                .zip(other)
                .map(|(one, other)| *one - *other * Interval::point(0.5))
                .collect();
            let exact = super::super::vector::dot(&direction, &start);
            let inner = 1e-9;
            assert!(span.values.lower() <= exact.lower() + inner, "{span:?} {exact}");
            assert!(span.values.upper() >= exact.upper() - inner, "{span:?} {exact}");
        }
    }

    #[test]
    fn entries_outside_are_refused() {
        let error = SparseFlow::new(&[vec![(1, Interval::point(1.0))]]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "row 0 has an entry in column 1, and there are 1 columns, from 0"
        );
    }
}
