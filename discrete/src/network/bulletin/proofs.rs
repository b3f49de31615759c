//! The newest notice wins, in whatever order notices are heard.

use super::*;

/// The notice after this many steps: at each step exactly one is issued.
fn bulletin(steps: u8) -> Bulletin<u8> {
    let mut bulletin = Bulletin::first(100);
    for step in 0..3 {
        if step < steps {
            bulletin = bulletin.next(101 + step);
        }
    }
    bulletin
}

/// Any three notices of the first four steps of a mission, the first of them known: hearing the
/// others in either order, or twice, leaves the newest of the three, and says whether it was news.
///
/// Assumes that each step has one notice, which the sole right to issue it gives.
#[kani::proof]
#[kani::unwind(5)]
fn the_newest_notice_wins_in_any_order() {
    let step = || kani::any_where(|step: &u8| *step < 4);
    let (known, one, other) = (step(), step(), step());
    let (mut forth, mut back) = (bulletin(known), bulletin(known));
    let news = forth.merge(&bulletin(one));
    forth.merge(&bulletin(other));
    back.merge(&bulletin(other));
    back.merge(&bulletin(one));
    kani::cover!(one < known && known < other);
    assert!(news == (one > known));
    assert!(forth == back);
    assert!(forth == bulletin(known.max(one).max(other)));
    assert!(!forth.merge(&bulletin(one)));
}
