//! A place is held at every instant of a period.

use super::below;
use crate::network::motion::first_gap;

/// The fractions at which robots come and go.
const QUARTERS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// The instants at which one looks: these, and some between.
const EIGHTHS: [f64; 9] = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];

/// Any three intervals with ends at quarters of the period: if no gap is found, every instant is
/// covered; if one is found, every instant up to it is covered and those right after it are not.
#[kani::proof]
#[kani::unwind(5)]
fn a_gap_is_found_where_there_is_one() {
    let interval = || {
        let (start, end) = (below(5), below(5));
        kani::assume(start <= end);
        (QUARTERS[start], QUARTERS[end])
    };
    let intervals = [interval(), interval(), interval()];
    let instant = EIGHTHS[below(9)];
    let (mut covered, mut soon_covered) = (false, false);
    let mut sorted = intervals;
    let gap = first_gap(&mut sorted);
    for (start, end) in intervals {
        covered |= start <= instant && instant <= end;
        soon_covered |= start <= instant && instant < end;
    }
    match gap {
        None => {
            kani::cover!(intervals[0].0 > 0.0 && intervals[0].1 < 1.0);
            assert!(covered);
        }
        Some(gap) => {
            kani::cover!(gap == 0.5 && intervals[2].1 == 1.0);
            assert!(covered || instant >= gap);
            assert!(!soon_covered || instant != gap);
        }
    }
}
