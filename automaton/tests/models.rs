//! Models with parameters, in matrix form, with the time, and made from data.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::DMatrix;
use pleach_automaton::check::Kind;
use pleach_automaton::diagram::{latex, mermaid};
use pleach_automaton::{
    Automaton, BuildError, Coordinates, Flow, Name, Record, Vector, coordinates, from, sweep,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, Table, piecewise, variable};

vocabulary! {
    enum Motion: Location { Falling = "falling" }
    enum Contact: Event { Bounce = "bounce" }
}
coordinates! {
    struct Ball { height = "h", velocity = "v" }
    struct Room { temperature = "T", time = "t" }
}
use {Contact::Bounce, Motion::Falling};

/// A ball under gravity g that keeps a part e of its speed.
fn ball() -> Automaton<Motion, Contact, Ball> {
    let Ball { height, velocity } = Ball::coordinates();
    let [gravity, restitution] = ["g", "e"].map(variable);
    Automaton::starting_in(Falling)
        .initially(Ball { height: 10.0, velocity: 0.0 })
        .parameter("g", 9.81)
        .parameter("e", 0.8)
        .flow(Falling, [height.rate(&velocity), velocity.rate(-gravity)])
        .invariant(Falling, height.at_least(0.0))
        .transition(
            from(Falling)
                .on(Bounce)
                .to(Falling)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then(velocity.becomes(-restitution * &velocity)),
        )
        .build()
        .unwrap()
}

#[test]
fn parameters_are_names_in_texts_and_numbers_in_runs() {
    let ball = ball();
    assert!(mermaid(&ball).contains("(−e) · v"), "{}", mermaid(&ball));
    assert!(latex(&ball).contains("-g"), "{}", latex(&ball));
    assert!(ball.parameters().eq([("g", 9.81), ("e", 0.8)]));
    for gravity in [9.81, 1.62, 24.79] {
        let trajectory = ball.with("g", gravity).unwrap().run(10.0).unwrap();
        let fall = (2.0 * 10.0 / gravity).sqrt();
        assert!((trajectory.jumps()[0].at.t - fall).abs() < 1e-12);
    }
    let report = ball.check();
    assert!(report.is_sound(), "{report}");
    // A ball that loses more than its speed lands with a velocity that is no number it can have.
    let report = ball.with("e", -1.0).unwrap().check();
    assert!(report.findings().iter().any(|one| one.kind == Kind::TimelessCycle), "{report}");
}

#[test]
fn automata_with_numbers_step_by_hand() {
    let ball = ball().with_numbers();
    let (mut location, mut state) = (Falling, Ball { height: 0.0, velocity: -5.0 });
    ball.step(&mut location, &mut state).unwrap().unwrap();
    assert_eq!(state.velocity, 4.0);
}

#[test]
fn wrong_parameters_are_refused() {
    let Ball { height, velocity } = Ball::coordinates();
    let begin = || {
        Automaton::<Motion, Contact, Ball>::starting_in(Falling)
            .flow(Falling, height.rate(variable("g") * &velocity))
    };
    let error = begin().build().unwrap_err();
    assert!(matches!(error, BuildError::UnknownVariable { .. }), "{error}");
    let error = begin().parameter("g", 1.0).parameter("v", 1.0).build().unwrap_err();
    assert_eq!(error, BuildError::ParameterNameTaken { parameter: "v".into() });
    let error = begin().parameter("g", f64::NAN).build().unwrap_err();
    assert!(matches!(error, BuildError::ParameterNotFinite { .. }), "{error}");
    let built = begin().parameter("g", 1.0).build().unwrap();
    assert!(built.with("h", 1.0).is_err() && built.with("g", f64::INFINITY).is_err());
}

