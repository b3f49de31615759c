//! Every run returns.

use pleach_automaton::{Automaton, Failure, Limit, Reason, Settings, from};

use super::Cue::{Go, Rest};
use super::Place::{Here, There};
use super::{Body, Machine, One, Plane, ball_and_table, built, go, metronome, ramp, run, times, x};

#[test]
fn a_flow_ends_where_it_is_singular() {
    let Plane { px, py } = Plane::coordinates();
    let singular = |rate: pleach_guards::Expression| {
        let machine: Machine<Plane> = built(
            Automaton::starting_in(Here)
                .initially(Plane { px: 0.0, py: 0.0 })
                .flow(Here, [px.rate(1.0), py.rate(rate)]),
        );
        run(&machine, 1.1)
    };
    for power in [-1.0, -2.0, -3.0] {
        let trajectory = singular((&px - 1.0).power(power));
        let Reason::Finished(Failure::Flow { reason, .. }) = &trajectory.ending().reason else {
            panic!("{:?}", trajectory.ending())
        };
        assert!((trajectory.ending().at.t - 1.0).abs() < 1e-9, "{:?}", trajectory.ending());
        assert!(!reason.is_empty());
    }
    let quotient = singular(1.0 / (&px - 1.0));
    assert!((quotient.ending().at.t - 1.0).abs() < 1e-9, "{:?}", quotient.ending());
    // A pole so weak that no step shows it.
    let weak = singular(1e-15 * (&px - 1.0).power(-1.0));
    assert!((weak.ending().at.t - 1.0).abs() < 1e-9, "{:?}", weak.ending());
    // What has no pole goes on.
    assert_eq!(singular(1.0 / (&px + 1.0)).ending().reason, Reason::Horizon);
}

/// The impacts with ω = 200 before 100 s, by a scan and mpmath's `findroot` at 60 digits: the table throws
/// the ball so high that there are four. From impact to impact errors grow some thousandfold.
#[test]
fn a_ball_on_a_fast_table_is_thrown_four_times() {
    let exact = [
        4.464_697_466_376_835,
        38.506_904_579_880_75,
        57.405_176_221_048_81,
        69.464_957_480_901_24,
    ];
    let trajectory = run(&ball_and_table(200.0), 100.0);
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    assert!(trajectory.doubts().is_empty());
    let found = times(&trajectory);
    assert_eq!(found.len(), exact.len(), "{found:?}");
    for ((found, exact), tolerance) in found.iter().zip(exact).zip([2e-15, 1e-11, 1e-7, 1e-3]) {
        assert!((found - exact).abs() < tolerance, "{found} {exact}");
    }
}

/// From 1 s on a clock ticks at every spacing of the numbers.
#[test]
fn jumps_that_leave_no_time_end_the_run() {
    let tick = from(There).on(Rest).to(There).must(x().at_least(1e-16)).then(x().becomes(0.0));
    let begin = from(Here).on(Go).to(There).must(x().at_least(1.0)).then(x().becomes(0.0));
    let ticking = ramp().flow(There, x().rate(1.0)).transition(begin).transition(tick);
    let trajectory = run(&built(ticking), 2.0);
    assert!(matches!(trajectory.ending().reason, Reason::JumpLimit(_)));
    assert!(trajectory.jumps().len() < 10_000, "{:?}", trajectory.ending());
    assert!((trajectory.ending().at.t - 1.0).abs() < 1e-11, "{:?}", trajectory.ending());
}

#[test]
fn limits_end_a_run_with_instant_and_reason() {
    let few = Settings { jump_limit: 10, ..Settings::default() };
    let trajectory = metronome(0.5, 1.0).run_with(few, 100.0).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Limit(Limit::Jumps(10)));
    assert_eq!((trajectory.ending().at.t, trajectory.jumps().len()), (5.5, 10));

    let small = Settings { memory_limit: 100_000, ..Settings::default() };
    let trajectory = metronome(0.5, 1.0).run_with(small, 1e6).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Limit(Limit::Memory(100_000)));

    let short = Settings { step_limit: 100, ..Settings::default() };
    let touching = go((x().sin() + x().cos()).at_least(2f64.sqrt() + 1e-15));
    let trajectory = touching.run_with(short, 1e6).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Limit(Limit::Steps(100)));
    let at = trajectory.ending().at.t;
    assert!(at < 1e6 && trajectory.value("x", at).is_ok_and(|x| (x - at).abs() < 1e-9));
}

