//! Differential equations.

use std::f64::consts::TAU;

use pleach_automaton::{Coordinates, Vector};
use pleach_guards::{Expression, variable};

/// A problem with its answers.
pub struct Problem<const N: usize> {
    pub name: &'static str,
    pub field: fn(&[f64; N]) -> [f64; N],
    pub formulas: [Expression; N],
    pub start: [f64; N],
    pub end: f64,
    /// The states at some instants, as another library computes them with its smallest tolerance.
    pub answers: Vec<(f64, [f64; N])>,
}

fn variables<const N: usize>() -> [Expression; N] {
    std::array::from_fn(|index| variable(Vector::<N>::NAMES[index]))
}

/// Lorenz's equations at his parameters.
pub fn lorenz() -> Problem<3> {
    let field = |x: &[f64; 3]| {
        [10.0 * (x[1] - x[0]), x[0] * (28.0 - x[2]) - x[1], x[0] * x[1] - 8.0 / 3.0 * x[2]]
    };
    let [x, y, z] = &variables();
    let formulas = [10.0 * (y - x), x * (28.0 - z) - y, x * y - (8.0 / 3.0) * z];
    Problem::new("Lorenz", field, formulas, [1.0, 1.0, 1.0], 10.0)
}

/// Four of van der Pol's oscillators with μ = 2 in a ring of springs.
pub fn coupled_van_der_pol() -> Problem<8> {
    let field = |x: &[f64; 8]| {
        let mut rates = [0.0; 8];
        for i in 0..4 {
            let (left, right) = (x[(i + 3) % 4], x[(i + 1) % 4]);
            rates[i] = x[4 + i];
            rates[4 + i] =
                2.0 * (1.0 - x[i] * x[i]) * x[4 + i] - x[i] + 0.3 * (left + right - 2.0 * x[i]);
        }
        rates
    };
    let x = variables::<8>();
    let formulas = std::array::from_fn(|place| {
        let Some(i) = place.checked_sub(4) else { return x[place + 4].clone() };
        let (here, left, right) = (&x[i], &x[(i + 3) % 4], &x[(i + 1) % 4]);
        2.0 * (1.0 - here * here) * &x[place] - here + 0.3 * (left + right - 2.0 * here)
    });
    let start = [2.0, 1.0, -0.5, 0.3, 0.0, 0.4, -0.2, 0.0];
    Problem::new("coupled van der Pol", field, formulas, start, 20.0)
}

/// Twenty-five masses in a row, joined by springs.
pub fn chain() -> Problem<50> {
    let field = |x: &[f64; 50]| {
        let mut rates = [0.0; 50];
        for i in 0..25 {
            let left = if i == 0 { 0.0 } else { x[i - 1] };
            let right = if i == 24 { 0.0 } else { x[i + 1] };
            rates[i] = x[25 + i];
            rates[25 + i] = left - 2.0 * x[i] + right;
        }
        rates
    };
    let x = variables::<50>();
    let formulas = std::array::from_fn(|place| {
        let Some(i) = place.checked_sub(25) else { return x[place + 25].clone() };
        let pulled = if i == 0 { -2.0 * &x[0] } else { &x[i - 1] - 2.0 * &x[i] };
        if i == 24 { pulled } else { pulled + &x[i + 1] }
    });
    let mut start = [0.0; 50];
    start[0] = 1.0;
    Problem::new("linear chain", field, formulas, start, 20.0)
}

/// A body on an ellipse of eccentricity 0.6 about one of unit weight, for three turns.
pub fn orbit() -> Problem<4> {
    let field = |x: &[f64; 4]| {
        let squared = x[0] * x[0] + x[1] * x[1];
        let cubed = squared * squared.sqrt();
        [x[2], x[3], -x[0] / cubed, -x[1] / cubed]
    };
    let [x, y, u, v] = &variables();
    let squared = x * x + y * y;
    let cubed = &squared * squared.square_root();
    let formulas = [u.clone(), v.clone(), -x / &cubed, -y / &cubed];
    Problem::new("orbit", field, formulas, [0.4, 0.0, 0.0, 2.0], 3.0 * TAU)
}
