//! Running a harness.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::case::{self, Ended, Odometer, Source};
use crate::dice::Dice;

/// Combinations after which going through all of them is given up.
pub const MOST_CASES: u64 = 1_000_000;

/// Cases that are drawn at random where there are too many to go through them.
pub const RANDOM_CASES: u64 = 100_000;

/// Runs the body of a harness on concrete values: all of them, or many.
///
/// # Panics
///
/// If the body panics, with the name of the harness and the values drawn; if no case meets the
/// assumptions; if one of the `covers` covers in the body is never satisfied, or there is none; and if
/// `proofs/harnesses.toml` has other numbers of cases and values.
pub fn run(harness: &str, covers: usize, body: impl Fn()) {
    assert!(covers > 0, "harness `{harness}` has no cover!: it could hold vacuously");
    case::begin(Source::Enumeration(Odometer::default()));
    let (kind, count) = match run_every_case(harness, &body) {
        Some(count) => ("all", count),
        None => ("random", run_random_cases(harness, &body)),
    };
    let lines: Vec<u32> = case::with(|case| case.covered.iter().map(|place| place.1).collect());
    assert!(
        lines.len() >= covers,
        "harness `{harness}`: {} of {covers} covers are ever satisfied, in lines {lines:?}",
        lines.len()
    );
    let values = case::with(|case| case.values);
    println!("{harness}: {kind} {count} cases of {values} values at the most");
    if let Some(listed) = listed(harness) {
        let cases = if kind == "all" { format!("cases = {count}\n") } else { String::new() };
        let found = format!("\nvalues = {values}\n{cases}");
        let is_listed = listed.contains(&found) && listed.contains("\ncases") == (kind == "all");
        assert!(is_listed, "harness `{harness}`: proofs/harnesses.toml should say:{found}");
    }
}

/// What the list of harnesses says of one.
fn listed(harness: &str) -> Option<&'static str> {
    const LIST: &str = include_str!("../../harnesses.toml");
    let mut entries = LIST.split("[[harness]]").skip(1);
    entries.find(|entry| entry.contains(&format!("\nname = \"{harness}\"\n")))
}

/// How many cases met the assumptions; none if there are too many cases.
fn run_every_case(harness: &str, body: &impl Fn()) -> Option<u64> {
    let (mut met, mut tried) = (0, 0);
    loop {
        match run_case(harness, body) {
            Ok(()) => met += 1,
            Err(Ended::Rejected) => {}
            Err(Ended::TooMany) => return None,
        }
        tried += 1;
        let goes_on = case::with(|case| match &mut case.source {
            Source::Enumeration(odometer) => odometer.advance(),
            Source::Chance(_) => false,
        });
        if !goes_on {
            return Some(met);
        }
        if tried == MOST_CASES {
            return None;
        }
    }
}

fn run_random_cases(harness: &str, body: &impl Fn()) -> u64 {
    /// Cases that may be dropped for one that meets the assumptions.
    const PATIENCE: u64 = 100;
    let (mut met, mut tried) = (0, 0);
    while met < RANDOM_CASES {
        assert!(
            tried < PATIENCE * RANDOM_CASES,
            "harness `{harness}`: {met} of {tried} random cases meet its assumptions"
        );
        case::with(|case| case.source = Source::Chance(Dice::new(tried)));
        tried += 1;
        if run_case(harness, body).is_ok() {
            met += 1;
        }
    }
    met
}

fn run_case(harness: &str, body: &impl Fn()) -> Result<(), Ended> {
    case::with(|case| case.drawn.clear());
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(()) => {
            case::with(|case| case.values = case.values.max(case.drawn.len()));
            Ok(())
        }
        Err(payload) => match payload.downcast::<Ended>() {
            Ok(reason) => Err(*reason),
            Err(_) => {
                let drawn = case::with(|case| case.drawn.clone());
                let drawn: Vec<String> = drawn.iter().map(ToString::to_string).collect();
                panic!("harness `{harness}` fails for the draws [{}]", drawn.join(", "))
            }
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    fn failure(body: impl Fn()) -> String {
        let outcome = catch_unwind(AssertUnwindSafe(|| run("sample", 1, &body)));
        let payload = outcome.expect_err("the harness fails");
        payload.downcast_ref::<String>().cloned().unwrap_or_default()
    }

    #[test]
    fn every_combination_is_run_once() {
        let cases = Cell::new(0);
        let pairs = Cell::new(0_u64);
        run("pairs", 1, || {
            let first: u8 = crate::any_where(|value| *value < 4);
            let second: u8 = crate::any_where(|value| *value < first);
            crate::cover!(first == 3 && second == 2);
            cases.set(cases.get() + 1);
            pairs.set(pairs.get() | 1 << (4 * first + second));
        });
        assert_eq!((cases.get(), pairs.get().count_ones()), (6, 6));
    }

    #[test]
    fn a_failure_names_the_draws() {
        let message = failure(|| {
            let number: i8 = crate::any();
            crate::cover!(number == 0);
            assert!(number < 3);
        });
        assert_eq!(message, "harness `sample` fails for the draws [3]");
    }

    #[test]
    fn a_harness_that_covers_nothing_fails() {
        let message = failure(|| {
            let is_on: bool = crate::any();
            crate::assume(is_on);
            crate::cover!(!is_on);
        });
        assert_eq!(message, "harness `sample`: 0 of 1 covers are ever satisfied, in lines []");
    }

    #[test]
    fn wide_domains_are_sampled() {
        let cases = Cell::new(0);
        run("wide", 2, || {
            let number: i64 = crate::any();
            crate::cover!(number == i64::MAX);
            let other: f64 = crate::any();
            crate::cover!(other.is_nan());
            cases.set(cases.get() + 1);
        });
        assert_eq!(cases.get(), RANDOM_CASES);
    }
}
