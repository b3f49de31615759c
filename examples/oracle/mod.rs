//! An answer to compare with where there is no formula: affine flows ẋ = A x + b by the power
//! series of the matrix exponential, and the instants at which something happens by bisection.
//!
//! It shares nothing with what it judges: the framework takes another exponential and looks for
//! events in another way.

#![allow(dead_code)] // each classic uses a part of it

use nalgebra::{DMatrix, DVector};

/// The flow ẋ = A x + b as (x, 1)˙ = M (x, 1).
pub struct Affine {
    generator: DMatrix<f64>,
}

/// How far apart the flow is looked at, in seconds: far below every time constant of the classics.
const LOOK: f64 = 1e-2;
/// Where the series of the exponential is cut: the norm of the matrix is below 1/8 by then, so
/// that the rest is below the rounding.
const TERMS: u32 = 16;

impl Affine {
    /// The flow whose rates are these functions of the state, all of them affine: a column of A
    /// is what a step along one axis adds to the rates at the origin.
    pub fn new(dimension: usize, rates: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        let mut generator = DMatrix::zeros(dimension + 1, dimension + 1);
        let offset = rates(&vec![0.0; dimension]);
        for column in 0..dimension {
            let mut axis = vec![0.0; dimension];
            axis[column] = 1.0;
            for (row, rate) in rates(&axis).iter().enumerate() {
                generator[(row, column)] = rate - offset[row];
            }
        }
        for (row, rate) in offset.iter().enumerate() {
            generator[(row, dimension)] = *rate;
        }
        Affine { generator }
    }

    /// The state after `duration` seconds.
    pub fn after(&self, state: &[f64], duration: f64) -> Vec<f64> {
        let padded = DVector::from_iterator(
            state.len() + 1,
            state.iter().copied().chain(std::iter::once(1.0)),
        );
        let flown = exponential(&self.generator * duration) * padded;
        flown.iter().take(state.len()).copied().collect()
    }

    /// After how many seconds `happens` holds first; `None` if not within `limit` seconds.
    pub fn time_until(
        &self,
        state: &[f64],
        limit: f64,
        happens: impl Fn(&[f64]) -> bool,
    ) -> Option<f64> {
        let happens_after = |duration: f64| happens(&self.after(state, duration));
        let mut looks = (1..).map(|look| f64::from(look) * LOOK).take_while(|&time| time <= limit);
        let time = looks.find(|&time| happens_after(time))?;
        Some(bisect(time - LOOK, time, |time| !happens_after(time)))
    }
}

/// The boundary between `lower`, where `is_before` holds, and `upper`, where it does not, as
/// exactly as numbers allow.
pub fn bisect(mut lower: f64, mut upper: f64, is_before: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = f64::midpoint(lower, upper);
        if middle <= lower || middle >= upper {
            return upper;
        }
        *if is_before(middle) { &mut lower } else { &mut upper } = middle;
    }
}

/// exp(M), from the series of M/2ᵏ squared k times.
fn exponential(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let halvings = (8.0 * matrix.norm()).max(1.0).log2().ceil();
    let small = &matrix / halvings.exp2();
    let identity = DMatrix::identity(matrix.nrows(), matrix.ncols());
    let series = (1..=TERMS)
        .rev()
        .fold(identity.clone(), |sum, term| &identity + &small * sum / f64::from(term));
    (0..halvings as u32).fold(series, |power, _| &power * &power)
}
