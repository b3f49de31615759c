//! Questions about compositions, through their products.

use pleach_automaton::composition::{Policy, ProductError};
use pleach_automaton::{Automaton, Composition, Name, Record, from};
use pleach_guards::{Expression, Interval, Predicate, always, constant, variable};
use pleach_verify::reach::{
    Answer, Completion, Effort, Forbidden, Model, ModelError, Settings, verify,
};

use super::support::{Named, boxed, enclosed, escape};

/// A room that is heated from 18 on until 22, by a heater and a controller that sees the temperature
/// and measures the time between two switches.
fn house() -> Composition {
    let [off, on, watching] = ["off", "on", "watching"].map(Name::new);
    let [turn_on, turn_off] = ["turn on", "turn off"].map(Name::new);
    let room = Record::new([("T", 20.0)]).unwrap();
    let t = &room.coordinates()[0];
    let heater: Named = Automaton::starting_in(off)
        .initially(room.clone())
        .flow(off, t.rate(-0.1 * t))
        .flow(on, t.rate(5.0 - 0.1 * t))
        .transition(from(off).on(turn_on).to(on).may(always()))
        .transition(from(on).on(turn_off).to(off).may(always()))
        .build()
        .unwrap();
    let reading = Record::new([("T", 20.0), ("clock", 0.0)]).unwrap();
    let [seen, clock] = &reading.coordinates()[..] else { unreachable!() };
    let controller: Named = Automaton::starting_in(watching)
        .initially(reading.clone())
        .flow(watching, clock.rate(1.0))
        .transition(
            from(watching)
                .on(turn_on)
                .to(watching)
                .must(seen.at_most(18.0))
                .then(clock.becomes(0.0)),
        )
        .transition(
            from(watching)
                .on(turn_off)
                .to(watching)
                .must(seen.at_least(22.0))
                .then(clock.becomes(0.0)),
        )
        .build()
        .unwrap();
    Composition::builder()
        .add("heater", &heater)
        .add("controller", &controller)
        .connect("heater.T", "controller.T")
        .label("turn on")
        .label("turn off")
        .build()
        .unwrap()
}

#[test]
fn a_composition_stays_between_its_bounds() {
    let product = house().product().unwrap();
    let model = Model::of(&product).unwrap();
    assert_eq!(model.variables(), house().variables());
    let names: Vec<&str> = model.locations().iter().map(|place| place.name.as_str()).collect();
    assert_eq!(names, ["off, watching", "on, watching"]);
    let settings = Settings { horizon: 4.0, step: 0.02, ..Settings::default() };
    let start = boxed(&[(19.0, 21.0), (0.0, 0.0)]);
    let temperature = variable(&model.variables()[0]);
    let ask = |forbidden| {
        let forbidden = [Forbidden::anywhere(forbidden)];
        verify(
            &product,
            &[],
            std::slice::from_ref(&start),
            &forbidden,
            &settings,
            &Effort::default(),
        )
        .unwrap()
    };
    assert!(matches!(
        ask(temperature.at_most(17.9) | temperature.at_least(22.1)),
        Answer::Holds(_)
    ));
    assert!(matches!(ask(temperature.at_most(18.1)), Answer::Violated(_)));
    let (_, enclosure) = enclosed(&product, &[], &start, &settings);
    // A run of the composition itself, whose locations are those of its components.
    let run = house().run_with(
        pleach_automaton::Settings { policy: Policy::Late, ..Default::default() },
        settings.horizon,
    );
    let run = run.unwrap();
    assert!(!run.jumps().is_empty());
    for interval in run.intervals() {
        let parts = run.components().iter().zip(&interval.locations);
        let parts: Vec<&str> =
            parts.map(|(component, place)| component.locations[*place].as_ref()).collect();
        let location = names.iter().position(|name| *name == parts.join(", ")).unwrap();
        for sample in &interval.samples {
            let segments = enclosure.visits.iter().filter(|visit| visit.location == location);
            let mut segments = segments.flat_map(|visit| &visit.segments);
            let is_inside = |side: &Interval, value: &f64| {
                side.lower() - 1e-9 <= *value && *value <= side.upper() + 1e-9
            };
            assert!(segments.any(|segment| {
                let sides = segment.set.hull().unwrap();
                segment.time.lower() - 1e-9 <= sample.t
                    && sample.t <= segment.time.upper() + 1e-9
                    && sides.iter().zip(&sample.values).all(|(side, value)| is_inside(side, value))
            }));
        }
    }
}

/// The product runs as the composition does.
#[test]
fn a_product_runs_like_its_composition() {
    let product = house().product().unwrap();
    let alone = Composition::builder().add("house", &product).build().unwrap();
    let [one, other] = [house(), alone].map(|it| it.run(6.0).unwrap());
    assert_eq!(one.jumps().len(), other.jumps().len());
    for (one, other) in one.jumps().iter().zip(other.jumps()) {
        assert!((one.at.t - other.at.t).abs() < 1e-9);
    }
    let model = Model::of(&product).unwrap();
    let settings = Settings { horizon: 6.0, step: 0.02, ..Settings::default() };
    let (_, enclosure) = enclosed(&product, &[], &boxed(&[(20.0, 20.0), (0.0, 0.0)]), &settings);
    assert_eq!(escape(&model, &enclosure, &other, 1e-9), None);
}

/// A thermostat that looks at the temperature once a second; off, this changes at `cooling`, on, it rises by 0.75 a
/// second.
fn sampled_thermostat(cooling: &Expression) -> Named {
    let [off, on, cold, warm] = ["off", "on", "cold", "warm"].map(Name::new);
    let room = Record::new([("T", 20.0)]).unwrap();
    let t = &room.coordinates()[0];
    Automaton::starting_in(off)
        .initially(room.clone())
        .flow(off, t.rate(cooling))
        .flow(on, t.rate(0.75))
        .transition(from(off).on(cold).to(on).may(t.at_most(18.0)))
        .transition(from(on).on(warm).to(off).may(t.at_least(22.0)))
        .every(cold, 1.0)
        .every(warm, 1.0)
        .build()
        .unwrap()
}

