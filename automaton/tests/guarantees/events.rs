//! No event is missed in silence.

use std::f64::consts::TAU;

use pleach_automaton::{Automaton, Flow, Reason, Why, from};
use pleach_guards::{Predicate, variable};
use proptest::prelude::*;

use super::Cue::Go;
use super::Place::{Here, There};
use super::{Body, One, ball_and_table, built, go, ramp, run, times, x};

/// sin 50t = 0.99 first at asin(0.99) ÷ 50 = 0.0285851370694093880097…, by mpmath at 40 digits.
const SINE: f64 = 0.028_585_137_069_409_388;

#[test]
fn a_fast_guard_on_a_slow_flow_is_met_whatever_the_horizon() {
    let machine = go((50.0 * &x()).sin().at_least(0.99));
    for horizon in [0.03, 1.0, 10.0, 100.0, 1e4, 1e6] {
        let trajectory = run(&machine, horizon);
        assert!((times(&trajectory)[0] - SINE).abs() < 1e-16, "{:?}", times(&trajectory));
        assert!(trajectory.doubts().is_empty());
    }
    assert!(times(&run(&machine, 0.028)).is_empty());
}

#[test]
fn a_fast_invariant_on_a_slow_flow_is_kept() {
    let machine = built(ramp().invariant(Here, (50.0 * &x()).sin().at_most(0.99)));
    for horizon in [1.0, 100.0] {
        let trajectory = run(&machine, horizon);
        assert_eq!(trajectory.ending().reason, Reason::Blocked);
        assert!((trajectory.ending().at.t - SINE).abs() < 1e-15);
    }
}

/// The first impacts with ω = 50, by a scan and mpmath's `findroot` at 40 digits. From impact to
/// impact errors grow some tenfold.
const IMPACTS: [f64; 8] = [
    4.481_730_273_889_152,
    4.532_485_268_821_463,
    10.765_445_938_106_596,
    10.790_836_133_228_32,
    16.540_702_594_580_74,
    16.557_284_515_121_993,
    16.570_648_960_963_916,
    16.588_746_578_060_719,
];

#[test]
fn a_ball_on_a_vibrating_table_meets_it_every_time() {
    let machine = ball_and_table(50.0);
    for horizon in [17.0, 20.0] {
        let found = times(&run(&machine, horizon));
        assert_eq!(found.len(), IMPACTS.len(), "{found:?}");
        for ((found, exact), grown) in found.iter().zip(IMPACTS).zip(1..) {
            assert!((found - exact).abs() < 1e-13 * 10f64.powi(grown), "{found} {exact}");
        }
    }
    assert_eq!(times(&run(&machine, 12.0)).len(), 4, "the horizon is no matter");
    // The ball is never below the table.
    let trajectory = run(&machine, 20.0);
    for step in 0..200_000 {
        let t = 1e-4 * f64::from(step);
        let h = trajectory.value("h", t).expect("the run lasts");
        assert!(h - 0.05 * (50.0 * t).sin() > -1e-9, "{h} at {t}");
    }
}

#[test]
fn what_only_touches_is_said() {
    let wave = || x().sin() + x().cos();
    let trajectory = run(&go(wave().at_least(2f64.sqrt() + 1e-15)), 10.0);
    assert!(trajectory.jumps().is_empty());
    let doubts = trajectory.doubts();
    let at = |t: f64| doubts.iter().any(|doubt| doubt.from <= t && t <= doubt.to);
    assert!(doubts.iter().all(|doubt| doubt.why == Why::Touch && doubt.to - doubt.from < 1e-6));
    assert!(doubts.len() == 2 && at(TAU / 8.0) && at(TAU / 8.0 + TAU), "{doubts:?}");
    assert!(run(&go(wave().at_least(1.4143)), 10.0).doubts().is_empty());
}

#[test]
fn what_is_a_function_is_said() {
    let late = Predicate::function("late", |state| Ok(variable("x").evaluate(state)? - 3.0));
    let trajectory = run(&go(late), 10.0);
    assert!((times(&trajectory)[0] - 3.0).abs() < 1e-14);
    assert!(trajectory.doubts().iter().all(|doubt| doubt.why == Why::Function));
    assert_eq!(trajectory.doubts().len(), 1);

    let advance = |state: &mut One, duration: f64| state.x += duration;
    let exact: Flow<One> = Flow::exact("ẋ = 1", advance);
    let machine = built(
        Automaton::starting_in(Here)
            .initially(One { x: 0.0 })
            .flow(Here, exact)
            .transition(from(Here).on(Go).to(There).must((50.0 * &x()).sin().at_least(0.99))),
    );
    let trajectory = run(&machine, 10.0);
    assert!((times(&trajectory)[0] - SINE).abs() < 1e-12);
    assert_eq!(trajectory.doubts().len(), 1);
    assert_eq!(trajectory.doubts()[0].why, Why::Solution);
}

proptest! {
    #![proptest_config(cases::usually(64))]

    /// sin(a x + b x²) ≥ c on a line, on a parabola by a linear flow and on an integrated flow: the
    /// first root is that of a quadratic equation.
    #[test]
    fn random_models_meet_their_first_root(
        a in 0.5..60.0_f64,
        b in 0.0..20.0_f64,
        c in 0.05..0.999_f64,
    ) {
        let angle = c.asin();
        let exact = 2.0 * angle / (a + (a * a + 4.0 * b * angle).sqrt());
        let Body { h, v, clock } = Body::coordinates();
        let start = Body { h: 0.0, v: a, clock: 0.0 };
        let bend = Automaton::starting_in(Here).initially(start);
        // h = a t + b t².
        let guard = h.sin().at_least(c);
        let linear = [h.rate(&v), v.rate(2.0 * b), clock.rate(1.0)];
        let general = [h.rate(a + 2.0 * b * &clock + 0.0 * h.power(2.0)), clock.rate(1.0)];
        let flows: [Flow<Body>; 2] = [linear.into(), general.into()];
        for (flow, tolerance) in flows.into_iter().zip([1e-13, 1e-8]) {
            let go = from(Here).on(Go).to(There).must(guard.clone());
            let trajectory = run(&built(bend.clone().flow(Here, flow).transition(go)), 50.0);
            let found = times(&trajectory);
            prop_assert!((found[0] - exact).abs() < tolerance * exact, "{} {exact}", found[0]);
        }
    }
}
