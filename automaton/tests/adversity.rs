//! Models that are made to be missed, to hang or to panic: of every event the run has it, or says that it
//! is in doubt.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use pleach_automaton::{
    Automaton, Builder, Coordinate, Coordinates, Reason, Settings, Trajectory, coordinates, from,
};
use pleach_guards::{Expression, Predicate};

use crate::common::body::Cue::{self, Back, Go};
use crate::common::body::Place::{self, Here, There};
use crate::common::body::{Body, body};

coordinates! {
    struct Line { x }
}

fn x() -> Coordinate<Line> {
    Line::coordinates().x
}

/// x from a start on at a constant rate.
fn line(start: f64, rate: f64) -> Builder<Place, Cue, Line> {
    Automaton::starting_in(Here).initially(Line { x: start }).flow(Here, x().rate(rate))
}

fn run<S: Coordinates>(parts: Builder<Place, Cue, S>, horizon: f64) -> Trajectory {
    let automaton = parts.build().expect("the model can be built");
    // What never ends would fail as a limit, and not hang.
    let settings = Settings { step_limit: 1_000_000, ..Settings::default() };
    automaton.run_with(settings, horizon).expect("it can be run")
}

/// The run until a guard holds.
fn go<S: Coordinates>(parts: Builder<Place, Cue, S>, guard: Predicate, horizon: f64) -> Trajectory {
    run(parts.transition(from(Here).on(Go).to(There).must(guard)), horizon)
}

/// The first event is near an instant.
fn assert_event(trajectory: &Trajectory, exact: f64, tolerance: f64) {
    let found = trajectory.jumps().first().map(|jump| jump.at.t);
    let is_near = found.is_some_and(|found| (found - exact).abs() <= tolerance);
    assert!(is_near, "{found:?} is not {exact}: {:?}", trajectory.ending());
}

/// Either the first event is near an instant, or a doubt is on record there.
fn assert_said(trajectory: &Trajectory, exact: f64, tolerance: f64) {
    let found = trajectory.jumps().first().map(|jump| jump.at.t);
    let doubts = trajectory.doubts();
    let is_met = found.is_some_and(|found| (found - exact).abs() <= tolerance);
    let mut spans = doubts.iter().map(|doubt| (doubt.from - tolerance, doubt.to + tolerance));
    let is_said = spans.any(|(first, last)| first <= exact && exact <= last);
    assert!(is_met || is_said, "{found:?}, {doubts:?}: {exact}, {:?}", trajectory.ending());
}

/// Two roots that lie 2·10⁻⁷ s apart, on a parabola by a linear flow and on one that is integrated.
#[test]
fn a_dip_between_two_close_roots_is_met() {
    let Body { place, speed, .. } = Body::coordinates();
    let depth: f64 = 1e-14;
    let linear = body([1.0, -2.0], [Expression::from(&speed), 2.0.into()]);
    let trajectory = go(linear, place.at_most(depth), 5.0);
    assert_said(&trajectory, 1.0 - depth.sqrt(), 1e-9);
    let bent = body([1.0, -2.0], [&speed + 0.0 * speed.power(2.0), 2.0.into()]);
    assert_said(&go(bent, place.at_most(depth), 5.0), 1.0 - depth.sqrt(), 1e-6);
}

#[test]
fn a_guard_that_touches_its_bound_is_said() {
    let Body { place, speed, .. } = Body::coordinates();
    let parabola = || body([1.0, -2.0], [Expression::from(&speed), 2.0.into()]);
    assert_said(&go(parabola(), place.at_most(0.0), 5.0), 1.0, 1e-6);
    assert_said(&go(line(0.0, 1.0), (x() - 1.0).abs().at_most(0.0), 5.0), 1.0, 1e-6);
    assert_said(&go(line(0.0, 1.0), (x() - 1.0).power(2.0).at_most(0.0), 5.0), 1.0, 1e-6);
    assert_said(&go(line(0.0, 1.0), (x() - 1.0).power(4.0).at_most(0.0), 5.0), 1.0, 1e-3);
}

/// x ≥ c and x ≤ c hold at one instant, which lies between two numbers.
#[test]
fn an_equality_on_a_curve_is_said() {
    let Body { place, speed, .. } = Body::coordinates();
    let wave = body([0.0, 1.0], [Expression::from(&speed), -&place]);
    let guard = place.at_least(0.7) & place.at_most(0.7);
    assert_said(&go(wave, guard, 1.0), 0.7f64.asin(), 1e-12);
    let third = x().at_least(1.0 / 3.0) & x().at_most(1.0 / 3.0);
    assert_said(&go(line(0.0, 0.1), third, 10.0), 10.0 / 3.0, 1e-12);
}

