//! The table of duties is deterministic and keeps every fixed post held.

use super::*;
use crate::{Event, Location};

/// The bounds of `unwind` below: more than there are rows.
const _: () = assert!(DUTIES.rows().len() < 128);

/// One of `values`: any of them.
fn any_of<T: Copy>(values: &[T]) -> T {
    values[usize::from(kani::any_where(|at: &u8| usize::from(*at) < values.len()))]
}

/// Two rows answer one event.
const SEVERAL: u16 = 1 << 15;

/// The activity to which each activity goes on each event, as a bit: the compiler reads the table.
const TARGETS: [[u16; DutyEvent::ALL.len()]; Activity::ALL.len()] = {
    let mut targets = [[0; DutyEvent::ALL.len()]; Activity::ALL.len()];
    let (rows, mut at) = (DUTIES.rows(), 0);
    while at < rows.len() {
        let target = &mut targets[rows[at].source as usize][rows[at].event as usize];
        *target = if *target == 0 { 1 << rows[at].target as u16 } else { SEVERAL };
        at += 1;
    }
    targets
};

/// For every activity and event there is at most one row, and [`TransitionTable::next`] follows it.
#[kani::proof]
#[kani::unwind(128)]
fn an_activity_answers_every_event_in_one_way() {
    // A table of its own, not the constant: Kani reads a constant byte by byte.
    let targets = TARGETS;
    let (activity, event) = (any_of(Activity::ALL), any_of(DutyEvent::ALL));
    let expected = targets[activity as usize][event as usize];
    match DUTIES.next(activity, event) {
        Ok(target) => {
            kani::cover!();
            assert!(expected == 1 << target as u16);
        }
        Err(refusal) => {
            kani::cover!();
            assert!(expected == 0);
            assert!(refusal.location == activity && refusal.event == event);
        }
    }
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
