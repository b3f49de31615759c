//! Missions that failed once, found by random floor plans. Each file says what went wrong; all
//! tasks of all of them are serviced, with every property monitored.

use pleach::automaton::network::record::Outcome;
use pleach::{mission, scenario_file};
use std::path::PathBuf;

#[test]
fn what_failed_once_does_not_fail_again() {
    let files = std::fs::read_dir("tests/scenarios/found").unwrap();
    let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty());
    for file in files {
        let scenario = scenario_file::read(&file).unwrap();
        let end = mission::run(&scenario, &mut []).unwrap().end;
        let said = format!("{}: {:?}: {}", scenario.name, end.outcome, end.reason);
        assert_eq!(end.outcome, Outcome::Serviced, "{said}");
    }
}

/// Whether they can be serviced or not: no property is violated.
#[test]
fn races_that_were_lost_once_violate_nothing() {
    let scenario = scenario_file::read("tests/scenarios/races/exchange-and-call.toml").unwrap();
    let end = mission::run(&scenario, &mut []).unwrap().end;
    assert_ne!(end.outcome, Outcome::InvariantViolated, "{}", end.reason);
}
