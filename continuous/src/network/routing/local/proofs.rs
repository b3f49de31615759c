//! Shares are never negative.

use super::*;

/// Any number, also one that is none: its positive part is a share that may be given.
#[kani::proof]
#[kani::unwind(2)]
fn a_positive_part_is_never_negative() {
    let number: f64 = kani::any();
    let part = positive_part(number);
    kani::cover!(number.is_nan());
    kani::cover!(number == f64::INFINITY);
    assert!(part >= 0.0);
    assert!(part == if number > 0.0 { number } else { 0.0 });
}
