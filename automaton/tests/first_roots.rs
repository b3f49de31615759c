//! The first event of models that oscillate, touch, are stiff, singular or of extreme scale, with instants
//! by closed forms or by mpmath at 40 digits; and of random formulas, with those that a dense scan finds.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use pleach_automaton::{Builder, Reason, Settings, Trajectory, Why, from};
use pleach_guards::{Expression, Predicate, constant, maximum, minimum, piecewise, variable};
use proptest::prelude::*;

use crate::common::body::Cue::{self, Go};
use crate::common::body::Place::{self, Here, There};
use crate::common::body::{Body, assert_near, body, coordinates, line};

/// p = sin t, s = cos t, by a linear flow or by the integrator.
fn wave(is_integrated: bool) -> Builder<Place, Cue, Body> {
    let [place, speed, _] = coordinates();
    let nothing = if is_integrated { 0.0 * place.power(2.0) } else { constant(0.0) };
    body([0.0, 1.0], [speed + nothing, -place])
}

fn run(parts: Builder<Place, Cue, Body>, horizon: f64) -> Trajectory {
    let settings = Settings { step_limit: 5_000_000, ..Settings::default() };
    let machine = parts.build().expect("the model is sound");
    machine.run_with(settings, horizon).expect("it can be run")
}

fn go(parts: Builder<Place, Cue, Body>, guard: Predicate, horizon: f64) -> Trajectory {
    run(parts.transition(from(Here).on(Go).to(There).must(guard)), horizon)
}

/// When the first event happens; nothing before it is in doubt.
fn first(parts: Builder<Place, Cue, Body>, guard: Predicate, horizon: f64) -> f64 {
    let trajectory = go(parts, guard, horizon);
    assert!(trajectory.doubts().is_empty(), "{:?}", trajectory.doubts());
    let jump = trajectory.jumps().first();
    jump.unwrap_or_else(|| panic!("no event: {:?}", trajectory.ending())).at.t
}

#[test]
fn fast_guards_are_met_on_every_flow() {
    let [place, speed, time] = coordinates();
    let pendulum = body([1.0, 0.0], [(&speed).into(), -place.sin()]);
    let fast = (1000.0 * &place).sin().at_least(0.9999);
    assert_near(first(pendulum, fast, 10.0), 0.116_141_477_510_596, 1e-9);
    let beat = ((1e4 * &place).sin() * place.sin()).at_least(0.99999);
    assert_near(first(line(), beat, 1e3), 1.566_555_034_885_601_8, 1e-13);
    let product = || (&place * &speed).at_least(0.499_999_9);
    assert_near(first(wave(false), product(), 50.0), 0.785_081_935_626_161, 1e-12);
    assert_near(first(wave(true), product(), 50.0), 0.785_081_935_626_161, 1e-6);
    let needle = || (1.0 / (1.0 + 1e8 * (&place - 0.5).power(2.0))).at_least(0.5);
    assert_near(first(wave(false), needle(), 50.0), 0.523_483_309_392_949_6, 1e-12);
    assert_near(first(wave(true), needle(), 50.0), 0.523_483_309_392_949_6, 1e-8);
    let nested = maximum([
        minimum([(50.0 * &time).sin(), (3.0 * &time).cos(), 2.0 - &place]),
        -&time,
        (-(&time - 7.0).power(2.0)) - 1.0,
    ]);
    assert_near(first(line(), nested.at_least(0.98), 1e4), 0.027_409_229_689_435_54, 1e-15);
}

/// sin t + sin √2 t comes closer and closer to 2: within 10⁻⁶ after half an hour.
#[test]
fn a_sum_of_waves_without_a_period_is_met() {
    let [place, ..] = coordinates();
    let sum = || place.sin() + (SQRT_2 * &place).sin();
    for (bound, exact) in [
        (1.9999, 45.538_974_659_444_32),
        (1.99999, 1_547.231_540_965_738_4),
        (1.999_999, 1_547.233_321_534_189_6),
    ] {
        assert_near(first(line(), sum().at_least(bound), 1e4), exact, 1e-9);
    }
}

