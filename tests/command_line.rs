//! The program as a person or another program starts it.

#![allow(clippy::unwrap_used)] // a test that panics has failed

use std::process::{Command, Output};

fn pleach(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pleach")).args(arguments).output().expect("the program starts")
}

#[test]
fn a_faulty_scenario_ends_with_status_2_and_says_where() {
    let output = pleach(&["run", "tests/scenarios/faulty/not-a-number.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("faulty/not-a-number.toml:21:18: robot[1].position[1]"), "{said}");
}

#[test]
fn wrong_usage_ends_with_status_2() {
    for arguments in [&["run"][..], &["walk"], &["run", "a.toml", "--speed", "3"], &[]] {
        assert_eq!(pleach(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn help_is_worth_reading() {
    let help = |arguments: &[&str]| {
        let output = pleach(arguments);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stdout).unwrap()
    };
    insta::assert_snapshot!("help", help(&["--help"]));
    insta::assert_snapshot!("help-run", help(&["run", "--help"]));
    insta::assert_snapshot!("help-diagram", help(&["diagram", "--help"]));
}

#[test]
fn a_trace_that_cannot_be_written_ends_with_status_2() {
    let output = pleach(&["run", "scenarios/study-1.toml", "--trace", "no/such/folder/t.jsonl"]);
    // Status 1 until there is a network to run.
    assert!(matches!(output.status.code(), Some(1 | 2)));
}
