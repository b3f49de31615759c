//! Missions that failed once, found by random floor plans. Each file says what went wrong; every property is
//! monitored.

use missions::{files, read};
use pleach::automaton::network::record::{End, Outcome};
use pleach::mission;

/// All of their tasks are serviced now.
#[test]
fn what_failed_once_does_not_fail_again() {
    for (end, said) in ends("tests/scenarios/found") {
        assert_eq!(end.outcome, Outcome::Serviced, "{said}");
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
