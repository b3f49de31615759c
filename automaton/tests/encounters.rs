//! Components that meet at one instant, guards with kinks at their crossing, tables, extreme scales, and runs
//! that are cut or repeated: with instants by closed forms or by mpmath at 30 digits.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, LN_2, PI};
use std::thread;

use pleach_automaton::{
    Automaton, Builder, Composition, Policy, Reason, Settings, Trajectory, coordinates, from,
};
use pleach_guards::{Expression, Predicate, Table, constant, maximum, minimum, piecewise};

use crate::common::body::Cue::{self, Back, Go};
use crate::common::body::Place::{self, Here, There};
use crate::common::body::{Body, body, instants, line};

coordinates! {
    struct Link { heard = "h", time = "t", done = "d" }
}

type Part = Automaton<Place, Cue, Link>;

/// A clock that hears of another component, and says once that it is done.
fn link(guard: impl Fn(&Expression, &Expression) -> Predicate) -> Part {
    let Link { heard, time, done } = Link::coordinates();
    let guard = guard(&Expression::from(&heard), &Expression::from(&time));
    Automaton::starting_in(Here)
        .initially(Link { heard: 0.0, time: 0.0, done: 0.0 })
        .flow(Here, time.rate(1.0))
        .flow(There, time.rate(1.0))
        .transition(from(Here).on(Go).to(There).must(guard).then(done.becomes(1.0)))
        .build()
        .expect("it is sound")
}

fn run_with(parts: Builder<Place, Cue, Body>, settings: Settings, horizon: f64) -> Trajectory {
    parts.build().expect("it is sound").run_with(settings, horizon).expect("it can be run")
}

fn go(parts: Builder<Place, Cue, Body>, guard: Predicate, horizon: f64) -> Trajectory {
    let parts = parts.transition(from(Here).on(Go).to(There).must(guard));
    run_with(parts, Settings { step_limit: 1_000_000, ..Settings::default() }, horizon)
}

fn movers(trajectory: &Trajectory) -> Vec<usize> {
    trajectory.jumps().iter().flat_map(|jump| &jump.moves).map(|one| one.component).collect()
}

fn assert_event(trajectory: &Trajectory, exact: f64, tolerance: f64) {
    let found = trajectory.jumps().first().map(|jump| jump.at.t);
    let is_near = found.is_some_and(|found| (found - exact).abs() <= tolerance);
    let (ending, doubts) = (trajectory.ending(), trajectory.doubts());
    assert!(is_near, "{found:?} is not {exact}: {ending:?}, {doubts:?}");
}

/// Either the first event is near an instant, or a doubt is on record there.
fn assert_said(trajectory: &Trajectory, exact: f64, tolerance: f64) {
    let found = trajectory.jumps().first().map(|jump| jump.at.t);
    let is_met = found.is_some_and(|found| (found - exact).abs() <= tolerance);
    let doubts = trajectory.doubts();
    let is_said =
        doubts.iter().any(|doubt| doubt.from - tolerance <= exact && exact <= doubt.to + tolerance);
    assert!(is_met || is_said, "{found:?}, {doubts:?}: {exact}");
}

/// Both may jump at one instant, and each jump disables the other: the first component jumps.
#[test]
fn of_two_that_disable_each_other_one_jumps() {
    let part = link(|heard, time| time.at_least(1.0) & heard.less_than(0.5));
    let duel = Composition::builder()
        .add("one", &part)
        .add("other", &part)
        .connect("one.d", "other.h")
        .connect("other.d", "one.h")
        .build()
        .expect("they fit");
    let trajectory = duel.run(3.0).expect("it can be run");
    assert_eq!((instants(&trajectory), movers(&trajectory)), (vec![1.0], vec![0]));
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
}

/// One makes the next one's guard true, five times at one instant, in whatever order they are added.
#[test]
fn chains_of_urgent_events_take_no_time() {
    let first = link(|_, time| time.at_least(0.7));
    let next = link(|heard, _| heard.at_least(1.0));
    for is_reversed in [false, true] {
        let mut order: Vec<usize> = (0..5).collect();
        if is_reversed {
            order.reverse();
        }
        let chain = order.iter().fold(Composition::builder(), |chain, number| {
            chain.add(&number.to_string(), if *number == 0 { &first } else { &next })
        });
        let chain = (1..5).fold(chain, |chain, number| {
            chain.connect(&format!("{}.d", number - 1), &format!("{number}.h"))
        });
        let trajectory = chain.build().expect("they fit").run(2.0).expect("it can be run");
        assert_eq!(instants(&trajectory), [0.7; 5]);
        assert!(movers(&trajectory).iter().map(|one| order[*one]).eq(0..5));
    }
}