#[test]
fn small_and_large_scales_are_met() {
    let [place, speed, _] = coordinates();
    let at = |start: f64, rate: f64, bound: f64, horizon: f64| {
        let parts = body([start, 0.0], [rate.into(), 0.0.into()]);
        first(parts, place.at_least(bound), horizon)
    };
    assert_eq!(at(0.0, 1e-9, 1.0, 2e9), 1.0 / 1e-9);
    assert_eq!(at(0.0, 1e9, 1e-9, 1e9), 1e-18);
    assert_eq!(at(1e9, 1.0, 1e9 + 0.5, 1e9), 0.5);
    assert_eq!(at(-1e-9, 1e-9, 1e-9, 1e9), 2.0);
    // An oscillator of 10⁹ radians a second and 10⁻⁹ wide, and one of 10⁻⁹ that is 10⁹ wide.
    for frequency in [1e9, 1e-9] {
        let rates = [Expression::from(&speed), -frequency * frequency * &place];
        let parts = || body([0.0, 1.0], rates.clone());
        let found = first(parts(), place.at_least(0.5 / frequency), 1e3 / frequency);
        assert_near(found * frequency, 0.5f64.asin(), 1e-13);
        let bent = [&speed + 0.0 * speed.power(2.0), -frequency * frequency * &place];
        let settings =
            Settings { absolute_tolerance: 1e-12 / frequency.max(1.0), ..Settings::default() };
        let jump = from(Here).on(Go).to(There).must(place.at_least(0.5 / frequency));
        let machine = body([0.0, 1.0], bent).transition(jump).build().expect("it is sound");
        let trajectory = machine.run_with(settings, 10.0 / frequency).expect("it can be run");
        assert_near(trajectory.jumps()[0].at.t * frequency, 0.5f64.asin(), 1e-8);
    }
}

#[test]
fn events_at_the_horizon_and_right_behind_it() {
    let [place, speed, _] = coordinates();
    let count = |guard: Predicate, horizon: f64| go(wave(false), guard, horizon).jumps().len();
    assert_eq!(count(place.at_least(0.5), 0.5f64.asin() - 1e-12), 0);
    assert_eq!(count(place.at_least(0.5), 0.5f64.asin() + 1e-12), 1);
    assert_eq!(count(speed.at_most(0.0), FRAC_PI_2 - 1e-12), 0);
    assert_eq!(count(speed.at_most(0.0), FRAC_PI_2 + 1e-12), 1);
    let third = go(body([0.0; 2], [(1.0 / 3.0).into(), 0.0.into()]), place.at_least(1.0), 3.0);
    assert_eq!(third.jumps().len(), 1);
    // What happens there is in no doubt.
    let [.., time] = coordinates();
    let last = go(wave(false), time.at_least(2.0), 2.0);
    assert_eq!((last.jumps().len(), last.doubts()), (1, &[][..]));
}

/// Where rounding and the errors of solutions decide whether something happens at the horizon.
#[test]
fn what_may_happen_at_the_horizon_is_said() {
    let [place, speed, _] = coordinates();
    let growth = || body([1.0, 0.0], [Expression::from(&place), 0.0.into()]);
    let fall = |height: f64| body([height, 0.0], [Expression::from(&speed), (-1.0).into()]);
    let bent = || body([0.0; 2], [1.0 + place.power(2.0), 0.0.into()]);
    for step in 1..80 {
        let time = 0.019 * f64::from(step);
        let cases = [
            (growth(), place.at_least(time.exp())),
            (fall(0.5 * time * time), place.at_most(0.0)),
            (bent(), place.at_least(time.tan())),
        ];
        for (parts, guard) in cases {
            let run = |horizon: f64| go(parts.clone(), guard.clone(), horizon);
            let last = run(time);
            let doubts = last.doubts().iter();
            let is_said = doubts.clone().any(|doubt| doubt.from <= time && time <= doubt.to);
            assert!(is_said || !last.jumps().is_empty(), "{guard} at {time}");
            assert!(doubts.clone().all(|doubt| doubt.to <= time), "{guard}: {:?}", last.doubts());
            for horizon in [time * (1.0 - 1e-6), time * (1.0 + 1e-6)] {
                let trajectory = run(horizon);
                assert_eq!(trajectory.doubts(), [], "{guard} before {horizon}");
                assert_eq!(trajectory.jumps().len(), usize::from(horizon > time));
            }
        }
    }
}

