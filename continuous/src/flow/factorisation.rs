//! Systems of linear equations, solved by factorising their matrix once.

/// A matrix P A = L U by Gaussian elimination with partial pivoting, in place and without taking
/// memory.
#[derive(Debug)]
pub(super) struct Factorisation {
    dimension: usize,
    /// Row by row; L below the diagonal, U on and above it.
    entries: Vec<f64>,
    /// By column: the row that was exchanged for the pivot's.
    pivots: Vec<usize>,
}

impl Factorisation {
    pub(super) fn new(dimension: usize) -> Self {
        let entries = vec![0.0; dimension * dimension];
        Factorisation { dimension, entries, pivots: vec![0; dimension] }
    }

    /// Factorises the matrix whose entry in `row` and `column` is `entry(row, column)`; says
    /// whether it is regular and finite.
    pub(super) fn factorise(&mut self, entry: impl Fn(usize, usize) -> f64) -> bool {
        let n = self.dimension;
        for row in 0..n {
            for column in 0..n {
                self.entries[row * n + column] = entry(row, column);
            }
        }
        (0..n).all(|column| self.eliminate(column))
    }

    fn eliminate(&mut self, column: usize) -> bool {
        let n = self.dimension;
        let mut pivot = column;
        for row in column + 1..n {
            if self.entries[row * n + column].abs() > self.entries[pivot * n + column].abs() {
                pivot = row;
            }
        }
        self.pivots[column] = pivot;
        if pivot != column {
            for place in 0..n {
                self.entries.swap(pivot * n + place, column * n + place);
            }
        }
        let (above, below) = self.entries.split_at_mut((column + 1) * n);
        let pivot_row = &above[column * n..];
        let diagonal = pivot_row[column];
        if diagonal == 0.0 || !diagonal.is_finite() {
            return false;
        }
        for row in below.chunks_exact_mut(n) {
            let factor = row[column] / diagonal;
            row[column] = factor;
            if factor != 0.0 {
                for place in column + 1..n {
                    row[place] -= factor * pivot_row[place];
                }
            }
        }
        true
    }

    /// Replaces the right-hand side by the solution.
    pub(super) fn solve(&self, right: &mut [f64]) {
        let n = self.dimension;
        for row in 0..n {
            right.swap(row, self.pivots[row]);
        }
        for row in 0..n {
            let known: f64 =
                (0..row).map(|place| self.entries[row * n + place] * right[place]).sum();
            right[row] -= known;
        }
        for row in (0..n).rev() {
            let entries = &self.entries[row * n..(row + 1) * n];
            let known: f64 = (row + 1..n).map(|place| entries[place] * right[place]).sum();
            right[row] = (right[row] - known) / entries[row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_satisfy_their_equations() {
        // The first pivot is 0, and the last row the largest.
        let matrix = [[0.0, 2.0, 1.0], [1.0, -1.0, 3.0], [4.0, 1.0, -2.0]];
        let mut factorisation = Factorisation::new(3);
        assert!(factorisation.factorise(|row, column| matrix[row][column]));
        let mut solution = [7.0, 8.0, 0.0];
        factorisation.solve(&mut solution);
        for ((found, expected), _) in solution.iter().zip([1.0, 2.0, 3.0]).zip(matrix) {
            assert!((found - expected).abs() < 1e-14, "{solution:?}");
        }
        assert!(!factorisation.factorise(|row, _| row as f64));
        assert!(!factorisation.factorise(|_, _| f64::NAN));
    }
}
