//! When flows end: at the first instant at which something has to happen, with instants in closed form.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use pleach_automaton::composition::SimulationError;
use pleach_automaton::{
    Automaton, Builder, Doubt, Flow, Limit, Policy, Reason, Settings, Trajectory, Why, from,
};
use pleach_guards::{Predicate, always, constant};
use proptest::prelude::*;

use crate::common::body::Cue::{self, Back, Go};
use crate::common::body::Place::{self, Here, There};
use crate::common::body::{Body, assert_near, body, coordinates, instants, line};

/// How p = sin t and s = cos t are solved.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Linear,
    Integrated,
    Solved,
}

const KINDS: [Kind; 3] = [Kind::Linear, Kind::Integrated, Kind::Solved];

impl Kind {
    fn tolerance(self) -> f64 {
        if matches!(self, Kind::Integrated) { 1e-6 } else { 1e-12 }
    }

    fn flow(self) -> Flow<Body> {
        let [place, speed, time] = coordinates();
        let bent = match self {
            Kind::Linear => constant(0.0),
            Kind::Integrated => 0.0 * place.power(2.0),
            Kind::Solved => {
                return Flow::exact("a wave", |body: &mut Body, duration| {
                    let (sine, cosine) = duration.sin_cos();
                    let Body { place, speed, .. } = *body;
                    body.place = place * cosine + speed * sine;
                    body.speed = speed * cosine - place * sine;
                    body.time += duration;
                });
            }
        };
        Flow::from([place.rate(&speed + bent), speed.rate(-&place), time.rate(1.0)])
    }

    fn wave(self) -> Builder<Place, Cue, Body> {
        let start = Body { place: 0.0, speed: 1.0, time: 0.0 };
        Automaton::starting_in(Here)
            .initially(start)
            .flow(Here, self.flow())
            .flow(There, self.flow())
    }
}

fn run_with(parts: Builder<Place, Cue, Body>, settings: Settings, horizon: f64) -> Trajectory {
    parts.build().expect("it is sound").run_with(settings, horizon).expect("it can be run")
}

fn run(parts: Builder<Place, Cue, Body>, horizon: f64) -> Trajectory {
    let settings = Settings { step_limit: 100_000, ..Settings::default() };
    run_with(parts, settings, horizon)
}

/// Nothing is in doubt but that a flow is a function, and what rounding hides for a moment.
fn is_certain(trajectory: &Trajectory) -> bool {
    let is_harmless = |doubt: &Doubt| doubt.why == Why::Solution || doubt.to - doubt.from < 1e-12;
    trajectory.doubts().iter().all(is_harmless)
}

/// The first instant from `from` on at which sin t ≥ `bound`, between −1 and 1.
fn first_above(bound: f64, from: f64) -> f64 {
    let turn = (from / TAU).floor() * TAU;
    let (rises, falls) = (bound.asin(), PI - bound.asin());
    let risings = [rises - TAU, rises, rises + TAU].map(|rise| turn + rise);
    let is_above = risings.iter().any(|rise| *rise <= from && from <= rise + falls - rises);
    let next = risings.into_iter().find(|rise| *rise >= from);
    if is_above { from } else { next.expect("there is one in each turn") }
}

proptest! {
    #![proptest_config(cases::usually(48))]

    /// A wave and a time that both, or one of which, have to be reached.
    #[test]
    fn a_wave_and_a_time_are_met_together_and_apart(
        bound in -0.99..0.99_f64,
        after in 0.01..20.0_f64,
        kind in prop::sample::select(KINDS.to_vec()),
    ) {
        let [place, _, time] = coordinates();
        // Where the wave is just passed when the time comes, rounding decides.
        let (both, one) = (first_above(bound, after), after.min(first_above(bound, 0.0)));
        prop_assume!(((after.sin() - bound) / bound).abs() > 1e-4);
        let (high, late) = (|| place.at_least(bound), || time.at_least(after));
        let tolerance = 100.0 * kind.tolerance() / (1.0 - bound.abs()).sqrt();
        for (guard, exact) in [(high() & late(), both), (high() | late(), one)] {
            let invariant = !guard.clone();
            let go = from(Here).on(Go).to(There).must(guard.clone());
            let jumping = run(kind.wave().transition(go), 30.0);
            prop_assert!(is_certain(&jumping), "{:?}", jumping.doubts());
            prop_assert_eq!(jumping.jumps().len(), 1, "{:?}", jumping.ending());
            let found = jumping.jumps()[0].at.t;
            prop_assert!((found - exact).abs() <= tolerance, "{guard}: {found} is not {exact}");
            let blocked = run(kind.wave().invariant(Here, invariant.clone()), 30.0);
            let end = blocked.ending().at.t;
            if exact > 0.0 {
                prop_assert_eq!(&blocked.ending().reason, &Reason::Blocked);
            }
            prop_assert!((end - exact).abs() <= tolerance, "{invariant}: {end} is not {exact}");
            // What may be taken from a little before on, is taken at the end, or at once.
            let slack = 0.5 * exact;
            for (policy, due) in [(Policy::Late, exact), (Policy::Early, slack)] {
                let may = from(Here).on(Go).to(There).may(time.at_least(slack));
                let parts = kind.wave().invariant(Here, invariant.clone()).transition(may);
                let left = run_with(parts, Settings { policy, ..Settings::default() }, 30.0);
                prop_assert_eq!(left.jumps().len(), 1, "{:?}", left.ending());
                let found = left.jumps()[0].at.t;
                prop_assert!((found - due).abs() <= tolerance, "{policy:?}: {found} is not {due}");
            }
        }
    }
}

