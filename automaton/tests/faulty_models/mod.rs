//! A planted set of faulty models: each fault is found where it is, and nothing else is; witnesses
//! are tried out on the model itself. On sound models there is nothing to find.

mod components;
mod confirm;
mod planted;
mod sound;

use pleach_automaton::check::{Report, Severity};
use pleach_automaton::{Automaton, Builder, coordinates, from};
use pleach_discrete::vocabulary;

vocabulary! {
    enum Room: Location { A = "a", B = "b", C = "c" }
    enum Cue: Event { Go = "go", Back = "back", Turn = "turn", On = "on" }
}
coordinates! {
    struct Point { x, y }
}

type Machine = Automaton<Room, Cue, Point>;
type Parts = Builder<Room, Cue, Point>;

const ORIGIN: Point = Point { x: 0.0, y: 0.0 };

/// Begins in `a` at the origin, within 100 of it.
fn machine() -> Parts {
    let Point { x, y } = Point::coordinates();
    Automaton::starting_in(Room::A)
        .initially(ORIGIN)
        .range(&x, -100.0..=100.0)
        .range(&y, -100.0..=100.0)
}

/// The errors and warnings, each as severity, kind and place.
fn faults(report: &Report) -> Vec<String> {
    let faults = report.findings().iter().filter(|one| one.severity != Severity::Note);
    faults.map(|one| format!("{}: {}: {}", one.severity, one.kind, one.place)).collect()
}

/// How many notes there are.
fn notes(report: &Report) -> usize {
    report.of(Severity::Note).count()
}

#[test]
fn a_report_reads_as_a_list() {
    let Point { x, .. } = Point::coordinates();
    let machine = machine()
        .flow(Room::A, x.rate(1.0))
        .invariant(Room::A, x.at_most(1.0))
        .transition(from(Room::A).on(Cue::Go).to(Room::A).may(x.at_least(200.0)))
        .build()
        .expect("the parts fit");
    let text = "\
error: blocked: location `a`: the flow leaves the invariant through `x ≤ 1`, and no guard holds \
there: add a transition, or widen a guard
    for example at x = 1, y = 0
warning: never fires: location `a`, on `go`: its guard `x ≥ 200` holds nowhere in the declared \
ranges: correct one of them
warning: unreachable: location `b`: no way leads here from the initial location: add a transition, \
or leave it out
warning: unreachable: location `c`: no way leads here from the initial location: add a transition, \
or leave it out
1 error, 3 warnings, 0 notes; 0 faults excluded by proof";
    assert_eq!(machine.check().to_string(), text);
}
