//! The flow ẋ = A x + b.

use nalgebra::linalg::Schur;
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use super::{Curve, Piece};

mod pieces;

/// A solution of ẋ = A x + b, by the exponential of the matrix and not by steps.
///
/// With the constant 1 as one more component the flow is homogeneous,
///
/// ```text
/// d/dt (x, 1) = M (x, 1),   M = ( A b )   and so   (x(t), 1) = exp(M t) (x₀, 1).
///                               ( 0 0 )
/// ```
///
/// Where the series of the exponential ends, as for a body in free flight, the solution is a
/// polynomial in time and is evaluated as one. Otherwise the exponentials of M τ, 2 M τ, 4 M τ, …
/// are computed once, and a state is reached by those that make up its time and a short Taylor
/// series for the rest: the action of the exponential on a vector, after A. H. Al-Mohy and
/// N. J. Higham (2011), doi:10.1137/100788860. Construction costs O(n³) for dimension n, an
/// evaluation O(n²), each times the logarithm of ‖A‖ times the duration.
///
/// The relative error is about that of rounding A: some 10⁻¹⁶ (1 + ‖A‖ t).
///
/// ```
/// use nalgebra::dmatrix;
/// use pleach_continuous::flow::{Curve, LinearFlow};
///
/// // An undamped oscillator: position and velocity.
/// let matrix = dmatrix![0.0, 1.0; -1.0, 0.0];
/// let oscillator = LinearFlow::new(&matrix, &[0.0, 0.0], &[0.0, 1.0], 100.0)?;
/// let mut state = [0.0; 2];
/// oscillator.state_at(99.0, &mut state);
/// assert!((state[0] - 99f64.sin()).abs() < 1e-13);
/// assert!((state[1] - 99f64.cos()).abs() < 1e-13);
/// # Ok::<(), pleach_continuous::flow::InvalidFlow>(())
/// ```
#[derive(Clone, Debug)]
pub struct LinearFlow {
    dimension: usize,
    duration: f64,
    solution: Solution,
}

#[derive(Clone, Debug)]
enum Solution {
    /// The coefficients of t⁰, t¹, …: x(t) is their polynomial.
    Polynomial(Vec<DVector<f64>>),
    Exponential(Exponential),
}

/// The solution by powers of exp(M τ).
#[derive(Clone, Debug)]
struct Exponential {
    /// M, its last column scaled.
    generator: DMatrix<f64>,
    /// (x₀, 1), its last component scaled the other way.
    initial: DVector<f64>,
    /// τ in seconds, a power of two, such that ‖M τ‖ ≤ 1/2.
    span: f64,
    /// exp(M τ), exp(2 M τ), exp(4 M τ), … as far as the duration needs them.
    powers: Vec<DMatrix<f64>>,
    modes: Vec<Mode>,
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

impl LinearFlow {
    /// The flow that is in `state` at time 0 and moves by `matrix` · x + `offset` per second, for
    /// `duration` seconds.
    ///
    /// # Errors
    ///
    /// [`InvalidFlow`] unless the matrix is square, `offset` and `state` have its dimension, all
    /// numbers are finite, and the duration is not negative.
    pub fn new(
        matrix: &DMatrix<f64>,
        offset: &[f64],
        state: &[f64],
        duration: f64,
    ) -> Result<Self, InvalidFlow> {
        let dimension = state.len();
        InvalidFlow::check_length("rows of the matrix", matrix.nrows(), dimension)?;
        InvalidFlow::check_length("columns of the matrix", matrix.ncols(), dimension)?;
        InvalidFlow::check_length("offset", offset.len(), dimension)?;
        InvalidFlow::check_finite("matrix", matrix.as_slice())?;
        InvalidFlow::check_finite("offset", offset)?;
        InvalidFlow::check_finite("state", state)?;
        if !(duration >= 0.0 && duration.is_finite()) {
            return Err(InvalidFlow::Duration { duration });
        }
        let (offset, state) = (DVector::from_column_slice(offset), DVector::from_row_slice(state));
        let solution = match polynomial(matrix, &offset, &state) {
            Some(coefficients) => Solution::Polynomial(coefficients),
            None => Solution::Exponential(Exponential::new(matrix, &offset, &state, duration)),
        };
        Ok(LinearFlow { dimension, duration, solution })
    }
}

impl Curve for LinearFlow {
    fn start(&self) -> f64 {
        0.0
    }

    fn end(&self) -> f64 {
        self.duration
    }

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn state_at(&self, time: f64, state: &mut [f64]) {
        let time = time.clamp(0.0, self.duration);
        match &self.solution {
            Solution::Polynomial(coefficients) => {
                for (i, x) in state.iter_mut().enumerate() {
                    let horner = |sum, term: &DVector<f64>| sum * time + term[i];
                    *x = coefficients.iter().rev().fold(0.0, horner);
                }
            }
            Solution::Exponential(exponential) => exponential.state_at(time, state),
        }
    }

    fn time_scale(&self, time: f64) -> f64 {
        match &self.solution {
            Solution::Polynomial(_) => f64::INFINITY,
            Solution::Exponential(exponential) => exponential.time_scale(time),
        }
    }

