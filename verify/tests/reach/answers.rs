//! Questions with known answers.

use pleach_automaton::{Automaton, Name, Record, from};
use pleach_guards::{Predicate, always, variable};
use pleach_verify::reach::{
    Answer, Completion, Effort, Forbidden, ModelError, ReachError, Settings, Uncertain, verify,
};

use super::support::{Named, boxed, enclosed, over};

/// A ball that bounces with the restitution c; `h` is measured from the ground.
fn ball() -> Named {
    let state = Record::new([("h", 10.0), ("v", 0.0)]).unwrap();
    let coordinates = state.coordinates();
    let [h, v] = &coordinates[..] else { unreachable!() };
    let (falling, bounce) = (Name::new("falling"), Name::new("bounce"));
    Automaton::starting_in(falling)
        .initially(state.clone())
        .flow(falling, [h.rate(v), v.rate(-9.81)])
        .invariant(falling, h.at_least(0.0))
        .transition(
            from(falling)
                .on(bounce)
                .to(falling)
                .must(h.at_most(0.0) & v.less_than(0.0))
                .then(v.becomes(-0.75 * v)),
        )
        .build()
        .unwrap()
}

fn asked(
    automaton: &Named,
    start: &[(f64, f64)],
    forbidden: Predicate,
    settings: &Settings,
) -> Answer {
    let starts = [boxed(start)];
    let forbidden = [Forbidden::anywhere(forbidden)];
    verify(automaton, &[], &starts, &forbidden, settings, &Effort::default()).unwrap()
}

#[test]
fn a_ball_stays_below_where_it_begins() {
    let settings = Settings { horizon: 5.0, step: 0.01, ..Settings::default() };
    let start = [(10.0, 10.2), (0.0, 0.0)];
    let high = variable("h").at_least(10.21);
    let Answer::Holds(proof) = asked(&ball(), &start, high, &settings) else { panic!("no proof") };
    assert!(proof.clearances[0] > 0.0 && proof.clearances[0] < 0.02, "{:?}", proof.clearances);
    assert_eq!(proof.enclosure.ending, Completion::Horizon);

    // It falls faster than this just before the ground.
    let fast = variable("v").at_most(-14.0);
    let Answer::Violated(run) = asked(&ball(), &start, fast, &settings) else { panic!("no run") };
    assert!(run.state[1] <= -14.0 && run.is_violation);
    assert!(run.start[0] >= 10.0 && run.start[0] <= 10.2);

    // The truth lies between: no run is so fast, and steps are too long to prove it.
    let fastest = (2.0 * 9.81 * 10.2f64).sqrt();
    let barely = variable("v").at_most(-fastest - 1e-4);
    let coarse = Settings { step: 0.5, ..settings };
    let Answer::Undecided(proof) = asked(&ball(), &start, barely, &coarse) else {
        panic!("decided")
    };
    assert!(!proof.doubts.is_empty());
}

/// An invariant of two alternatives keeps runs in both of them.
#[test]
fn every_alternative_of_an_invariant_counts() {
    let state = Record::new([("x", 0.0)]).unwrap();
    let coordinates = state.coordinates();
    let [x] = &coordinates[..] else { unreachable!() };
    let apart = Name::new("apart");
    let drifting = Automaton::<Name, Name, Record>::starting_in(apart)
        .initially(state.clone())
        .flow(apart, [x.rate(0.1)])
        .invariant(apart, x.at_most(1.0) | x.at_least(2.0))
        .build()
        .unwrap();
    let settings = Settings { horizon: 1.0, step: 0.1, ..Settings::default() };
    for (start, reached) in [((0.0, 0.1), 0.15), ((2.0, 2.1), 2.15)] {
        let comes_there = variable("x").at_least(reached) & variable("x").at_most(reached + 0.01);
        let answer = asked(&drifting, &[start], comes_there, &settings);
        assert!(matches!(answer, Answer::Violated(_)), "from {start:?}: {answer:?}");
        let beyond = variable("x").at_least(reached + 0.1);
        assert!(matches!(asked(&drifting, &[start], beyond, &settings), Answer::Holds(_)));
    }
    // Begun between them on, runs go through both.
    let far = variable("x").at_least(2.15);
    assert!(!matches!(asked(&drifting, &[(0.0, 2.1)], far, &settings), Answer::Holds(_)));
}

