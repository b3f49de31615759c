//! The table is total, deterministic and connected.

use super::*;
use crate::{Event, Location};

/// The bounds of `unwind` below: more than there are rows.
const _: () = assert!(MISSION.rows().len() < 64);

/// One of `values`: any of them.
fn any_of<T: Copy>(values: &[T]) -> T {
    values[usize::from(kani::any_where(|at: &u8| usize::from(*at) < values.len()))]
}

/// What a table says of an event: to be led on by the only row there is, or to be refused.
fn answers_in_one_way<L: Location, E: Event>(
    table: &TransitionTable<L, E>,
    location: L,
    event: E,
) -> bool {
    let mut found = None;
    for row in table.rows() {
        if row.source == location && row.event == event {
            if found.is_some() {
                return false;
            }
            found = Some(row.target);
        }
    }
    match table.next(location, event) {
        Ok(target) => found == Some(target),
        Err(refusal) => found.is_none() && refusal.location == location && refusal.event == event,
    }
}

/// For every phase and step: at most one row, and [`TransitionTable::next`] follows it.
#[kani::proof]
#[kani::unwind(64)]
fn a_phase_answers_every_step_in_one_way() {
    let (phase, step) = (any_of(Phase::ALL), any_of(MissionStep::ALL));
    kani::cover!(MISSION.next(phase, step) == Ok(Phase::Shift));
    assert!(answers_in_one_way(&MISSION, phase, step));
}

/// Every phase can be reached from `Idle`.
#[kani::proof]
#[kani::unwind(64)]
fn every_phase_is_reached() {
    let mut phases = [false; Phase::ALL.len()];
    MISSION.mark_reachable(Phase::Idle, &mut phases);
    let phase = any_of(Phase::ALL);
    kani::cover!(phase == Phase::Shift);
    assert!(phases[phase as usize]);
}

/// The end is heard in every phase but itself, and only another announcement follows it.
#[kani::proof]
#[kani::unwind(64)]
fn the_end_is_heard_and_only_an_announcement_follows() {
    let (phase, step) = (any_of(Phase::ALL), any_of(MissionStep::ALL));
    kani::cover!(phase == Phase::Shift && step == MissionStep::Blocked);
    if phase == Phase::Ended {
        let is_announced = matches!(step, MissionStep::Announced | MissionStep::Overtaken);
        assert!(MISSION.next(phase, step).is_ok() == is_announced);
    } else {
        assert!(MISSION.next(phase, MissionStep::Ended) == Ok(Phase::Ended));
    }
}
