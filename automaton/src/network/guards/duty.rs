//! The guards of the duty automaton (Algorithms 3 and 4, Remark 5.6).
//!
//! Some propositions name the step of the mission, or which exchange of duties, the automaton
//! jumps together with; in a jump by itself they are false.

use pleach_guards::{Guard, Predicate, proposition, variable};

fn named(name: &str, predicate: Predicate) -> Guard {
    Guard::new(name, predicate)
}

/// What a robot does by itself only while it does not exchange duties: what two robots have offered
/// each other stays as it is until both have taken it.
fn disengaged(name: &str, predicate: Predicate) -> Guard {
    Guard::new(name, predicate.and(!proposition("engaged")))
}

/// It joins a mission under way.
pub(crate) fn joined() -> Guard {
    named("joined", proposition("joins_late"))
}

/// It has won the leader election, and nothing depends on it.
pub(crate) fn elected() -> Guard {
    named("elected", proposition("wins").and(!proposition("has_past_duties")))
}

/// It has won the leader election, and has past duties: L_b = 1.
pub(crate) fn bound() -> Guard {
    named("bound", proposition("wins").and(proposition("has_past_duties")))
}

/// It leads, nobody follows it, and a branch of the tree depends on its post.
pub(crate) fn burdened() -> Guard {
    disengaged("burdened", proposition("burdened"))
}

/// The path Σ passes its post.
pub(crate) fn path_joined() -> Guard {
    named("path joined", proposition("on_coming_path"))
}

/// Another task is announced, and its post services none.
pub(crate) fn relay_resumed() -> Guard {
    let plain = !proposition("serves") & !proposition("superfluous");
    named("relay resumed", proposition("superseded") & plain)
}

/// Another task is announced, and its post services one.
pub(crate) fn leaf_resumed() -> Guard {
    let serving = proposition("serves") & !proposition("superfluous");
    named("leaf resumed", proposition("superseded") & serving)
}

fn called_off(name: &str, predicate: Predicate) -> Guard {
    named(name, proposition("called_off").and(predicate))
}

/// Σ is given up or done, and its post is that of a redundant robot, or held by the robot behind.
pub(crate) fn standby_kept() -> Guard {
    called_off("standby kept", proposition("free") | proposition("superfluous"))
}

/// Σ is given up or done, and its post is a fixed one.
pub(crate) fn relay_kept() -> Guard {
    called_off("relay kept", kept() & !proposition("serves"))
}

/// Σ is given up or done, and a task is serviced from its post.
pub(crate) fn leaf_kept() -> Guard {
    called_off("leaf kept", kept() & proposition("serves"))
}

/// Its post is a fixed one, and no other robot holds it.
fn kept() -> Predicate {
    !proposition("free") & !proposition("superfluous")
}

/// Σ is given up, and the post of the leader that awaits its release is held by the robot behind.
pub(crate) fn release_missed() -> Guard {
    called_off("release missed", proposition("superfluous"))
}

/// Σ is given up although the leader has not been released, and no other task is announced.
pub(crate) fn bound_kept() -> Guard {
    called_off("bound kept", !proposition("superseded") & !proposition("superfluous"))
}

/// It is the last robot that Σ relieves, and joins the team.
pub(crate) fn team_joined() -> Guard {
    named("team joined", proposition("is_relieved"))
}

/// It is the leader, and another robot holds its post, or nothing depends on it.
pub(crate) fn released() -> Guard {
    named("released", proposition("is_relieved"))
}

fn reached(name: &str, predicate: Predicate) -> Guard {
    named(name, proposition("takes_post_ahead").and(predicate))
}

/// The post ahead is that of a redundant robot.
pub(crate) fn standby_reached() -> Guard {
    reached("standby reached", proposition("ahead_is_free"))
}

/// The post ahead is a fixed one on one branch.
pub(crate) fn relay_reached() -> Guard {
    let plain = !proposition("ahead_is_free") & !proposition("ahead_serves");
    reached("relay reached", plain & variable("branches_ahead").less_than(2.0))
}

/// Branches part from the post ahead.
pub(crate) fn junction_reached() -> Guard {
    let plain = !proposition("ahead_is_free") & !proposition("ahead_serves");
    reached("junction reached", plain & variable("branches_ahead").at_least(2.0))
}

/// A task is serviced from the post ahead.
pub(crate) fn leaf_reached() -> Guard {
    reached("leaf reached", !proposition("ahead_is_free") & proposition("ahead_serves"))
}

/// The leader has reached its task.
pub(crate) fn task_reached() -> Guard {
    named("task reached", proposition("reaches_task"))
}

/// The primary team is dissolved.
pub(crate) fn dissolved() -> Guard {
    named("dissolved", proposition("dissolved"))
}

/// Its turn on Σ has come.
pub(crate) fn set_out() -> Guard {
    disengaged("set out", proposition("may_set_out"))
}

/// Another parent is better.
pub(crate) fn attached() -> Guard {
    disengaged("attached", proposition("finds_better_parent"))
}

/// A branch of the tree depends on it.
pub(crate) fn promoted() -> Guard {
    disengaged("promoted", variable("branches").at_least(1.0))
}

/// The task that is serviced from its post is over.
pub(crate) fn discharged() -> Guard {
    disengaged("discharged", proposition("task_closed"))
}

/// A second branch parts from its post.
pub(crate) fn branched() -> Guard {
    named("branched", variable("branches").at_least(2.0))
}

/// Only one branch is left.
pub(crate) fn merged() -> Guard {
    named("merged", variable("branches").less_than(2.0))
}

/// For some periods no branch has depended on it, and no recruit is sought: which robots may answer a call does not
/// change while it is under way.
pub(crate) fn retired() -> Guard {
    let unused = variable("unused").at_least(variable("unused_patience"));
    let free = variable("branches").less_than(1.0) & !proposition("recruiting");
    disengaged("retired", unused & free)
}

/// It takes over a duty called `name` in an exchange.
pub(crate) fn takes(name: &'static str) -> Guard {
    let fact = format!("takes_{}", name.replace(' ', "_"));
    Guard::new(&format!("takes {name}"), proposition(&fact))
}
