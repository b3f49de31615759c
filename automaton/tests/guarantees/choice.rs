//! What is left open, and sliding.

use pleach_automaton::{Automaton, Policy, Reason, Settings, from};
use pleach_guards::Predicate;

use super::Cue::{Go, Rest};
use super::Place::{Here, There};
use super::{Machine, One, built, ramp, run, times, x};

/// Leaves between 1 and 3, by one of two edges with one event.
fn wanderer() -> Machine<One> {
    let within = || x().at_least(1.0) & x().at_most(3.0);
    built(
        ramp()
            .invariant(Here, x().at_most(3.0))
            .transition(from(Here).on(Go).to(There).may(within()).then(x().becomes(10.0)))
            .transition(from(Here).on(Go).to(There).may(within()).then(x().becomes(20.0))),
    )
}

#[test]
fn chance_takes_every_instant_and_edge_and_equal_seeds_agree() {
    let runs = |seed: u64| {
        let policy = Policy::Random { seed };
        let settings = Settings { policy, ..Settings::default() };
        wanderer().run_with(settings, 5.0).expect("it can be run")
    };
    let (mut low, mut high, mut first, mut earliest, mut latest) = (0, 0, 0, 3.0_f64, 1.0_f64);
    for seed in 0..400 {
        let trajectory = runs(seed);
        let t = trajectory.jumps().first().map(|jump| jump.at.t);
        let t = t.unwrap_or_else(|| panic!("{seed}: {:?}", trajectory.ending()));
        assert!((1.0..=3.0).contains(&t), "{t}");
        (earliest, latest) = (earliest.min(t), latest.max(t));
        (low, high) = if t < 2.0 { (low + 1, high) } else { (low, high + 1) };
        first += usize::from(trajectory.value("x", t) == Ok(10.0));
    }
    assert!(low > 150 && high > 150, "{low} {high}");
    assert!((150..250).contains(&first), "{first}");
    assert!(earliest < 1.05 && latest > 2.95, "{earliest} {latest}");
    assert_eq!(runs(7), runs(7));
    let late = run(&wanderer(), 5.0);
    assert_eq!(times(&late), [3.0]);
    assert_eq!(late.value("x", 4.0), Ok(10.0), "the edge declared first");
}

/// ẋ = −sgn x, once with guards that hold on the boundary and once with guards that do not.
#[test]
fn sliding_is_recognised() {
    let side = |down: Predicate, up: Predicate| {
        built(
            Automaton::starting_in(Here)
                .initially(One { x: 1.0 })
                .flow(Here, x().rate(-1.0))
                .flow(There, x().rate(3.0))
                .transition(from(Here).on(Go).to(There).must(down))
                .transition(from(There).on(Rest).to(Here).must(up)),
        )
    };
    let closed = side(x().at_most(0.0), x().at_least(0.0));
    let open = side(x().less_than(0.0), x().more_than(0.0));
    for machine in [closed, open] {
        let trajectory = run(&machine, 5.0);
        let Reason::Sliding(sliding) = trajectory.ending().reason else {
            panic!("{:?}", trajectory.ending())
        };
        assert!((trajectory.ending().at.t - 1.0).abs() < 1e-9);
        let mut locations = sliding.locations;
        locations.sort_unstable();
        assert_eq!((sliding.component, locations), (0, [0, 1]));
        // ¾ of the first flow and ¼ of the second stay where they are.
        let share = if sliding.locations[1] == 1 { 0.25 } else { 0.75 };
        assert!((sliding.share - share).abs() < 1e-12, "{sliding:?}");
    }
}