#[test]
fn the_margin_of_a_predicate_is_kept() {
    let settings = Settings { horizon: 3.0, step: 0.01, ..Settings::default() };
    let slow = variable("v").at_least(-20.0) & variable("v").at_most(20.0);
    let starts = [boxed(&[(10.0, 10.2), (0.0, 0.0)])];
    let answer = |margin: f64| {
        let below = [Forbidden::below(&slow, margin)];
        verify(&ball(), &[], &starts, &below, &settings, &Effort::default()).unwrap()
    };
    assert!(matches!(answer(5.0), Answer::Holds(_)));
    assert!(matches!(answer(6.1), Answer::Violated(_)));
}

/// Without a horizon the search ends where nothing new is reached.
#[test]
fn all_times_are_covered_where_sets_come_back() {
    let state = Record::new([("T", 20.0)]).unwrap();
    let coordinates = state.coordinates();
    let t = &coordinates[0];
    let [off, on] = ["off", "on"].map(Name::new);
    let [cold, warm] = ["cold", "warm"].map(Name::new);
    let thermostat: Named = Automaton::starting_in(off)
        .initially(state.clone())
        .flow(off, t.rate(-0.1 * t))
        .flow(on, t.rate(5.0 - 0.1 * t))
        .transition(from(off).on(cold).to(on).must(t.at_most(18.0)))
        .transition(from(on).on(warm).to(off).must(t.at_least(22.0)))
        .build()
        .unwrap();
    let settings = Settings { horizon: f64::INFINITY, step: 0.05, ..Settings::default() };
    let (_, enclosure) = enclosed(&thermostat, &[], &boxed(&[(19.0, 21.0)]), &settings);
    assert_eq!(enclosure.ending, Completion::Everything);
    let outside = t.at_most(17.9) | t.at_least(22.1);
    let answer = asked(&thermostat, &[(19.0, 21.0)], outside, &settings);
    assert!(matches!(answer, Answer::Holds(_)));
}

/// A jump at an instant that a clock fixes is taken on entry as well, by states that are past it.
#[test]
fn states_past_the_instant_of_a_jump_take_it_on_entry() {
    let state = Record::new([("c", 1.0)]).unwrap();
    let coordinates = state.coordinates();
    let [c] = &coordinates[..] else { unreachable!() };
    let [wait, done, go] = ["wait", "done", "go"].map(Name::new);
    let timer: Named = Automaton::starting_in(wait)
        .initially(state.clone())
        .flow(wait, c.rate(1.0))
        .transition(from(wait).on(go).to(done).must(c.at_least(1.0)))
        .build()
        .unwrap();
    for lower in [0.9, 1.0 - 1e-10, 1.0, 1.1] {
        let late = Forbidden::within("done", variable("c").at_least(1.5));
        let starts = [boxed(&[(lower, 2.0)])];
        let effort = Effort::default();
        let answer = verify(&timer, &[], &starts, &[late], &Settings::default(), &effort).unwrap();
        assert!(matches!(answer, Answer::Violated(_)), "from {lower}: {answer:?}");
    }
}

/// A stable flow that is back in the box where it began has shown all of its states.
#[test]
fn a_flow_that_returns_into_its_origin_ends() {
    let state = Record::new([("x", 0.0), ("y", 0.0)]).unwrap();
    let coordinates = state.coordinates();
    let [x, y] = &coordinates[..] else { unreachable!() };
    let only = Name::new("flow");
    let spiral: Named = Automaton::starting_in(only)
        .initially(state.clone())
        .flow(only, [x.rate(-x - 2.0 * y), y.rate(2.0 * x - y)])
        .build()
        .unwrap();
    let settings = Settings { horizon: f64::INFINITY, step: 0.02, ..Settings::default() };
    let (_, enclosure) = enclosed(&spiral, &[], &boxed(&[(-1.0, 1.0), (-1.0, 1.0)]), &settings);
    assert_eq!(enclosure.ending, Completion::Everything);
    assert!(enclosure.visits[0].segments.len() < 60);
}