/// A bump of a millionth of a second in a quarter of an hour.
#[test]
fn a_narrow_bump_is_met() {
    let bump = (-((x() - 437.5) / 1e-6).power(2.0)).exp();
    let exact = 437.5 - 1e-6 * 2f64.ln().sqrt();
    assert_event(&go(line(0.0, 1.0), bump.at_least(0.5), 1000.0), exact, 1e-12);
}

#[test]
fn sawteeth_and_fast_waves_are_met() {
    let tooth = x() - x().floor();
    assert_event(&go(line(0.0, 1.0), tooth.at_least(0.999), 1e6), 0.999, 1e-12);
    let wave = (1e6 * x()).sin();
    let exact = 0.999_999_9f64.asin() / 1e6;
    assert_event(&go(line(0.0, 1.0), wave.at_least(0.999_999_9), 1e3), exact, 1e-15);
    let step = x().floor().at_least(3.0) & (x() - 3.5).sign().at_least(0.0);
    assert_said(&go(line(0.0, 1.0), step, 10.0), 3.5, 1e-12);
}

#[test]
fn scales_at_the_ends_of_the_numbers_are_met() {
    assert_event(&go(line(0.0, 1e300), x().at_least(1e305), 1e6), 1e5, 1e-9);
    assert_event(&go(line(0.0, 1e-300), x().at_least(1e-299), 1e6), 10.0, 1e-12);
    assert_event(&go(line(0.0, 1e-320), x().at_least(1e-319), 1e6), 10.0, 1e-2);
    assert_event(&go(line(0.0, 1.0), x().at_least(1e15), 2e15), 1e15, 0.5);
    assert_event(&go(line(1e17, 1.0), x().at_least(1e17 + 64.0), 1e3), 64.0, 16.0);
    let Body { place, speed, .. } = Body::coordinates();
    let fall = || body([1e-160, 0.0], [Expression::from(&speed), (-2e-160).into()]);
    assert_event(&go(fall(), place.at_most(0.0), 1e3), 1.0, 1e-9);
    let far = || body([1e160, 0.0], [Expression::from(&speed), (-2e160).into()]);
    assert_event(&go(far(), place.at_most(0.0), 1e3), 1.0, 1e-9);
}

/// Growth to the end of the numbers is met, and what grows beyond ends the run with a reason.
#[test]
fn growth_beyond_the_numbers_ends_the_run() {
    let Body { place, .. } = Body::coordinates();
    let growth = || body([1.0, 0.0], [Expression::from(&place), 0.0.into()]);
    assert_event(&go(growth(), place.at_least(1e300), 1e3), 300.0 * 10f64.ln(), 1e-6);
    let trajectory = run(growth(), 1000.0);
    assert!(matches!(trajectory.ending().reason, Reason::Finished(_)), "{:?}", trajectory.ending());
    let last = trajectory.ending().at.t;
    assert!(last > 600.0 && last < 709.8, "{last}");
    let blows_up = body([1.0, 0.0], [place.power(2.0), 0.0.into()]);
    let trajectory = run(blows_up, 5.0);
    assert!(matches!(trajectory.ending().reason, Reason::Finished(_)), "{:?}", trajectory.ending());
    assert!((trajectory.ending().at.t - 1.0).abs() < 1e-3, "{:?}", trajectory.ending());
}

/// Formulas with poles and ends of their domains.
#[test]
fn poles_and_domains_of_guards_are_met_or_said() {
    // The formula has no value at the pole, and the guard holds right behind it.
    let pole = go(line(0.0, 1.0), (1.0 / (x() - 1.0)).at_least(1e6), 5.0);
    match &pole.ending().reason {
        Reason::Finished(_) => assert!((pole.ending().at.t - 1.0).abs() < 1e-5),
        _ => assert_said(&pole, 1.0, 1e-5),
    }
    let before = go(line(0.0, 1.0), (1.0 / (1.0 - x())).at_least(1e6), 5.0);
    assert_event(&before, 1.0 - 1e-6, 1e-12);
    let root = go(line(0.0, 1.0), (1.0 - x()).square_root().at_most(0.1), 5.0);
    assert_event(&root, 0.99, 1e-12);
    let late = go(line(0.0, 1.0), (1.0 - x()).square_root().less_than(0.0), 5.0);
    assert!(matches!(late.ending().reason, Reason::Finished(_)), "{:?}", late.ending());
    assert!((late.ending().at.t - 1.0).abs() < 1e-12, "{:?}", late.ending());
}

