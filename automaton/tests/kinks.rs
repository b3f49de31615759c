//! Rates with kinks and jumps on curves: integration steps end where the state passes one, so that the
//! errors are those of smooth flows.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use pleach_automaton::{
    Automaton, Composition, Coordinate, Failure, Reason, Settings, Trajectory, Why, coordinates,
    from,
};
use pleach_continuous::flow::Method;
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, Table, constant, maximum, piecewise};
use proptest::prelude::*;

vocabulary! {
    enum Place: Location { Here = "here", There = "there" }
    enum Cue: Event { Go = "go" }
}
coordinates! {
    struct Body { place = "p", speed = "s", time = "t" }
}
use Cue::Go;
use Place::{Here, There};

fn coordinates() -> [Coordinate<Body>; 3] {
    let Body { place, speed, time } = Body::coordinates();
    [place, speed, time]
}

type Machine = Automaton<Place, Cue, Body>;

fn machine(start: [f64; 2], rates: [Expression; 2]) -> Machine {
    let [place, speed, time] = coordinates();
    let [moves, speeds] = rates;
    Automaton::starting_in(Here)
        .initially(Body { place: start[0], speed: start[1], time: 0.0 })
        .flow(Here, [place.rate(moves), speed.rate(speeds), time.rate(1.0)])
        .build()
        .expect("the model is sound")
}

/// Few steps are enough.
fn run(machine: &Machine, horizon: f64) -> Trajectory {
    let settings = Settings { step_limit: 100_000, ..Settings::default() };
    machine.run_with(settings, horizon).expect("it can be run")
}

/// Place and speed at the end; nothing is in doubt.
fn end(start: [f64; 2], rates: [Expression; 2], horizon: f64) -> [f64; 2] {
    let trajectory = run(&machine(start, rates), horizon);
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    assert!(trajectory.doubts().is_empty(), "{:?}", trajectory.doubts());
    let values = trajectory.values_at(horizon).expect("the run lasts");
    [values[0], values[1]]
}

fn assert_near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() < tolerance, "{found} is not {exact}");
}

/// ẍ = −sgn x goes to and fro on parabolas, 4 √2 s for each turn.
#[test]
fn a_force_that_changes_sign_keeps_its_period() {
    let [p, s, _] = coordinates();
    let found = end([1.0, 0.0], [Expression::from(&s), -p.sign()], 40.0 * 2f64.sqrt());
    assert_near(found[0], 1.0, 1e-10);
    assert_near(found[1], 0.0, 1e-10);
}

/// Springs of strength 1 on the right and 4 on the left: a turn takes π + π ÷ 2.
#[test]
fn a_spring_that_is_stiffer_on_one_side_keeps_its_period() {
    let [p, s, _] = coordinates();
    let forms = [
        -p.max(0.0) - 4.0 * p.min(0.0),
        -2.5 * &p + 1.5 * p.abs(),
        piecewise([(p.at_least(0.0), -&p)], -4.0 * &p).expect("a comparison"),
        -Table::linear([(-9.0, -36.0), (0.0, 0.0), (9.0, 9.0)]).expect("in order").at(&p),
        maximum([-&p, -4.0 * &p, &p - 100.0]),
    ];
    for force in forms {
        let found = end([1.0, 0.0], [Expression::from(&s), force], 15.0 * PI);
        assert_near(found[0], 1.0, 1e-8);
        assert_near(found[1], 0.0, 2e-8);
    }
}

/// Dry friction takes 2 μ off the amplitude at every half turn.
#[test]
fn dry_friction_takes_its_share_at_every_half_turn() {
    let [p, s, _] = coordinates();
    let rates = [Expression::from(&s), -&p - 0.05 * s.sign()];
    let found = end([1.05, 0.0], rates, 9.0 * PI);
    assert_near(found[0], -0.15, 1e-9);
    assert_near(found[1], 0.0, 1e-9);
}

/// Where it sticks no solution follows either side of the jump: the run ends, soon, with the reason.
#[test]
fn a_flow_that_leads_to_a_jump_from_both_sides_ends() {
    let [p, s, time] = coordinates();
    let stuck = |rates: [Expression; 2], start: [f64; 2], exact: f64| {
        let trajectory = run(&machine(start, rates), 100.0);
        let Reason::Finished(Failure::Flow { reason, .. }) = &trajectory.ending().reason else {
            panic!("{:?}", trajectory.ending())
        };
        assert!(reason.contains("sign(") && reason.contains("slides"), "{reason}");
        assert_near(trajectory.ending().at.t, exact, 1e-9);
    };
    stuck([Expression::from(&s), -&p - 0.15 * s.sign()], [1.0, 0.0], 3.0 * PI);
    stuck([-p.sign(), 0.0.into()], [1.0, 0.0], 1.0);
    stuck([0.5 * time.cos() - p.sign(), 0.0.into()], [1.0, 0.0], 1.498_701_133_517_849);
}

