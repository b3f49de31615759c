//! Linear flows in pieces.
//!
//! A polynomial is its own only piece. A solution by exponentials is cut into pieces of a fraction
//! of a turn of its fastest mode that has not faded. Each is the Taylor polynomial of the solution,
//! with a proven bound on the rest: with |M| the matrix of magnitudes and a the magnitudes of the
//! next term, if |M| a ≤ λ a in every component, the terms that follow shrink at least as those of
//! a geometric series. Where a mode is so fast that it has faded but rules the series, as in stiff
//! systems, the piece is instead a polynomial [through](Piece::through) the solution, with an
//! estimate of its error.

use nalgebra::DVector;

use super::{Exponential, LinearFlow, Solution};
use crate::flow::{Curve, Piece};

/// How much of a radian of the fastest lasting mode a piece is long.
const LENGTH: f64 = 2.0;
/// The most terms of a Taylor polynomial.
const MOST_TERMS: usize = 32;
/// Terms of this part of the sum of magnitudes are below rounding.
const NEGLIGIBLE: f64 = 1e-17;
/// How often a piece may be halved before interpolation is tried.
const HALVINGS: u32 = 4;

impl LinearFlow {
    pub(super) fn piece_from(&self, time: f64) -> Piece {
        let start = time.clamp(0.0, self.duration);
        match &self.solution {
            Solution::Polynomial(coefficients) => {
                let mut piece = Piece::new(0.0, self.duration, 0.0, 1.0);
                for component in 0..self.dimension {
                    piece.push(coefficients.iter().map(|term| term[component]), 0.0);
                }
                piece
            }
            Solution::Exponential(exponential) => self.piece_of(exponential, start),
        }
    }

    fn piece_of(&self, exponential: &Exponential, start: f64) -> Piece {
        let left = self.duration - start;
        let wanted = (LENGTH / std::f64::consts::PI * exponential.time_scale(start)).min(left);
        let mut state = vec![0.0; self.dimension];
        self.state_at(start, &mut state);
        let mut length = wanted;
        for _ in 0..=HALVINGS {
            if let Some(piece) = exponential.taylor(&state, start, length) {
                return piece;
            }
            length *= 0.5;
        }
        Piece::through(start, wanted, self.dimension, |time, state| self.state_at(time, state))
    }
}

impl Exponential {
    /// The Taylor polynomial of the solution from `state` on, if few terms suffice over `length`.
    fn taylor(&self, state: &[f64], start: f64, length: f64) -> Option<Piece> {
        let dimension = state.len();
        let magnitudes = self.generator.abs();
        let mut term = DVector::from_column_slice(state).push(self.initial[dimension]);
        let mut most = term.abs();
        let mut sums = most.clone();
        let mut terms = Vec::with_capacity(MOST_TERMS);
        for degree in 1..=MOST_TERMS {
            let step = length / degree as f64;
            let next = &self.generator * &term * step;
            terms.push(std::mem::replace(&mut term, next));
            most = &magnitudes * &most * step;
            sums += &most;
            let Some(rest) = remainder(&magnitudes, &most, length / (degree + 1) as f64) else {
                continue;
            };
            let is_enough = |i: usize| rest * most[i] <= NEGLIGIBLE * sums[i];
            if (0..dimension).all(is_enough) {
                let mut piece = Piece::new(start, start + length, start, length);
                for i in 0..dimension {
                    piece.push(terms.iter().map(|term| term[i]), rest * most[i]);
                }
                return Some(piece);
            }
        }
        None
    }
}

/// By how much all terms from this one on are more than it, at most; none where no bound is seen.
fn remainder(magnitudes: &nalgebra::DMatrix<f64>, most: &DVector<f64>, step: f64) -> Option<f64> {
    let next = magnitudes * most * step;
    let mut ratio: f64 = 0.0;
    for (next, this) in next.iter().zip(most) {
        if *next > 0.0 {
            ratio = ratio.max(next / this);
        }
    }
    // Rounding of the products is far below this margin.
    let ratio = ratio * (1.0 + 1e-12);
    (ratio < 0.5).then(|| 1.0 / (1.0 - ratio))
}
