//! A quick share of the fuzzing.

use crate::fuzzing::{Reader, read};

/// Inputs of each reader in every run.
const DAILY: u64 = 1_000;

#[test]
fn readers_answer_whatever_the_text() {
    for reader in Reader::ALL {
        let tally = read(reader, 1, DAILY).unwrap_or_else(|panic| panic!("{panic}"));
        assert!(tally.read > 0 && tally.refused > DAILY / 10, "{reader:?}: {tally:?}");
    }
}