/// Limits count in long flows, too, also where nothing but a clock ends them.
#[test]
fn limits_end_a_flow_without_jumps() {
    let Body { h, v, clock } = Body::coordinates();
    let swing: Machine<Body> = built(
        Automaton::starting_in(Here)
            .initially(Body { h: 1.0, v: 0.0, clock: 0.0 })
            .flow(Here, [h.rate(&v), v.rate(-h.power(3.0)), clock.rate(1.0)])
            .transition(from(Here).on(Go).to(There).must(clock.at_least(1e6))),
    );
    for (settings, limit) in [
        (Settings { step_limit: 100, ..Settings::default() }, Limit::Steps(100)),
        (Settings { memory_limit: 100_000, ..Settings::default() }, Limit::Memory(100_000)),
    ] {
        let trajectory = swing.run_with(settings, 2e6).expect("it can be run");
        assert_eq!(trajectory.ending().reason, Reason::Limit(limit));
        assert!(trajectory.ending().at.t < 1e5, "{:?}", trajectory.ending());
    }
}

/// What is infinite from the start on is no overflow, of this variable or another.
#[test]
fn a_variable_may_be_infinite_from_the_start_on() {
    let Plane { px, py } = Plane::coordinates();
    let beside: Machine<Plane> = built(
        Automaton::starting_in(Here)
            .initially(Plane { px: 0.0, py: 1.0 })
            .flow(Here, [px.rate(0.0), py.rate(-1.0 * &py)]),
    );
    let start = Plane { px: f64::INFINITY, py: 1.0 };
    let trajectory = beside.run_from(start, 3.0).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    assert_eq!(trajectory.value("x", 2.0), Ok(f64::INFINITY));
    assert!(trajectory.value("y", 3.0).is_ok_and(|y| (y - (-3f64).exp()).abs() < 1e-9));
}

/// Where the state is coarser than time, an invariant ends many numbers of seconds before it is violated.
#[test]
fn a_flow_ends_at_the_last_instant_within_an_invariant() {
    let from = 1e6;
    let ramp: Machine<One> = built(
        Automaton::starting_in(Here)
            .initially(One { x: from })
            .flow(Here, x().rate(1.0))
            .invariant(Here, x().at_most(from + 1.0)),
    );
    let trajectory = run(&ramp, 3.0);
    assert_eq!(trajectory.ending().reason, Reason::Blocked);
    let end = trajectory.ending().at.t;
    assert!(from + end <= from + 1.0 && from + end.next_up() > from + 1.0, "{end}");
}

/// Where no time can pass from the start on, the ending says which invariant is in the way.
#[test]
fn a_start_outside_an_invariant_is_told() {
    let trajectory = run(&built(ramp().invariant(Here, x().at_least(1.0))), 10.0);
    let Reason::Finished(failure) = &trajectory.ending().reason else {
        panic!("{:?}", trajectory.ending())
    };
    assert_eq!(
        failure.to_string(),
        "component `automaton` begins in location `here` outside its invariant `x ≥ 1`, and no \
         transition can be taken"
    );
}

/// Flows count their time from their start, and runs from theirs: messages have that of the run.
#[test]
fn a_flow_that_fails_after_a_jump_tells_the_time_of_the_run() {
    let Plane { px, py } = Plane::coordinates();
    let singular: Machine<Plane> = built(
        Automaton::starting_in(Here)
            .initially(Plane { px: 0.0, py: 0.0 })
            .flow(Here, [px.rate(1.0)])
            .flow(There, [px.rate(1.0), py.rate((&px - 1.0).power(-1.0))])
            .transition(from(Here).on(Go).to(There).must(px.at_least(3.0)).then(px.becomes(0.0))),
    );
    let trajectory = run(&singular, 10.0);
    let Reason::Finished(failure) = &trajectory.ending().reason else {
        panic!("{:?}", trajectory.ending())
    };
    assert!((trajectory.ending().at.t - 4.0).abs() < 1e-9);
    let message = failure.to_string();
    let time = message.split(" at ").last().and_then(|rest| rest.split(' ').next());
    let time = time.and_then(|time| time.parse::<f64>().ok());
    assert!(time.is_some_and(|time| (time - 4.0).abs() < 1e-9), "{message}");
}
