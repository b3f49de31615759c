//! Multipliers stay in the non-negative orthant.

use super::*;

/// Any number but NaN, infinite ones among them: the multiplier that comes of it lies in
/// [0, [`MULTIPLIER_CAP`]], and one that lies there already stays.
#[kani::proof]
#[kani::unwind(2)]
fn a_projected_multiplier_is_never_negative() {
    let number: f64 = kani::any();
    kani::assume(!number.is_nan());
    let multiplier = projected(number);
    kani::cover!(number == f64::NEG_INFINITY);
    kani::cover!(multiplier == MULTIPLIER_CAP);
    let orthant = 0.0..=MULTIPLIER_CAP;
    assert!(orthant.contains(&multiplier));
    assert!(multiplier == number || !orthant.contains(&number));
    assert!(DualState::new(number).multiplier() == multiplier);
}
