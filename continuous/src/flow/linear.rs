//! The flow ẋ = A x + b.

use std::sync::{Arc, OnceLock};

use nalgebra::{DMatrix, DVector};

use super::{Curve, InvalidFlow, Piece};

mod exponential;
mod pieces;
mod polynomial;

use exponential::Exponential;

/// The vector field ẋ = A x + b, with what all its solutions share.
///
/// ```
/// use std::sync::Arc;
///
/// use nalgebra::dmatrix;
/// use pleach_continuous::flow::{Curve, LinearField, LinearFlow};
///
/// let oscillator = Arc::new(LinearField::new(&dmatrix![0.0, 1.0; -1.0, 0.0], &[0.0, 0.0])?);
/// let mut state = [0.0; 2];
/// for amplitude in [1.0, 2.0, 3.0] {
///     LinearFlow::of(&oscillator, &[amplitude, 0.0], 10.0)?.state_at(5.0, &mut state);
///     assert!((state[0] - amplitude * 5f64.cos()).abs() < 1e-14);
/// }
/// # Ok::<(), pleach_continuous::flow::InvalidFlow>(())
/// ```
#[derive(Debug)]
pub struct LinearField {
    matrix: DMatrix<f64>,
    offset: DVector<f64>,
    /// Those of the matrix.
    rows: Entries,
    /// Known from the first solution on that is no polynomial.
    exponential: OnceLock<Exponential>,
}

/// By row of a matrix: the column and the value of each entry that is not 0.
type Entries = Vec<Vec<(usize, f64)>>;

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
/// polynomial in time and is evaluated as one. Otherwise a state is reached by those of the
/// exponentials of M τ, 2 M τ, 4 M τ, … that make up its time and a short Taylor series for the
/// rest: the action of the exponential on a vector, after A. H. Al-Mohy and N. J. Higham (2011),
/// doi:10.1137/100788860. Each exponential costs O(n³) for dimension n and is computed once for all
/// solutions of a [`LinearField`]; an evaluation costs O(n²) times the logarithm of ‖A‖ times the
/// duration.
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
    field: Arc<LinearField>,
    start: Vec<f64>,
    duration: f64,
    /// The coefficients of t⁰, t¹, … if x(t) is their polynomial.
    polynomial: Option<Vec<DVector<f64>>>,
}

impl LinearField {
    /// The field `matrix` · x + `offset`, per second.
    ///
    /// # Errors
    ///
    /// [`InvalidFlow`] unless the matrix is square and of the dimension of the offset, and all numbers
    /// are finite.
    pub fn new(matrix: &DMatrix<f64>, offset: &[f64]) -> Result<Self, InvalidFlow> {
        let dimension = offset.len();
        InvalidFlow::check_length("rows of the matrix", matrix.nrows(), dimension)?;
        InvalidFlow::check_length("columns of the matrix", matrix.ncols(), dimension)?;
        InvalidFlow::check_finite("matrix", matrix.as_slice())?;
        InvalidFlow::check_finite("offset", offset)?;
        Ok(LinearField {
            matrix: matrix.clone(),
            offset: DVector::from_column_slice(offset),
            rows: entries(matrix),
            exponential: OnceLock::new(),
        })
    }

    /// The number of components of the state.
    pub fn dimension(&self) -> usize {
        self.offset.len()
    }

    fn exponential(&self) -> &Exponential {
        self.exponential.get_or_init(|| Exponential::new(&self.matrix, &self.offset))
    }
}

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
        InvalidFlow::check_length("offset", offset.len(), state.len())?;
        LinearFlow::of(&Arc::new(LinearField::new(matrix, offset)?), state, duration)
    }

    /// The flow along a field that is in `state` at time 0, for `duration` seconds.
    ///
    /// # Errors
    ///
    /// [`InvalidFlow`] unless `state` has the dimension of the field, its numbers are finite, and the
    /// duration is finite and not negative.
    pub fn of(field: &Arc<LinearField>, state: &[f64], duration: f64) -> Result<Self, InvalidFlow> {
        InvalidFlow::check_length("state at the start", state.len(), field.dimension())?;
        InvalidFlow::check_finite("state", state)?;
        if !(duration >= 0.0 && duration.is_finite()) {
            return Err(InvalidFlow::Duration { duration });
        }
        let polynomial = field.polynomial(&DVector::from_column_slice(state));
        Ok(LinearFlow { field: Arc::clone(field), start: state.to_vec(), duration, polynomial })
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
        self.start.len()
    }

    fn state_at(&self, time: f64, state: &mut [f64]) {
        let time = time.clamp(0.0, self.duration);
        if let Some(coefficients) = &self.polynomial {
            for (i, x) in state.iter_mut().enumerate() {
                let horner = |sum, term: &DVector<f64>| sum * time + term[i];
                *x = coefficients.iter().rev().fold(0.0, horner);
            }
        } else {
            state.copy_from_slice(&self.start);
            self.field.exponential().advance(time, state);
        }
    }

    fn time_scale(&self, time: f64) -> f64 {
        match &self.polynomial {
            Some(_) => f64::INFINITY,
            None => self.field.exponential().time_scale(time),
        }
    }

    fn piece(&self, time: f64) -> Option<Piece> {
        Some(self.piece_up_to(time, self.duration))
    }
}

fn entries(matrix: &DMatrix<f64>) -> Entries {
    let row = |row: usize| {
        let entries = (0..matrix.ncols()).map(|column| (column, matrix[(row, column)]));
        entries.filter(|(_, entry)| *entry != 0.0).collect()
    };
    (0..matrix.nrows()).map(row).collect()
}
