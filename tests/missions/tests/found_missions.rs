//! Missions that failed once, found by random floor plans. Each file says what went wrong; every property is
//! monitored.

use missions::{files, read};
use pleach::automaton::network::record::{End, Outcome};
use pleach::mission;

/// Missions that fail again, with the cause.
const OPEN: [(&str, &str); 2] = [
    (
        "bound-leader-near-another-tree",
        "links that are stretched as far as they may be carry no more, and the team is blocked",
    ),
    (
        "follower-in-the-bend",
        "the robot behind is pulled straight across the bend, and stands in the way of the leader",
    ),
];

/// All of their tasks are serviced now, but for those that are open.
#[test]
fn what_failed_once_does_not_fail_again() {
    for (end, said) in ends("tests/scenarios/found") {
        let is_open = OPEN.iter().any(|(name, _)| said.starts_with(name));
        assert_eq!(end.outcome == Outcome::Serviced, !is_open, "{said}");
    }
}

/// Missions that end without a violation and in time, whether all tasks can be serviced or not.
#[test]
fn hard_missions_come_to_an_end() {
    for (end, said) in ends("tests/scenarios/hard") {
        let has_ended = matches!(end.outcome, Outcome::Serviced | Outcome::InsufficientRobots);
        assert!(has_ended, "{said}");
    }
}

/// How the missions of a folder end, by the names of their files, and the same in words.
fn ends(folder: &str) -> impl Iterator<Item = (End, String)> {
    files(folder).into_iter().map(|file| {
        let scenario = read(file);
        let end = mission::run(&scenario, &mut []).unwrap().end;
        let said = format!("{}: {:?}: {}", scenario.name, end.outcome, end.reason);
        (end, said)
    })
}