/// Up where the wave passes ½ on its way up, down where it passes −½ on its way down: for many turns, and the
/// same in two runs as in one.
#[test]
fn a_wave_is_met_in_every_turn() {
    let [place, ..] = coordinates();
    for kind in KINDS {
        let parts = || {
            kind.wave()
                .transition(from(Here).on(Go).to(There).must(place.at_least(0.5)))
                .transition(from(There).on(Back).to(Here).must(place.at_most(-0.5)))
        };
        let turns = 60;
        let trajectory = run(parts(), TAU * f64::from(turns));
        let found = instants(&trajectory);
        assert_eq!(found.len(), 2 * turns as usize, "{kind:?}");
        for (number, found) in found.iter().enumerate() {
            let exact = 0.5f64.asin() + PI * number as f64;
            assert_near(*found, exact, (1.0 + number as f64) * kind.tolerance());
        }
        for look in 0..500 {
            let t = TAU * f64::from(turns) * f64::from(look) / 500.0;
            let [values, tolerance] = [(t.sin(), t.cos()), (100.0, 0.0)];
            let near = |name: &str, exact: f64| {
                let found = trajectory.value(name, t).expect("the run lasts");
                assert_near(found, exact, tolerance.0 * kind.tolerance());
            };
            near("p", values.0);
            near("s", values.1);
            near("t", t);
        }
    }
}

/// Time stops at the last number at which the invariant holds, as numbers say it: 10⁹ + t is rounded to
/// multiples of 2⁻²³, so that it is 10⁹ + 1 from t = 1 − 2⁻²⁴ on.
#[test]
fn an_invariant_ends_at_the_last_number_at_which_it_holds() {
    let [place, speed, time] = coordinates();
    let late = (&time + 1e9).less_than(1e9 + 1.0);
    for rates in [[constant(1.0), constant(0.0)], [&speed + 0.0, -&place]] {
        let parts = body([0.0, 1.0], rates).invariant(Here, late.clone());
        let trajectory = run(parts, 5.0);
        assert_eq!(trajectory.ending().reason, Reason::Blocked);
        let last = (1.0 - 2f64.powi(-24)).next_down();
        assert_eq!(trajectory.ending().at.t, last);
    }
}

/// A stay of almost no time, after which something switches before the flow comes to its event.
#[test]
fn a_short_stay_hides_nothing_that_comes_later() {
    let [place, speed, time] = coordinates();
    for short in [1e-300, 1e-17, 1e-9] {
        let parts = body([0.0; 2], [1.0.into(), 0.0.into()])
            .flow(There, [place.rate(&speed), speed.rate(-&place), time.rate(1.0)])
            .transition(
                from(Here)
                    .on(Go)
                    .to(There)
                    .must(time.at_least(short))
                    .then([place.becomes(0.0), speed.becomes(1.0)]),
            )
            .transition(
                from(There).on(Back).to(Here).must(time.at_least(5.0) & place.at_least(0.5)),
            );
        let trajectory = run(parts, 10.0);
        let found = instants(&trajectory);
        assert!(found.len() >= 2, "{:?}", trajectory.ending());
        assert_near(found[0], short, 0.0);
        assert_near(found[1], short + TAU + 0.5f64.asin(), 1e-12);
    }
}