/// What holds at the last instant at which the formula has a value, and at no number before it.
#[test]
fn what_holds_where_a_domain_ends_is_taken() {
    for bound in [0.0, 1e-9, 1e-8, 1e-7] {
        let root = (1.0 - x()).square_root().at_most(bound);
        assert_event(&go(line(0.0, 1.0), root, 5.0), 1.0, 1e-13);
    }
    // Time stops there, but before it, where the invariant holds.
    let parts = line(0.0, 1.0).invariant(Here, (1.0 - x()).square_root().more_than(0.0));
    let trajectory = run(parts, 5.0);
    assert_eq!(trajectory.ending().reason, Reason::Blocked);
    assert!((trajectory.ending().at.t - 1.0).abs() < 1e-15, "{:?}", trajectory.ending());
}

/// What was in doubt before is not forgotten.
#[test]
fn doubts_before_the_end_of_a_domain_are_kept() {
    let touching = (x().sin() + x().cos()).at_least(2f64.sqrt() + 1e-15);
    let undefined = (1.0 - x()).square_root().less_than(0.0);
    let parts = line(0.0, 1.0).transition(from(Here).on(Back).to(There).must(undefined));
    let trajectory = go(parts, touching, 5.0);
    assert!(matches!(trajectory.ending().reason, Reason::Finished(_)), "{:?}", trajectory.ending());
    assert_said(&trajectory, FRAC_PI_4, 0.0);
}

/// Clocks are exact in the state, and the polynomials of the flow beside them differ from it by rounding.
#[test]
fn formulas_of_clocks_beside_curves_are_met() {
    let Body { place, speed, time } = Body::coordinates();
    let forces = [-&place, -place.sin()];
    for (number, force) in (1..=600).zip(forces.iter().cycle()) {
        let (start, rate, due) = (0.37, 0.7 + 1e-3 * f64::from(number), 0.037 * f64::from(number));
        let guards = [
            time.power(3.0).at_least((start + rate * due).powi(3)),
            time.square_root().at_least((start + rate * due).sqrt()),
        ];
        for guard in guards {
            let swing = Automaton::starting_in(Here)
                .initially(Body { place: 1.0, speed: 0.0, time: start })
                .flow(Here, [place.rate(&speed), speed.rate(force.clone()), time.rate(rate)]);
            let trajectory = go(swing, guard, 30.0);
            assert_event(&trajectory, due, 1e-13);
            assert_eq!(trajectory.ending().reason, Reason::Horizon);
        }
    }
    let every = from(Here).on(Go).to(Here).must(time.power(2.0).at_least(0.01));
    let pendulum = body([1.0, 0.0], [Expression::from(&speed), -place.sin()]);
    let trajectory = run(pendulum.transition(every.then(time.becomes(0.0))), 100.05);
    assert_eq!(trajectory.jumps().len(), 1000, "{:?}", trajectory.ending());
}

/// Where a formula begins to have a value, at the start, nothing is in doubt.
#[test]
fn formulas_that_begin_with_the_run_are_met() {
    let root = go(line(0.0, 1.0), x().square_root().at_least(2.0), 5.0);
    assert_event(&root, 4.0, 1e-14);
    let logarithm = go(line(0.0, 1.0), x().ln().at_least(0.0), 5.0);
    assert_event(&logarithm, 1.0, 1e-15);
    let mirrored = go(line(0.0, -1.0), (-x()).square_root().at_least(2.0), 5.0);
    assert_event(&mirrored, 4.0, 1e-14);
    assert!([root, logarithm, mirrored].iter().all(|run| run.doubts().is_empty()));
}

/// On both sides of these poles the formulas rise, or on both they fall, and across them they jump.
#[test]
fn poles_between_slopes_of_one_sign_are_met() {
    for horizon in [3.0, 10.0, 1e3] {
        assert_event(&go(line(0.0, 1.0), x().tan().at_least(1.0), horizon), FRAC_PI_4, 1e-14);
        let behind = go(line(0.0, 1.0), x().tan().at_most(-1e3), horizon);
        assert_event(&behind, FRAC_PI_2, 1e-14);
        for exponent in [-1.0, -3.0] {
            let pole = || (x() - 1.1).power(exponent);
            assert_event(&go(line(0.0, 1.0), pole().at_least(1e3), horizon), 1.1, 1e-14);
            let before = 1.1 - 1e3f64.powf(1.0 / exponent);
            assert_event(&go(line(0.0, 1.0), pole().at_most(-1e3), horizon), before, 1e-13);
        }
        // An angle that falls, and jumps up where its point crosses the axis on the left; and the opposite.
        let rises = (x() - 1.1).atan2(-1.0).at_least(3.0);
        assert_event(&go(line(0.0, 1.0), rises, horizon), 1.1, 1e-14);
        let falls = (1.1 - x()).atan2(-1.0).at_most(-3.0);
        assert_event(&go(line(0.0, 1.0), falls, horizon), 1.1, 1e-14);
    }
}

