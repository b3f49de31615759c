//! Polynomials through the values of a function at Chebyshev's nodes.

use std::f64::consts::PI;

use super::Piece;

/// Nodes of the polynomial. Over two radians of an oscillation it is off by less than 10⁻¹⁸.
const NODES: usize = 17;

impl Piece {
    /// The polynomials of degree 16 through a function of time, which writes states of `dimension`
    /// components, from `start` for `length` seconds.
    ///
    /// They agree with it at Chebyshev's nodes, the cosines of equally spaced angles. Their errors
    /// are estimated by their last terms, which for a smooth function are larger than all that
    /// would follow (L. N. Trefethen 2013, *Approximation Theory and Approximation Practice*, chapters
    /// 7 and 8); of a function that is not, they say how far from a polynomial it is.
    pub fn through(
        start: f64,
        length: f64,
        dimension: usize,
        mut function: impl FnMut(f64, &mut [f64]),
    ) -> Piece {
        let radius = 0.5 * length;
        let origin = start + radius;
        let mut states = vec![0.0; NODES * dimension];
        for (node, state) in states.chunks_mut(dimension.max(1)).enumerate() {
            function(origin + radius * angle(node).cos(), state);
        }
        let mut piece = Piece::new(start, start + length, origin, radius);
        for component in 0..dimension {
            let values: Vec<f64> =
                (0..NODES).map(|node| states[node * dimension + component]).collect();
            let weights = weights(&values);
            let size: f64 = weights.iter().map(|weight| weight.abs()).sum();
            let last: f64 = weights[NODES - 2..].iter().map(|weight| weight.abs()).sum();
            let is_line = weights[2..].iter().all(|weight| weight.abs() <= LINE * size);
            if is_line {
                piece.push([weights[0], weights[1]], LINE * size);
            } else {
                piece.push(powers(&weights), 2.0 * last + ROUNDING * size);
            }
        }
        piece
    }
}

/// Weights of this part of all of them are rounding errors, and what has no others is a line.
const LINE: f64 = 8.0 * f64::EPSILON;
/// The rounding error of the weights and of their powers, relative to their sum.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

fn angle(node: usize) -> f64 {
    PI * (node as f64 + 0.5) / NODES as f64
}

/// The weights of the Chebyshev polynomials whose sum has these values at the nodes.
fn weights(values: &[f64]) -> Vec<f64> {
    let weight = |degree: usize| {
        let wave = |node: usize| (degree as f64 * angle(node)).cos();
        let sum: f64 = values.iter().enumerate().map(|(node, value)| value * wave(node)).sum();
        if degree == 0 { sum / NODES as f64 } else { 2.0 * sum / NODES as f64 }
    };
    (0..NODES).map(weight).collect()
}

/// A sum of Chebyshev polynomials by its powers.
fn powers(weights: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; weights.len()];
    // Tₙ₊₁ = 2 s Tₙ − Tₙ₋₁, beginning with T₀ = 1 and T₁ = s.
    let mut before = vec![0.0; weights.len()];
    let mut now = before.clone();
    now[0] = 1.0;
    for (degree, weight) in weights.iter().enumerate() {
        for (total, power) in sum.iter_mut().zip(&now) {
            *total += weight * power;
        }
        let factor = if degree == 0 { 1.0 } else { 2.0 };
        let shifted = |power: usize| if power == 0 { 0.0 } else { factor * now[power - 1] };
        let next = (0..now.len()).map(|power| shifted(power) - before[power]).collect();
        before = std::mem::replace(&mut now, next);
    }
    sum
}