/// Components that jump at the same instant jump in the order in which they were added, whatever the
/// connections between them.
#[test]
fn at_one_instant_components_jump_in_their_order() {
    let late = link(|_, time| time.at_least(0.7));
    let three =
        ["0", "1", "2"].iter().fold(Composition::builder(), |all, name| all.add(name, &late));
    let three = three.connect("0.d", "2.h").build().expect("they fit");
    let trajectory = three.run(2.0).expect("it can be run");
    assert_eq!(instants(&trajectory), [0.7; 3]);
    assert_eq!(movers(&trajectory), [0, 1, 2]);
}

/// A stiff variable that follows the cosine of a clock of another component: k (cos t − x) passes zero, up to
/// what has faded, where tan t = −k.
#[test]
fn a_stiff_component_on_a_clock() {
    let Link { heard, done, .. } = Link::coordinates();
    let clock = link(|_, time| time.at_least(9.0));
    for stiffness in [1e3, 1e6] {
        let follower = Automaton::starting_in(Here)
            .initially(Link { heard: 0.0, time: 0.0, done: 1.0 })
            .flow(Here, done.rate(stiffness * (heard.cos() - &done)))
            .transition(from(Here).on(Go).to(There).must(done.at_most(0.0)))
            .build()
            .expect("it is sound");
        let pair = Composition::builder().add("clock", &clock).add("follower", &follower);
        let pair = pair.connect("clock.t", "follower.h").build().expect("they fit");
        let trajectory = pair.run(5.0).expect("it can be run");
        assert_event(&trajectory, PI - stiffness.atan(), 1e-6);
    }
}

/// Minima, maxima and cases whose kink or jump is where the guard begins to hold.
#[test]
fn kinks_and_jumps_at_the_crossing_are_met_or_said() {
    let Body { place: x, .. } = Body::coordinates();
    let both = || [Expression::from(&x), 2.0 - &x];
    assert_said(&go(line(), maximum(both()).at_most(1.0), 5.0), 1.0, 1e-15);
    assert_said(&go(line(), minimum(both()).at_least(1.0), 5.0), 1.0, 1e-15);
    let waves = || [x.sin(), x.cos()];
    let lowest = maximum(waves()).at_most(FRAC_1_SQRT_2);
    assert_said(&go(line(), lowest, 5.0), FRAC_PI_4, 1e-14);
    let highest = minimum(waves()).at_least(FRAC_1_SQRT_2 - 1e-9);
    assert_event(&go(line(), highest, 5.0), (FRAC_1_SQRT_2 - 1e-9).asin(), 1e-13);
    let case = || piecewise([(x.less_than(1.0), constant(0.0))], 2.0).expect("a comparison");
    assert_event(&go(line(), case().at_least(1.0), 5.0), 1.0, 1e-15);
    let bent = piecewise([(x.at_most(1.0), x.power(2.0))], 2.0 - &x).expect("a comparison");
    assert_said(&go(line(), bent.at_least(1.0), 5.0), 1.0, 1e-15);
}

/// A table that jumps onto the threshold, over it, and to it from a slope, as a guard and as an input of a flow.
#[test]
fn tables_that_jump_at_the_threshold() {
    let Body { place: x, time, .. } = Body::coordinates();
    let steps = Table::steps([(0.0, 0.0), (2.0, 1.0), (3.0, 0.0)]).expect("in order");
    assert_event(&go(line(), steps.at(&x).at_least(1.0), 5.0), 2.0, 1e-15);
    assert!(go(line(), steps.at(&x).more_than(1.0), 5.0).jumps().is_empty());
    let ramp = Table::linear([(0.0, 0.0), (2.0, 1.0), (4.0, 0.0)]).expect("in order");
    assert_said(&go(line(), ramp.at(&x).at_least(1.0), 5.0), 2.0, 1e-15);
    // It rests at zero, then falls to its threshold within a second, and rests there.
    let driven = body([1.0, 0.0], [-steps.at(&time), 0.0.into()]);
    assert_said(&go(driven, x.at_most(0.0), 5.0), 3.0, 1e-12);
    let driven = body([1.0, 0.0], [-steps.at(&time), 0.0.into()]);
    assert_event(&go(driven, x.at_most(0.25), 5.0), 2.75, 1e-12);
}