#[test]
fn double_and_close_roots_are_met_in_order() {
    let [place, ..] = coordinates();
    let square = ((&place - 1.0) * (&place - 2.0)).power(2.0);
    assert_near(first(line(), square.at_most(1e-12), 10.0), 0.999_999_000_001, 1e-12);
    // The earlier of two that are 10⁻⁹ apart, and the only one of a pole and a root that are as close.
    let pair = (&place - 1.0) * (&place - (1.0 + 1e-9));
    // Rounding hides a few spacings of the numbers before it.
    assert_near(go(line(), pair.less_than(0.0), 10.0).jumps()[0].at.t, 1.0, 1e-14);
    assert_near(first(line(), (-pair).at_most(0.0) & place.at_least(0.5), 10.0), 0.5, 0.0);
    let pole = (&place - 1.0 - 1e-9) / (&place - 1.0);
    // It holds at nine numbers, right before the pole.
    let trajectory = go(line(), pole.at_least(1e6), 5.0);
    let is_met = trajectory.jumps().first().is_some_and(|jump| (jump.at.t - 1.0).abs() < 1e-14);
    assert!(is_met || trajectory.doubts().iter().any(|one| one.from < 1.0 - 1e-15 && 1.0 < one.to));
}

/// A peak that is beyond its bound by less than the errors of the solution.
#[test]
fn peaks_within_the_errors_of_a_flow_are_met_or_said() {
    let [place, speed, _] = coordinates();
    for turns in 1..=20 {
        let frequency = f64::from(turns);
        let rates = [frequency * &speed + 0.0 * place.power(2.0), -frequency * &place];
        let jump = from(Here).on(Go).to(There).must(place.at_least(1.0 - 1e-13));
        let machine = body([0.0, 1.0], rates).transition(jump).build().expect("it is sound");
        let settings = Settings { relative_tolerance: 1e-6, ..Settings::default() };
        let peak = FRAC_PI_2 / frequency;
        let trajectory = machine.run_with(settings, 1.5 * peak).expect("it can be run");
        let near = 0.1 * peak;
        let is_met = trajectory.jumps().first().is_some_and(|one| (one.at.t - peak).abs() < near);
        let mut doubts = trajectory.doubts().iter();
        let is_said = doubts.any(|doubt| doubt.from - near < peak && peak < doubt.to + near);
        assert!(is_met || is_said, "{frequency}: {:?}", trajectory.ending());
    }
}

/// Which case counts changes amid the run: over spans in which both do, nothing may be concluded.
#[test]
fn guards_with_cases_are_met_before_the_cases_change() {
    let [place, ..] = coordinates();
    let (one, other) = (3.0 - 4.5 * &place, 5.0 * &place);
    let cases = piecewise([(one.less_than(&other), one)], other.power(2.0)).expect("a comparison");
    for horizon in [1.0, 3.0, 10.0] {
        let exact = 1.9f64.atan().sqrt() / 5.0;
        assert_near(first(line(), cases.abs().tan().at_least(1.9), horizon), exact, 1e-14);
    }
}