/// ẋ = 1 + ⌊x⌋ takes 1 ÷ k from k − 1 to k.
#[test]
fn stairs_are_climbed_in_a_harmonic_sum() {
    let [p, ..] = coordinates();
    let sum: f64 = (1..=200).map(|step| 1.0 / f64::from(step)).sum();
    assert_near(end([0.0; 2], [1.0 + p.floor(), 0.0.into()], sum)[0], 200.0, 1e-9);
}

/// √h has no value below 0, where max(h, 0) is on another side: the tank is empty after 8 s, and stays so.
#[test]
fn a_side_without_a_value_beyond_its_kink_is_left() {
    let [p, s, _] = coordinates();
    let full = || p.max(0.0).square_root();
    let found = end([4.0, 0.0], [-0.5 * full() + 0.0 * &s, full()], 12.0);
    assert_near(found[0], 0.0, 1e-9);
    // The integral of 2 − t ÷ 4.
    assert_near(found[1], 8.0, 1e-6);
    // Of cases it is not known that they fit together where they meet.
    let case = piecewise([(p.more_than(0.0), p.square_root())], 0.0).expect("a comparison");
    let trajectory = run(&machine([4.0, 0.0], [-0.5 * case, 0.0.into()]), 12.0);
    assert_near(trajectory.value("p", 12.0).expect("the run lasts"), 0.0, 1e-9);
    assert!(trajectory.doubts().iter().all(|doubt| doubt.why == Why::Graze && doubt.from > 7.9));
}

/// A capacitor behind a diode, with an oscillator's voltage: a stiff flow, by the integrator's choice, and
/// by either method alone. Solved by hand between the kinks.
#[test]
fn kinks_of_stiff_flows_end_steps() {
    let [p, s, time] = coordinates();
    let fast = 1000.0;
    let voltage = || time.cos() + 0.0 * s.power(2.0);
    let follow = -fast * (&p - voltage().max(0.0));
    let follows = |t: f64| fast * (fast * t.cos() + t.sin()) / (fast * fast + 1.0);
    for method in [Method::Automatic, Method::Implicit, Method::Explicit] {
        let settings = Settings { method, ..Settings::default() };
        let machine = machine([follows(0.0), 0.0], [follow.clone(), -&p]);
        let trajectory = machine.run_with(settings, 7.0).expect("it can be run");
        let at = |t: f64| trajectory.value("p", t).expect("the run lasts");
        assert_near(at(1.0), follows(1.0), 1e-8);
        let later = 1e-3;
        assert_near(at(FRAC_PI_2 + later), follows(FRAC_PI_2) * (-fast * later).exp(), 1e-8);
        assert_near(at(4.0), 0.0, 1e-8);
        let begin = 3.0 * FRAC_PI_2;
        let exact = follows(begin + later) - follows(begin) * (-fast * later).exp();
        assert_near(at(begin + later), exact, 1e-8);
        assert_near(at(7.0), follows(7.0), 1e-8);
    }
}

/// An angle jumps by 2π where its point crosses the axis on the left, and has no kink elsewhere.
#[test]
fn angles_are_integrated_over_their_jumps() {
    let [p, s, time] = coordinates();
    let saw = time.sin().atan2(time.cos());
    let until = 20.0 * PI + 1.0;
    assert_near(end([0.0; 2], [saw, 0.0.into()], until)[0], 0.5, 1e-8);
    // A heading that turns to the nearest course, from all sides.
    let error = || (&p - &s).sin().atan2((&p - &s).cos());
    for (start, target) in [(3.0, 0.0), (4.0, TAU), (-3.5, -TAU), (20.0, 3.0 * TAU)] {
        let exact = target + (start - target) * (-5f64).exp();
        assert_near(end([start, 0.0], [-error(), 0.0.into()], 5.0)[0], exact, 1e-8);
    }
    // A course that turns faster than the heading can follow: the error e grows by 4 − e, and begins again
    // with −π where it has come to π.
    let turn = ((4.0 + PI) / (4.0 - PI)).ln();
    let first = (4.0 / (4.0 - PI)).ln();
    let turns = ((20.0 - first) / turn).floor();
    let left = 20.0 - first - turns * turn;
    let behind = PI + TAU * turns + (4.0 + PI) * (1.0 - (-left).exp());
    assert_near(end([0.0; 2], [-error(), 4.0.into()], 20.0)[0], 80.0 - behind, 1e-7);
}

