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

/// Multipliers from 0 to 7, residuals from −4 to 4, a reserve of 1 and a step of ½: the multiplier
/// stays in the orthant, and rises exactly if the residual misses the reserve.
///
/// The steps are computed one by one, and compared for any two numbers.
#[kani::proof]
#[kani::unwind(11)]
fn a_multiplier_rises_while_the_reserve_is_missed() {
    let mut after = [[0.0; 9]; 8];
    for (multiplier, row) in after.iter_mut().enumerate() {
        for (residual, stepped) in row.iter_mut().enumerate() {
            *stepped = dual_step(multiplier as f64, 0.5, residual as f64 - 4.0, 1.0);
        }
    }
    let multiplier: u8 = kani::any_where(|multiplier| *multiplier < 8);
    let residual: u8 = kani::any_where(|residual| *residual < 9);
    let before = f64::from(multiplier);
    let after = after[usize::from(multiplier)][usize::from(residual)];
    kani::cover!(after == 0.0 && multiplier > 0);
    assert!((0.0..=MULTIPLIER_CAP).contains(&after));
    assert!((after > before) == (residual < 5));
    assert!((after < before) == (residual > 5 && multiplier > 0));
}
