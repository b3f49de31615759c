//! A mission that is given up comes with a certificate, and the judge takes no false one.

use missions::{read, run, shipped, traced, valid};
use pleach::automaton::network::record::Outcome;
use pleach::automaton::network::scenario::Scenario;
use pleach::automaton::network::scenario::Unreachable;
use pleach::judge::{Verdict, judge};
use pleach::trace::TraceReader;
use pleach::verify::network::Property;
use serde_json::Value;

/// A scenario that is given up, with the outcome and the kind of certificate.
fn given_up() -> Vec<(Scenario, Outcome, &'static str)> {
    let kept = |name: &str| read(format!("tests/scenarios/{name}")).into_scenario();
    let mut pair = shipped("too-few");
    pair.robot.truncate(2);
    // A robot that sends all the time has none left for a link that becomes longer.
    let mut reserved = shipped("two-teams");
    reserved.control.routing_reserve = Some(0.3);
    vec![
        (shipped("unreachable"), Outcome::UnreachableTask, "unreachable"),
        (kept("touching/cut-in-two.toml"), Outcome::UnreachableTask, "unreachable"),
        (pair, Outcome::InsufficientRobots, "bound"),
        (shipped("too-few"), Outcome::InsufficientRobots, "tried"),
        (kept("given-up/wrong-order.toml"), Outcome::Blocked, "blocked"),
        (kept("given-up/given-up-beside-another-fleet.toml"), Outcome::InsufficientRobots, "tried"),
        (kept("saturated.toml"), Outcome::Blocked, "tried"),
        (kept("given-up/body-in-corridor.toml"), Outcome::Blocked, "blocked"),
        (reserved, Outcome::Blocked, "blocked"),
    ]
}

/// The lines of the trace of a mission.
fn trace(scenario: Scenario) -> Vec<String> {
    let text = String::from_utf8(traced(&valid(scenario)).0).unwrap();
    text.lines().map(str::to_owned).collect()
}

/// What the judge says of a trace whose last line is replaced; none if it cannot be read.
fn verdict(lines: &[String], end: &Value) -> Option<Verdict> {
    let (_, before) = lines.split_last().unwrap();
    let text = format!("{}\n{end}\n", before.join("\n"));
    judge(TraceReader::new(text.as_bytes()).unwrap()).ok()
}

/// Every certificate that differs from this one in a single number, word or truth value, or lacks one element
/// of a list; lists of hindrances may be shorter, since each claim stands alone.
fn changed(value: &Value) -> Vec<(String, Value)> {
    let below = |key: String, within: &Value, put: &dyn Fn(Value) -> Value| {
        changed(within)
            .into_iter()
            .map(|(at, new)| (format!("{key}/{at}"), put(new)))
            .collect::<Vec<_>>()
    };
    match value {
        Value::Object(entries) => {
            let of = |(key, within): (&String, &Value)| {
                let mut found = below(key.clone(), within, &|new| {
                    let mut entries = entries.clone();
                    entries.insert(key.clone(), new);
                    Value::Object(entries)
                });
                if key == "hindrances" {
                    found.retain(|(at, _)| !at.ends_with("left out"));
                }
                found
            };
            entries.iter().flat_map(of).collect()
        }
        Value::Array(elements) => {
            let of = |(at, within): (usize, &Value)| {
                let mut found = below(at.to_string(), within, &|new| {
                    let mut elements = elements.clone();
                    elements[at] = new;
                    Value::Array(elements)
                });
                let mut fewer = elements.clone();
                fewer.remove(at);
                found.push((format!("{at} left out"), Value::Array(fewer)));
                found
            };
            elements.iter().enumerate().flat_map(of).collect()
        }
        Value::Number(number) => match number.as_u64() {
            Some(count) => vec![("one more".into(), (count + 1).into())],
            None => vec![("more".into(), (number.as_f64().unwrap() + 0.01).into())],
        },
        Value::String(_) => vec![("another word".into(), "another".into())],
        Value::Bool(is_so) => vec![("not so".into(), (!is_so).into())],
        Value::Null => Vec::new(),
    }
}

/// The end with another certificate, or none; of several fleets, that which gave up has it, too.
fn replace(end: &mut Value, certificate: Option<&Value>) {
    let put = |end: &mut Value| {
        let entries = end.as_object_mut().unwrap();
        match certificate {
            Some(certificate) => entries.insert("certificate".into(), certificate.clone()),
            None => entries.remove("certificate"),
        };
    };
    put(end);
    let fleets = end.get_mut("fleets").and_then(Value::as_array_mut);
    let gave_up = fleets.into_iter().flatten().filter(|fleet| fleet["outcome"] != "serviced");
    gave_up.for_each(put);
}

#[test]
fn every_end_that_is_given_up_comes_with_a_certificate_and_false_ones_are_refused() {
    for (mut scenario, outcome, kind) in given_up() {
        scenario.mission.unreachable = Some(Unreachable::End);
        let name = scenario.name.clone();
        let lines = trace(scenario);
        let end: Value = serde_json::from_str(lines.last().unwrap()).unwrap();
        assert_eq!(end["outcome"], outcome.name(), "{name}: {end}");
        assert_eq!(end["certificate"]["kind"], kind, "{name}: {end}");
        let sound = verdict(&lines, &end);
        assert!(matches!(sound, Some(Verdict::Sound { .. })), "{name}: {sound:?}");

        let refused = |certificate: Option<Value>| {
            let mut spoiled = end.clone();
            replace(&mut spoiled, certificate.as_ref());
            match verdict(&lines, &spoiled) {
                Some(Verdict::Violated(violation)) => violation.property == Property::Outcome,
                Some(Verdict::Sound { .. }) => false,
                None => true,
            }
        };
        assert!(refused(None), "{name}: without a certificate");
        let changes = changed(&end["certificate"]);
        assert!(changes.len() > 4, "{name}");
        // Each is judged with the whole record: of many, some are taken, always the same.
        let every = changes.len().div_ceil(40);
        for (change, certificate) in changes.into_iter().step_by(every) {
            assert!(refused(Some(certificate)), "{name}: {change}");
        }
    }
}

/// The task lies in a thin wall, nearer to the side on which no robot is, and within δ of the other.
#[test]
fn a_task_in_a_wall_is_serviced_from_the_side_where_the_robots_are() {
    let mut scenario = read("tests/scenarios/touching/cut-in-two.toml").into_scenario();
    scenario.workspace.holes = vec![vec![[1.0, 0.0], [1.02, 0.0], [1.02, 1.0], [1.0, 1.0]]];
    scenario.task[0].position = [1.015, 0.5];
    assert!(
        valid(scenario.clone())
            .remarks()
            .iter()
            .all(|remark| !remark.to_string().contains("no robot can service"))
    );
    run(scenario.clone()).assert_serviced();
    scenario.task[0].position = [1.025, 0.5];
    assert_eq!(run(scenario).end.outcome, Outcome::UnreachableTask);
}