/// A body comes to a jump of its force at 1 and turns: whether it passes it, the error of the flow hides.
#[test]
fn a_jump_that_is_touched_is_said() {
    let [p, s, _] = coordinates();
    let forces = [
        piecewise([(p.at_most(1.0), constant(-0.5))], -5.0).expect("a comparison"),
        -2.75 - 2.25 * (&p - 1.0).sign(),
        -0.5 - 4.5 * p.floor().max(0.0),
        Table::steps([(-9.0, -0.5), (1.0, -5.0)]).expect("in order").at(&p),
    ];
    for force in forces {
        let with_speed = |speed: f64| {
            let rates = [Expression::from(&s), force.clone() + 0.0 * s.power(2.0)];
            run(&machine([0.0, speed], rates), 3.0)
        };
        for miss in [-1e-13, 0.0, 1e-13] {
            let trajectory = with_speed(1.0 + miss);
            let is_near = |at: f64| (at - 2.0).abs() < 1e-2;
            let mut doubts = trajectory.doubts().iter().filter(|doubt| doubt.why == Why::Graze);
            let is_said = doubts.any(|doubt| is_near(doubt.from) && is_near(doubt.to));
            assert!(is_said, "{force} {miss}: {:?}", trajectory.doubts());
        }
        for speed in [0.9, 0.999_999, 1.1] {
            assert!(with_speed(speed).doubts().is_empty(), "{force} {speed}");
        }
    }
}

/// A brief pulse at a known time, beside a component of its group whose kink is at a state.
#[test]
fn known_kinks_count_beside_a_component_that_is_held() {
    let [p, s, time] = coordinates();
    let pulse = Table::steps([(0.0, 0.0), (5.0, 1000.0), (5.001, 0.0)]).expect("it is a table");
    let pulsed = machine([0.0; 2], [pulse.at(&time) + 0.0 * s.sin(), constant(0.0)]);
    for beside in [-p.abs() + 0.0 * &s, -1.0 * p.sin() + 0.0 * &s] {
        let bent: Machine = Automaton::starting_in(Here)
            .initially(Body { place: 1.0, speed: 0.0, time: 0.0 })
            .flow(Here, [p.rate(beside), time.rate(1.0)])
            .build()
            .expect("the model is sound");
        let both = Composition::builder()
            .add("pulsed", &pulsed)
            .add("bent", &bent)
            .connect("pulsed.p", "bent.s")
            .build()
            .expect("the parts fit");
        let found = both.run(10.0).expect("it can be run").value("pulsed.p", 10.0);
        assert_near(found.expect("the run lasts"), 1.0, 1e-9);
    }
}

/// A table that is 0 everywhere adds no kink to one at a state.
#[test]
fn flat_tables_hide_no_kinks() {
    let [_, s, _] = coordinates();
    let flat: Expression = "flat((-1, 0), (100, 5), t)".parse().expect("it is a table");
    let stairs = |more: Expression| [more + (10.0 * &s).floor(), -2.0 * &s];
    let exact: f64 = (1..=9).map(|k| (10.0 / f64::from(k)).ln() / 2.0).sum();
    for more in [constant(0.0), flat] {
        let found = run(&machine([0.0, 1.0], stairs(more)), 2.0).value("p", 2.0);
        assert_near(found.expect("the run lasts"), exact, 1e-9);
    }
}

/// A kink beside the way, and one that is touched, end no step and change nothing.
#[test]
fn kinks_that_are_not_passed_change_nothing() {
    let [p, s, _] = coordinates();
    let beside = [Expression::from(&s), -&p + (&p + 1.5).min(0.0) + 0.0 * s.power(2.0)];
    assert_near(end([1.0, 0.0], beside, 20.0 * PI)[0], 1.0, 1e-8);
    let touched = [Expression::from(&s), -&p + (&p + 1.0).abs() - (&p + 1.0)];
    assert_near(end([1.0, 0.0], touched, 20.0 * PI)[0], 1.0, 1e-7);
}

proptest! {
    #![proptest_config(cases::usually(64))]

    /// ẋ = a + b |x − c| from below c to above it: the instant is a sum of two logarithms. With kinks of
    /// which some are further in, and some do not count.
    #[test]
    fn a_level_beyond_a_kink_is_met_at_its_instant(
        a in 0.05..2.0_f64,
        b in 0.1..30.0_f64,
        c in 0.1..3.0_f64,
        form in 0..4,
    ) {
        let [p, ..] = coordinates();
        let distance = match form {
            0 => (&p - c).abs(),
            1 => (&p - c).max(c - &p),
            2 => (&p - c) * (&p - c).sign(),
            _ => ((&p - c).abs() - 100.0).abs().min(1000.0) * -1.0 + 100.0,
        };
        let level = 2.0 * c;
        let [place, speed, time] = coordinates();
        let rates = [place.rate(a + b * distance), speed.rate(0.0), time.rate(1.0)];
        let machine = Automaton::starting_in(Here)
            .initially(Body { place: 0.0, speed: 0.0, time: 0.0 })
            .flow(Here, rates)
            .transition(from(Here).on(Go).to(There).must(p.at_least(level)))
            .build()
            .expect("the model is sound");
        let exact = 2.0 * (1.0 + b * c / a).ln() / b;
        let trajectory = run(&machine, 2.0 * exact);
        let found = trajectory.jumps().first().map(|jump| jump.at.t);
        let is_near = found.is_some_and(|found| (found - exact).abs() < 1e-8 * exact);
        prop_assert!(is_near, "{found:?} {exact}, {:?}", trajectory.ending());
    }
}
