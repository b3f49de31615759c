//! Coverage counts what runs went through, neither more nor less.

use crate::common::classics::{ball, gears, house, thermostat};
use pleach_automaton::{Coverage, CoverageError, diagram};

#[test]
fn every_jump_is_counted_once() {
    let run = house().run(60.0).expect("it can be run");
    let mut coverage = Coverage::of(&house()).expect("guards fit");
    coverage.add(&run).expect("it is a run of this composition");
    coverage.add(&run).expect("it is a run of this composition");
    assert_eq!(coverage.runs(), 2);
    let moves: usize = run.jumps().iter().map(|jump| jump.moves.len()).sum();
    let taken = coverage.components().iter().flat_map(|one| one.transitions());
    assert_eq!(taken.map(|transition| transition.taken()).sum::<usize>(), 2 * moves);
    let entered = coverage.components().iter().flat_map(|one| one.locations());
    let starts = 2; // one of each component
    assert_eq!(entered.map(|location| location.entered()).sum::<usize>(), 2 * (moves + starts),);
    assert!(coverage.is_complete(), "{coverage}");
}

#[test]
fn guards_are_seen_from_the_sides_that_the_samples_lie_on() {
    // Up to 22 °C takes longer than two seconds: nothing is known of the guard that switches off.
    let run = thermostat().run(2.0).expect("it can be run");
    let mut coverage = Coverage::of_automaton(&thermostat()).expect("guards fit");
    coverage.add(&run).expect("it is a run of this automaton");
    let expected = "\
automaton: 2 of 2 locations, 1 of 2 transitions, 1 of 2 location pairs, 3 of 4 sides of boundaries

| transition | event | taken | guard |
| --- | --- | --- | --- |
| off → on | turn on | 1 | T ≤ 18: both sides |
| on → off | turn off | 0 | T ≥ 22: only false |
";
    assert_eq!(coverage.to_string(), expected);
    assert!(!coverage.is_complete());
}

#[test]
fn pairs_of_locations_are_counted_over_all_transitions_that_join_them() {
    let run = gears().run(60.0).expect("it can be run");
    let mut coverage = Coverage::of_automaton(&gears()).expect("guards fit");
    coverage.add(&run).expect("it is a run of this automaton");
    let passed: Vec<_> =
        coverage.components()[0].pairs().into_iter().filter(|(.., passed)| *passed > 0).collect();
    let expected = [
        ("first", "second", 1),
        ("second", "third", 1),
        ("third", "fourth", 1),
        ("fourth", "fourth", 6), // from 28.3 s on every five seconds
    ];
    assert_eq!(passed, expected);
}

#[test]
fn what_is_left_out_is_red() {
    let nothing = Coverage::of_automaton(&gears()).expect("guards fit");
    let transitions = nothing.components()[0].transitions().len();
    let picture = diagram::coverage_svg(&gears(), &nothing.components()[0]);
    assert_eq!(picture.matches("never taken").count(), transitions);
    assert_eq!(picture.matches("url(#missed-head)").count(), transitions);
    assert_eq!(picture.matches("class=\"location missed\"").count(), 4);

    let mut coverage = nothing.clone();
    coverage.add(&gears().run(60.0).expect("it can be run")).expect("it is a run of the gears");
    let picture = diagram::coverage_svg(&gears(), &coverage.components()[0]);
    assert_eq!(picture.matches("never taken").count(), transitions - 4);
    assert_eq!(picture.matches("class=\"location missed\"").count(), 0);
}

#[test]
fn runs_of_something_else_are_refused() {
    let mut coverage = Coverage::of_automaton(&thermostat()).expect("guards fit");
    let run = ball().run(1.0).expect("it can be run");
    let other = CoverageError::OtherComposition { part: "locations" };
    assert_eq!(coverage.add(&run), Err(other));
    let run = house().run(1.0).expect("it can be run");
    let error = coverage.add(&run).expect_err("it is a run of two components");
    assert_eq!(
        error.to_string(),
        "the trajectory is of another composition: its components differ"
    );
    assert_eq!(coverage.runs(), 0);
}