    fn piece(&self, time: f64) -> Option<Piece> {
        Some(self.piece_from(time))
    }
}

/// The coefficients of the solution if it is a polynomial.
///
/// The k-th derivative at time 0 is Aᵏ⁻¹ (A x₀ + b). Whether a derivative vanishes is decided by
/// where the matrix and the derivative before have entries at all, not by the numbers: products of
/// small ones may vanish in rounding. If one of the first n + 1 vanishes so do all that follow;
/// otherwise there is a cycle among the entries, and none need vanish.
fn polynomial(
    matrix: &DMatrix<f64>,
    offset: &DVector<f64>,
    state: &DVector<f64>,
) -> Option<Vec<DVector<f64>>> {
    let dimension = state.len();
    let mut coefficients = vec![state.clone()];
    let mut coefficient = matrix * state + offset;
    let mut present: Vec<bool> = (0..dimension)
        .map(|row| offset[row] != 0.0 || meets(matrix, row, |column| state[column] != 0.0))
        .collect();
    for degree in 1..=dimension + 1 {
        if !present.contains(&true) {
            return Some(coefficients);
        }
        let next = matrix * &coefficient / (degree + 1) as f64;
        coefficients.push(std::mem::replace(&mut coefficient, next));
        present = (0..dimension).map(|row| meets(matrix, row, |column| present[column])).collect();
    }
    None
}

/// Whether the row has an entry in one of these columns.
fn meets(matrix: &DMatrix<f64>, row: usize, column: impl Fn(usize) -> bool) -> bool {
    (0..matrix.ncols()).any(|index| matrix[(row, index)] != 0.0 && column(index))
}

impl Exponential {
    fn new(
        matrix: &DMatrix<f64>,
        offset: &DVector<f64>,
        state: &DVector<f64>,
        duration: f64,
    ) -> Self {
        let dimension = state.len();
        // The offset counts as the constant β times b/β, with β such that it does not dominate the
        // norm; a power of two scales without rounding.
        let matrix_norm = one_norm(matrix);
        let constant = power_of_two_above((offset.lp_norm(1) / matrix_norm).max(1.0));
        let mut generator = DMatrix::zeros(dimension + 1, dimension + 1);
        generator.view_mut((0, 0), (dimension, dimension)).copy_from(matrix);
        generator.view_mut((0, dimension), (dimension, 1)).copy_from(&(offset / constant));
        let initial = state.push(constant);

        let span = 0.5 * power_of_two_above(LARGEST_NORM / one_norm(&generator));
        let mut powers = Vec::new();
        let mut reached = span;
        let mut power = (&generator * span).exp();
        while reached <= duration {
            let square = &power * &power;
            powers.push(std::mem::replace(&mut power, square));
            reached *= 2.0;
        }
        Exponential { generator, initial, span, powers, modes: modes(matrix) }
    }

    fn state_at(&self, time: f64, state: &mut [f64]) {
        let mut sum = self.initial.clone();
        let mut term = sum.clone();
        let mut rest = time;
        for (exponent, power) in self.powers.iter().enumerate().rev() {
            let duration = self.span * (exponent as f64).exp2();
            if rest >= duration {
                rest -= duration;
                term.gemv(1.0, power, &sum, 0.0);
                std::mem::swap(&mut sum, &mut term);
            }
        }
        term.copy_from(&sum);
        let mut next = term.clone();
        for degree in 1..TERMS {
            next.gemv(rest / degree as f64, &self.generator, &term, 0.0);
            sum += &next;
            std::mem::swap(&mut term, &mut next);
        }
        state.copy_from_slice(&sum.as_slice()[..state.len()]);
    }

    /// Half a turn of the fastest mode that has not faded.
    fn time_scale(&self, time: f64) -> f64 {
        let lasting = self.modes.iter().filter(|mode| time < mode.faded);
        std::f64::consts::PI / lasting.map(|mode| mode.speed).fold(0.0, f64::max)
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

/// Why a constant or linear flow cannot be made.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InvalidFlow {
    /// Something has not the dimension of the state.
    #[error("{what}: length {found}, but the state has dimension {dimension}")]
    Length {
        /// What it is.
        what: &'static str,
        /// How long it is.
        found: usize,
        /// The dimension of the state.
        dimension: usize,
    },
    /// An entry is infinite or NaN.
    #[error("entry {index} of the {what} is {value}: it must be finite")]
    NotFinite {
        /// Where the entry is.
        what: &'static str,
        /// Its index, counted from 0; in a matrix column by column.
        index: usize,
        /// What was given.
        value: f64,
    },
    /// The duration is negative, NaN, or infinite where it must not be.
    #[error("a flow cannot last {duration} s")]
    Duration {
        /// What was given, in seconds.
        duration: f64,
    },
}

impl InvalidFlow {
    pub(super) fn check_length(
        what: &'static str,
        found: usize,
        dimension: usize,
    ) -> Result<(), InvalidFlow> {
        if found == dimension {
            Ok(())
        } else {
            Err(InvalidFlow::Length { what, found, dimension })
        }
    }

    pub(super) fn check_finite(what: &'static str, entries: &[f64]) -> Result<(), InvalidFlow> {
        match entries.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            Some((index, &value)) => Err(InvalidFlow::NotFinite { what, index, value }),
            None => Ok(()),
        }
    }
}