/// Inputs may change at every instant: a swing that is pushed in time goes farther than under any
/// constant force.
#[test]
fn inputs_vary() {
    let state = Record::new([("x", 0.0), ("y", 0.0)]).unwrap();
    let coordinates = state.coordinates();
    let [x, y] = &coordinates[..] else { unreachable!() };
    let only = Name::new("flow");
    let swing: Named = Automaton::starting_in(only)
        .initially(state.clone())
        .parameter("u", 0.0)
        .flow(only, [x.rate(y), y.rate(-x + variable("u"))])
        .build()
        .unwrap();
    let uncertain = |varies| [Uncertain { parameter: "u".into(), values: over(-1.0, 1.0), varies }];
    let settings =
        Settings { horizon: 2.0 * std::f64::consts::PI, step: 0.01, ..Settings::default() };
    let (_, enclosure) =
        enclosed(&swing, &uncertain(true), &boxed(&[(0.0, 0.0), (0.0, 0.0)]), &settings);
    let widest = |enclosure: &pleach_verify::reach::Enclosure| {
        let segments = &enclosure.visits[0].segments;
        segments.iter().map(|segment| segment.set.hull().unwrap()[0].upper()).fold(0.0, f64::max)
    };
    // ∫ |sin| over a turn is 4.
    let reached = widest(&enclosure);
    assert!((4.0..4.05).contains(&reached), "{reached}");
    // Constant, the force is a third coordinate that rests: 1 − cos t is at most 2.
    let start = boxed(&[(0.0, 0.0), (0.0, 0.0), (-1.0, 1.0)]);
    let (model, enclosure) = enclosed(&swing, &uncertain(false), &start, &settings);
    assert_eq!(model.variables(), ["x", "y", "u"]);
    let reached = widest(&enclosure);
    assert!((2.0..2.05).contains(&reached), "{reached}");
}

/// In a location that has to be left at once no time passes, whatever else its flow says.
#[test]
fn no_time_passes_where_a_jump_has_to_be_taken_in_every_state() {
    let state = Record::new([("x", 0.0)]).unwrap();
    let coordinates = state.coordinates();
    let [x] = &coordinates[..] else { unreachable!() };
    let [counting, passing, there] = ["counting", "passing", "there"].map(Name::new);
    let step = Name::new("step");
    let relay = |urgent: bool| {
        let on = from(passing).on(step).to(there);
        let on = if urgent { on.at_once(always()) } else { on.may(always()) };
        Automaton::starting_in(counting)
            .initially(state.clone())
            .throughout([x.rate(1.0)])
            .invariant(there, x.at_most(-1.0))
            .transition(from(counting).on(step).to(passing).must(x.at_least(1.0)))
            .transition(on)
            .build()
            .unwrap()
    };
    let settings = Settings { horizon: 4.0, ..Settings::default() };
    let late = x.at_least(1.5);
    let answer = asked(&relay(true), &[(0.0, 0.0)], late.clone(), &settings);
    assert!(matches!(answer, Answer::Holds(_)), "{answer:?}");
    let answer = asked(&relay(false), &[(0.0, 0.0)], late, &settings);
    assert!(matches!(answer, Answer::Violated(_)), "{answer:?}");
}

#[test]
fn what_cannot_be_asked_is_told() {
    let forbidden = [Forbidden::within("flying", variable("h").at_most(-1.0))];
    let settings = Settings::default();
    let ask = |starts, forbidden: &[Forbidden], settings: &Settings| {
        verify(&ball(), &[], &[boxed(starts)], forbidden, settings, &Effort::default()).unwrap_err()
    };
    let start = [(10.0, 10.0), (0.0, 0.0)];
    let error = ask(&start, &forbidden, &settings);
    assert_eq!(error.to_string(), "there is no location `flying`: there are `falling`");
    let error = ask(&start[..1], &[], &settings);
    assert_eq!(error.to_string(), "the initial set has 1 coordinates, and the model 2: h, v");
    let error = ask(&start, &[], &Settings { step: 0.0, ..settings.clone() });
    assert_eq!(error.to_string(), "`step` is 0, and has to be a duration above 0");
    let error = verify(&ball(), &[], &[], &[], &settings, &Effort::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "no initial states are given: give at least one set in which runs begin"
    );
    let stranger = [Forbidden::anywhere(variable("w").at_most(0.0))];
    let error = ask(&start, &stranger, &settings);
    assert_eq!(error.to_string(), "`w ≤ 0` reads `w`, which is no variable of the model");
    let uncertain = [Uncertain { parameter: "g".into(), values: over(9.0, 10.0), varies: false }];
    let error = verify(&ball(), &uncertain, &[boxed(&start)], &[], &settings, &Effort::default());
    let parameter = "g".to_owned();
    assert_eq!(error.unwrap_err(), ReachError::Model(ModelError::Parameter { parameter }));
}
