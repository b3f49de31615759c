//! Sliding along surfaces by Filippov's convention: where it begins, how it goes and where it ends.

use std::f64::consts::PI;

use pleach_automaton::check::{Finding, Kind};
use pleach_automaton::{
    Automaton, Builder, Composition, Coordinates, Filippov, Reason, Trajectory, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::Predicate;
use proptest::prelude::*;

use crate::common::classics::{Gear, Shift};

vocabulary! {
    enum Side: Location { Before = "before", Behind = "behind" }
    enum Way: Event { There = "there", Back = "back", Leave = "leave" }
}
use Side::{Before, Behind};
use Way::{Back, Leave, There};

coordinates! {
    struct Point { x }
    struct Plane { px = "x", py = "y" }
    struct Block { place = "x", speed = "v", clock = "τ" }
}

type Parts<S> = Builder<Side, Way, S>;

/// Two sides of a surface, without flows yet.
fn sides<S: Coordinates>(start: S, there: Predicate, back: Predicate) -> Parts<S> {
    Automaton::starting_in(Before)
        .initially(start)
        .transition(from(Before).on(There).to(Behind).must(there))
        .transition(from(Behind).on(Back).to(Before).must(back))
}

fn sliding<S: Coordinates>(parts: Parts<S>) -> Automaton<Filippov<Side>, Way, S> {
    parts.build().expect("the model is sound").with_sliding().expect("it has a surface")
}

fn run<S: Coordinates>(parts: Parts<S>, horizon: f64) -> Trajectory {
    sliding(parts).run(horizon).expect("the model can be run")
}

/// The instants of the jumps and the locations that they lead to.
fn story(trajectory: &Trajectory) -> Vec<(f64, &str)> {
    let place = |location: usize| trajectory.components()[0].locations[location].as_str();
    trajectory.jumps().iter().map(|jump| (jump.at.t, place(jump.moves[0].target))).collect()
}

/// As `story`, against what it should be.
fn tells(trajectory: &Trajectory, expected: &[(f64, &str)], tolerance: f64) {
    let found = story(trajectory);
    assert_eq!(trajectory.ending().reason, Reason::Horizon, "{found:?}");
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for ((found, place), (exact, other)) in found.iter().zip(expected) {
        assert!((found - exact).abs() <= tolerance && place == other, "{found} {place} {exact}");
    }
}

/// Jumps back and forth are sliding only where both flows lead to the boundary.
#[test]
fn jumps_back_and_forth_along_one_flow_are_no_sliding() {
    let Point { x } = Point::coordinates();
    let reason = |there: f64, back: f64| {
        let parts = sides(Point { x: -1.0 }, x.at_least(0.0), x.at_most(0.0));
        let both = parts.flow(Before, x.rate(there)).flow(Behind, x.rate(back));
        both.build().expect("it is sound").run(2.0).expect("it can be run").ending().reason.clone()
    };
    assert!(matches!(reason(1.0, -1.0), Reason::Sliding(_)));
    assert!(matches!(reason(1.0, 1.0), Reason::JumpLimit(_)));
}

/// However slow a side is, jumps to and fro over one boundary are sliding; with room between the guards they
/// are none, however little it is.
#[test]
fn slow_sliding_is_recognised_and_hysteresis_is_none() {
    let Point { x } = Point::coordinates();
    let reason = |rates: [f64; 2], start: f64, room: f64| {
        let parts = sides(Point { x: start }, x.more_than(0.5), x.at_most(0.5 - room));
        let both = parts.flow(Before, x.rate(rates[0])).flow(Behind, x.rate(-rates[1]));
        both.build().expect("it is sound").run(2e3).expect("it can be run").ending().reason.clone()
    };
    for start in [0.0_f64, -1e3] {
        for rates in [[1.0, 0.01], [1.0, 1e-4], [1.0, 1e-9], [0.01, 1.0], [1e3, 1e-3], [1.0, 1e3]] {
            let rates = rates.map(|rate: f64| if start < 0.0 { rate.max(1.0) } else { rate });
            let Reason::Sliding(sliding) = reason(rates, start, 0.0) else {
                panic!("{rates:?}: {:?}", reason(rates, start, 0.0))
            };
            let share = rates[sliding.locations[0]] / (rates[0] + rates[1]);
            assert!((sliding.share - share).abs() < 1e-9, "{}", sliding.share);
        }
    }
    for room in [1e-3, 1e-6, 1e-9] {
        let slow = [room, room];
        assert_eq!(reason(slow, 0.5 - room, room), Reason::Horizon, "{room}");
    }
}

/// What a run would find is found before it runs, where no reset and no room keeps the sides apart.
#[test]
fn checks_find_where_flows_face_each_other() {
    let Plane { px, py } = Plane::coordinates();
    let found = |rates: [f64; 2], room: f64| {
        let there = (&px + 2.0 * &py).more_than(0.5);
        let back = (&px + 2.0 * &py).at_most(0.5 - room);
        let parts = sides(Plane { px: 0.0, py: 0.0 }, there, back);
        let both = parts
            .flow(Before, [px.rate(rates[0]), py.rate(-1.0)])
            .flow(Behind, [px.rate(-rates[1]), py.rate(1.0)]);
        let report = both.build().expect("it is sound").check();
        let is_sliding = |finding: &&Finding| finding.kind == Kind::Sliding;
        report.findings().iter().find(is_sliding).map(ToString::to_string)
    };
    let text = found([2.01, 2.01], 0.0).expect("both flows lead to the boundary");
    for part in ["warning", "`before`", "`behind`", "with_sliding", "for example at"] {
        assert!(text.contains(part), "{text}");
    }
    assert_eq!(found([2.01, 1.99], 0.0), None, "the flow leads through");
    assert_eq!(found([1.99, 1.99], 0.0), None, "both flows lead away");
    assert_eq!(found([2.01, 2.01], 0.1), None, "there is room");
}

/// Nor are jumps back and forth over two boundaries that meet: no mixture of the flows stays on both.
#[test]
fn jumps_over_two_boundaries_that_meet_are_no_sliding() {
    let Plane { px, py } = Plane::coordinates();
    let reason = |py_back: f64| {
        sides(Plane { px: 0.0, py: 0.0 }, py.at_most(0.0), px.at_most(0.0))
            .flow(Before, [px.rate(0.25), py.rate(-0.75)])
            .flow(Behind, [px.rate(-0.75), py.rate(py_back)])
            .build()
            .expect("it is sound")
            .run(2.0)
            .expect("it can be run")
            .ending()
            .reason
            .clone()
    };
    // One tank is filled while the other runs out, and the hose is moved to and fro.
    assert!(matches!(reason(0.25), Reason::JumpLimit(_)));
    // A quarter of the second flow stays on both boundaries: the state rests in the corner.
    assert!(matches!(reason(2.25), Reason::Sliding(_)));
}

/// Nor are jumps in a circle, though the flows of two of its three locations lead to the boundary.
#[test]
fn jumps_in_a_circle_are_no_sliding() {
    use Gear::{First, Second, Third};
    let Point { x } = Point::coordinates();
    let next = |source, target| from(source).on(Shift::Up).to(target).must(x.at_least(0.0));
    for start in [First, Second, Third] {
        let circle = Automaton::starting_in(start)
            .initially(Point { x: 0.0 })
            .flow(First, x.rate(1.0))
            .flow(Second, x.rate(-1.0))
            .transition(next(First, Second))
            .transition(next(Second, Third))
            .transition(next(Third, First));
        let trajectory = circle.build().expect("it is sound").run(2.0).expect("it can be run");
        assert!(matches!(trajectory.ending().reason, Reason::JumpLimit(_)));
    }
}

#[test]
fn the_opposite_of_the_sign_comes_to_rest_with_closed_and_with_strict_guards() {
    let Point { x } = Point::coordinates();
    let closed = sides(Point { x: 1.0 }, x.at_most(0.0), x.at_least(0.0));
    let strict = sides(Point { x: 1.0 }, x.less_than(0.0), x.more_than(0.0));
    for parts in [closed, strict] {
        let parts = parts.flow(Before, x.rate(-1.0)).flow(Behind, x.rate(1.0));
        let inside =
            parts.clone().invariant(Before, x.at_least(0.0)).invariant(Behind, x.at_most(0.0));
        for parts in [parts, inside] {
            let trajectory = run(parts, 5.0);
            tells(&trajectory, &[(1.0, "before | behind")], 1e-15);
            assert_eq!(trajectory.value("x", 3.0), Ok(0.0));
            assert_eq!(trajectory.location(0, 3.0), Some("before | behind"));
            assert!(trajectory.doubts().is_empty());
        }
    }
}

#[test]
fn a_start_behind_the_surface_is_no_sliding() {
    let Point { x } = Point::coordinates();
    let parts = sides(Point { x: -2.0 }, x.at_most(0.0), x.at_least(0.0))
        .flow(Before, x.rate(-1.0))
        .flow(Behind, x.rate(1.0));
    let expected = [(0.0, "behind"), (2.0, "before | behind")];
    tells(&run(parts, 5.0), &expected, 1e-15);
}

#[test]
fn a_surface_that_is_crossed_is_crossed_as_before() {
    let Plane { px, py } = Plane::coordinates();
    let parts = sides(Plane { px: 1.0, py: 0.0 }, px.less_than(0.0), px.more_than(0.0))
        .flow(Before, [px.rate(-1.0), py.rate(1.0)])
        .flow(Behind, [px.rate(-2.0), py.rate(3.0)]);
    let plain = parts.clone().build().expect("sound").run(2.0).expect("it can be run");
    let trajectory = run(parts, 2.0);
    tells(&trajectory, &[(1.0, "behind")], 1e-15);
    assert_eq!(trajectory.values_at(2.0), plain.values_at(2.0));
}

/// The flow before the surface turns: sliding ends where it no longer leads there, t² ÷ 2 later.
#[test]
fn sliding_ends_on_either_side_where_a_flow_turns_away() {
    let Plane { px, py } = Plane::coordinates();
    let parts = || sides(Plane { px: 0.5, py: -1.0 }, px.at_most(0.0), px.at_least(0.0));
    // With y = t − 1: before the surface ẋ = y, which turns at t = 1; behind it ẋ = 1.
    let first = parts().flow(Before, [px.rate(&py), py.rate(1.0)]);
    let first = first.flow(Behind, [px.rate(1.0), py.rate(1.0)]);
    // x = ½ − t + t² ÷ 2 touches 0 at t = 1, so start nearer.
    let first = first.initially(Plane { px: 0.375, py: -1.0 });
    let trajectory = run(first, 3.0);
    tells(&trajectory, &[(0.5, "before | behind"), (1.0, "before")], 1e-12);
    for t in [1.5, 2.0, 3.0] {
        let x = trajectory.value("x", t).expect("the run lasts");
        assert!((x - 0.5 * (t - 1.0).powi(2)).abs() < 1e-11, "{x} at {t}");
    }
    // The same behind it: ẋ = −1 before, ẋ = −y = 1 − t behind.
    let second = parts().flow(Before, [px.rate(-1.0), py.rate(1.0)]);
    let second = second.flow(Behind, [px.rate(-&py), py.rate(1.0)]);
    let trajectory = run(second, 3.0);
    tells(&trajectory, &[(0.5, "before | behind"), (1.0, "behind")], 1e-12);
    let x = trajectory.value("x", 3.0).expect("the run lasts");
    assert!((x + 2.0).abs() < 1e-11, "{x}");
}

#[test]
fn what_else_is_asked_of_a_crossing_ends_sliding() {
    let Plane { px, py } = Plane::coordinates();
    let parts =
        sides(Plane { px: 1.0, py: 0.0 }, px.at_most(0.0) & py.at_most(2.0), px.at_least(0.0))
            .flow(Before, [px.rate(-1.0), py.rate(1.0)])
            .flow(Behind, [px.rate(1.0), py.rate(1.0)]);
    let trajectory = run(parts, 4.0);
    tells(&trajectory, &[(1.0, "before | behind"), (2.0, "before")], 1e-12);
    assert!(trajectory.value("x", 4.0).is_ok_and(|x| (x + 2.0).abs() < 1e-11));
}

#[test]
fn other_transitions_are_taken_from_the_surface() {
    let Plane { px, py } = Plane::coordinates();
    let parts = sides(Plane { px: 1.0, py: 0.0 }, px.at_most(0.0), px.at_least(0.0))
        .flow(Before, [px.rate(-1.0), py.rate(1.0)])
        .flow(Behind, [px.rate(1.0), py.rate(1.0)])
        .transition(
            from(Behind)
                .on(Leave)
                .to(Before)
                .must(py.at_least(2.0) & px.at_most(0.0))
                .then([px.becomes(3.0), py.becomes(-10.0)]),
        );
    let trajectory = run(parts, 4.0);
    tells(&trajectory, &[(1.0, "before | behind"), (2.0, "before")], 1e-12);
    assert_eq!(trajectory.value("x", 4.0), Ok(1.0));
}

/// Two flows through a circle, one outwards and one inwards, both turning: the state goes round.
#[test]
fn a_curved_surface_is_followed() {
    let Plane { px, py } = Plane::coordinates();
    let radius = || px.power(2.0) + py.power(2.0);
    let parts = sides(Plane { px: 0.5, py: 0.0 }, radius().at_least(1.0), radius().at_most(1.0))
        .flow(Before, [px.rate(&px - &py), py.rate(&py + &px)])
        .flow(Behind, [px.rate(-1.0 * &px - &py), py.rate(&px - &py)]);
    let trajectory = run(parts, 20.0);
    // eᵗ ÷ 2 = 1.
    let begin = 2f64.ln();
    tells(&trajectory, &[(begin, "before | behind")], 1e-9);
    for step in 1..200 {
        let t = begin + 0.09 * f64::from(step);
        let values = trajectory.values_at(t).expect("the run lasts");
        assert!((values[0] - t.cos()).abs() < 1e-7, "{values:?} at {t}");
        assert!((values[1] - t.sin()).abs() < 1e-7, "{values:?} at {t}");
    }
}

/// A block on a plate that shakes: ẍ = a sin t − sgn ẋ. It sticks until the force exceeds friction.
fn shaken(amplitude: f64) -> Parts<Block> {
    let Block { place, speed, clock } = Block::coordinates();
    let motion = |friction: f64| {
        [place.rate(&speed), speed.rate(amplitude * clock.sin() - friction), clock.rate(1.0)]
    };
    let start = Block { place: 0.0, speed: 0.0, clock: 0.0 };
    sides(start, speed.at_most(0.0), speed.at_least(0.0))
        .flow(Before, motion(1.0))
        .flow(Behind, motion(-1.0))
}

/// With a = 5/4 it slips from asin 4/5 until 5/4 (3/5 − cos t) = t − asin 4/5, and half a turn later
/// the other way: the root and the way by mpmath at 40 digits.
#[test]
fn a_shaken_block_sticks_and_slips() {
    const SLIPS: f64 = 0.9272952180016122;
    const STICKS: f64 = 2.8870039059807797;
    const WAY: f64 = 0.23474315327557727;
    let trajectory = run(shaken(1.25), 6.5 * PI);
    let mut expected = vec![(0.0, "before | behind")];
    for half in 0..6 {
        let turn = f64::from(half) * PI;
        let side = if half % 2 == 0 { "before" } else { "behind" };
        expected.push((SLIPS + turn, side));
        expected.push((STICKS + turn, "before | behind"));
    }
    expected.push((SLIPS + 6.0 * PI, "before"));
    tells(&trajectory, &expected, 1e-8);
    for half in 0..6 {
        let stuck = f64::from(half) * PI + 3.5;
        let way = if half % 2 == 0 { WAY } else { 0.0 };
        let values = trajectory.values_at(stuck).expect("the run lasts");
        assert_eq!(values[1], 0.0, "it does not creep");
        assert!((values[0] - way).abs() < 1e-8, "{values:?} at {stuck}");
    }
}

proptest! {
    #![proptest_config(cases::usually(64))]

    /// A block on a spring with dry friction: each swing is shorter by 2 f, and it sticks in the first
    /// turn at which the spring is weaker than friction.
    #[test]
    fn a_block_on_a_spring_swings_less_and_less_and_sticks(
        start in 0.1..20.0_f64,
        friction in 0.5..3.0_f64,
    ) {
        // How far it is at the end of each swing, and whether a turn comes close to sticking.
        let mut turns = vec![start];
        while turns[turns.len() - 1].abs() > friction {
            let last = turns[turns.len() - 1];
            turns.push(-(last - 2.0 * friction * last.signum()));
        }
        prop_assume!(turns.iter().all(|turn| (turn.abs() - friction).abs() > 1e-6));
        let Block { place, speed, clock } = Block::coordinates();
        let motion = |friction: f64| {
            [place.rate(&speed), speed.rate(-friction - &place), clock.rate(1.0)]
        };
        let block = sides(
            Block { place: start, speed: 0.0, clock: 0.0 },
            speed.at_most(0.0),
            speed.at_least(0.0),
        );
        let block = block.flow(Before, motion(friction)).flow(Behind, motion(-friction));
        let trajectory = run(block, 80.0);
        let (last, swings) = (turns[turns.len() - 1], turns.len() - 1);
        let (t, name) = *story(&trajectory).last().expect("it sticks");
        prop_assert_eq!(name, "before | behind");
        prop_assert!((t - swings as f64 * PI).abs() < 1e-9, "{t}");
        let values = trajectory.values_at(80.0).expect("the run lasts");
        prop_assert!((values[0] - last).abs() < 1e-9 && values[1] == 0.0, "{values:?} {last}");
    }
}

#[test]
fn parameters_checks_and_drawings_know_the_surface() {
    let Plane { px, py } = Plane::coordinates();
    let force = pleach_guards::variable("f");
    let parts = sides(Plane { px: 0.0, py: 1.0 }, py.at_most(0.0), py.at_least(0.0))
        .parameter("f", 1.0)
        .range(&px, -10.0..=10.0)
        .flow(Before, [px.rate(&py), py.rate(-&force - &px)])
        .flow(Behind, [px.rate(&py), py.rate(&force - &px)]);
    let automaton = sliding(parts);
    let names: Vec<&str> = automaton
        .locations()
        .iter()
        .map(|location| pleach_discrete::Location::name(*location))
        .collect();
    assert_eq!(names, ["before", "behind", "before | behind"]);
    let drawn = pleach_automaton::diagram::mermaid(&automaton);
    assert!(drawn.contains("before | behind"), "{drawn}");
    for force in [0.5, 2.0] {
        let changed = automaton.with("f", force).expect("it has the parameter");
        let trajectory = changed.run(40.0).expect("it can be run");
        assert_eq!(trajectory.ending().reason, Reason::Horizon, "{:?}", story(&trajectory));
        let rests = trajectory.value("x", 40.0).expect("the run lasts");
        assert!(rests.abs() <= force && trajectory.value("y", 40.0) == Ok(0.0), "{rests}");
    }
    let report = automaton.check();
    assert!(report.is_sound(), "{report}");
}

#[test]
fn surfaces_that_read_other_components_are_refused() {
    let Plane { px, py } = Plane::coordinates();
    let belt = sides(Plane { px: 1.0, py: 0.0 }, px.at_most(&py), px.at_least(&py))
        .flow(Before, px.rate(-1.0))
        .flow(Behind, px.rate(1.0));
    let drive = sides(Point { x: 0.0 }, pleach_guards::never(), pleach_guards::never());
    let drive = drive.build().expect("sound");
    let pair = Composition::builder().add("drive", &drive).add("block", &sliding(belt));
    let error = pair.connect("drive.x", "block.y").build().err().expect("nothing is known of y");
    assert_eq!(
        error.to_string(),
        "component `block` slides along a surface that depends on `y`, but reads it from another \
         component: of its rate nothing is known there"
    );
}

#[test]
fn hysteresis_and_resets_are_no_surfaces() {
    let Point { x } = Point::coordinates();
    let hysteresis = sides(Point { x: 1.0 }, x.at_most(-0.1), x.at_least(0.1));
    let one_way = sides(Point { x: 1.0 }, x.at_most(0.0), x.at_most(0.0));
    for parts in [hysteresis, one_way] {
        let parts = parts.flow(Before, x.rate(-1.0)).flow(Behind, x.rate(1.0));
        assert_eq!(sliding(parts).locations().len(), 2);
    }
}
