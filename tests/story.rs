//! Events read as sentences.

use crate::common::every_event;
use pleach::story;

#[test]
fn every_event_is_told() {
    let sentences: Vec<_> = every_event().iter().map(story::tell).collect();
    insta::assert_snapshot!(sentences.join("\n"));
}
