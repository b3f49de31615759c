//! Multipliers for a bound on a linear function over a polytope.

use super::Polytope;

/// The simplex method on the dual: minimise Σ yᵢ bᵢ over y ≥ 0 with Σ yᵢ dᵢ = ℓ, from the basis of
/// the box. Nothing depends on its being right.
pub(super) struct Simplex<'a> {
    polytope: &'a Polytope,
    /// The places of the directions in the basis.
    basis: Vec<usize>,
    /// Row i: what yᵢ of the basis is per unit of each coordinate of ℓ.
    inverse: Vec<Vec<f64>>,
    /// The multipliers of the basis.
    values: Vec<f64>,
    /// Where the program is unbounded: multipliers that combine the directions to nothing.
    pub ray: Vec<(usize, f64)>,
}

impl<'a> Simplex<'a> {
    /// How often the basis changes, at most, for each coordinate.
    const PIVOTS: usize = 8;

    pub(super) fn new(polytope: &'a Polytope, direction: &[f64]) -> Self {
        let dimension = direction.len();
        let positive = |axis: usize| direction[axis] >= 0.0;
        let basis = (0..dimension).map(|axis| 2 * axis + usize::from(!positive(axis))).collect();
        let mut inverse = vec![vec![0.0; dimension]; dimension];
        for (axis, row) in inverse.iter_mut().enumerate() {
            row[axis] = if positive(axis) { 1.0 } else { -1.0 };
        }
        let values = direction.iter().map(|entry| entry.abs()).collect();
        Simplex { polytope, basis, inverse, values, ray: Vec::new() }
    }

    /// Improves the basis; `false` where the dual is unbounded, so that the polytope is empty.
    pub(super) fn run(&mut self) -> bool {
        for _ in 0..Self::PIVOTS * self.basis.len() {
            let Some(entering) = self.entering() else { return true };
            let direction = &self.polytope.template.directions[entering];
            let column: Vec<f64> = self
                .inverse
                .iter()
                .map(|row| row.iter().zip(direction).map(|(a, b)| a * b).sum())
                .collect();
            let Some(leaving) = self.leaving(&column) else {
                self.ray =
                    self.basis.iter().zip(&column).map(|(place, entry)| (*place, -entry)).collect();
                self.ray.push((entering, 1.0));
                return false;
            };
            self.pivot(entering, leaving, &column);
        }
        true
    }

    /// The direction whose bound the vertex of the basis exceeds most.
    fn entering(&self) -> Option<usize> {
        const NEARLY: f64 = 1e-12;
        let dimension = self.basis.len();
        let bounds = &self.polytope.bounds;
        let mut vertex = vec![0.0; dimension];
        for (row, place) in self.inverse.iter().zip(&self.basis) {
            for (coordinate, entry) in vertex.iter_mut().zip(row) {
                *coordinate += entry * bounds[*place];
            }
        }
        let excess = |(place, direction): (usize, &Vec<f64>)| {
            let (mut reached, mut size) = (0.0, 0.0);
            for (entry, coordinate) in direction.iter().zip(&vertex) {
                reached += entry * coordinate;
                size += (entry * coordinate).abs();
            }
            let excess = reached - bounds[place];
            (excess > NEARLY * (size + bounds[place].abs())).then_some((place, excess))
        };
        let exceeded = self.polytope.template.directions.iter().enumerate().filter_map(excess);
        exceeded.max_by(|(_, one), (_, other)| one.total_cmp(other)).map(|(place, _)| place)
    }

    /// The row that becomes zero first.
    fn leaving(&self, column: &[f64]) -> Option<usize> {
        const PIVOT: f64 = 1e-9;
        let ratios = column.iter().zip(&self.values).enumerate();
        let ratios = ratios.filter(|(_, (entry, _))| **entry > PIVOT);
        let ratios = ratios.map(|(row, (entry, value))| (row, value / entry));
        ratios.min_by(|(_, one), (_, other)| one.total_cmp(other)).map(|(row, _)| row)
    }

    fn pivot(&mut self, entering: usize, leaving: usize, column: &[f64]) {
        let step = self.values[leaving] / column[leaving];
        let pivot_row: Vec<f64> =
            self.inverse[leaving].iter().map(|entry| entry / column[leaving]).collect();
        for (row, factor) in column.iter().enumerate().filter(|(row, _)| *row != leaving) {
            self.values[row] = (self.values[row] - factor * step).max(0.0);
            for (entry, pivot) in self.inverse[row].iter_mut().zip(&pivot_row) {
                *entry -= factor * pivot;
            }
        }
        self.values[leaving] = step;
        self.inverse[leaving] = pivot_row;
        self.basis[leaving] = entering;
    }

    pub(super) fn multipliers(&self) -> Vec<(usize, f64)> {
        self.basis.iter().copied().zip(self.values.iter().copied()).collect()
    }
}
