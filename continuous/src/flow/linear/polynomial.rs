//! Linear flows whose series end.

use nalgebra::DVector;

use super::LinearField;

impl LinearField {
    /// The coefficients of the solution from `state` on if it is a polynomial.
    ///
    /// The k-th derivative at time 0 is Aᵏ⁻¹ (A x₀ + b). Whether a derivative vanishes is decided by
    /// where the matrix and the derivative before have entries at all, not by the numbers: products of
    /// small ones may vanish in rounding.
    pub(super) fn polynomial(&self, state: &DVector<f64>) -> Option<Vec<DVector<f64>>> {
        let degree = self.degree(state)?;
        let mut coefficients = vec![state.clone()];
        let mut coefficient = &self.matrix * state + &self.offset;
        for power in 1..=degree {
            let next = &self.matrix * &coefficient / (power + 1) as f64;
            coefficients.push(std::mem::replace(&mut coefficient, next));
        }
        Some(coefficients)
    }

    /// How many derivatives at time 0 there are before all vanish.
    ///
    /// If one of the first n + 1 vanishes so do all that follow; otherwise there is a cycle among the
    /// entries, and none need vanish.
    fn degree(&self, state: &DVector<f64>) -> Option<usize> {
        let dimension = state.len();
        let mut present: Vec<bool> = (0..dimension)
            .map(|row| self.offset[row] != 0.0 || self.meets(row, |column| state[column] != 0.0))
            .collect();
        for degree in 0..=dimension {
            if !present.contains(&true) {
                return Some(degree);
            }
            let next: Vec<bool> =
                (0..dimension).map(|row| self.meets(row, |column| present[column])).collect();
            if next == present {
                return None;
            }
            present = next;
        }
        None
    }

    /// Whether the row has an entry in one of these columns.
    fn meets(&self, row: usize, column: impl Fn(usize) -> bool) -> bool {
        self.rows[row].iter().any(|&(index, _)| column(index))
    }
}
