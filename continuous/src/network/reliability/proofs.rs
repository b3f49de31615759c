//! Eq. (27): exact at its ends for every number, monotone on a grid.

use super::*;

/// The model of the studies, in tenths: l = 4, u = 5.
fn link() -> CubicReliability {
    CubicReliability { full_range: 4.0, max_range: 5.0 }
}

/// Any distance outside of the transition, up to infinity: all of the transition is left up to l,
/// and none from u on, exactly. There R is 1 and 0, and its slope is 0 at both ends, so that R is
/// continuous and smooth where its pieces meet.
#[kani::proof]
#[kani::unwind(2)]
fn reliability_is_flat_outside_of_the_transition() {
    let link = link();
    let distance: f64 = kani::any();
    kani::assume(distance >= 0.0 && !(4.0 < distance && distance < 5.0));
    kani::cover!(distance == 4.0);
    kani::cover!(distance == 5.0);
    kani::cover!(distance == f64::INFINITY);
    assert!(link.remaining(distance) == if distance <= 4.0 { 1.0 } else { 0.0 });
    // What follows depends on the distance by what is left of the transition alone.
    assert!(link.reliability(4.0) == 1.0 && link.reliability(5.0) == 0.0);
    assert!(link.slope(4.0) == 0.0 && link.slope(5.0) == 0.0);
    assert!(link.expected_transmissions(4.0) == 1.0);
    assert!(link.expected_transmissions(5.0) == f64::INFINITY);
}

/// How many steps the grid has from l to u.
const STEPS: usize = 16;

/// R, its slope and 1/R at the points of the grid, from l to u.
fn grid() -> [(f64, f64, f64); STEPS + 1] {
    let link = link();
    let mut grid = [(0.0, 0.0, 0.0); STEPS + 1];
    for (step, values) in grid.iter_mut().enumerate() {
        let distance = 4.0 + step as f64 / STEPS as f64;
        *values = (
            link.reliability(distance),
            link.slope(distance),
            link.expected_transmissions(distance),
        );
    }
    grid
}

/// Any two of 17 distances from l to u: R lies in [0, 1] and does not increase, its slope is never
/// positive, and 1/R does not decrease.
///
/// Between the points of the grid the lemma is that of `proofs/smt/reliability-*.smt2`.
#[kani::proof]
#[kani::unwind(19)]
fn reliability_falls_from_one_to_zero() {
    let grid = grid();
    let near: u8 = kani::any_where(|near| *near <= 16);
    let far: u8 = kani::any_where(|far| *far <= 16);
    kani::assume(near < far);
    let ((one, slope, cost), (other, _, dearer)) =
        (grid[usize::from(near)], grid[usize::from(far)]);
    kani::cover!(near == 0 && far == 16);
    assert!(0.0 <= other && other < one && one <= 1.0);
    assert!(slope <= 0.0 && (slope < 0.0 || near == 0));
    assert!(1.0 <= cost && cost < dearer);
}
