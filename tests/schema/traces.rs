//! Every line that is written is as the schema says, and a spoiled one is not.

#![allow(clippy::unwrap_used)] // a test that panics has failed

#[path = "../common/mod.rs"]
mod common;

use pleach::automaton::network::scenario::{LinkModel, Scenario, ValidScenario};
use pleach::trace::TraceWriter;
use pleach::{mission, scenario_file};
use serde_json::Value;
use std::path::Path;
use trace_schema::Schema;

fn shipped(name: &str) -> Scenario {
    let path = Path::new("../../scenarios").join(name).with_extension("toml");
    scenario_file::read(&path).unwrap().into_scenario()
}

fn trace(scenario: &ValidScenario) -> Vec<Value> {
    let mut writer = TraceWriter::new(Vec::new(), scenario).unwrap();
    mission::run(scenario, &mut [&mut writer]).unwrap();
    let bytes = writer.finish().unwrap();
    let text = std::str::from_utf8(&bytes).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn every_line_of_a_trace_is_what_the_schema_says() {
    let schema = Schema::new().unwrap();
    for name in ["too-few", "unreachable", "leaf-leader", "redundant-node", "errands", "two-teams"]
    {
        let mut scenario = shipped(name);
        if name == "too-few" {
            scenario.link.model = LinkModel::Logistic;
        }
        let lines = trace(&ValidScenario::new(scenario).unwrap());
        for line in &lines {
            assert_eq!(schema.complaint(line), None, "{name}: {line}");
            assert!(schema.describes(line), "{name}: a key has no description: {line}");
        }
    }
}

#[test]
fn every_event_is_described() {
    let schema = Schema::new().unwrap();
    for event in common::every_event() {
        let mut line = serde_json::to_value(&event).unwrap();
        line["type"] = "event".into();
        line["k"] = 7.into();
        assert_eq!(schema.complaint(&line), None, "{line}");
        assert!(schema.describes(&line), "{line}");
    }
}

#[test]
fn a_spoiled_line_is_refused() {
    let schema = Schema::new().unwrap();
    let lines = trace(&ValidScenario::new(shipped("unreachable")).unwrap());
    let spoil = |kind: &str, key: &str, value: Value| {
        let mut line = lines.iter().find(|line| line["type"] == kind).unwrap().clone();
        line[key] = value;
        assert!(schema.complaint(&line).is_some(), "{line}");
    };
    spoil("header", "version", 2.into());
    spoil("step", "role", vec!["boss"].into());
    spoil("step", "k", (-1).into());
    spoil("event", "event", "lunch".into());
    spoil("end", "outcome", "fine".into());
}