/// The invariant ends where the transition may be taken first, on lines, curves and oscillations.
#[test]
fn what_may_be_taken_where_the_invariant_ends_is_taken() {
    let Body { place: x, speed, .. } = Body::coordinates();
    let flows: [(Builder<Place, Cue, Body>, f64, f64); 4] = [
        (line(), 1.0, 1.0),
        (body([0.0; 2], [1.0 - &x, 0.0.into()]), 0.5, LN_2),
        (body([0.0, 1.0], [Expression::from(&speed), -Expression::from(&x)]), 0.5, PI / 6.0),
        (body([0.0; 2], [1.0 + x.power(2.0), 0.0.into()]), 1.0, FRAC_PI_4),
    ];
    for (parts, bound, due) in flows {
        for policy in [Policy::Late, Policy::Early, Policy::Random { seed: 3 }] {
            let edge = from(Here).on(Go).to(There).may(x.at_least(bound));
            let parts = parts.clone().invariant(Here, x.at_most(bound)).transition(edge);
            let trajectory = run_with(parts, Settings { policy, ..Settings::default() }, 9.0);
            assert_event(&trajectory, due, 1e-8);
            assert_eq!(trajectory.ending().reason, Reason::Horizon);
        }
    }
}

/// A stay of a nanosecond, far along a long run.
#[test]
fn short_stays_in_long_runs() {
    let Body { place: x, .. } = Body::coordinates();
    for horizon in [1e4, 1e9] {
        let (enters, leaves) = (1000.0, 1000.0 + 1e-9);
        let window = (&x - enters) * (&x - leaves);
        assert_event(&go(line(), window.at_most(0.0), horizon), enters, 1e-12);
        let parts = line()
            .flow(There, x.rate(1.0))
            .transition(from(Here).on(Go).to(There).must(x.at_least(enters) & x.less_than(leaves)))
            .transition(from(There).on(Back).to(Here).must(x.at_least(leaves)));
        let trajectory = run_with(parts, Settings::default(), horizon);
        assert_eq!(instants(&trajectory), [enters, leaves]);
    }
}

/// Decays and pendulums in other units of time and of state.
#[test]
fn scaled_models_are_the_same() {
    let Body { place: x, speed, .. } = Body::coordinates();
    for time in [1e-12, 1.0, 1e12] {
        for size in [1e-12, 1.0, 1e12] {
            let decay = body([size, 0.0], [(-1.0 / time) * &x, 0.0.into()]);
            let trajectory = go(decay, x.at_most(0.5 * size), 10.0 * time);
            assert_event(&trajectory, LN_2 * time, 1e-13 * time);

            let force = (-size / time) * (&x / size).sin();
            let parts = body([size, 0.0], [&speed / time, force]);
            let guard = from(Here).on(Go).to(There).must(x.at_most(0.0));
            let absolute_tolerance = 1e-9 * size;
            let settings = Settings { absolute_tolerance, ..Settings::default() };
            let trajectory = run_with(parts.transition(guard), settings, 10.0 * time);
            // A quarter of the period of a pendulum from 1 rad, by mpmath: K(sin²(1/2)).
            assert_event(&trajectory, 1.674_993_916_092_613 * time, 1e-7 * time);
        }
    }
}

/// A pendulum that is kicked: to the end in one run, and in two.
#[test]
fn runs_that_are_cut_go_on_as_one() {
    let Body { place: x, speed, .. } = Body::coordinates();
    let kicked = || {
        let kick = from(Here).on(Go).to(Here).must(x.at_most(0.0) & speed.less_than(0.0));
        body([1.0, 0.0], [Expression::from(&speed), -x.sin()])
            .transition(kick.then([x.becomes(0.0), speed.becomes(1.1)]))
            .build()
            .expect("it is sound")
    };
    let whole = kicked().run(40.0).expect("it can be run");
    for cut in [20.0, 17.3] {
        let first = kicked().run(cut).expect("it can be run");
        let values = first.values_at(cut).expect("it lasts");
        let state = Body { place: values[0], speed: values[1], time: values[2] };
        let rest = kicked().run_from(state, 40.0 - cut).expect("it can be run");
        let later = instants(&rest).into_iter().map(|time| cut + time);
        let joined: Vec<f64> = instants(&first).into_iter().chain(later).collect();
        assert!(joined.len() > 5);
        assert_eq!(joined.len(), whole.jumps().len());
        let apart = joined.iter().zip(instants(&whole)).map(|(one, other)| (one - other).abs());
        let apart = apart.fold(0.0, f64::max);
        assert!(apart < 1e-7, "{apart}");
    }
}

/// Equal seeds make equal runs, also at the same time on several threads.
#[test]
fn chance_is_repeatable_over_threads() {
    let Body { place: x, .. } = Body::coordinates();
    let parts = line()
        .invariant(Here, x.at_most(1.0))
        .transition(from(Here).on(Go).to(Here).may(x.at_least(0.2)).then(x.becomes(0.0)));
    let automaton = parts.build().expect("it is sound");
    let settings = Settings { policy: Policy::Random { seed: 11 }, ..Settings::default() };
    let run = || automaton.run_with(settings, 50.0).expect("it can be run");
    let alone = run();
    assert!(alone.jumps().len() > 50);
    thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(run)).collect();
        for thread in threads {
            assert_eq!(thread.join().expect("it returns"), alone);
        }
    });
}
