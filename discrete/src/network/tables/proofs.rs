//! The tables are total, deterministic and connected.

use super::*;

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

/// For every role and event: at most one row, and [`TransitionTable::next`] follows it.
#[kani::proof]
#[kani::unwind(36)]
fn a_role_answers_every_event_in_one_way() {
    let (role, event) = (any_of(&Role::ALL), any_of(RoleEvent::ALL));
    kani::cover!(ROLES.next(role, event).is_ok());
    kani::cover!(ROLES.next(role, event).is_err());
    assert!(answers_in_one_way(&ROLES, role, event));
}

/// For every phase and step: at most one row, and [`TransitionTable::next`] follows it.
#[kani::proof]
#[kani::unwind(36)]
fn a_phase_answers_every_step_in_one_way() {
    let (phase, step) = (any_of(&Phase::ALL), any_of(MissionStep::ALL));
    kani::cover!(MISSION.next(phase, step) == Ok(Phase::Shift));
    assert!(answers_in_one_way(&MISSION, phase, step));
}

/// Every role can be reached from `Redundant`, and every phase from `Idle`.
#[kani::proof]
#[kani::unwind(36)]
fn every_role_and_every_phase_is_reached() {
    let (mut roles, mut phases) = ([false; Role::ALL.len()], [false; Phase::ALL.len()]);
    ROLES.mark_reachable(Role::Redundant, &mut roles);
    MISSION.mark_reachable(Phase::Idle, &mut phases);
    let (role, phase) = (any_of(&Role::ALL), any_of(&Phase::ALL));
    kani::cover!(role == Role::Leader && phase == Phase::Shift);
    assert!(roles[role as usize] && phases[phase as usize]);
}

/// No transition of a leaf or junction leaves its place without a robot: [`keeps_places_held`].
#[kani::proof]
#[kani::unwind(36)]
fn a_leaf_or_junction_goes_when_it_is_replaced() {
    let (role, event) = (any_of(&Role::ALL), any_of(RoleEvent::ALL));
    if let Ok(target) = ROLES.next(role, event) {
        kani::cover!(role == Role::Leaf && target == Role::Node);
        kani::cover!(role == Role::Junction && target == Role::Recruit);
        assert!(keeps_places_held(role, event, target));
    }
}

/// Along any three events a robot stays in the table, and a leaf that is neither replaced nor
/// elected stays a leaf.
#[kani::proof]
#[kani::unwind(36)]
fn a_leaf_that_nobody_replaces_stays_a_leaf() {
    let mut role = any_of(&Role::ALL);
    let mut entrusted = role == Role::Leaf;
    for _ in 0..3 {
        let event = any_of(RoleEvent::ALL);
        let Ok(next) = ROLES.next(role, event) else { continue };
        let released = event.needs_replacement() || event == RoleEvent::Elected;
        entrusted = event == RoleEvent::Entrusted || entrusted && !released;
        role = next;
        kani::cover!(entrusted);
        assert!(!entrusted || role == Role::Leaf);
    }
}

/// The end is heard in every phase but itself, and nothing follows it.
#[kani::proof]
#[kani::unwind(36)]
fn the_end_is_heard_and_final() {
    let (phase, step) = (any_of(&Phase::ALL), any_of(MissionStep::ALL));
    kani::cover!(phase == Phase::Shift && step == MissionStep::Blocked);
    if phase == Phase::Ended {
        assert!(MISSION.next(phase, step).is_err());
    } else {
        assert!(MISSION.next(phase, MissionStep::Ended) == Ok(Phase::Ended));
    }
}
