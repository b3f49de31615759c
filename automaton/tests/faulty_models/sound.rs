//! Models in which there is nothing to find, in the way the literature writes them.

use pleach_automaton::{Automaton, Composition, Flow, Reset, from};
use pleach_guards::{Predicate, always, constant, norm};

use super::Cue::{Back, Go, Turn};
use super::Room::{A, B, C};
use super::{Point, faults, machine, notes};
use pleach_automaton::check::{Kind, Report, Severity};

/// At most so many notes, and nothing worse.
fn check(report: &Report, most_notes: usize) {
    assert!(report.is_sound(), "{report}");
    assert_eq!(faults(report), [""; 0]);
    assert!(notes(report) <= most_notes, "{report}");
}

mod classics {
    use pleach_discrete::vocabulary;

    vocabulary! {
        pub enum Ball: Location { Falling = "falling" }
        pub enum Contact: Event { Bounce = "bounce" }
        pub enum Heater: Location { Off = "off", On = "on" }
        pub enum Switch: Event { TurnOn = "turn on", TurnOff = "turn off" }
        pub enum Controller: Location { Watching = "watching" }
    }
}
use classics::{Ball, Contact, Controller, Heater, Switch};

#[test]
fn the_bouncing_ball() {
    let Point { x: height, y: velocity } = Point::coordinates();
    let impact = height.at_most(0.0) & velocity.less_than(0.0);
    let bounce = from(Ball::Falling).on(Contact::Bounce).to(Ball::Falling).must(impact);
    let ball = Automaton::starting_in(Ball::Falling)
        .initially(Point { x: 1.0, y: 0.0 })
        .flow(Ball::Falling, [height.rate(&velocity), velocity.rate(-9.81)])
        .invariant(Ball::Falling, height.at_least(0.0))
        .transition(bounce.then(velocity.becomes(-0.8 * &velocity)))
        .build()
        .expect("the parts fit");
    check(&ball.check(), 0);
}

fn heater(low: Predicate, high: Predicate) -> pleach_automaton::Builder<Heater, Switch, Point> {
    let Point { x, .. } = Point::coordinates();
    Automaton::starting_in(Heater::Off)
        .initially(Point { x: 20.0, y: 0.0 })
        .flow(Heater::Off, x.rate(-0.1 * &x))
        .flow(Heater::On, x.rate(5.0 - 0.1 * &x))
        .transition(from(Heater::Off).on(Switch::TurnOn).to(Heater::On).may(low))
        .transition(from(Heater::On).on(Switch::TurnOff).to(Heater::Off).may(high))
}

#[test]
fn the_thermostat() {
    let Point { x, .. } = Point::coordinates();
    let thermostat = heater(x.less_than(19.0), x.more_than(21.0))
        .invariant(Heater::Off, x.at_least(18.0))
        .invariant(Heater::On, x.at_most(22.0))
        .build()
        .expect("the parts fit");
    check(&thermostat.check(), 0);
}

#[test]
fn two_tanks() {
    let Point { x: left, y: right } = Point::coordinates();
    let tanks = Automaton::starting_in(Heater::Off)
        .initially(Point { x: 0.0, y: 1.0 })
        .flow(Heater::Off, [left.rate(0.25), right.rate(-0.5)])
        .flow(Heater::On, [left.rate(-0.5), right.rate(0.25)])
        .invariant(Heater::Off, right.at_least(0.0))
        .invariant(Heater::On, left.at_least(0.0))
        .transition(from(Heater::Off).on(Switch::TurnOn).to(Heater::On).must(right.at_most(0.0)))
        .transition(from(Heater::On).on(Switch::TurnOff).to(Heater::Off).must(left.at_most(0.0)))
        .build()
        .expect("the parts fit");
    let report = tanks.check();
    check(&report, 1);
    // The one note is the state in which the water is gone.
    let note = &report.findings()[0];
    let state = note.witness.as_ref().map(|state| (state["x"], state["y"]));
    assert_eq!((note.kind, state), (Kind::TimelessCycle, Some((0.0, 0.0))));
}

#[test]
fn heater_and_controller() {
    let Point { x: seen, .. } = Point::coordinates();
    let here = Controller::Watching;
    let controller = Automaton::starting_in(here)
        .initially(Point { x: 20.0, y: 0.0 })
        .transition(from(here).on(Switch::TurnOn).to(here).must(seen.at_most(19.0)))
        .transition(from(here).on(Switch::TurnOff).to(here).must(seen.at_least(21.0)))
        .build()
        .expect("the parts fit");
    let house = Composition::builder()
        .add("heater", &heater(always(), always()).build().expect("the parts fit"))
        .add("controller", &controller)
        .connect("heater.x", "controller.x")
        .label("turn on")
        .label("turn off")
        .build()
        .expect("the components fit");
    check(&house.check(), 0);
}

// ---- Notes -------------------------------------------------------------------------------------

#[test]
fn free_choices_are_noted_once_for_each_location() {
    let Point { x, .. } = Point::coordinates();
    let machine = machine()
        .transition(from(A).on(Go).to(B).may(always()))
        .transition(from(A).on(Turn).to(C).may(always()))
        .transition(from(A).on(Back).to(A).may(always()).then(x.becomes(0.0)))
        .build()
        .expect("the parts fit");
    let report = machine.check();
    check(&report, 1);
    assert_eq!(report.findings()[0].kind, Kind::Choice);
    assert_eq!(report.findings()[0].place.events, ["go", "turn", "back"]);
}

#[test]
fn functions_are_noted_once_each() {
    let near = Predicate::function("near", |_| Ok(1.0));
    let machine = machine()
        .flow(B, Flow::field("drift", |point: &Point| *point))
        .transition(from(A).on(Go).to(B).must(near.clone()).then(Reset::new("home", |_| ())))
        .transition(from(B).on(Go).to(C).must(near).then(Reset::new("home", |_| ())))
        .build()
        .expect("the parts fit");
    let report = machine.check();
    check(&report, 3);
    let notes: Vec<String> =
        report.of(Severity::Note).map(|note| format!("{}: {}", note.place, note.message)).collect();
    assert_eq!(
        notes,
        [
            "location `b`: the flow `drift` is a function, which no check can see into",
            "on `go`: the part of a guard `near` is a function, which no check can see into",
            "on `go`: the reset `home` is a function, which no check can see into",
        ]
    );
}

#[test]
fn what_is_not_decided_is_noted_with_its_resolution() {
    let Point { x, y } = Point::coordinates();
    let circle = norm([x.clone().into(), y.clone().into()]);
    // √2 is no floating-point number, so that they touch, but nobody can show where.
    let root = constant(2.0).square_root();
    let machine = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(circle.at_least(2.0)))
        .transition(
            from(A).on(Turn).to(C).must(circle.at_most(2.0) & x.at_least(&root) & y.at_least(root)),
        )
        .build()
        .expect("the parts fit");
    let report = machine.check();
    check(&report, 1);
    let note = &report.findings()[0];
    assert_eq!(note.kind, Kind::Overlap);
    assert!(note.message.contains("undecided at a resolution of"), "{note}");
}
