//! Solutions of linear flows by exponentials of their matrix.

use std::sync::OnceLock;

use nalgebra::linalg::Schur;
use nalgebra::{DMatrix, DVector};

use super::Entries;

/// exp(M t) for any t, where M is the matrix with the offset as one more column.
#[derive(Debug)]
pub(super) struct Exponential {
    /// M, its last column scaled.
    pub(super) generator: Entries,
    /// What stands for the 1 in (x, 1): the last column is scaled the other way.
    pub(super) constant: f64,
    /// τ in seconds, a power of two, such that ‖M τ‖ ≤ 1/2.
    span: f64,
    /// exp(M τ), and what follows it.
    power: Power,
    modes: Vec<Mode>,
}

/// exp(M d) for a duration d; exp(2 M d), exp(4 M d), … are computed when they are first needed.
#[derive(Debug)]
struct Power {
    matrix: DMatrix<f64>,
    /// What the entries of the diagonal differ from 1 by. Where a slow variable is beside a fast one, that is
    /// far below 1, and of a rounded entry most of its digits would be missing.
    change: DVector<f64>,
    square: OnceLock<Box<Power>>,
}

/// How one eigenvalue λ of A moves the state.
#[derive(Clone, Copy, Debug)]
struct Mode {
    /// |λ|, per second.
    speed: f64,
    /// When it has faded, in seconds; never if it does not decay.
    faded: f64,
}

/// ‖M τ‖ at most: small enough for a short series, large enough for few powers.
const LARGEST_NORM: f64 = 0.5;
/// Terms of the Taylor series: the next one, (1/2)¹⁵/15! ≈ 2·10⁻¹⁷, is below rounding.
const TERMS: usize = 15;
/// A mode has faded when it has shrunk by e⁻⁴⁰ ≈ 4·10⁻¹⁸, which is below rounding.
const FADED: f64 = 40.0;
/// More iterations than the eigenvalues of any ordinary matrix take; where it takes more, the norm
/// of A stands in for them.
const EIGENVALUE_ITERATIONS: usize = 10_000;

impl Exponential {
    pub(super) fn new(matrix: &DMatrix<f64>, offset: &DVector<f64>) -> Self {
        let dimension = offset.len();
        // The offset counts as the constant β times b/β, with β such that it does not dominate the
        // norm; a power of two scales without rounding.
        let matrix_norm = one_norm(matrix);
        let constant = power_of_two_above((offset.lp_norm(1) / matrix_norm).max(1.0));
        let mut generator = DMatrix::zeros(dimension + 1, dimension + 1);
        generator.view_mut((0, 0), (dimension, dimension)).copy_from(matrix);
        generator.view_mut((0, dimension), (dimension, 1)).copy_from(&(offset / constant));
        let span = 0.5 * power_of_two_above(LARGEST_NORM / one_norm(&generator));
        let power = Power::of(&(&generator * span));
        Exponential {
            generator: super::entries(&generator),
            constant,
            span,
            power,
            modes: modes(matrix),
        }
    }

    /// Moves a state by `time` seconds.
    pub(super) fn advance(&self, time: f64, state: &mut [f64]) {
        let mut sum = DVector::from_column_slice(state).push(self.constant);
        let mut term = sum.clone();
        let rest = self.power.advance(self.span, time, &mut sum, &mut term);
        term.copy_from(&sum);
        let mut next = term.clone();
        for degree in 1..TERMS {
            let step = rest / degree as f64;
            for (next, row) in next.iter_mut().zip(&self.generator) {
                *next = step * row.iter().map(|&(column, entry)| entry * term[column]).sum::<f64>();
            }
            sum += &next;
            std::mem::swap(&mut term, &mut next);
        }
        state.copy_from_slice(&sum.as_slice()[..state.len()]);
    }

    /// Half a turn of the fastest mode that has not faded `time` seconds after the start.
    pub(super) fn time_scale(&self, time: f64) -> f64 {
        let lasting = self.modes.iter().filter(|mode| time < mode.faded);
        std::f64::consts::PI / lasting.map(|mode| mode.speed).fold(0.0, f64::max)
    }
}

impl Power {
    /// The exponential of a matrix whose norm is at most [`LARGEST_NORM`], by its series.
    fn of(generator: &DMatrix<f64>) -> Self {
        let mut term = generator.clone();
        let mut matrix = term.clone();
        for degree in 2..=TERMS {
            term = &term * generator / degree as f64;
            matrix += &term;
        }
        let change = matrix.diagonal();
        matrix.set_diagonal(&change.add_scalar(1.0));
        Power { matrix, change, square: OnceLock::new() }
    }

    fn square(&self) -> &Power {
        self.square.get_or_init(|| {
            let mut matrix = &self.matrix * &self.matrix;
            let mut change = self.change.clone();
            for (place, change) in change.iter_mut().enumerate() {
                let around = (0..matrix.nrows()).filter(|other| *other != place);
                let around: f64 = around
                    .map(|other| self.matrix[(place, other)] * self.matrix[(other, place)])
                    .sum();
                *change = *change * (2.0 + *change) + around;
                // Of a mode that has faded the entry itself has more digits.
                if change.abs() < 0.5 {
                    matrix[(place, place)] = 1.0 + *change;
                }
            }
            Box::new(Power { matrix, change, square: OnceLock::new() })
        })
    }

    /// Moves a state by the largest multiple of `duration` in `time`; what is left of the time. This
    /// is the power for that duration, and `room` for a state of the same length.
    fn advance(
        &self,
        duration: f64,
        time: f64,
        state: &mut DVector<f64>,
        room: &mut DVector<f64>,
    ) -> f64 {
        let twice = 2.0 * duration;
        let mut left = time;
        if time >= twice {
            left = self.square().advance(twice, time, state, room);
        }
        if left >= duration {
            left -= duration;
            room.gemv(1.0, &self.matrix, state, 0.0);
            std::mem::swap(state, room);
        }
        left
    }
}

fn modes(matrix: &DMatrix<f64>) -> Vec<Mode> {
    match Schur::try_new(matrix.clone(), f64::EPSILON, EIGENVALUE_ITERATIONS) {
        Some(schur) => {
            let eigenvalues = schur.complex_eigenvalues();
            let mode = |re: f64, speed: f64| Mode {
                speed,
                faded: if re < 0.0 { FADED / -re } else { f64::INFINITY },
            };
            eigenvalues.iter().map(|value| mode(value.re, value.norm())).collect()
        }
        None => vec![Mode { speed: one_norm(matrix), faded: f64::INFINITY }],
    }
}

/// The operator norm that goes with the sum of absolute values.
fn one_norm(matrix: &DMatrix<f64>) -> f64 {
    matrix.column_iter().map(|column| column.lp_norm(1)).fold(0.0, f64::max)
}

fn power_of_two_above(value: f64) -> f64 {
    value.log2().ceil().exp2()
}