#[test]
fn sweeps_keep_the_order_and_tell_their_progress() {
    let ball = ball();
    let cases: Vec<f64> = (0..40).map(|step| 1.0 + 0.5 * f64::from(step)).collect();
    let (calls, last) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let progress = |done: usize, all: usize| {
        assert_eq!(all, 40);
        assert_eq!(last.swap(done, Ordering::SeqCst) + 1, done);
        calls.fetch_add(1, Ordering::SeqCst);
    };
    let falls = sweep(&cases, progress, |gravity| {
        ball.with("g", *gravity).unwrap().run(8.0).unwrap().jumps()[0].at.t
    });
    assert_eq!(calls.into_inner(), 40);
    for (gravity, fall) in cases.iter().zip(falls) {
        assert!((fall - (20.0 / gravity).sqrt()).abs() < 1e-12);
    }
    assert_eq!(sweep(&[] as &[u8], |_, _| (), |_| 0), [0; 0]);
}

#[test]
fn linear_flows_are_given_by_matrices() {
    // A ring of springs, 13 coordinates of position and 13 of velocity.
    const N: usize = 26;
    let ring = DMatrix::from_fn(N, N, |row, column| match (row.checked_sub(13), column) {
        (None, _) => f64::from(column == row + 13),
        (Some(here), there) if there < 13 => {
            let is_next = (here + 1) % 13 == there || (there + 1) % 13 == here;
            if here == there { -2.0 } else { f64::from(is_next) }
        }
        _ => 0.0,
    });
    let coordinates = Vector::<N>::coordinates();
    let flow = Flow::linear(&coordinates, &ring, &[0.0; N]).unwrap();
    let mut start = [0.0; N];
    start[0] = 1.0;
    let automaton = Automaton::<Motion, Contact, Vector<N>>::starting_in(Falling)
        .initially(Vector::from(start))
        .flow(Falling, flow)
        .build()
        .unwrap();
    let end = automaton.run(3.0).unwrap().values_at(3.0).unwrap();
    let exact = (ring * 3.0).exp() * Vector::<N>::from(start).0;
    for (found, expected) in end.iter().zip(exact.iter()) {
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    }
    let error = Flow::linear(&coordinates, &DMatrix::zeros(3, 2), &[0.0; N]).unwrap_err();
    assert!(error.to_string().contains("3 rows and 2 columns"), "{error}");
}

/// A room is heated by a table of the day: the temperature is the integral of a polygon.
#[test]
fn time_is_a_coordinate_that_moves_throughout() {
    let Room { temperature, time } = Room::coordinates();
    let heating = Table::linear([(0.0, 0.0), (2.0, 4.0), (3.0, 0.0)]).unwrap();
    let room = Automaton::<Motion, Contact, Room>::starting_in(Falling)
        .initially(Room { temperature: 15.0, time: 0.0 })
        .throughout([time.rate(1.0)])
        .flow(Falling, temperature.rate(heating.at(&time)))
        .build()
        .unwrap();
    let trajectory = room.run(5.0).unwrap();
    let end = trajectory.value("T", 5.0).unwrap();
    assert!((end - 21.0).abs() < 1e-13, "{end}");
    assert_eq!(trajectory.value("t", 5.0), Ok(5.0));
    let function = Flow::field("drift", |room: &Room| *room);
    let error = Automaton::<Motion, Contact, Room>::starting_in(Falling)
        .throughout([time.rate(1.0)])
        .flow(Falling, function)
        .build()
        .unwrap_err();
    assert_eq!(error, BuildError::NoRates { location: "falling" });
}