/// The limits of what is looked at and kept hold within a flow, too, which is kept up to there.
#[test]
fn limits_end_a_flow_on_its_way() {
    for (memory_limit, step_limit) in [(20_000, 1_000_000), (1 << 31, 40)] {
        let settings = Settings { memory_limit, step_limit, ..Settings::default() };
        let trajectory = run_with(Kind::Integrated.wave(), settings, 1e4);
        let expected = match step_limit {
            40 => Limit::Steps(40),
            _ => Limit::Memory(20_000),
        };
        assert_eq!(trajectory.ending().reason, Reason::Limit(expected));
        let end = trajectory.ending().at.t;
        assert!(1.0 < end && end < 1000.0, "{end}");
        assert_near(trajectory.value("p", end).expect("the run lasts"), end.sin(), 1e-5);
    }
}

/// A jump leaves at least a state before it, one after it and three lines, of three variables: twelve numbers.
#[test]
fn what_many_jumps_leave_counts_as_memory() {
    let [place, ..] = coordinates();
    let back = from(Here).on(Go).to(Here).must(place.at_least(1.0)).then(place.becomes(0.0));
    let memory_limit = 100_000;
    let settings = Settings { memory_limit, ..Settings::default() };
    let trajectory = run_with(line().transition(back), settings, 1e6);
    assert_eq!(trajectory.ending().reason, Reason::Limit(Limit::Memory(memory_limit)));
    let jumps = trajectory.jumps().len() as u64;
    assert!(100 < jumps && 12 * 8 * jumps < memory_limit, "{jumps}");
}

#[test]
fn settings_without_sense_are_refused() {
    let rest = Settings::default();
    for settings in [
        Settings { relative_tolerance: -1e-9, ..rest },
        Settings { absolute_tolerance: f64::NAN, ..rest },
        Settings { largest_step: -1.0, ..rest },
        Settings { resolution: -1e-3, ..rest },
    ] {
        let run = line().build().expect("it is sound").run_with(settings, 1.0);
        assert!(matches!(run, Err(SimulationError::Settings(_))), "{settings:?}");
    }
}

/// The margin of a sign is no rounding: it excuses no invariant that is violated behind the jump.
#[test]
fn a_sign_excuses_no_state_outside_an_invariant() {
    let [place, ..] = coordinates();
    let parts = line()
        .invariant(There, place.at_most(0.8))
        .transition(from(Here).on(Go).to(There).must((&place - 1.0).sign().at_least(0.5)));
    let trajectory = run(parts, 5.0);
    assert_eq!(trajectory.ending().reason, Reason::Blocked);
    assert_near(trajectory.ending().at.t, 1.0, 1e-12);
}

/// What stays on a bound is not beyond it, whatever else moves.
#[test]
fn a_strict_bound_is_not_passed_at_rest() {
    let [place, speed, _] = coordinates();
    for rate in [constant(0.25), 1.0 - &speed, 1.0 + speed.power(2.0)] {
        let guard = place.more_than(1.0) & speed.at_least(0.5);
        let go = from(Here).on(Go).to(There).must(guard);
        let trajectory = run(body([1.0, 0.0], [constant(0.0), rate]).transition(go), 1.5);
        assert_eq!(trajectory.ending().reason, Reason::Horizon);
        assert!(trajectory.jumps().is_empty() && trajectory.doubts().is_empty());
    }
}

/// A state beyond a bound by rounding, where the flow has met it, is within the invariant behind the bound.
#[test]
fn rounding_at_an_event_leaves_the_invariant_behind_it() {
    let [place, speed, time] = coordinates();
    let bent = || 0.0 * speed.power(2.0);
    for step in 1..40 {
        let bound = 0.024 * f64::from(step);
        for rise in [1.0 - &place, 1.0 - &place + bent(), &place + 0.01 + bent()] {
            let parts = body([0.0; 2], [rise, constant(0.0)])
                .flow(There, [place.rate(-0.3), time.rate(1.0)])
                .invariant(Here, place.at_most(bound))
                .invariant(There, place.at_most(bound) & place.at_least(0.0))
                .transition(from(Here).on(Go).to(There).must(place.at_least(bound)))
                .transition(from(There).on(Back).to(Here).may(always()));
            let trajectory = run(parts, 50.0);
            assert_eq!(trajectory.ending().reason, Reason::Horizon, "{bound}");
            let found = instants(&trajectory);
            assert_near(found[1] - found[0], bound / 0.3, 1e-8);
        }
    }
}

