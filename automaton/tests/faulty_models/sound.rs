//! Models in which there is nothing to find, in the way the literature writes them.

use pleach_automaton::{Automaton, Composition, Flow, Reset, coordinates, from};
use pleach_guards::{Predicate, always, constant, norm};

use super::Cue::{Back, Go, Turn};
use super::Room::{A, B, C};
use super::{Point, faults, machine, notes};
use pleach_automaton::check::{Kind, Report, Severity};

/// At most this many notes, and nothing worse.
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
        pub enum Switch: Event { TurnOn = "turn on", TurnOff = "turn off", Turn = "turn" }
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
    check(&report, 3);
    // Only less than no water would lead outside; at none at all, runs end.
    let notes = report.findings();
    let outside = notes.iter().filter(|note| note.kind == Kind::LandsOutside);
    assert_eq!(outside.count(), 2, "{report}");
    let note = notes.iter().find(|note| note.kind == Kind::TimelessCycle).expect("a cycle");
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

coordinates! {
    struct Sleeve { vx, vy, px, py }
}

/// The sleeve of a gearbox between two teeth, by Chen, Mover and Sankaranarayanan (2017), without
/// ranges: tan θ and sin θ ÷ cos θ differ as numbers, and at speeds of 10¹⁷ that would show.
#[test]
fn gearbox_meshing() {
    let Sleeve { vx, vy, px, py } = Sleeve::coordinates();
    let theta = 36.0_f64.to_radians();
    let (sin, cos, tan) = (theta.sin(), theta.cos(), theta.tan());
    let (edge, slip) = (-0.003, 0.9);
    let upper = py.at_most(-tan * &px);
    let lower = py.at_least(tan * &px);
    let toward_upper = (sin * &vx + cos * &vy).at_least(0.0);
    let toward_lower = (sin * &vx - cos * &vy).at_least(0.0);
    let mirrored = |sign: f64| {
        let along = cos * cos - slip * sin * sin;
        let across = -(slip + 1.0) * sin * cos * sign;
        [
            vx.becomes(along * &vx + across * &vy),
            vy.becomes(across * &vx + (sin * sin - slip * cos * cos) * &vy),
        ]
    };
    let (free, meshed) = (Heater::Off, Heater::On);
    let gearbox = Automaton::starting_in(free)
        .initially(Sleeve { vx: 0.0, vy: 0.0, px: -0.0165, py: 0.003 })
        .flow(free, [vx.rate(21.875), vy.rate(-0.1147), px.rate(&vx), py.rate(&vy)])
        .invariant(free, px.at_most(edge) & upper.clone() & lower.clone())
        .transition(
            from(free)
                .on(Switch::TurnOff)
                .to(free)
                .must(py.at_least(-tan * &px) & toward_upper)
                .then(mirrored(1.0)),
        )
        .transition(
            from(free)
                .on(Switch::Turn)
                .to(free)
                .must(py.at_most(tan * &px) & toward_lower)
                .then(mirrored(-1.0)),
        )
        .transition(
            from(free).on(Switch::TurnOn).to(meshed).must(px.at_least(edge) & vx.at_least(0.0)),
        )
        .build()
        .expect("the parts fit");
    let report = gearbox.check();
    let blocked = report.findings().iter().find(|one| one.kind == Kind::Blocked);
    assert!(blocked.is_none_or(|one| one.severity == Severity::Note), "{report}");
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
    // √2 is no floating-point number, so that they touch, but no number shows where.
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
