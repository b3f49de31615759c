//! What is written into a trace can be read back, and is the same to the byte.

use crate::common::{end, every_event, reports, room, show};
use missions::{shipped, traced, valid};
use pleach::automaton::network::record::{End, Outcome, Snapshot};
use pleach::automaton::network::scenario::{Settings, Strategy};
use pleach::judge::{Verdict, judge};
use pleach::mission::Watcher;
use pleach::trace::{TraceEntry, TraceError, TraceReader, TraceWriter};
use pleach::verify::network::Property;
use proptest::prelude::*;

fn written() -> String {
    let mut writer = TraceWriter::new(Vec::new(), &room()).unwrap();
    show(&mut writer);
    String::from_utf8(writer.finish().unwrap()).unwrap()
}

#[test]
fn a_trace_looks_as_the_format_says() {
    insta::assert_snapshot!(written());
}

#[test]
fn a_trace_is_the_same_to_the_byte() {
    assert_eq!(written(), written());
}

#[test]
fn what_is_read_is_what_was_written() {
    let text = written();
    let reader = TraceReader::new(text.as_bytes()).unwrap();
    assert_eq!(reader.scenario(), &room().with_defaults());
    assert_eq!(Settings::resolve(reader.scenario()), Settings::resolve(&room()));

    let mut expected = Vec::new();
    for report in reports() {
        let step = report.snapshot.step;
        expected.extend(report.events.into_iter().map(|event| TraceEntry::Event { step, event }));
        expected.push(TraceEntry::Step(Box::new(report.snapshot)));
    }
    expected.push(TraceEntry::End(end()));
    let entries: Vec<_> = reader.collect::<Result<_, _>>().unwrap();
    assert_eq!(entries, expected);
}

/// Other programs may write the keys of an object in the order of the alphabet.
#[test]
fn keys_may_come_in_any_order() {
    let text = written();
    let sorted = |line: &str| serde_json::from_str::<serde_json::Value>(line).unwrap().to_string();
    let other: Vec<String> = text.lines().map(sorted).collect();
    let [read, again] = [text, other.join("\n")].map(|text| {
        let reader = TraceReader::new(text.as_bytes()).unwrap();
        (reader.scenario().clone(), reader.collect::<Result<Vec<_>, _>>().unwrap())
    });
    assert!(!other.iter().any(|line| line.starts_with("{\"type\"")));
    assert_eq!(read, again);
}