/// Whether the temperature of a sampled thermostat is ever in these states.
fn ask_of_sampled(cooling: &Expression, forbidden: Predicate, horizon: f64) -> Answer {
    let room = Composition::builder().add("room", &sampled_thermostat(cooling)).build().unwrap();
    let product = room.product().unwrap();
    let start = product.initial_state().unwrap().values().iter().map(|value| (*value, *value));
    let start = [boxed(&start.collect::<Vec<_>>())];
    let settings = Settings { horizon, step: 0.05, ..Settings::default() };
    let forbidden = [Forbidden::anywhere(forbidden)];
    verify(&product, &[], &start, &forbidden, &settings, &Effort::default()).unwrap()
}

/// Falling by 0.75 a second, it is at 17.75 when it looks at 3 s, then rises up to 22.25 at 9 s. By T' = −T²/500,
/// it is at 17.86 at 3 s.
#[test]
fn a_sampled_loop_takes_every_sample_that_it_can() {
    let t = variable("T");
    let ask = |forbidden, horizon| ask_of_sampled(&constant(-0.75), forbidden, horizon);
    assert!(matches!(ask(t.at_most(17.74), 20.0), Answer::Holds(_)));
    assert!(matches!(ask(t.at_least(22.26), 20.0), Answer::Holds(_)));
    let Answer::Violated(run) = ask(t.at_most(17.8), 5.0) else { panic!("it is there") };
    assert!((run.margin - 0.05).abs() < 1e-9, "{}", run.margin);
    let square = -0.002 * t.power(2.0);
    assert!(matches!(ask_of_sampled(&square, t.at_most(17.5), 5.0), Answer::Holds(_)));
    assert!(matches!(ask_of_sampled(&square, t.at_most(17.9), 5.0), Answer::Violated(_)));
    let alone = Model::of(&sampled_thermostat(&square)).map(|_| ());
    assert!(matches!(alone, Err(ModelError::Sampled { event }) if event == "cold"));
}

/// Every run trips at the second sample and is reset by the check at the same instant.
#[test]
fn a_location_is_entered_whatever_its_clock_samples_then() {
    let [running, tripped, sample, check] =
        ["running", "tripped", "sample", "check"].map(Name::new);
    let state = Record::new([("x", 0.0)]).unwrap();
    let x = &state.coordinates()[0];
    let automaton: Named = Automaton::starting_in(running)
        .initially(state.clone())
        .throughout([x.rate(1.0)])
        .transition(from(running).on(sample).to(tripped).may(x.at_least(0.9)))
        .transition(from(tripped).on(check).to(running).may(always()))
        .every(sample, 0.5)
        .every(check, 0.5)
        .build()
        .unwrap();
    let product = automaton.alone().unwrap().product().unwrap();
    let start = [boxed(&[(0.0, 0.0), (0.5, 0.5)])];
    let settings = Settings { horizon: 2.0, step: 0.02, ..Settings::default() };
    let ask = |location| {
        let forbidden = [Forbidden::within(location, always())];
        verify(&product, &[], &start, &forbidden, &settings, &Effort::default())
    };
    for location in ["tripped", "tripped (sampling check)", "running (sampling check)"] {
        assert!(matches!(ask(location), Ok(Answer::Violated(_))), "{location}");
    }
    let message = ask("trip").unwrap_err().to_string();
    let known = "there is no location `trip`: there are `running (ticking)`, ";
    assert!(message.starts_with(known), "{message}");
}

/// However often a model samples, its question has an answer, which names the limit.
#[test]
fn a_period_far_below_the_horizon_ends_at_a_limit() {
    let [off, on, cold, warm] = ["off", "on", "cold", "warm"].map(Name::new);
    let room = Record::new([("T", 20.0)]).unwrap();
    let t = &room.coordinates()[0];
    for period in [1e-300, 1e-9, 1e-5] {
        let automaton: Named = Automaton::starting_in(off)
            .initially(room.clone())
            .throughout([t.rate(1.0)])
            .transition(from(off).on(cold).to(on).may(t.at_most(30.0)))
            .transition(from(on).on(warm).to(off).may(t.at_most(30.0)))
            .every(cold, period)
            .every(warm, period)
            .build()
            .unwrap();
        let product = automaton.alone().unwrap().product().unwrap();
        let start = [boxed(&[(20.0, 20.0), (period, period)])];
        let settings = Settings { horizon: 1.0, ..Settings::default() };
        let forbidden = [Forbidden::anywhere(t.at_least(25.0))];
        let effort = Effort { random: 4, rounds: 1, variations: 2, ..Effort::default() };
        let answer = verify(&product, &[], &start, &forbidden, &settings, &effort).unwrap();
        let Answer::Undecided(proof) = answer else { panic!("{answer:?}") };
        assert_eq!(proof.enclosure.ending, Completion::JumpLimit, "{period}");
        assert!(proof.enclosure.ending.to_string().contains("`jump_limit`"));
    }
}

#[test]
fn functions_have_no_product() {
    let only = Name::new("flow");
    let state = Record::new([("x", 0.0)]).unwrap();
    let field = pleach_automaton::Flow::field("rest", |state: &Record| state.clone());
    let automaton: Named =
        Automaton::starting_in(only).initially(state).flow(only, field).build().unwrap();
    let composition = Composition::builder().add("it", &automaton).build().unwrap();
    assert!(matches!(composition.product(), Err(ProductError::Function { .. })));
}
