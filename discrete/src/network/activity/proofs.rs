//! The table of duties is deterministic and keeps every fixed post held.

use super::*;
use crate::{Event, Location};

/// The bounds of `unwind` below: more than there are rows.
const _: () = assert!(DUTIES.rows().len() < 128);

/// One of `values`: any of them.
fn any_of<T: Copy>(values: &[T]) -> T {
    values[usize::from(kani::any_where(|at: &u8| usize::from(*at) < values.len()))]
}

/// For every activity and event there is at most one row, and [`TransitionTable::next`] follows it.
#[kani::proof]
#[kani::unwind(128)]
fn an_activity_answers_every_event_in_one_way() {
    let (activity, event) = (any_of(Activity::ALL), any_of(DutyEvent::ALL));
    kani::cover!(DUTIES.next(activity, event).is_ok());
    kani::cover!(DUTIES.next(activity, event).is_err());
    let mut found = None;
    for row in DUTIES.rows() {
        if row.source == activity && row.event == event {
            assert!(found.is_none());
            found = Some(row.target);
        }
    }
    assert!(DUTIES.next(activity, event).ok() == found);
}

/// A robot that holds a fixed post of the tree goes away from it only when it is replaced.
#[kani::proof]
#[kani::unwind(128)]
fn a_robot_leaves_a_fixed_post_when_it_is_replaced() {
    let (activity, event) = (any_of(Activity::ALL), any_of(DutyEvent::ALL));
    if let Ok(target) = DUTIES.next(activity, event) {
        kani::cover!(activity == Activity::Waiting && target == Activity::Shifting);
        kani::cover!(activity == Activity::Leaf && target == Activity::Following);
        assert!(keeps_posts_held(activity, event, target));
    }
}
