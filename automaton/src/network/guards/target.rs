//! The guards of the targets ψ (Algorithm 2): where a robot goes at a sample.

use pleach_guards::{Predicate, proposition, variable};

/// A robot has a target only while it does not exchange duties, the mission goes on, and no robot
/// is still attached to it that has not heard of its successor.
fn free_to_move(predicate: Predicate) -> Predicate {
    let bound = proposition("engaged") | proposition("mission_over") | proposition("held_back");
    (!bound).and(predicate)
}

/// A mover that cannot pass asks for way.
pub(crate) fn gives_way() -> Predicate {
    free_to_move(proposition("asked_for_way"))
}

/// It is off the reference of its post, and no mover is near.
pub(crate) fn returns() -> Predicate {
    free_to_move(proposition("off_post") & !proposition("near_mover"))
}

/// Its subgroup of Σ is the active team, and it is off the place ahead: eq. (25).
pub(crate) fn shifts() -> Predicate {
    free_to_move(proposition("in_active_subgroup") & proposition("off_place_ahead"))
}

/// Its subgroup of Σ is the active team, and it has yet to change over to another access point on its way to the
/// place ahead.
pub(crate) fn changes_over() -> Predicate {
    shifts() & proposition("before_changeover")
}

/// The primary team is the active team or, where recruits are called for ahead of a standstill, goes on while
/// one is sought and comes.
fn team_goes_on() -> Predicate {
    proposition("advances") | (proposition("eager") & proposition("recruiting"))
}

/// The primary team goes on: eq. (24).
pub(crate) fn follows() -> Predicate {
    free_to_move(team_goes_on())
}

/// It has joined the primary team from afar, and has yet to change over to another access point on its way there.
pub(crate) fn joins_over() -> Predicate {
    follows() & proposition("before_changeover")
}

/// The primary team goes on, the task is not within reach, and no redundant robot is attached to the leader:
/// eq. (24).
pub(crate) fn leads() -> Predicate {
    let away = variable("distance").more_than(variable("reach"));
    free_to_move(team_goes_on() & away & !proposition("bears_redundant"))
}
