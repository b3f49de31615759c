//! Traces of missions with faults are judged by what no fault may break: sound ones pass, spoiled ones
//! do not.

use crate::missions::shipped;
use pleach::automaton::network::record::{Faults, Outcome};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{Crash, Trouble};
use pleach::automaton::node::Weather;
use pleach::judge::{Verdict, judge};
use pleach::mission;
use pleach::trace::{TraceReader, TraceWriter};
use pleach::verify::network::Property;
use pleach::verify::network::storm::{Kind, Storm, draw};
use serde_json::{Value, json};
use std::sync::OnceLock;

/// Three messages of ten are lost.
fn lossy() -> Storm {
    let weather = Weather { loss: 0.3, ..Weather::default() };
    Storm { seed: 1, weather, troubles: Vec::new() }
}

/// The trace of a mission in a storm, line by line.
fn trace_of(name: &str, storm: &Storm) -> Vec<Value> {
    let mut scenario = shipped(name);
    scenario.control.max_steps = Some(700);
    let scenario = ValidScenario::new(scenario).unwrap();
    let mut writer = TraceWriter::with_faults(Vec::new(), &scenario, storm.faults()).unwrap();
    mission::run_in_storm(&scenario, storm, &mut [&mut writer]).unwrap();
    let bytes = writer.finish().unwrap();
    let text = String::from_utf8(bytes).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn verdict(lines: &[Value]) -> Verdict {
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    judge(TraceReader::new(text.as_bytes()).unwrap()).unwrap()
}

/// A mission with losses that is serviced.
fn sound() -> Vec<Value> {
    static TRACE: OnceLock<Vec<Value>> = OnceLock::new();
    TRACE.get_or_init(|| trace_of("redundant-node", &lossy())).clone()
}

#[test]
fn a_mission_with_losses_is_sound_by_what_no_loss_breaks_and_not_by_all_definitions() {
    let mut lines = sound();
    assert_eq!(lines[0]["faults"], json!({ "messages": true, "nodes": false }));
    match verdict(&lines) {
        Verdict::Sound { end, .. } => assert_eq!(end.outcome, Outcome::Serviced),
        Verdict::Violated(violation) => panic!("{violation}"),
    }
    lines[0].as_object_mut().unwrap().remove("faults");
    assert!(matches!(verdict(&lines), Verdict::Violated(_)), "robots cannot know all without loss");
}

/// A trace has one line for each control period, and so no place for clocks that are not aligned.
#[test]
fn nothing_is_violated_in_storms_of_all_kinds() {
    let scenario = ValidScenario::new(shipped("redundant-node")).unwrap();
    let kinds = Kind::ALL.iter().filter(|kind| kind.errors(&scenario).are_none());
    for &kind in
        kinds.filter(|kind| !matches!(kind, Kind::Partition | Kind::Clocks | Kind::Everything))
    {
        let mut storm = draw(kind, 3, &scenario, 100.0);
        storm.weather.partitions.clear();
        assert!(!storm.faults().are_none(), "{}", kind.name());
        if let Verdict::Violated(violation) = verdict(&trace_of("redundant-node", &storm)) {
            panic!("{}: {violation}", kind.name());
        }
    }
}

#[test]
fn a_robot_that_stops_is_a_body_and_nothing_else() {
    let crash = Crash { time: 30.0, inputs: 0, back: Some(60.0) };
    let trouble = Trouble { crash: Some(crash), ..Trouble::default() };
    let storm = Storm { troubles: vec![(3, trouble)], ..lossy() };
    let lines = trace_of("redundant-node", &storm);
    assert_eq!(lines[0]["faults"], json!({ "messages": true, "nodes": true }));
    for line in lines.iter().filter(|line| line["type"] == "step") {
        let is_down = (30..60).contains(&line["k"].as_u64().unwrap());
        assert_eq!(line.get("absent"), is_down.then(|| json!([3])).as_ref(), "{}", line["k"]);
        if is_down {
            let names = |list: &Value| list.as_array().unwrap().iter().any(names_three);
            assert!(!names(&line["route"]) && !names(&line["tree"]), "{}", line["k"]);
        }
    }
    assert!(matches!(verdict(&lines), Verdict::Sound { .. }));
}

/// Whether a route or an edge of the tree begins or ends at robot 3.
fn names_three(ends: &Value) -> bool {
    ends[0] == 3 || ends[1] == 3
}

type Spoil = (&'static str, fn(&mut Vec<Value>), Property);

/// The last step that has a route between robots.
fn last_step(lines: &mut [Value]) -> &mut Value {
    let is_step = |line: &&mut Value| line["type"] == "step";
    lines.iter_mut().rev().find(is_step).unwrap()
}

const SPOILS: [Spoil; 10] = [
    (
        "a robot leaps",
        |lines| {
            let x = last_step(lines)["position"][0][0].as_f64().unwrap();
            last_step(lines)["position"][0][0] = json!(x + 0.06);
        },
        Property::StepLength,
    ),
    (
        "two robots are in one place",
        |lines| {
            let step = last_step(lines);
            step["position"][1] = step["position"][0].clone();
        },
        Property::Separation,
    ),
    (
        "a robot sends more than all the time",
        |lines| last_step(lines)["route"][0][2] = json!(1.5),
        Property::Shares,
    ),
    (
        "a robot is sent more than it passes on",
        |lines| {
            let route = last_step(lines)["route"].as_array_mut().unwrap();
            let relay = route.iter().find(|it| it[1].as_u64() < Some(6)).unwrap()[1].clone();
            route.retain(|it| it[0] != relay);
        },
        Property::Residual,
    ),
    (
        "a robot is attached to one that is out of range",
        |lines| {
            let tree = last_step(lines)["tree"].as_array_mut().unwrap();
            tree.iter_mut().for_each(|edge| edge[1] = json!(7));
        },
        Property::TreeRange,
    ),
    (
        "a task is serviced from elsewhere",
        |lines| {
            let event = lines.iter_mut().find(|line| line["event"] == "task_serviced").unwrap();
            event["robot"] = json!((event["robot"].as_u64().unwrap() + 1) % 6);
        },
        Property::Events,
    ),
    (
        "no task has been serviced",
        |lines| lines.retain(|line| line["event"] != "task_serviced"),
        Property::Outcome,
    ),
    (
        "the mission is given up, and all tasks are serviced",
        |lines| {
            let end = lines.last_mut().unwrap();
            (end["outcome"], end["task"]) = (json!("blocked"), json!(0));
        },
        Property::Outcome,
    ),
    (
        "a control period is left out",
        |lines| lines.retain(|line| line["k"] != 20),
        Property::Record,
    ),
    (
        "a robot that does not exist is absent",
        |lines| last_step(lines)["absent"] = json!([40]),
        Property::Record,
    ),
];

#[test]
fn spoiled_traces_with_losses_are_refused() {
    for (name, spoil, property) in SPOILS {
        let mut lines = sound();
        spoil(&mut lines);
        match verdict(&lines) {
            Verdict::Violated(violation) => assert_eq!(violation.property, property, "{name}"),
            Verdict::Sound { .. } => panic!("{name}: it is judged sound"),
        }
    }
}

#[test]
fn a_task_is_announced_when_those_before_it_have_been_serviced() {
    let mut lines = trace_of("leaf-leader", &lossy());
    assert!(matches!(verdict(&lines), Verdict::Sound { .. }));
    lines.retain(|line| line["event"] != "task_serviced" || line["task"] != 1);
    let Verdict::Violated(violation) = verdict(&lines) else { panic!("it is judged sound") };
    assert_eq!(violation.property, Property::Events);
    assert!(violation.to_string().contains("task 1 has not been serviced"), "{violation}");
}

#[test]
fn without_faults_nothing_in_a_trace_is_new() {
    let scenario = ValidScenario::new(shipped("redundant-node")).unwrap();
    let write = |faults: Faults| {
        let writer = TraceWriter::with_faults(Vec::new(), &scenario, faults).unwrap();
        String::from_utf8(writer.finish().unwrap()).unwrap()
    };
    assert!(!write(Faults::default()).contains("faults"));
    assert!(write(Faults { messages: true, nodes: false }).contains("faults"));
}
