//! Events read as sentences.

mod common;

use pleach::story;

#[test]
fn every_event_is_told() {
    let sentences: Vec<_> = common::every_event().iter().map(story::tell).collect();
    insta::assert_snapshot!(sentences.join("\n"));
}
