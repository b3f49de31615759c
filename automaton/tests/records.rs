//! What settings do to a run, and what its record says: methods, doubts, times of failures, files.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::io::{self, Write};

use pleach_automaton::composition::{Method, ReplayError};
use pleach_automaton::{
    Automaton, Builder, Composition, Failure, Flow, Reason, Settings, Trajectory, Why, coordinates,
    from,
};
use pleach_discrete::vocabulary;
use pleach_guards::always;

vocabulary! {
    enum Place: Location { Waiting = "waiting", Running = "running" }
    enum Cue: Event { Start = "start", Stop = "stop" }
}
coordinates! {
    struct Plane { px = "x", py = "y" }
}
use Cue::{Start, Stop};
use Place::{Running, Waiting};

type Parts = Builder<Place, Cue, Plane>;

fn parts(start: Plane) -> Parts {
    Automaton::starting_in(Running).initially(start)
}

fn run_by(method: Method, parts: Parts, horizon: f64) -> Trajectory {
    let settings = Settings { method, ..Settings::default() };
    parts.build().unwrap().run_with(settings, horizon).unwrap()
}

/// y follows cos x within 10 µs: the explicit method takes steps as short as that.
#[test]
fn the_method_of_integration_is_a_setting() {
    let Plane { px, py } = Plane::coordinates();
    let follower = || {
        parts(Plane { px: 0.0, py: 1.0 })
            .flow(Running, [px.rate(1.0), py.rate(-1e5 * (&py - px.cos()) - px.sin())])
    };
    let steps = |method: Method| {
        let trajectory = run_by(method, follower(), 0.5);
        assert_eq!(trajectory.ending().reason, Reason::Horizon);
        let end = trajectory.value("y", 0.5).unwrap();
        assert!((end - 0.5f64.cos()).abs() < 1e-6, "{method:?}: {end}");
        trajectory.intervals().map(|phase| phase.samples.len()).sum::<usize>()
    };
    let [automatic, explicit, implicit] =
        [Method::Automatic, Method::Explicit, Method::Implicit].map(steps);
    assert!(
        explicit > 2 * automatic && explicit > 2 * implicit,
        "{automatic} {explicit} {implicit}"
    );
    // Settings are a part of the record, and a record without a method was made by the automatic one.
    let settings = Settings { method: Method::Implicit, ..Settings::default() };
    let text = serde_json::to_string(&settings).unwrap();
    assert!(text.contains(r#""method":"Implicit""#), "{text}");
    assert_eq!(serde_json::from_str::<Settings>(&text).unwrap(), settings);
    let older = text.replace(r#""method":"Implicit","#, "");
    assert_eq!(serde_json::from_str::<Settings>(&older).unwrap(), Settings::default());
}

/// A function could be singular between two of the states that an integrator looks at.
#[test]
fn rates_that_are_a_function_are_a_doubt_on_record() {
    let circle = Flow::field("turn", |state: &Plane| Plane { px: state.py, py: -state.px });
    let trajectory =
        run_by(Method::Automatic, parts(Plane { px: 1.0, py: 0.0 }).flow(Running, circle), 3.0);
    let [doubt] = trajectory.doubts() else { panic!("{:?}", trajectory.doubts()) };
    assert_eq!((doubt.why, doubt.from, doubt.to), (Why::Field, 0.0, 3.0));
    assert!(doubt.to_string().contains("rates are a function"), "{doubt}");
}

/// A solution that turns fifty times as fast as time is followed in pieces that polynomials fit.
#[test]
fn events_of_a_fast_solution_are_found() {
    let Plane { px, .. } = Plane::coordinates();
    let turn = Flow::exact("turn", |state: &mut Plane, time| {
        let (sine, cosine) = (50.0 * time).sin_cos();
        let Plane { px, py } = *state;
        (state.px, state.py) = (cosine * px - sine * py, sine * px + cosine * py);
    });
    let back = from(Running).on(Stop).to(Waiting).must(px.at_most(-0.5));
    let turning = parts(Plane { px: 1.0, py: 0.0 }).flow(Running, turn).transition(back);
    let trajectory = run_by(Method::Automatic, turning, 10.0);
    let [jump] = trajectory.jumps() else { panic!("{:?}", trajectory.jumps()) };
    let exact = std::f64::consts::TAU / 150.0;
    assert!((jump.at.t - exact).abs() < 1e-9, "{} is not {exact}", jump.at.t);
    let [doubt] = trajectory.doubts() else { panic!("{:?}", trajectory.doubts()) };
    assert_eq!((doubt.why, doubt.from), (Why::Solution, 0.0));
}

/// After 2.5 s of waiting comes a flow that ends: ẏ = y² at 1 ÷ y₀ later, ẏ = √(1 − x) a second later.
#[test]
fn failures_of_flows_tell_the_time_of_the_run() {
    let Plane { px, py } = Plane::coordinates();
    let escape: Flow<Plane> = [px.rate(1.0), py.rate(py.power(2.0))].into();
    let root: Flow<Plane> = [px.rate(1.0), py.rate((1.0 - &px).square_root())].into();
    let pole: Flow<Plane> = [px.rate(1.0), py.rate((&px - 1.0).power(-1.0))].into();
    let vanishing = Flow::field("vanish", |state: &Plane| Plane {
        px: 1.0,
        py: if state.px < 1.0 { 0.0 } else { f64::NAN },
    });
    for flow in [escape, root, pole, vanishing] {
        for method in [Method::Automatic, Method::Explicit, Method::Implicit] {
            let parts = Automaton::starting_in(Waiting)
                .initially(Plane { px: -2.5, py: 1.0 })
                .flow(Waiting, px.rate(1.0))
                .flow(Running, flow.clone())
                .transition(from(Waiting).on(Start).to(Running).must(px.at_least(0.0)))
                .transition(from(Running).on(Stop).to(Waiting).must(px.at_least(5.0)));
            let trajectory = run_by(method, parts, 10.0);
            let Reason::Finished(Failure::Flow { reason, .. }) = &trajectory.ending().reason else {
                panic!("{flow}: {:?}", trajectory.ending())
            };
            assert!(
                (trajectory.ending().at.t - 3.5).abs() < 1e-3,
                "{flow}: {:?}",
                trajectory.ending()
            );
            assert!(reason.contains("at 3.") && !reason.contains("0.99"), "{flow}: {reason}");
        }
    }
}

/// Counts how often it is written to.
#[derive(Default)]
struct Counter {
    calls: usize,
    bytes: Vec<u8>,
}

impl Write for &mut Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.calls += 1;
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_trajectory_is_written_in_blocks() {
    let Plane { px, .. } = Plane::coordinates();
    let clock = parts(Plane { px: 0.0, py: 0.0 }).flow(Running, px.rate(1.0)).transition(
        from(Running).on(Start).to(Running).must(px.at_least(0.01)).then(px.becomes(0.0)),
    );
    let trajectory = run_by(Method::Automatic, clock, 10.0);
    let mut file = Counter::default();
    trajectory.write(&mut file).unwrap();
    let length = file.bytes.len();
    assert!(length > 100_000 && file.calls < length / 4096, "{} calls", file.calls);
    assert_eq!(Trajectory::read(&file.bytes[..]).unwrap(), trajectory);
}

/// What components do apart is told apart: doubts name their component.
#[test]
fn doubts_name_their_components() {
    let still = parts(Plane { px: 0.0, py: 0.0 })
        .transition(from(Running).on(Start).to(Waiting).may(always()));
    let circle = Flow::field("turn", |state: &Plane| Plane { px: state.py, py: -state.px });
    let turning = parts(Plane { px: 1.0, py: 0.0 }).flow(Running, circle);
    let pair = Composition::builder()
        .add("still", &still.build().unwrap())
        .add("turning", &turning.build().unwrap())
        .build()
        .unwrap();
    let trajectory = pair.run(1.0).unwrap();
    assert!(trajectory.doubts().iter().all(|doubt| doubt.components == [1]));
    assert_eq!(trajectory.doubts().len(), 1);
}

/// A record is replayed by the composition that it is of, down to the last bit.
#[test]
fn a_record_of_another_composition_is_not_replayed() {
    let Plane { px, py } = Plane::coordinates();
    let composed = |names: [&str; 2], start: f64| {
        let moving =
            parts(Plane { px: start, py: 0.0 }).flow(Running, [px.rate(1.0), py.rate(&px)]);
        let moving = moving.build().unwrap();
        let empty = Composition::builder().add(names[0], &moving);
        empty.add(names[1], &moving).build().unwrap()
    };
    let record = composed(["a", "b"], 0.0).run(2.0).unwrap();
    assert_eq!(composed(["a", "b"], 0.0).replay(&record), Ok(()));
    let other = composed(["a", "c"], 0.0).replay(&record);
    assert_eq!(other, Err(ReplayError::OtherComposition("variables")));
    let differs = composed(["a", "b"], 1e-300).replay(&record);
    assert!(matches!(differs, Err(ReplayError::Diverged { at }) if at.t == 0.0), "{differs:?}");
    let still = |name: &str| {
        let still =
            Automaton::<Place, Cue, ()>::starting_in(Running).initially(()).build().unwrap();
        Composition::builder().add(name, &still).build().unwrap()
    };
    let record = still("a").run(2.0).unwrap();
    assert_eq!(still("a").replay(&record), Ok(()));
    assert_eq!(still("b").replay(&record), Err(ReplayError::OtherComposition("components")));
    let bare = Composition::builder().add("a", &common_place()).build().unwrap();
    assert_eq!(bare.replay(&record), Err(ReplayError::OtherComposition("locations")));
}

/// An automaton with no variable and one location.
fn common_place() -> Automaton<crate::common::classics::Motion, Cue, ()> {
    Automaton::starting_in(crate::common::classics::Motion::Falling).initially(()).build().unwrap()
}