#[test]
fn a_line_has_one_type() {
    for twice in [r#"{"type":"step","k":0,"type":"end"}"#, r#"{"k":0,"type":"step","type":"end"}"#]
    {
        let text = written();
        let text = format!("{}\n{twice}\n", text.lines().next().unwrap());
        let wrong = TraceReader::new(text.as_bytes()).unwrap().next().unwrap().unwrap_err();
        assert!(wrong.to_string().contains("duplicate field `type`"), "{wrong}");
    }
}

/// Traces of older builds do not say where robots are in their automata.
#[test]
fn a_trace_without_views_of_robots_is_read() {
    let text = written();
    let older = text.lines().map(|line| {
        let mut line: serde_json::Value = serde_json::from_str(line).unwrap();
        let fields = line.as_object_mut().unwrap();
        for name in ["location", "exchange", "known_phase", "target", "sent", "heard"] {
            fields.remove(name);
        }
        format!("{line}\n")
    });
    let older: String = older.collect();
    let entries = TraceReader::new(older.as_bytes()).unwrap().map(Result::unwrap);
    let steps = entries.filter_map(|entry| match entry {
        TraceEntry::Step(snapshot) => Some(*snapshot),
        _ => None,
    });
    let expected =
        reports().into_iter().map(|report| Snapshot { robots: vec![], ..report.snapshot });
    assert!(steps.eq(expected));
    assert!(pleach::page::of_trace(older.as_bytes()).unwrap().contains("not recorded"));
}

/// Traces of older builds leave the strategy out where it is that of the paper, and are judged by its order.
#[test]
fn a_trace_that_states_no_strategy_is_in_the_papers_order() {
    for strategy in [Strategy::Paper, Strategy::Eager] {
        let mut scenario = shipped("too-few");
        scenario.control.strategy = Some(strategy);
        let (bytes, _) = traced(&valid(scenario));
        let text = String::from_utf8(bytes).unwrap();
        let reader = TraceReader::new(text.as_bytes()).unwrap();
        assert_eq!(reader.scenario().control.strategy, Some(strategy));
        assert!(matches!(judge(reader).unwrap(), Verdict::Sound { .. }), "{strategy:?}");

        let (header, rest) = text.split_once('\n').unwrap();
        let mut header: serde_json::Value = serde_json::from_str(header).unwrap();
        let control = header["scenario"]["control"].as_object_mut().unwrap();
        assert!(control.remove("strategy").is_some(), "a header states every default");
        let older = format!("{header}\n{rest}");
        let reader = TraceReader::new(older.as_bytes()).unwrap();
        assert_eq!(reader.scenario().control.strategy, Some(Strategy::Paper));
        match (strategy, judge(reader).unwrap()) {
            (Strategy::Paper, Verdict::Sound { .. }) => {}
            (Strategy::Eager, Verdict::Violated(it)) if it.property == Property::Events => {}
            (_, verdict) => panic!("{strategy:?}: {verdict:?}"),
        }
    }
}

#[test]
fn every_kind_of_event_survives() {
    let snapshot = reports()[1].snapshot.clone();
    let mut writer = TraceWriter::new(Vec::new(), &room()).unwrap();
    writer.observe(&snapshot, &every_event()).unwrap();
    let text = writer.finish().unwrap();
    let read: Vec<_> = TraceReader::new(text.as_slice()).unwrap().map(Result::unwrap).collect();
    let events = every_event().into_iter().map(|event| TraceEntry::Event { step: 1, event });
    let expected: Vec<_> = events.chain([TraceEntry::Step(Box::new(snapshot))]).collect();
    assert_eq!(read, expected);
}

#[test]
fn an_end_with_a_reason_keeps_it() {
    let reason = "no recruit is left: 2 more are needed".to_owned();
    let end = End::new(Outcome::InsufficientRobots, reason, Some(1));
    let mut writer = TraceWriter::new(Vec::new(), &room()).unwrap();
    writer.end(&end).unwrap();
    let text = String::from_utf8(writer.finish().unwrap()).unwrap();
    assert!(text.ends_with(
        "{\"type\":\"end\",\"outcome\":\"insufficient_robots\",\
         \"reason\":\"no recruit is left: 2 more are needed\",\"task\":1}\n"
    ));
    let entries: Vec<_> = TraceReader::new(text.as_bytes()).unwrap().collect();
    assert!(matches!(&entries[..], [Ok(TraceEntry::End(read))] if *read == end));
}

/// The last line of a run that was killed is not an entry until it is whole, and nothing wrong either.
#[test]
fn a_trace_that_breaks_off_is_read_up_to_there() {
    let text = written();
    let header = text.find('\n').unwrap() + 1;
    for end in (header..text.len()).filter(|&end| text.is_char_boundary(end)) {
        let (killed, whole_lines) = (&text[..end], text[header..=end].matches('\n').count());
        let entries: Result<Vec<_>, _> = TraceReader::new(killed.as_bytes()).unwrap().collect();
        assert_eq!(entries.unwrap().len(), whole_lines, "{end}");
        assert!(pleach::page::of_trace(killed.as_bytes()).is_ok(), "{end}");
    }
    let spoiled = format!("{}\n", &text[..text.len() - 9]);
    let last = TraceReader::new(spoiled.as_bytes()).unwrap().last().unwrap();
    assert!(matches!(last, Err(TraceError::NotALine { .. })), "{last:?}");
}

#[test]
fn what_is_not_a_trace_is_refused() {
    let refused = |text: &str| TraceReader::new(text.as_bytes()).unwrap_err();
    assert!(matches!(refused(""), TraceError::Empty));
    assert!(matches!(refused("hello"), TraceError::NotATrace { .. }));
    assert_eq!(
        refused("name = \"room\"").to_string(),
        "line 1: not the header of a trace, which `pleach run --trace FILE` writes first: expected \
         ident in column 2"
    );
    let other = written().replacen("\"version\":1", "\"version\":2", 1);
    assert!(matches!(refused(&other), TraceError::OtherFormat { version: 2, .. }));
    let headless = written().split_once('\n').unwrap().1.to_owned();
    assert!(matches!(refused(&headless), TraceError::Misplaced { line: 1, .. }));

    let uneven = written().replacen("[\"redundant\",\"leader\"]", "[\"redundant\"]", 1);
    let error = TraceReader::new(uneven.as_bytes()).unwrap().find_map(Result::err).unwrap();
    assert_eq!(
        error.to_string(),
        "line 5: role has 1 elements where position has 2: one for each robot"
    );
    let unknown = written().replacen("\"leading the team\"", "\"asleep\"", 1);
    let error = TraceReader::new(unknown.as_bytes()).unwrap().find_map(Result::err).unwrap();
    assert_eq!(error.to_string(), "line 5: no location is called \"asleep\"");
}

proptest! {
    #[test]
    fn every_number_survives(
        numbers in prop::collection::vec(prop::num::f64::NORMAL | prop::num::f64::ZERO, 4),
    ) {
        let mut snapshot = reports()[0].snapshot.clone();
        snapshot.positions[0] = [numbers[0], numbers[1]].into();
        snapshot.residuals[0] = numbers[2];
        snapshot.routes[0].share = numbers[3];
        let mut writer = TraceWriter::new(Vec::new(), &room()).unwrap();
        writer.observe(&snapshot, &[]).unwrap();
        let text = writer.finish().unwrap();
        let entry = TraceReader::new(text.as_slice()).unwrap().next().unwrap().unwrap();
        prop_assert_eq!(entry, TraceEntry::Step(Box::new(snapshot)));
    }
}