#[test]
fn stiff_and_singular_flows_are_met() {
    let [place, speed, time] = coordinates();
    let fast = 1e6;
    let follow = -fast * (&place - time.sin()) + 0.0 * speed.power(2.0);
    let stiff = body([0.5, 0.0], [follow, 0.0.into()]);
    let guard = place.at_least(0.9) & time.at_least(0.1);
    assert_near(first(stiff, guard, 3.0), 1.119_770_514_999_666_6, 1e-7);
    let ends = |rate: Expression, start: f64, exact: f64, tolerance: f64| {
        let trajectory = run(body([start, 0.0], [rate, 0.0.into()]), 10.0);
        let is_failure = matches!(trajectory.ending().reason, Reason::Finished(_));
        assert!(is_failure, "{:?}", trajectory.ending());
        assert_near(trajectory.ending().at.t, exact, tolerance);
    };
    ends(place.power(3.0), 1.0, 0.5, 1e-6);
    ends((1.0 - &place).power(-0.5), 0.0, 2.0 / 3.0, 1e-6);
    ends(1.0 + place.power(2.0), 0.0, FRAC_PI_2, 1e-6);
    ends(place.tan(), 0.5, -(0.5f64.sin()).ln(), 1e-6);
}

/// ẋ = 1 + x² from −1 to 1, ten thousand times: π ÷ 2 each.
#[test]
fn ten_thousand_integrated_turns_keep_their_period() {
    let [place, ..] = coordinates();
    let back = from(Here).on(Go).to(Here).must(place.at_least(1.0)).then(place.becomes(-1.0));
    let turning = body([-1.0, 0.0], [1.0 + place.power(2.0), 0.0.into()]).transition(back);
    let trajectory = run(turning, 1e4 * FRAC_PI_2 + 0.5);
    assert_eq!(trajectory.jumps().len(), 10_000);
    let last = trajectory.jumps().last().expect("there are").at.t;
    assert_near(last, 1e4 * FRAC_PI_2, 1e-9 * 1e4);
}

/// Resets onto the bound of the guard: it holds again at once, or from the next number on.
#[test]
fn resets_onto_guards_end_the_run() {
    let [place, ..] = coordinates();
    for guard in [place.at_least(1.0), place.more_than(1.0)] {
        let again = from(Here).on(Go).to(Here).must(guard).then(place.becomes(1.0));
        let trajectory = run(line().transition(again), 5.0);
        let ending = trajectory.ending();
        assert!(matches!(ending.reason, Reason::JumpLimit(_)), "{ending:?}");
        assert_near(trajectory.ending().at.t, 1.0, 1e-11);
    }
}

/// It is left for 2·10⁻⁹ s.
#[test]
fn an_invariant_that_is_left_for_a_moment_ends_the_run() {
    let [place, speed, time] = coordinates();
    let apart = |x: Expression, at: f64| (x - at).power(2.0).at_least(1e-18);
    let trajectory = run(line().invariant(Here, apart((&place).into(), 3.0)), 10.0);
    assert_eq!(trajectory.ending().reason, Reason::Blocked);
    assert_near(trajectory.ending().at.t, 3.0 - 1e-9, 1e-14);
    let trajectory = run(wave(false).invariant(Here, apart((&time).into(), 3.0)), 10.0);
    assert_near(trajectory.ending().at.t, 3.0 - 1e-9, 1e-14);
    let trajectory = run(wave(false).invariant(Here, speed.more_than(-1.0 + 1e-15)), 10.0);
    let is_said = trajectory.doubts().iter().any(|doubt| doubt.from < PI && PI < doubt.to);
    let is_met = (trajectory.ending().at.t - PI).abs() < 1e-6;
    assert!(is_said || is_met, "{:?} {:?}", trajectory.ending(), trajectory.doubts());
}

/// A function that holds for a millionth of a second is missed, and all of the run is in doubt.
#[test]
fn what_functions_hide_is_said() {
    let hidden = Predicate::function("hidden", |state| {
        Ok(1e-6 - (variable("p").evaluate(state)? - 1.234_567).abs())
    });
    let trajectory = go(line(), hidden, 100.0);
    let is_met = trajectory.jumps().first().is_some_and(|jump| jump.at.t < 1.234_569);
    let mut doubts = trajectory.doubts().iter().filter(|doubt| doubt.why == Why::Function);
    assert!(is_met || doubts.any(|doubt| doubt.from <= 1.2 && doubt.to >= 1.3));
}

