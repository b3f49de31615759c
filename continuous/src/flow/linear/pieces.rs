//! Linear flows in pieces.
//!
//! A polynomial is its own only piece. A solution by exponentials is cut into pieces of a fraction
//! of a turn of its fastest mode that has not faded. Each is the Taylor polynomial of the solution,
//! with a proven bound on the rest: with |M| the matrix of magnitudes, s the sum of the magnitudes of
//! the terms up to the k-th, and times in units of the length of the piece, let |M| s ≤ λ s in every
//! component. If the k-th term is at most μ s, the one after it is at most μ s λ ÷ (k + 1), and so
//! on: they shrink at least as those of a geometric series. Where a mode is so fast that it has faded
//! but rules the series, as in stiff systems, the piece is instead a polynomial
//! [through](Piece::through) the solution, with an estimate of its error.

use super::{Exponential, LinearFlow};
use crate::flow::{Curve, Piece};

/// How much of a radian of the fastest lasting mode a piece is long.
const LENGTH: f64 = 2.0;
/// The most terms of a Taylor polynomial.
const MOST_TERMS: usize = 32;
/// For how many terms there is room at first.
const FEW_TERMS: usize = 8;
/// Terms of this part of the sum of magnitudes are below rounding.
const NEGLIGIBLE: f64 = 1e-17;
/// How often a piece may be halved before interpolation is tried.
const HALVINGS: u32 = 4;
/// By what part of a variable at the end of a piece its polynomial may be wrong.
const EXACT: f64 = 1e-12;
/// By what part of the variables that move it a variable is wrong for rounding.
const ROUNDING: f64 = 256.0 * f64::EPSILON;

impl LinearFlow {
    /// The [piece](Curve::piece) that holds `time`, which may end at `limit`: a short one has few terms.
    pub fn piece_up_to(&self, time: f64, limit: f64) -> Piece {
        let start = time.clamp(0.0, self.duration);
        let Some(coefficients) = &self.polynomial else {
            let end = if limit > start { limit.min(self.duration) } else { self.duration };
            return self.piece_of(self.field.exponential(), start, end);
        };
        let mut piece = Piece::new(0.0, self.duration, 0.0, 1.0);
        for component in 0..self.dimension() {
            piece.push(coefficients.iter().map(|term| term[component]), 0.0);
        }
        piece
    }

    fn piece_of(&self, exponential: &Exponential, start: f64, end: f64) -> Piece {
        let left = end - start;
        let wanted = (LENGTH / std::f64::consts::PI * exponential.time_scale(start)).min(left);
        let mut state = self.start.clone();
        if start > 0.0 {
            self.state_at(start, &mut state);
        }
        let mut length = wanted;
        for _ in 0..=HALVINGS {
            if let Some(piece) = exponential.taylor(&state, start, length) {
                return piece;
            }
            length *= 0.5;
        }
        self.interpolated(start, wanted, &state)
    }

    /// The longest of a few polynomials through the solution that is exact beside the present state: what
    /// has faded at the start of a piece may be all that is left at its end.
    fn interpolated(&self, start: f64, wanted: f64, state: &[f64]) -> Piece {
        let exponential = self.field.exponential();
        let least = LENGTH / std::f64::consts::PI * exponential.least_time_scale(start);
        let mut end = vec![0.0; state.len()];
        let mut length = wanted;
        loop {
            let piece = Piece::through(start, length, state.len(), |time, state| {
                self.state_at(time, state)
            });
            piece.state_at(start + length, &mut end);
            let is_exact = |component: usize| {
                let movers = exponential.movers[component].iter();
                let noise = ROUNDING * movers.map(|&one| state[one].abs()).fold(0.0, f64::max);
                piece.error(component) <= (EXACT * end[component].abs()).max(noise)
            };
            if length <= least || (0..state.len()).all(is_exact) {
                return piece;
            }
            length *= 0.5;
        }
    }
}

impl Exponential {
    /// The Taylor polynomial of the solution from `state` on, if few terms suffice over `length`.
    fn taylor(&self, state: &[f64], start: f64, length: f64) -> Option<Piece> {
        let dimension = state.len();
        let mut term: Vec<f64> = state.iter().copied().chain([self.constant]).collect();
        let mut most: Vec<f64> = term.iter().map(|x| x.abs()).collect();
        let mut sums = most.clone();
        let mut moved = vec![0.0; most.len()];
        let (mut next, mut next_most) = (term.clone(), most.clone());
        let mut terms = Vec::with_capacity(FEW_TERMS * dimension);
        terms.extend_from_slice(state);
        for degree in 1..=MOST_TERMS + 1 {
            let step = length / degree as f64;
            for ((row, next), next_most) in self.generator.iter().zip(&mut next).zip(&mut next_most)
            {
                let (mut sum, mut bound) = (0.0, 0.0);
                for &(column, entry) in row {
                    sum += entry * term[column];
                    bound += entry.abs() * most[column];
                }
                (*next, *next_most) = (sum * step, bound * step);
            }
            moved
                .iter_mut()
                .zip(&next_most)
                .for_each(|(moved, most)| *moved += degree as f64 * most);
            // `most` bounds the last term, which would be the first that is left out.
            if degree > 1
                && let Some(rest) = remainder(&most, &sums, &moved, degree)
                && rest <= NEGLIGIBLE
            {
                let mut piece = Piece::new(start, start + length, start, length)
                    .with_room(dimension, degree - 1);
                let terms = &terms[..(degree - 1) * dimension];
                for (i, sum) in sums[..dimension].iter().enumerate() {
                    piece.push(terms.iter().copied().skip(i).step_by(dimension), rest * sum);
                }
                return Some(piece);
            }
            std::mem::swap(&mut term, &mut next);
            std::mem::swap(&mut most, &mut next_most);
            terms.extend(&term[..dimension]);
            sums.iter_mut().zip(&most).for_each(|(sum, most)| *sum += most);
        }
        None
    }
}

/// All terms from one on, as a part of the sum s of the magnitudes up to it, at most; none where no
/// bound is seen. `most` are the magnitudes of that term, whose degree is `next` − 1, and `moved` is
/// |M| s, for the length of the piece.
fn remainder(most: &[f64], sums: &[f64], moved: &[f64], next: usize) -> Option<f64> {
    let largest = |parts: &[f64]| {
        let mut ratios =
            parts.iter().zip(sums).map(|(part, sum)| if *part == 0.0 { 0.0 } else { part / sum });
        // Over sums that are not finite nothing is bounded.
        let largest = ratios
            .try_fold(0.0_f64, |largest, ratio| ratio.is_finite().then(|| largest.max(ratio)));
        // Rounding of the sums is far below this margin.
        largest.map(|largest| largest * (1.0 + 1e-12))
    };
    let ratio = largest(moved)? / next as f64;
    if ratio < 0.5 { Some(largest(most)? / (1.0 - ratio)) } else { None }
}