/// The error of an integrated flow hides where exactly a pole is: that costs no endless halving.
#[test]
fn poles_are_met_on_integrated_flows() {
    let Body { place, .. } = Body::coordinates();
    let rates = || [1.0 + 0.0 * place.power(2.0), 0.0.into()];
    let pole = |formula: Expression| {
        let settings = Settings { step_limit: 10_000, ..Settings::default() };
        let jump = from(Here).on(Go).to(There).must(formula.at_least(1e3));
        let automaton = body([0.0, 0.0], rates()).transition(jump).build();
        automaton.expect("it is sound").run_with(settings, 3.0).expect("it can be run")
    };
    assert_event(&pole(1.0 / (&place - 1.1)), 1.1, 1e-8);
    assert_event(&pole((&place - 1.1).power(-1.0)), 1.1, 1e-8);
    assert_event(&pole(-(&place + FRAC_PI_2 - 1.1).tan()), 1.1, 1e-8);
    assert_event(&pole((&place - 1.1).power(-2.0)), 1.1 - 1e-3f64.sqrt(), 1e-8);
    assert_said(&pole((&place - 1.1).power(-2.0) * 1e-12), 1.1, 1e-6);
}

#[test]
fn strict_guards_are_taken_at_the_next_number() {
    let trajectory = go(line(0.0, 1.0), x().more_than(1.0), 5.0);
    let found = trajectory.jumps()[0].at.t;
    assert!(found > 1.0 && found - 1.0 <= 1e-15, "{found}");
    let Body { place, speed, .. } = Body::coordinates();
    let wave = body([0.0, 1.0], [Expression::from(&speed), -&place]);
    let trajectory = go(wave, place.more_than(0.5), 5.0);
    assert_event(&trajectory, 0.5f64.asin(), 1e-14);
    // At a bound that is reached and not passed a strict guard never holds.
    let trajectory = go(line(0.0, 1.0), (x() - 1.0).abs().less_than(0.0), 5.0);
    assert!(trajectory.jumps().is_empty());
}

#[test]
fn events_at_the_start_and_at_the_horizon_are_taken() {
    assert_event(&go(line(0.0, 1.0), x().at_least(0.0), 0.0), 0.0, 0.0);
    assert_event(&go(line(0.0, 1.0), x().at_least(1.0), 1.0), 1.0, 0.0);
    assert_event(&go(line(0.0, 0.1), x().at_least(0.3), 3.0), 3.0, 1e-15);
    let Body { place, speed, .. } = Body::coordinates();
    let wave = || body([0.0, 1.0], [Expression::from(&speed), -&place]);
    let quarter = 0.5f64.asin();
    assert_said(&go(wave(), place.at_least(0.5), quarter), quarter, 1e-14);
    // Strict at the very start: the guard begins to hold right after it.
    assert_event(&go(wave(), place.more_than(0.0), 1.0), 0.0, 1e-15);
    assert_event(&go(wave(), place.more_than(0.0) & speed.less_than(0.0), 3.0), FRAC_PI_2, 1e-14);
}

/// A flow so stiff that its fast part is over after a hundred millionth of a second.
#[test]
fn an_event_on_a_stiff_flow_is_met() {
    let Body { place, speed, time } = Body::coordinates();
    let follow = -1e8 * (&place - time.sin()) + 0.0 * speed.power(2.0);
    let stiff = body([1.0, 0.0], [follow, 0.0.into()]);
    assert_event(&go(stiff, place.at_least(0.5) & time.at_least(0.1), 3.0), 0.5f64.asin(), 1e-6);
    let linear = body([1.0, 0.0], [-1e8 * &place, 1.0.into()]);
    assert_event(&go(linear, (&place + &speed).at_least(2.0), 3.0), 2.0, 1e-12);
}

