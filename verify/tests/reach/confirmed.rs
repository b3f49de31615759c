//! What checks find, and whether runs come there.

use pleach_automaton::check::Kind;
use pleach_automaton::{Automaton, Name, Record, from};
use pleach_verify::reach::{Confirmed, Effort, Reachability, Settings, confirm};

use super::support::Named;

/// A point that turns around the origin from (x, y). Beyond two boundaries it has to jump to different
/// places.
fn turning(x: f64, y: f64) -> Named {
    let state = Record::new([("x", x), ("y", y)]).unwrap();
    let coordinates = state.coordinates();
    let [x, y] = &coordinates[..] else { unreachable!() };
    let [turning, up, right] = ["turning", "up", "right"].map(Name::new);
    let [north, east] = ["north", "east"].map(Name::new);
    Automaton::starting_in(turning)
        .initially(state.clone())
        .range(x, -5.0..=5.0)
        .range(y, -5.0..=5.0)
        .flow(turning, [x.rate(-y), y.rate(x)])
        .transition(from(turning).on(north).to(up).must(y.at_least(0.9)))
        .transition(from(turning).on(east).to(right).must((x + y).at_least(2.5)))
        .build()
        .unwrap()
}

fn overlap(x: f64, y: f64) -> Confirmed {
    let automaton = turning(x, y);
    let settings = Settings { horizon: 8.0, ..Settings::default() };
    let found = confirm(&automaton, &automaton.check(), &[], &[], &settings, &Effort::default());
    let mut found = found.unwrap().into_iter();
    found.find(|one| one.finding.kind == Kind::Overlap).expect("the formulas admit it")
}

#[test]
fn a_finding_is_reachable_or_is_not() {
    // On the unit circle x + y is at most √2.
    assert!(matches!(overlap(1.0, 0.0).reachability, Reachability::Unreachable));
    // On this one x + y comes to 2.5 before y comes to 0.9, where it jumps.
    assert!(matches!(overlap(2.4, 0.0).reachability, Reachability::Unreachable));
    // Here both hold from the start.
    let Reachability::Reachable(run) = overlap(2.0, 1.0).reachability else {
        panic!("it is there")
    };
    assert_eq!((run.at.t, &run.state[..]), (0.0, &[2.0, 1.0][..]));
}
