//! What is admitted meets every constraint.

use super::*;

/// Any three margins, infinite ones and NaN among them: if the smallest is admitted, each is; so a
/// point that the motion problem admits is outside of no constraint.
#[kani::proof]
#[kani::unwind(5)]
fn what_is_admitted_meets_every_constraint() {
    let margins: [f64; 3] = kani::any();
    let least = smallest(margins);
    kani::cover!(is_admitted(least) && least < 0.0);
    kani::cover!(margins[0] > 0.0 && margins[1].is_nan() && margins[2] > 0.0);
    for margin in margins {
        assert!(!is_admitted(least) || is_admitted(margin));
    }
    assert!(is_admitted(least) || margins.iter().any(|margin| !is_admitted(*margin)));
}