/// Integration steps end where tables have their points and where cases change: the integral of a saw, of
/// steps and of cases, also backwards, and of a pulse of a millisecond in a quarter of an hour.
#[test]
fn steps_end_at_the_points_of_tables() {
    let Room { temperature, time } = Room::coordinates();
    let integral = |rate: Expression, start: f64, slope: f64, until: f64| {
        let room = Automaton::<Motion, Contact, Room>::starting_in(Falling)
            .initially(Room { temperature: 0.0, time: start })
            .flow(Falling, [temperature.rate(rate), time.rate(slope)])
            .build()
            .unwrap();
        room.run(until).unwrap().value("T", until).unwrap()
    };
    let saw: Vec<(f64, f64)> =
        (0..40).map(|tooth| (0.37 * f64::from(tooth), f64::from(tooth % 2))).collect();
    let teeth = Table::linear(&*saw).unwrap();
    let steps = Table::steps(saw).unwrap();
    let exact = 0.5 * 0.37 * 39.0;
    for (rate, exact) in [(teeth.at(&time), exact), (steps.at(&time), 19.0 * 0.37)] {
        let end = integral(rate.clone(), 0.0, 1.0, 0.37 * 39.0);
        assert!((end - exact).abs() < 1e-10, "{end} {exact}");
        let end = integral(rate, 0.37 * 39.0 - 1e-9, -2.0, 0.5 * 0.37 * 39.0);
        assert!((end - 0.5 * exact).abs() < 1e-8, "{end} {exact}");
    }
    let pulse = Table::linear([(500.0, 0.0), (500.001, 1000.0), (500.002, 0.0)]).unwrap();
    let block = Table::steps([(0.0, 0.0), (500.0, 1000.0), (500.001, 0.0)]).unwrap();
    let case = time.at_least(500.0) & time.less_than(500.001);
    let cases = piecewise([(case, 1000.0.into())], 0.0).unwrap();
    for rate in [pulse.at(&time), block.at(&time), cases] {
        let end = integral(rate, 0.0, 1.0, 900.0);
        assert!((end - 1.0).abs() < 1e-8, "{end}");
    }
}

/// A cascade of tanks, each of which opens the next one when it is full: as many as the data say.
#[test]
fn models_are_built_from_data() {
    let rates = [0.5, 0.25, 1.0, 2.0];
    let tanks = Record::new((0..rates.len()).map(|tank| (format!("level {tank}"), 0.0))).unwrap();
    let levels = tanks.coordinates();
    let places: Vec<Name> =
        (0..=rates.len()).map(|tank| Name::new(&format!("filling {tank}"))).collect();
    let full = Name::new("full");
    let mut model = Automaton::<Name, Name, Record>::starting_in(places[0]).initially(tanks);
    for (tank, rate) in rates.into_iter().enumerate() {
        let (here, next) = (places[tank], places[tank + 1]);
        model = model
            .flow(here, levels[tank].rate(rate))
            .transition(from(here).on(full).to(next).must(levels[tank].at_least(1.0)));
    }
    let cascade = model.build().unwrap();
    assert_eq!(cascade.locations(), places);
    assert_eq!(cascade.events(), [full]);
    assert_eq!(cascade.names()[3], "level 3");
    assert!(mermaid(&cascade).contains("filling 4"));
    let report = cascade.check();
    assert!(report.is_sound(), "{report}");

    let trajectory = cascade.run(20.0).unwrap();
    let instants: Vec<f64> = trajectory.jumps().iter().map(|jump| jump.at.t).collect();
    assert_eq!(instants, [2.0, 6.0, 7.0, 7.5]);
    assert_eq!(trajectory.location(0, 7.2), Some("filling 3"));
    assert_eq!(trajectory.value("level 1", 4.0), Ok(0.5));
    assert!(Record::new([("x", 1.0), ("x", 2.0)]).is_err());
}

#[test]
fn records_reach_functions_with_their_names() {
    let start = Record::new([("x", 1.0), ("y", 0.0)]).unwrap();
    let place = Name::new("anywhere");
    let turn =
        Flow::field("turn", |state: &Record| state.like(&[-state.values()[1], state.values()[0]]));
    let turning = Automaton::<Name, Name, Record>::starting_in(place)
        .initially(start)
        .flow(place, turn)
        .build()
        .unwrap();
    let trajectory = turning.run(1.0).unwrap();
    assert!((trajectory.value("x", 1.0).unwrap() - 1f64.cos()).abs() < 1e-8);
}
