//! The program as a person or another program starts it.

use pleach::automaton::network::record::Outcome;
use pleach::trace::{TraceEntry, TraceReader};
use std::path::Path;
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
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("no/such/folder/t.jsonl: cannot be created"), "{said}");
}

#[test]
fn a_task_out_of_reach_ends_with_status_3_and_the_same_trace_every_time() {
    let run = |trace: &Path| {
        let trace = trace.to_str().unwrap();
        pleach(&["run", "scenarios/unreachable.toml", "--no-figures", "--trace", trace])
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (first, second) = (folder.join("first.jsonl"), folder.join("second.jsonl"));
    let output = run(&first);
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(run(&second).status.code(), Some(3));

    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(summary.starts_with("unreachable: 1 of 2 tasks serviced"), "{summary}");
    let story = String::from_utf8(output.stderr).unwrap();
    assert!(story.contains("task 0 is serviced by robot"), "{story}");
    let trace = std::fs::read(&first).unwrap();
    assert_eq!(trace, std::fs::read(&second).unwrap());
    let last = TraceReader::new(trace.as_slice()).unwrap().last().unwrap().unwrap();
    assert!(matches!(last, TraceEntry::End(end) if end.outcome == Outcome::UnreachableTask));
}

#[test]
fn a_quiet_run_says_nothing_but_the_summary() {
    let output = pleach(&["run", "scenarios/unreachable.toml", "--no-figures", "--quiet"]);
    assert!(output.stderr.is_empty());
    assert!(!output.stdout.is_empty());
}
