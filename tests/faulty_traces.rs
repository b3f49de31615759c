//! Traces of missions with faults are judged by what must hold under any fault: sound ones pass, spoiled ones
//! do not.

use missions::{shipped, valid};
use pleach::automaton::network::record::{Faults, Outcome};
use pleach::automaton::network::{Crash, NodeFaults};
use pleach::automaton::node::MessageFaults;
use pleach::judge::{Verdict, judge};
use pleach::mission;
use pleach::page::of_trace;
use pleach::trace::{TraceReader, TraceWriter};
use pleach::verify::network::Property;
use pleach::verify::network::storm::{Kind, Storm, draw};
use serde_json::{Value, json};
use std::sync::OnceLock;

/// Three messages of ten are lost.
fn lossy() -> Storm {
    let messages = MessageFaults { loss: 0.3, ..MessageFaults::default() };
    Storm { seed: 1, messages, nodes: Vec::new() }
}

/// The trace of a mission in a storm, line by line.
fn trace_of(name: &str, storm: &Storm) -> Vec<Value> {
    let mut scenario = shipped(name);
    scenario.control.max_steps = Some(700);
    let scenario = valid(scenario);
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
    let scenario = valid(shipped("redundant-node"));
    let kinds = Kind::ALL.iter().filter(|kind| kind.errors(&scenario).are_none());
    for &kind in kinds.filter(|&&kind| kind != Kind::Clocks) {
        let mut storm = draw(kind, 3, &scenario, 100.0);
        storm.nodes.iter_mut().for_each(|(_, faults)| faults.shift = 0.0);
        assert!(!storm.faults().are_none(), "{}", kind.name());
        if let Verdict::Violated(violation) = verdict(&trace_of("redundant-node", &storm)) {
            panic!("{}: {violation}", kind.name());
        }
    }
}

#[test]
fn a_robot_that_stops_is_a_body_and_nothing_else() {
    let crash = Crash { time: 30.0, inputs: 0, back: Some(60.0) };
    let faults = NodeFaults { crash: Some(crash), ..NodeFaults::default() };
    let storm = Storm { nodes: vec![(3, faults)], ..lossy() };
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
    let mut creeps = lines;
    for line in creeps.iter_mut().filter(|line| line["type"] == "step" && line["k"] == 45) {
        line["position"][3][0] = json!(line["position"][3][0].as_f64().unwrap() + 1e-4);
    }
    let Verdict::Violated(violation) = verdict(&creeps) else { panic!("it is judged sound") };
    assert_eq!(violation.property, Property::Standstill, "{violation}");
}