/// Back and forth without time, with guards that hold together: the run says so.
#[test]
fn jumps_without_time_end_the_run() {
    let back = from(There).on(Back).to(Here).must(x().at_least(1.0));
    let trajectory = go(line(0.0, 1.0).transition(back), x().at_least(1.0), 5.0);
    assert!(
        matches!(trajectory.ending().reason, Reason::JumpLimit(_) | Reason::Sliding(_)),
        "{:?}",
        trajectory.ending()
    );
    assert!((trajectory.ending().at.t - 1.0).abs() < 1e-12);
}

/// Hops that become shorter by half each, to clocks: 1 − 2⁻ⁿ.
#[test]
fn hops_that_accumulate_end_the_run_at_their_limit() {
    let Body { place, speed, .. } = Body::coordinates();
    let hop = from(Here)
        .on(Go)
        .to(Here)
        .must(place.at_least(&speed))
        .then([place.becomes(0.0), speed.becomes(0.5 * &speed)]);
    let parts = body([0.0, 0.5], [1.0.into(), 0.0.into()]).transition(hop);
    let trajectory = run(parts, 5.0);
    let Reason::Zeno(zeno) = &trajectory.ending().reason else {
        panic!("{:?}", trajectory.ending())
    };
    assert!((zeno.accumulation - 1.0).abs() < 1e-9, "{zeno:?}");
}

/// Resets to what is no number, and infinite ones, end the run and name the coordinate or formula.
#[test]
fn resets_without_a_value_end_the_run() {
    for value in [x() / (x() - 1.0), (1.0 - 2.0 * x()).ln(), 1.0 / (x() - 1.0)] {
        let jump = from(Here).on(Go).to(There).must(x().at_least(1.0)).then(x().becomes(value));
        let trajectory = run(line(0.0, 1.0).transition(jump), 3.0);
        assert!(
            matches!(trajectory.ending().reason, Reason::Finished(_)),
            "{:?}",
            trajectory.ending()
        );
        assert_eq!(trajectory.ending().at.t, 1.0);
    }
}

/// An invariant that ends with nothing to do blocks the run on the side where it holds.
#[test]
fn an_invariant_that_ends_blocks_the_run() {
    let Body { place, speed, .. } = Body::coordinates();
    let wave = || body([0.0, 1.0], [Expression::from(&speed), -&place]);
    for invariant in [place.at_most(0.5), place.less_than(0.5)] {
        let trajectory = run(wave().invariant(Here, invariant), 5.0);
        assert_eq!(trajectory.ending().reason, Reason::Blocked);
        assert!((trajectory.ending().at.t - 0.5f64.asin()).abs() < 1e-14);
    }
    // It is left for 10⁻⁶ s only.
    let brief = x().power(2.0) - 2.0 * x() + 1.0;
    let trajectory = run(line(0.0, 1.0).invariant(Here, brief.at_least(2.5e-13)), 5.0);
    assert_eq!(trajectory.ending().reason, Reason::Blocked);
    assert!((trajectory.ending().at.t - (1.0 - 5e-7)).abs() < 1e-9, "{:?}", trajectory.ending());
}

/// A ball that may bounce where its invariant ends lands below the ground by rounding, and goes on.
#[test]
fn what_may_be_taken_beside_an_invariant_is_taken() {
    let Body { place, speed, .. } = Body::coordinates();
    let bounce = from(Here)
        .on(Go)
        .to(Here)
        .may(place.at_most(0.0) & speed.less_than(0.0))
        .then(speed.becomes(-&speed));
    let ball = body([1.0, 0.0], [Expression::from(&speed), (-2.0).into()])
        .invariant(Here, place.at_least(0.0))
        .transition(bounce);
    let trajectory = run(ball, 100.5);
    assert_eq!((&trajectory.ending().reason, trajectory.jumps().len()), (&Reason::Horizon, 50));
    let near = |(number, found): (i32, f64)| (found - f64::from(2 * number - 1)).abs() < 1e-10;
    assert!((1..).zip(trajectory.jumps().iter().map(|jump| jump.at.t)).all(near));
}

/// A thousand transitions that are due at one instant: the first in order is taken.
#[test]
fn of_many_transitions_at_one_instant_the_first_is_taken() {
    let mut parts = line(0.0, 1.0);
    for number in 0..1000 {
        let value = f64::from(number);
        let jump = from(Here).on(Go).to(There).must(x().at_least(2.0)).then(x().becomes(value));
        parts = parts.transition(jump);
    }
    let trajectory = run(parts, 3.0);
    assert_eq!(trajectory.jumps().len(), 1);
    assert_eq!(trajectory.value("x", 2.5), Ok(0.0));
}