/// Formulas of one variable with poles, kinks and jumps.
fn formulas() -> impl Strategy<Value = Expression> {
    let affine = (prop_oneof![0.2..6.0_f64, -6.0..-0.2_f64], -3.0..3.0_f64)
        .prop_map(|(slope, constant)| slope * variable("p") + constant);
    affine.prop_recursive(3, 8, 2, |inner| {
        let inner = inner.boxed();
        let pair = || (inner.clone(), inner.clone());
        let powers = prop::sample::select(vec![-1.0, -2.0, -3.0, 2.0, 3.0, 0.5, -0.5]);
        prop_oneof![
            inner.clone().prop_map(|a| a.tan()),
            inner.clone().prop_map(|a| a.sin()),
            inner.clone().prop_map(|a| a.abs()),
            inner.clone().prop_map(|a| a.tanh()),
            inner.clone().prop_map(|a| a.floor()),
            (inner.clone(), powers).prop_map(|(a, power)| a.power(power)),
            pair().prop_map(|(a, b)| a.atan2(b)),
            pair().prop_map(|(a, b)| a + b),
            pair().prop_map(|(a, b)| a * b),
            pair().prop_map(|(a, b)| a / b),
            pair().prop_map(|(a, b)| a.min(b)),
            pair().prop_map(|(a, b)| {
                piecewise([(a.less_than(&b), a.clone())], b.power(2.0)).expect("a comparison")
            }),
        ]
    })
}

/// How many instants of the run are looked at.
const LOOKS: u32 = 30_000;
const UNTIL: f64 = 3.0;

proptest! {
    #![proptest_config(cases::usually(128))]

    /// The event is no later than the first of many instants at which the guard holds, and the guard
    /// holds there; or a doubt is on record, or the formula has no value on the way.
    #[test]
    fn random_guards_are_met_no_later_than_by_a_scan(
        formula in formulas(),
        bound in -2.0..2.0_f64,
        kind in 0..3,
    ) {
        let guard = formula.at_least(bound);
        let value = formula.compile(&["p"]).expect("the only variable");
        let place = |t: f64| if kind == 0 { t } else { t.sin() };
        let (parts, tolerance) = match kind {
            0 => (line(), 1e-12),
            1 => (wave(false), 1e-11),
            _ => (wave(true), 1e-6),
        };
        let looks = (0..=LOOKS).map(|look| UNTIL * f64::from(look) / f64::from(LOOKS));
        let mut looks = looks.map(|t| (t, value.evaluate(&[place(t)])));
        let seen = looks.find(|(_, value)| value.is_nan() || *value >= bound);
        let trajectory = go(parts, guard.clone(), UNTIL);
        let doubts = trajectory.doubts();
        let is_in_doubt = |t: f64| {
            doubts.iter().any(|doubt| doubt.from - tolerance <= t && t <= doubt.to + tolerance)
        };
        let told = || format!("{guard}, {kind}: {seen:?}, {:?}, {doubts:?}", trajectory.ending());
        match (trajectory.jumps().first(), &trajectory.ending().reason) {
            (Some(jump), _) => {
                let t = jump.at.t;
                let is_late = seen.is_some_and(|(seen, _)| seen + tolerance < t && !is_in_doubt(seen));
                prop_assert!(!is_late, "{} at {t}", told());
                let found = trajectory.value("p", t).expect("the run lasts");
                prop_assert!((found - place(t)).abs() <= tolerance, "{} at {t}", told());
                let holds = guard.evaluate(&[("p", found)]).is_ok_and(|verdict| verdict.holds);
                prop_assert!(holds, "{} at {t}: {found}", told());
            }
            (None, Reason::Horizon) => {
                let is_missed = seen.is_some_and(|(seen, value)| !value.is_nan() && !is_in_doubt(seen));
                prop_assert!(!is_missed, "{}", told());
            }
            (None, Reason::Finished(_)) => {
                let end = trajectory.ending().at.t;
                let is_late = seen.is_some_and(|(seen, value)| {
                    !value.is_nan() && seen + tolerance < end && !is_in_doubt(seen)
                });
                prop_assert!(!is_late, "{}", told());
            }
            _ => prop_assert!(false, "{}", told()),
        }
    }
}
