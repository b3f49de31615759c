//! The coefficients of Dormand and Prince's pair of orders 5 and 4.
//!
//! J. R. Dormand and P. J. Prince, "A family of embedded Runge–Kutta formulae",
//! *Journal of Computational and Applied Mathematics* 6 (1980), doi:10.1016/0771-050X(80)90013-3.
//! Seven stages, of which the last is evaluated at the end of the step and so is the first of the
//! next one: six evaluations of the field per step.

/// Number of stages.
pub(super) const STAGES: usize = 7;

/// Where in the step each stage is evaluated, as a fraction of it.
pub(super) const NODES: [f64; STAGES] =
    [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

/// The weights of the earlier stages in the state at which the second is evaluated; and so on.
pub(super) const SECOND: [f64; 1] = [1.0 / 5.0];
pub(super) const THIRD: [f64; 2] = [3.0 / 40.0, 9.0 / 40.0];
pub(super) const FOURTH: [f64; 3] = [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0];
pub(super) const FIFTH: [f64; 4] =
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0];
pub(super) const SIXTH: [f64; 5] =
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0];

/// The weights of stages 1, 3, 4, 5 and 6 in the solution of order 5; those of 2 and 7 are zero.
pub(super) const SOLUTION: [f64; 5] =
    [35.0 / 384.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];

/// The weights of stages 1, 3, 4, 5, 6 and 7 in the difference of the solutions of order 5 and 4,
/// which estimates the error.
pub(super) const ERROR: [f64; 6] = [
    71.0 / 57600.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// The weights of stages 1, 3, 4, 5, 6 and 7 in the quartic term of the free interpolant, by
/// L. F. Shampine, "Some practical Runge–Kutta formulas", *Mathematics of Computation* 46 (1986),
/// doi:10.1090/S0025-5718-1986-0815836-3; in the form of Hairer, Nørsett and Wanner, *Solving
/// Ordinary Differential Equations I*, 2nd ed., section II.6, doi:10.1007/978-3-540-78862-1.
pub(super) const QUARTIC: [f64; 6] = [
    -12715105075.0 / 11282082432.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// target = base + step · Σ weight · stage.
pub(super) fn combine<const N: usize>(
    target: &mut [f64],
    base: &[f64],
    step: f64,
    weights: [f64; N],
    stages: [&[f64]; N],
) {
    // Slices of one known length spare the loop its bounds checks.
    let dimension = target.len();
    let base = &base[..dimension];
    let stages = stages.map(|stage| &stage[..dimension]);
    let weights = weights.map(|weight| step * weight);
    for i in 0..dimension {
        let mut sum = 0.0;
        for stage in 0..N {
            sum += weights[stage] * stages[stage][i];
        }
        target[i] = base[i] + sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_sum(weights: &[f64], expected: f64) {
        let sum: f64 = weights.iter().sum();
        assert!((sum - expected).abs() < 1e-14, "{weights:?} sums to {sum}, not to {expected}");
    }

    #[test]
    fn weights_of_a_stage_sum_to_its_node() {
        let rows: [&[f64]; 6] = [&SECOND, &THIRD, &FOURTH, &FIFTH, &SIXTH, &SOLUTION];
        for (weights, node) in rows.into_iter().zip(&NODES[1..]) {
            assert_sum(weights, *node);
        }
        assert_sum(&ERROR, 0.0);
        assert_sum(&QUARTIC, 0.0);
    }
}
