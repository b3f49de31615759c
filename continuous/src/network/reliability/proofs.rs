//! Eq. (27): exact outside of the transition for every number.

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
