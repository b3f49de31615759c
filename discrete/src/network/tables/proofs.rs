//! The table is deterministic, and the end is final.

use super::*;
use crate::{Event, Location};

/// The bounds of `unwind` below: more than there are rows.
const _: () = assert!(MISSION.rows().len() < 64);

/// One of `values`: any of them.
fn any_of<T: Copy>(values: &[T]) -> T {
    values[usize::from(kani::any_where(|at: &u8| usize::from(*at) < values.len()))]
}

/// Two rows answer one step.
const SEVERAL: u8 = 1 << 7;

/// The phase to which each phase goes on each step, as a bit: the compiler reads the table.
const TARGETS: [[u8; MissionStep::ALL.len()]; Phase::ALL.len()] = {
    let mut targets = [[0; MissionStep::ALL.len()]; Phase::ALL.len()];
    let (rows, mut at) = (MISSION.rows(), 0);
    while at < rows.len() {
        let target = &mut targets[rows[at].source as usize][rows[at].event as usize];
        *target = if *target == 0 { 1 << rows[at].target as u8 } else { SEVERAL };
        at += 1;
    }
    targets
};

/// For every phase and step there is at most one row, and [`TransitionTable::next`] follows it.
#[kani::proof]
#[kani::unwind(64)]
fn a_phase_answers_every_step_in_one_way() {
    // A table of its own, not the constant: Kani reads a constant byte by byte.
    let targets = TARGETS;
    let (phase, step) = (any_of(Phase::ALL), any_of(MissionStep::ALL));
    let expected = targets[phase as usize][step as usize];
    match MISSION.next(phase, step) {
        Ok(target) => {
            kani::cover!(target == Phase::Shift);
            assert!(expected == 1 << target as u8);
        }
        Err(refusal) => {
            kani::cover!();
            assert!(expected == 0);
            assert!(refusal.location == phase && refusal.event == step);
        }
    }
}

/// The end is heard in every phase but itself, and only another announcement follows it.
#[kani::proof]
#[kani::unwind(64)]
fn the_end_is_heard_and_only_an_announcement_follows() {
    let (phase, step) = (any_of(Phase::ALL), any_of(MissionStep::ALL));
    if phase == Phase::Ended {
        let is_announced = matches!(step, MissionStep::Announced | MissionStep::Overtaken);
        kani::cover!(is_announced);
        kani::cover!(!is_announced);
        assert!(MISSION.next(phase, step).is_ok() == is_announced);
    } else {
        kani::cover!(phase == Phase::Shift);
        assert!(MISSION.next(phase, MissionStep::Ended) == Ok(Phase::Ended));
    }
}
