//! Missions that failed once, found by random floor plans. Each file says what went wrong; all
//! tasks of all of them are serviced, with every property monitored.

use pleach::automaton::network::record::Outcome;
use pleach::{mission, scenario_file};
use std::path::PathBuf;

#[test]
fn what_failed_once_does_not_fail_again() {
    for file in files("tests/scenarios/found") {
        let scenario = scenario_file::read(&file).unwrap();
        let end = mission::run(&scenario, &mut []).unwrap().end;
        let said = format!("{}: {:?}: {}", scenario.name, end.outcome, end.reason);
        assert_eq!(end.outcome, Outcome::Serviced, "{said}");
    }
}

/// Missions that end without a violation and in time, whether all tasks can be serviced or not.
#[test]
fn hard_missions_come_to_an_end() {
    for file in files("tests/scenarios/hard") {
        let scenario = scenario_file::read(&file).unwrap();
        let end = mission::run(&scenario, &mut []).unwrap().end;
        let said = format!("{}: {:?}: {}", scenario.name, end.outcome, end.reason);
        assert!(end.outcome == Outcome::Serviced || end.outcome.is_given_up(), "{said}");
    }
}

/// Missions in which the residual of a robot falls below 0. Each file says why: the monitor stops them. One that has
/// been mended belongs to those above.
#[test]
fn what_is_known_to_be_violated_is_noticed() {
    for file in files("tests/scenarios/violated") {
        let scenario = scenario_file::read(&file).unwrap();
        let end = mission::run(&scenario, &mut []).unwrap().end;
        let said = format!("{}: {:?}: {}", scenario.name, end.outcome, end.reason);
        assert_eq!(end.outcome, Outcome::InvariantViolated, "{said}");
        assert!(end.reason.starts_with("residual is violated"), "{said}");
    }
}

/// The files of a folder, by name.
pub fn files(folder: &str) -> Vec<PathBuf> {
    let files = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty());
    files
}
