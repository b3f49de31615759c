//! What happens in one component is no matter for others.

use pleach_automaton::{
    Accumulation, Automaton, Composition, Limit, Policy, Reason, Settings, from,
};

use super::Cue::{Go, Rest};
use super::Place::{Here, There};
use super::{Body, Machine, One, ball_and_table, built, metronome, ramp, run, times, x};

#[test]
fn what_happens_elsewhere_changes_nothing() {
    let alone = run(&ball_and_table(50.0), 17.0);
    let clocks = (1..=50).map(|number| metronome(0.01 * f64::from(number), 1.0));
    let mut crowd = Composition::builder().add("ball", &ball_and_table(50.0));
    for (number, clock) in clocks.enumerate() {
        crowd = crowd.add(&format!("clock {number}"), &clock);
    }
    let crowd = crowd.build().expect("the parts fit").run(17.0).expect("it can be run");
    let of_ball = crowd.jumps().iter().filter(|jump| jump.moves[0].component == 0);
    let of_ball: Vec<f64> = of_ball.map(|jump| jump.at.t).collect();
    assert_eq!(of_ball, times(&alone));
    assert!(crowd.jumps().is_sorted_by(|one, next| one.at.t <= next.at.t));
    for step in 0..1700 {
        let t = 0.01 * f64::from(step);
        assert_eq!(crowd.value("ball.h", t), alone.value("h", t));
    }
}

#[test]
fn a_hundred_thousand_components_run() {
    let names = (0..100_000).map(|number| format!("clock {number}"));
    let crowd = Composition::builder().add_each(names, &metronome(1.0, 1.0)).build();
    let trajectory = crowd.expect("the parts fit").run(3.5).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    assert_eq!(trajectory.jumps().len(), 300_000);
    assert_eq!(trajectory.value("clock 99999.x", 3.5), Ok(0.5));
}

#[test]
fn policies_and_limits_concern_each_group_alone() {
    // One component is stuck at 1 and leaves as late as it can; the other one may go all the time.
    let late = built(
        ramp()
            .invariant(Here, x().at_most(1.0))
            .transition(from(Here).on(Go).to(There).may(x().at_least(0.0))),
    );
    let free = built(ramp().transition(from(Here).on(Rest).to(There).may(x().at_least(0.0))));
    let pair = Composition::builder().add("late", &late).add("free", &free).build();
    let pair = pair.expect("the parts fit");
    let trajectory = pair.run(2.0).expect("it can be run");
    let labels: Vec<&str> = trajectory.jumps().iter().map(|jump| &*jump.label).collect();
    assert_eq!(labels, ["go"]);
    let early = Settings { policy: Policy::Early, ..Settings::default() };
    let trajectory = pair.run_with(early, 2.0).expect("it can be run");
    assert_eq!(trajectory.jumps().len(), 2);
}

/// A room that is heated from 19 towards 30 and cooled from 23 towards 0; it begins at `start`.
fn thermostat(start: f64) -> (Machine<One>, One) {
    let heated = from(Here).on(Go).to(There).must(x().at_least(23.0));
    let cooled = from(There).on(Rest).to(Here).must(x().at_most(19.0));
    let room = Automaton::starting_in(Here)
        .initially(One { x: start })
        .flow(Here, x().rate(0.1 * (30.0 - &x())))
        .flow(There, x().rate(-0.1 * &x()))
        .transition(heated)
        .transition(cooled);
    (built(room), One { x: start })
}

/// How many pieces and spans a run of many rooms looks at, per jump: twice the smallest limit on
/// steps, of those that are powers of two, with which it comes to its end.
fn steps_per_jump(count: u32) -> f64 {
    let rooms = (0..count).fold(Composition::builder(), |rooms, number| {
        let (room, start) = thermostat(19.0 + 3.9 * f64::from(number) / f64::from(count));
        rooms.add_in(&format!("room {number}"), &room, start)
    });
    let rooms = rooms.build().expect("the parts fit");
    let run = |step_limit| {
        let settings = Settings { step_limit, ..Settings::default() };
        rooms.run_with(settings, 10_000.0 / f64::from(count)).expect("it can be run")
    };
    let enough = |steps: &u64| run(*steps).ending().reason != Reason::Limit(Limit::Steps(*steps));
    let steps = (0..40).map(|power| 1 << power).find(enough).expect("it ends");
    steps as f64 / run(steps).jumps().len() as f64
}

/// The work for an event is the same with one component and with a thousand.
#[test]
fn an_event_costs_the_same_in_a_crowd() {
    let one = steps_per_jump(1);
    for count in [10, 100, 1000] {
        let of_each = steps_per_jump(count);
        // Powers of two leave a factor of 2, and so do the flows that the horizon cuts.
        assert!(of_each <= 4.0 * one, "{count}: {of_each}, of one: {one}");
    }
}

/// The pieces and spans looked at for a bounce, with this many bounces before the horizon.
fn steps_per_bounce(bounces: u32) -> f64 {
    let Body { h, v, .. } = Body::coordinates();
    let ball = built(
        Automaton::starting_in(Here)
            .initially(Body { h: 1.0, v: 0.0, clock: 0.0 })
            .flow(Here, [h.rate(&v), v.rate(-2.0)])
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(h.at_most(0.0) & v.less_than(0.0))
                    .then([v.becomes(-1.0 * &v), h.becomes(0.0)]),
            ),
    );
    let run = |step_limit| {
        let settings =
            Settings { step_limit, accumulation: Accumulation::Off, ..Settings::default() };
        ball.run_with(settings, 2.0 * f64::from(bounces)).expect("it can be run")
    };
    let (mut few, mut enough) = (0_u64, 1 << 24);
    while enough - few > 1 + enough / 256 {
        let steps = few.midpoint(enough);
        let ends = run(steps).ending().reason == Reason::Limit(Limit::Steps(steps));
        if ends { few = steps } else { enough = steps }
    }
    assert_eq!(run(enough).jumps().len(), bounces as usize);
    enough as f64 / f64::from(bounces)
}

/// The work for a bounce is the same before a horizon that is far as before one that is near.
#[test]
fn a_bounce_costs_the_same_whatever_the_horizon() {
    let [few, many] = [100, 3000].map(steps_per_bounce);
    assert!(many <= 1.1 * few, "{many}, of few: {few}");
}
