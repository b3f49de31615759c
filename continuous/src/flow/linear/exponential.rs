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
    /// By variable: the others that move it, also by way of others.
    pub(super) movers: Vec<Vec<usize>>,
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
    /// When it has faded, in seconds, beside what else moves the same variables; never where nothing
    /// lasts longer.
    faded: f64,
    /// When nothing can be left of it.
    gone: f64,
}

/// ‖M τ‖ at most: small enough for a short series, large enough for few powers.
const LARGEST_NORM: f64 = 0.5;
/// β at most.
const LARGEST_SCALE: f64 = 1e270;
/// Terms of the Taylor series: the next one, (1/2)¹⁵/15! ≈ 2·10⁻¹⁷, is below rounding.
const TERMS: usize = 15;
/// A mode has faded beside another when it has shrunk by e⁻⁴⁰ ≈ 4·10⁻¹⁸ more, which is below rounding.
const FADED: f64 = 40.0;
/// A mode has faded altogether when even the largest number has shrunk by it to less than the smallest.
const NOTHING: f64 = 1500.0;
/// More iterations than the eigenvalues of any ordinary matrix take; where it takes more, the norm
/// of A stands in for them.
const EIGENVALUE_ITERATIONS: usize = 10_000;

impl Exponential {
    pub(super) fn new(matrix: &DMatrix<f64>, offset: &DVector<f64>) -> Self {
        let dimension = offset.len();
        // The offset counts as the constant β times b/β, with β such that it does not dominate the
        // norm; a power of two scales without rounding. Beside a larger one an offset would be lost.
        let matrix_norm = one_norm(matrix);
        let scale = (offset.lp_norm(1) / matrix_norm).max(1.0);
        let constant = power_of_two_above(scale.min(LARGEST_SCALE));
        let mut generator = DMatrix::zeros(dimension + 1, dimension + 1);
        generator.view_mut((0, 0), (dimension, dimension)).copy_from(matrix);
        generator.view_mut((0, dimension), (dimension, 1)).copy_from(&(offset / constant));
        let span = 0.5 * power_of_two_above(LARGEST_NORM / one_norm(&generator));
        let power = Power::of(&(&generator * span));
        let reached = reached(matrix);
        let movers = (0..dimension).map(|row| {
            (0..dimension).filter(|&column| column != row && reached[(row, column)]).collect()
        });
        Exponential {
            movers: movers.collect(),
            generator: super::entries(&generator),
            constant,
            span,
            power,
            modes: modes(matrix, offset, &reached),
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
        half_a_turn(lasting)
    }

    /// The same of those of which something may be left.
    pub(super) fn least_time_scale(&self, time: f64) -> f64 {
        half_a_turn(self.modes.iter().filter(|mode| time < mode.gone))
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

/// Half a turn of the fastest.
fn half_a_turn<'a>(modes: impl Iterator<Item = &'a Mode>) -> f64 {
    std::f64::consts::PI / modes.map(|mode| mode.speed).fold(0.0, f64::max)
}

/// The modes of ẋ = A x + b.
///
/// Variables that move each other have their modes in common. A mode fades beside the slowest of those
/// that move the same variables, and of the offset, which does not fade: what decays alone is followed
/// however small it becomes.
fn modes(matrix: &DMatrix<f64>, offset: &DVector<f64>, reached: &DMatrix<bool>) -> Vec<Mode> {
    let blocks = blocks(reached);
    let eigenvalues: Vec<Vec<(f64, f64)>> = blocks
        .iter()
        .map(|block| {
            eigenvalues(&DMatrix::from_fn(block.len(), block.len(), |row, column| {
                matrix[(block[row], block[column])]
            }))
        })
        .collect();
    let mut modes = Vec::new();
    for (block, own) in blocks.iter().zip(&eigenvalues) {
        let movers =
            blocks.iter().zip(&eigenvalues).filter(|(other, _)| reached[(block[0], other[0])]);
        let mut slowest = f64::NEG_INFINITY;
        for (other, values) in movers {
            let is_pushed = other.iter().any(|&row| offset[row] != 0.0);
            let lasting = if is_pushed { 0.0 } else { f64::NEG_INFINITY };
            slowest = values.iter().map(|(re, _)| *re).fold(slowest.max(lasting), f64::max);
        }
        modes.extend(own.iter().map(|&(re, speed)| {
            let gone = if re < 0.0 { NOTHING / -re } else { f64::INFINITY };
            let beside = if re < slowest { FADED / (slowest - re) } else { f64::INFINITY };
            Mode { speed, faded: gone.min(beside), gone }
        }));
    }
    modes
}

/// Whether the variable of a row is moved by that of a column, also by way of others.
fn reached(matrix: &DMatrix<f64>) -> DMatrix<bool> {
    let count = matrix.nrows();
    let mut reached =
        DMatrix::from_fn(count, count, |row, column| row == column || matrix[(row, column)] != 0.0);
    for by in 0..count {
        for row in 0..count {
            if reached[(row, by)] {
                (0..count).for_each(|column| reached[(row, column)] |= reached[(by, column)]);
            }
        }
    }
    reached
}

/// The variables, those together that move each other.
fn blocks(reached: &DMatrix<bool>) -> Vec<Vec<usize>> {
    let together = |one: usize, other: usize| reached[(one, other)] && reached[(other, one)];
    let count = reached.nrows();
    let firsts = (0..count).filter(|&one| !(0..one).any(|other| together(one, other)));
    firsts.map(|first| (first..count).filter(|&other| together(first, other)).collect()).collect()
}

/// The real parts and the magnitudes of the eigenvalues.
fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<(f64, f64)> {
    match Schur::try_new(matrix.clone(), f64::EPSILON, EIGENVALUE_ITERATIONS) {
        Some(schur) => {
            schur.complex_eigenvalues().iter().map(|value| (value.re, value.norm())).collect()
        }
        None => vec![(f64::INFINITY, one_norm(matrix))],
    }
}

/// The operator norm that goes with the sum of absolute values.
fn one_norm(matrix: &DMatrix<f64>) -> f64 {
    matrix.column_iter().map(|column| column.lp_norm(1)).fold(0.0, f64::max)
}

fn power_of_two_above(value: f64) -> f64 {
    value.log2().ceil().exp2()
}