/// The page says by what it judges, as the judge does, and shows when robots stop and restart.
#[test]
fn pages_of_missions_with_faults_say_so() {
    let crash = Crash { time: 30.0, inputs: 0, back: Some(60.0) };
    let faults = NodeFaults { crash: Some(crash), ..NodeFaults::default() };
    let storm = Storm { nodes: vec![(3, faults)], ..lossy() };
    let page_of = |lines: &[Value]| {
        let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
        of_trace(text.as_bytes()).unwrap()
    };
    let says = |page: &str| page.contains("; judged by what must hold under any fault</p>");
    let page = page_of(&trace_of("redundant-node", &storm));
    assert!(says(&page));
    for (at, event, text) in [
        (30, "stopped", "robot 3 has stopped, or is not received"),
        (60, "restarted", "robot 3 is back"),
    ] {
        let told = format!(r#"{{"at":{at},"event":"{event}","telling":true,"text":"{text}"}}"#);
        assert_eq!(page.matches(&told).count(), 1, "{told}");
        assert_eq!(page.matches(&format!(r#""event":"{event}""#)).count(), 1, "{event}");
    }
    let mut whole = sound();
    assert!(says(&page_of(&whole)));
    whole[0].as_object_mut().unwrap().remove("faults");
    assert!(!says(&page_of(&whole)));
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

const SPOILS: [Spoil; 14] = [
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
        "a task is announced twice",
        |lines| {
            let at = lines.iter().position(|line| line["event"] == "task_announced").unwrap();
            lines.insert(at, lines[at].clone());
        },
        Property::Events,
    ),
    (
        "no task has been serviced",
        |lines| lines.retain(|line| line["event"] != "task_serviced"),
        Property::Service,
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
        "a robot is absent, and no node fails",
        |lines| last_step(lines)["absent"] = json!([3]),
        Property::Record,
    ),
    (
        "there are more periods than the scenario allows",
        |lines| {
            let last = last_step(lines)["k"].clone();
            lines[0]["scenario"]["control"]["max_steps"] = last;
        },
        Property::Record,
    ),
    (
        "the mission of one team shows fleets",
        |lines| {
            last_step(lines)["fleets"] = json!([{
                "access_point": 0, "phase": "idle", "task": null, "active_team": [],
                "primary_team": [], "path": [],
            }]);
        },
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

/// What robots do for a task is judged as long as it is to be serviced.
#[test]
fn a_task_that_nobody_services_any_more_is_noticed() {
    let mut sound = trace_of("leaf-leader", &lossy());
    // Robots may be absent.
    sound[0]["faults"]["nodes"] = json!(true);
    let (at, begun) = event_of(&sound, "task_serviced", 0);
    let robot = sound[at]["robot"].clone();
    let found = |first: u64, spoil: &dyn Fn(&mut Value)| {
        let mut lines = sound.clone();
        let is_later = |line: &&mut Value| line["k"].as_u64().is_some_and(|step| step >= first);
        let steps = lines.iter_mut().filter(|line| line["type"] == "step");
        steps.filter(is_later).for_each(spoil);
        let Verdict::Violated(violation) = verdict(&lines) else { panic!("it is judged sound") };
        (violation.property, violation.sentence)
    };
    let (property, said) = found(begun + 1, &|line| line["absent"] = json!([robot]));
    assert_eq!(property, Property::Service, "{said}");
    let forgets = |line: &mut Value| {
        line["serviced"].as_array_mut().unwrap().retain(|held| held[0] != 0);
    };
    let (property, said) = found(begun, &forgets);
    assert_eq!(property, Property::Outcome);
    assert!(said.contains("no robot has serviced task 0 of late"), "{said}");
    let (property, said) = found(0, &|line| line["serviced"] = json!([[2, 1]]));
    assert_eq!(property, Property::Service, "{said}");
}

#[test]
fn no_node_is_absent_where_nothing_fails() {
    let mut lines = trace_of("redundant-node", &Storm::default());
    assert!(matches!(verdict(&lines), Verdict::Sound { .. }));
    last_step(&mut lines)["absent"] = json!([0]);
    let Verdict::Violated(violation) = verdict(&lines) else { panic!("it is judged sound") };
    assert_eq!(violation.property, Property::Record, "{violation}");
}

/// Errands, where the robot that services task 0 stops: the task is announced again, and another robot services it
/// for as long as it should be.
fn serviced_again() -> Vec<Value> {
    static TRACE: OnceLock<Vec<Value>> = OnceLock::new();
    let crash = Crash { time: 120.0, inputs: 0, back: None };
    let faults = NodeFaults { crash: Some(crash), ..NodeFaults::default() };
    let storm = Storm { seed: 1, messages: MessageFaults::default(), nodes: vec![(5, faults)] };
    TRACE.get_or_init(|| trace_of("errands", &storm)).clone()
}

/// Where the line of an event of a task stands, and the k that it states; the last one, if there are several.
fn event_of(lines: &[Value], event: &str, task: usize) -> (usize, u64) {
    let is_it = |line: &Value| line["event"] == event && line["task"] == task;
    let at = lines.iter().rposition(is_it).unwrap();
    (at, lines[at]["k"].as_u64().unwrap())
}

/// The end of task 0 is told in another control period.
fn with_end_at(step: u64) -> Vec<Value> {
    let mut lines = serviced_again();
    let (at, _) = event_of(&lines, "task_ended", 0);
    let mut ended = lines.remove(at);
    ended["k"] = json!(step);
    let before = lines.iter().position(|line| line["type"] == "step" && line["k"] == step).unwrap();
    lines.insert(before, ended);
    lines
}

#[test]
fn the_time_of_a_task_that_is_serviced_again_begins_anew() {
    let lines = serviced_again();
    let (first, ended) = (105, event_of(&lines, "task_ended", 0).1);
    let again = event_of(&lines, "task_serviced", 0).1;
    assert_eq!(ended, again + 80, "from the second service on");
    let is_first = |line: &&Value| line["event"] == "task_serviced" && line["task"] == 0;
    assert_eq!(lines.iter().find(is_first).unwrap()["k"], first);
    assert!(matches!(verdict(&with_end_at(ended)), Verdict::Sound { .. }));
    for step in [ended - 1, again + 9] {
        let Verdict::Violated(violation) = verdict(&with_end_at(step)) else { panic!("{step}") };
        let expected = format!("task 0 ends, and it is to end at k = {ended}");
        assert!(violation.to_string().contains(&expected), "{violation}");
    }
    let between = with_end_at(first + 80 + 200);
    let Verdict::Violated(violation) = verdict(&between) else { panic!("it is judged sound") };
    assert!(violation.to_string().contains("task 0 ends, and no robot services it"), "{violation}");
}

#[test]
fn a_task_that_is_serviced_has_been_announced() {
    let mut lines = serviced_again();
    let (at, _) = event_of(&lines, "task_announced", 3);
    lines.remove(at);
    let Verdict::Violated(violation) = verdict(&lines) else { panic!("it is judged sound") };
    assert_eq!(violation.property, Property::Events);
    let expected = "services task 3, and it has not been announced";
    assert!(violation.to_string().contains(expected), "{violation}");
}

#[test]
fn a_task_is_closed_once() {
    for (event, task) in [("task_ended", 0), ("task_withdrawn", 1)] {
        let mut lines = serviced_again();
        let (at, _) = event_of(&lines, event, task);
        let copy = lines[at].clone();
        lines.insert(at, copy);
        let Verdict::Violated(violation) = verdict(&lines) else { panic!("{event}") };
        assert_eq!(violation.property, Property::Events);
        assert!(violation.to_string().contains("it is over already"), "{violation}");
    }
}

#[test]
fn without_faults_nothing_in_a_trace_is_new() {
    let scenario = valid(shipped("redundant-node"));
    let write = |faults: Faults| {
        let writer = TraceWriter::with_faults(Vec::new(), &scenario, faults).unwrap();
        String::from_utf8(writer.finish().unwrap()).unwrap()
    };
    assert!(!write(Faults::default()).contains("faults"));
    assert!(write(Faults { messages: true, nodes: false }).contains("faults"));
}
