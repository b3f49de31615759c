//! The JSON Schema of traces in `docs/trace.schema.json` describes every line, and every key of
//! every line, that is written.

use crate::{common, missions};
use boon::{Compiler, SchemaIndex, Schemas};
use pleach::automaton::network::scenario::{LinkModel, ValidScenario};
use pleach::mission;
use pleach::trace::TraceWriter;
use serde_json::Value;

const SCHEMA: &str = include_str!("../docs/trace.schema.json");

struct Schema {
    schemas: Schemas,
    index: SchemaIndex,
    document: Value,
}

impl Schema {
    fn new() -> Self {
        let document: Value = serde_json::from_str(SCHEMA).unwrap();
        let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
        compiler.add_resource("trace.json", document.clone()).unwrap();
        let index = compiler.compile("trace.json", &mut schemas).unwrap();
        Schema { schemas, index, document }
    }

    fn complaint(&self, line: &Value) -> Option<String> {
        self.schemas.validate(line, self.index).err().map(|error| error.to_string())
    }

    /// Whether the schema of this line names all of its keys.
    fn describes(&self, line: &Value) -> bool {
        let name = match line["type"].as_str().unwrap() {
            "event" => line["event"].as_str().unwrap(),
            kind => kind,
        };
        let properties = self.document["$defs"][name]["properties"].as_object().unwrap();
        line.as_object().unwrap().keys().all(|key| properties.contains_key(key))
    }
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
    let schema = Schema::new();
    for name in ["too-few", "unreachable", "leaf-leader", "redundant-node", "errands"] {
        let mut scenario = missions::shipped(name);
        if name == "too-few" {
            scenario.link.model = LinkModel::Logistic;
        }
        let lines = trace(&missions::valid(scenario));
        for line in &lines {
            assert_eq!(schema.complaint(line), None, "{name}: {line}");
            assert!(schema.describes(line), "{name}: a key has no description: {line}");
        }
    }
}

#[test]
fn every_event_is_described() {
    let schema = Schema::new();
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
    let schema = Schema::new();
    let lines = trace(&missions::valid(missions::shipped("unreachable")));
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
