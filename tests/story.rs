//! Events read as sentences.

use crate::common::every_event;
use pleach::automaton::network::record::MissionEvent;
use pleach::story;
use std::collections::BTreeSet;

#[test]
fn every_event_is_told() {
    let sentences: Vec<_> = every_event().iter().map(story::tell).collect();
    insta::assert_snapshot!(sentences.join("\n"));
}

/// Events may be added to the format. Each of them has a sentence then, and a place in the test above.
#[test]
fn every_kind_of_event_has_a_sentence() {
    let refused = serde_json::from_str::<MissionEvent>(r#"{"event": "another"}"#).unwrap_err();
    let refused = refused.to_string();
    let kinds: BTreeSet<&str> = refused.split('`').skip(1).step_by(2).skip(1).collect();
    assert!(kinds.len() >= 14, "{refused}");
    let written: Vec<_> =
        every_event().iter().map(|event| serde_json::to_value(event).unwrap()).collect();
    let told: BTreeSet<&str> = written.iter().filter_map(|event| event["event"].as_str()).collect();
    assert_eq!(told, kinds);
    for event in every_event() {
        assert_ne!(story::tell(&event), format!("{event:?}"), "no sentence of its own");
    }
}
