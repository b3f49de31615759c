//! What a page says of a trace is what the judge says of it.

use missions::{shipped, traced, valid};
use pleach::judge::{Verdict, judge};
use pleach::page::of_trace;
use pleach::trace::TraceReader;
use serde_json::{Value, json};
use std::sync::OnceLock;

/// The trace of a mission that ends with tasks unserviced, line by line.
fn lines() -> Vec<Value> {
    static TRACE: OnceLock<Vec<Value>> = OnceLock::new();
    let trace = TRACE.get_or_init(|| {
        let (bytes, _) = traced(&valid(shipped("too-few")));
        let text = String::from_utf8(bytes).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    });
    trace.clone()
}

fn text(lines: &[Value]) -> String {
    lines.iter().map(|line| format!("{line}\n")).collect()
}

/// The line of the page that says how the mission ended.
fn outcome(lines: &[Value]) -> String {
    let page = of_trace(text(lines).as_bytes()).unwrap();
    page.lines().find(|line| line.starts_with("<p class=\"outcome")).unwrap().to_owned()
}

fn steps(lines: &mut [Value]) -> impl Iterator<Item = &mut Value> {
    lines.iter_mut().filter(|line| line["type"] == "step")
}

type Spoil = (&'static str, fn(&mut Vec<Value>));

const SPOILS: [Spoil; 7] = [
    ("claims that all is serviced", |lines| {
        *lines.last_mut().unwrap() = json!({ "type": "end", "outcome": "serviced" });
    }),
    ("a robot leaps", |lines| {
        let step = steps(lines).nth(100).unwrap();
        step["position"][0][0] = json!(step["position"][0][0].as_f64().unwrap() + 0.5);
    }),
    ("a robot leaps, and there is no end", |lines| {
        let step = steps(lines).nth(100).unwrap();
        step["position"][0][0] = json!(step["position"][0][0].as_f64().unwrap() + 0.5);
        lines.pop();
    }),
    ("goes on after its end", |lines| lines.push(lines.last().unwrap().clone())),
    ("an event of another step", |lines| {
        let event = lines.iter_mut().rev().find(|line| line["type"] == "event").unwrap();
        event["k"] = json!(event["k"].as_u64().unwrap() - 1);
    }),
    ("an event after the last step", |lines| {
        let event = lines.iter().find(|line| line["type"] == "event").unwrap().clone();
        lines.insert(lines.len() - 1, event);
    }),
    ("nothing is on record", |lines| {
        lines.retain(|line| line["type"] == "header" || line["type"] == "end");
    }),
];

#[test]
fn what_the_judge_finds_is_the_headline() {
    let sound = outcome(&lines());
    assert!(
        sound.starts_with("<p class=\"outcome doubtful\"><strong>insufficient robots"),
        "{sound}"
    );
    for (name, spoil) in SPOILS {
        let mut lines = lines();
        spoil(&mut lines);
        let verdict = judge(TraceReader::new(text(&lines).as_bytes()).unwrap()).unwrap();
        let Verdict::Violated(violation) = verdict else { panic!("{name}: it is judged sound") };
        let headline = format!("<p class=\"outcome bad\"><strong>violated</strong> {violation}; ");
        let told = outcome(&lines);
        assert!(told.starts_with(&headline), "{name}: {told}");
        let claim = match lines.last().unwrap()["outcome"].as_str() {
            Some(outcome) => format!("the run says: {}, ", outcome.replace('_', " ")),
            None => "the trace stops without an outcome, ".to_owned(),
        };
        assert!(told.contains(&claim), "{name}: {told}");
    }
}

#[test]
fn a_run_that_was_stopped_for_a_violation_says_so_itself() {
    let mut lines = lines();
    let end = json!({ "type": "end", "outcome": "invariant_violated", "reason": "robots met" });
    *lines.last_mut().unwrap() = end;
    let told = outcome(&lines);
    assert!(
        told.starts_with("<p class=\"outcome bad\"><strong>invariant violated</strong>"),
        "{told}"
    );
    assert_eq!(told.matches("robots met").count(), 1, "{told}");
}

#[test]
fn no_number_of_a_step_is_too_large() {
    let mut lines = lines();
    steps(&mut lines).last().unwrap()["k"] = json!(u64::MAX);
    assert!(outcome(&lines).contains("<strong>violated</strong>"));
}

#[test]
fn a_step_of_other_robots_is_refused() {
    let mut lines = lines();
    let fields = ["position", "role", "residual", "multiplier", "location", "exchange"];
    let step = steps(&mut lines).nth(3).unwrap();
    for name in fields.into_iter().chain(["known_phase", "target", "sent", "heard"]) {
        step[name].as_array_mut().unwrap().pop();
    }
    let error = of_trace(text(&lines).as_bytes()).unwrap_err().to_string();
    assert_eq!(error, "step 3 has 4 positions for 5 robots");
}