/// What is left behind a strict bound, by lines and by curves: as soon as numbers say it.
#[test]
fn strict_bounds_are_left_at_the_next_number() {
    let [place, _, time] = coordinates();
    for begin in [0.0, 7.0, 1e6] {
        let parts = line()
            .flow(There, place.rate(1.0))
            .transition(
                from(Here).on(Go).to(There).must(time.at_least(begin)).then(place.becomes(0.0)),
            )
            .transition(
                from(There)
                    .on(Back)
                    .to(Here)
                    .must(place.more_than(0.0))
                    .then(time.becomes(begin - 2.0)),
            );
        let trajectory = run(parts, begin + 1.0);
        let found = instants(&trajectory);
        assert_eq!(found.len(), 2, "{:?}", trajectory.ending());
        assert_near(found[1], begin, 1e-300 + 1e-30 * begin);
    }
}

/// At the very end of the run a wave turns at its bound, which rounding hides: it is met or said.
#[test]
fn what_happens_at_the_last_instant_is_met_or_said() {
    let [place, ..] = coordinates();
    for kind in KINDS {
        for (bound, last) in [(1.0, FRAC_PI_2), (0.5, 0.5f64.asin())] {
            let go = || from(Here).on(Go).to(There).must(place.at_least(bound));
            let trajectory = run(kind.wave().transition(go()), last);
            let is_said = trajectory
                .doubts()
                .iter()
                .any(|doubt| doubt.why != Why::Solution && doubt.to >= last - 1e-3);
            assert!(is_said || trajectory.jumps().len() == 1, "{kind:?} {bound}");
            let shorter = run(kind.wave().transition(go()), last - 1e-2);
            assert!(is_certain(&shorter) && shorter.jumps().is_empty(), "{kind:?}");
        }
    }
}

/// The guard has a value only up to the instant at which it holds: √(1 − t) is 0 there.
#[test]
fn the_last_number_with_a_value_is_met() {
    let [place, _, time] = coordinates();
    let rest =
        |guard: Predicate| run(line().transition(from(Here).on(Go).to(There).must(guard)), 5.0);
    for end in [1.0, 3.7] {
        let root = (end - &place).square_root();
        let trajectory = rest(root.at_most(0.0));
        assert_eq!(instants(&trajectory), [end], "{:?}", trajectory.ending());
        let trajectory = rest(root.at_most(-1.0) & time.at_least(0.0));
        assert!(matches!(trajectory.ending().reason, Reason::Finished(_)));
        assert_near(trajectory.ending().at.t, end, 0.0);
    }
}

/// The instant at which p, a function of the time, is first at least 0.
fn first_instant(height: impl Fn(f64) -> f64 + Clone + Send + Sync + 'static, horizon: f64) -> f64 {
    let [place, ..] = coordinates();
    let start = Body { place: height(0.0), speed: 0.0, time: 0.0 };
    let moved = Flow::exact("a function", move |body: &mut Body, duration| {
        body.time += duration;
        body.place = height(body.time);
    });
    let parts = Automaton::<Place, Cue, Body>::starting_in(Here).initially(start).flow(Here, moved);
    let parts = parts.transition(from(Here).on(Go).to(There).must(place.at_least(0.0)));
    let trajectory = run(parts, horizon);
    assert_eq!(trajectory.jumps().len(), 1, "{:?}", trajectory.ending());
    trajectory.jumps()[0].at.t
}

/// A function that comes as near as rounding without getting there, and a little later does for a moment.
#[test]
fn what_nearly_happens_hides_nothing_after_it() {
    for spacings in 1..=16 {
        let below = f64::from(spacings) * f64::EPSILON;
        let height = move |time: f64| {
            let (touch, bump) = (time - 1.0, time - 1.65);
            -below - touch * touch * (bump * bump - 0.0025)
        };
        assert_near(first_instant(height, 4.0), 1.6, 1e-12);
    }
}

/// √h ≤ c, where h falls at 1 from 1 on: right before its last value, and not at it.
#[test]
fn what_holds_before_the_last_value_happens_before_it() {
    let [place, ..] = coordinates();
    for power in 1..=7 {
        let bound = 10f64.powi(-power);
        let fall = body([1.0, 0.0], [(-1.0).into(), 0.0.into()]);
        let go = from(Here).on(Go).to(There).must(place.power(0.5).at_most(bound));
        let trajectory = run(fall.transition(go), 3.0);
        assert_near(trajectory.jumps()[0].at.t, 1.0 - bound * bound, 1e-15);
    }
}
