//! Compositions as one automaton.

use petgraph::visit::EdgeRef;
use pleach_automaton::composition::{Channel, ProductError, Reached};
use pleach_automaton::{
    Automaton, Composition, CompositionError, Flow, Name, Record, Reset, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Valuation, always};

vocabulary! {
    enum Lamp: Location { Dark = "dark", Lit = "lit" }
    enum Hand: Event { Press = "press", Flicker = "flicker" }
    enum Clerk: Location { Idle = "idle", Busy = "busy" }
    enum Bell: Event { Press = "press", Nod = "nod" }
}
coordinates! {
    struct Charge { charge = "q" }
    struct Watch { seen = "s", time = "t" }
}
use Clerk::{Busy, Idle};
use Lamp::{Dark, Lit};

/// A lamp that is pressed together with a clerk, who sees its charge, and flickers by itself.
fn office() -> Composition {
    let Charge { charge } = Charge::coordinates();
    let lamp = Automaton::starting_in(Dark)
        .initially(Charge { charge: 0.0 })
        .flow(Lit, charge.rate(-1.0 * &charge))
        .invariant(Lit, charge.at_least(0.125))
        .transition(
            from(Dark).on(Hand::Press).to(Lit).may(always()).then(charge.becomes_within(1.0, 2.0)),
        )
        .transition(from(Lit).on(Hand::Press).to(Dark).may(charge.at_most(1.5)))
        .transition(
            from(Lit)
                .on(Hand::Flicker)
                .to(Lit)
                .at_once(charge.at_most(0.25))
                .then(charge.becomes(&charge + 0.5)),
        )
        .build()
        .expect("it is sound");
    let Watch { seen, time } = Watch::coordinates();
    let clerk = Automaton::starting_in(Idle)
        .initially(Watch { seen: 0.0, time: 0.0 })
        .flow(Idle, time.rate(1.0))
        .flow(Busy, time.rate(2.0))
        .transition(
            from(Idle).on(Bell::Press).to(Busy).must(time.at_least(1.0)).then(time.becomes(0.0)),
        )
        .transition(from(Busy).on(Bell::Press).to(Idle).at_once(seen.at_most(0.75)))
        .transition(from(Busy).on(Bell::Press).to(Busy).may(time.at_least(3.0)))
        .transition(from(Busy).on(Bell::Nod).to(Busy).must(time.at_least(4.0)))
        .build()
        .expect("it is sound");
    Composition::builder()
        .add("lamp", &lamp)
        .add("clerk", &clerk)
        .connect("lamp.q", "clerk.s")
        .label("press")
        .build()
        .expect("the parts fit")
}

/// The transitions in words, in their order.
fn transitions(product: &Automaton<Name, Name, Record>) -> Vec<String> {
    let graph = product.graph();
    let told = graph.edge_references().map(|edge| {
        let [source, target] = [edge.source(), edge.target()].map(|node| graph[node].as_str());
        let (one, reset) = (edge.weight(), edge.weight().reset.name());
        let (event, urgency, guard) = (one.event.as_str(), one.urgency, one.guard.predicate());
        format!("{source}: {event}, {urgency:?} if {guard}, {reset} → {target}")
    });
    told.collect()
}

#[test]
fn a_composition_names_its_parts() {
    let office = office();
    assert!(office.components().eq(["lamp", "clerk"]));
    assert_eq!(office.variables(), ["lamp.q", "clerk.t"]);
    assert!(office.locations(1).eq(["idle", "busy"]) && office.locations(2).next().is_none());
    assert!(office.labels().eq([("press", vec![0, 1])]));
}

#[test]
fn a_product_has_the_transitions_of_its_parts() {
    let product = office().product().expect("all is formulas");
    assert_eq!(product.names(), ["lamp.q", "clerk.t"]);
    assert_eq!(product.initial().as_str(), "dark, idle");
    let expected = [
        "dark, idle: press, Must if clerk.t ≥ 1, lamp.q :∈ [1, 2], clerk.t := 0 → lit, busy",
        "lit, busy: flicker, AtOnce if lamp.q ≤ 0.25, lamp.q := lamp.q + 0.5 → lit, busy",
        "lit, busy: nod, Must if clerk.t ≥ 4,  → lit, busy",
        "lit, busy: press, AtOnce if lamp.q ≤ 1.5 ∧ lamp.q ≤ 0.75,  → dark, idle",
        "lit, busy: press, May if lamp.q ≤ 1.5 ∧ clerk.t ≥ 3,  → dark, busy",
        "dark, busy: nod, Must if clerk.t ≥ 4,  → dark, busy",
        "dark, busy: press, AtOnce if lamp.q ≤ 0.75, lamp.q :∈ [1, 2] → lit, idle",
        "dark, busy: press, May if clerk.t ≥ 3, lamp.q :∈ [1, 2] → lit, busy",
        "lit, idle: flicker, AtOnce if lamp.q ≤ 0.25, lamp.q := lamp.q + 0.5 → lit, idle",
        "lit, idle: press, Must if lamp.q ≤ 1.5 ∧ clerk.t ≥ 1, clerk.t := 0 → dark, busy",
    ];
    assert_eq!(transitions(&product), expected);
    let told = product.locations().iter().map(|location| {
        let mode = product.mode(*location).expect("it is one of its locations");
        let rates = mode.flow.as_ref().and_then(Flow::rates).expect("all are formulas");
        let rates = rates.iter().map(|rate| format!("{}: {}", rate.coordinate(), rate.rate()));
        let invariant = mode.invariant.as_ref().map_or(String::new(), ToString::to_string);
        format!("{}: {}; {invariant}", location.as_str(), rates.collect::<Vec<_>>().join(", "))
    });
    let expected = [
        "dark, idle: clerk.t: 1; ",
        "lit, busy: lamp.q: −1 · lamp.q, clerk.t: 2; lamp.q ≥ 0.125",
        "dark, busy: clerk.t: 2; ",
        "lit, idle: lamp.q: −1 · lamp.q, clerk.t: 1; lamp.q ≥ 0.125",
    ];
    assert_eq!(told.collect::<Vec<_>>(), expected);
}

#[test]
fn a_product_runs_like_its_composition() {
    let office = office();
    let alone = office.product().expect("all is formulas");
    let [apart, together] = [office.run(20.0), alone.run(20.0)].map(|run| run.expect("it runs"));
    let jumps = |run: &pleach_automaton::Trajectory| -> Vec<_> {
        run.jumps().iter().map(|jump| (jump.at, jump.label.clone())).collect()
    };
    assert!(jumps(&apart).len() > 10);
    assert_eq!(jumps(&apart), jumps(&together));
    assert_eq!(apart.values_at(20.0), together.values_at(20.0));
}

#[test]
fn functions_have_no_product() {
    let composed = |flow: Flow<Charge>, reset: Reset<Charge>| {
        let lamp = Automaton::starting_in(Dark)
            .initially(Charge { charge: 0.0 })
            .flow(Dark, flow)
            .transition(from(Dark).on(Hand::Press).to(Lit).may(always()).then(reset))
            .build()
            .expect("it is sound");
        let composition = Composition::builder().add("lamp", &lamp).build().expect("it is sound");
        composition.product().map(|_| ()).map_err(|error| error.to_string())
    };
    let rest = || Flow::from(Charge::coordinates().charge.rate(0.0));
    let function = Flow::field("rest", |state: &Charge| *state);
    let reset = Reset::new("empty", |state: &mut Charge| state.charge = 0.0);
    assert_eq!(composed(rest(), Reset::identity()), Ok(()));
    assert_eq!(
        composed(function, Reset::identity()),
        Err("component `lamp`: the flow of `dark` is a function: write it as formulas".to_owned())
    );
    assert_eq!(
        composed(rest(), reset),
        Err("component `lamp`: the reset of `press` is a function: write it as formulas".to_owned())
    );
}

#[test]
fn products_with_too_many_locations_are_refused() {
    let switch = Automaton::starting_in(Dark)
        .initially(())
        .transition(from(Dark).on(Hand::Press).to(Lit).may(always()))
        .build()
        .expect("it is sound");
    let switches = |count: usize| {
        let names = (0..count).map(|number| format!("switch {number}"));
        let all = names.fold(Composition::builder(), |all, name| all.add(&name, &switch));
        all.build().expect("the names differ").product()
    };
    let three = switches(3).expect("they are few");
    assert_eq!((three.locations().len(), three.graph().edge_count()), (8, 12));
    assert!((13..=15).all(|count| matches!(switches(count), Err(ProductError::Locations))));
}

/// A channel is called after its output, with a dot.
#[test]
fn coordinates_of_one_name_make_no_composition() {
    let [only, tick] = ["only", "tick"].map(Name::new);
    let state = Record::new([("tick →.held 1", 0.0), ("x", 0.0)]).expect("there are two names");
    let built = Automaton::<Name, Name, Record>::starting_in(only)
        .initially(state)
        .transition(from(only).on(tick).to(only).may(always()))
        .build();
    let channel = Channel::holding_last("a.tick").held("a.tick →.held 1", "a.x", 0.0);
    let refused = Composition::builder().add("a", &built.expect("it is sound")).channel(channel);
    let refused = refused.build().map(|_| ());
    assert!(
        matches!(&refused, Err(CompositionError::VariableTwice { variable }) if variable == "a.tick →.held 1"),
        "{refused:?}"
    );
}

#[test]
fn components_have_names_that_can_be_read_back() {
    let lamp = Automaton::<Lamp, Hand, ()>::starting_in(Dark).initially(()).build();
    let lamp = lamp.expect("it is sound");
    for name in ["", "p.q", "a,b", "a\"b", "a\nb"] {
        let one = Composition::builder().add(name, &lamp).build().map(|_| ());
        let each = Composition::builder().add_each(["first", name], &lamp).build().map(|_| ());
        for refused in [one, each] {
            assert_eq!(refused, Err(CompositionError::Name { name: name.to_owned() }));
        }
    }
}

/// Two components of one name are reported before what else is wrong with the second, or with how they are joined.
#[test]
fn repeated_names_are_reported_first() {
    let lamp = |start: Option<()>| {
        let lamp = Automaton::<Lamp, Hand, ()>::starting_in(Dark);
        let lamp = start.into_iter().fold(lamp, pleach_automaton::Builder::initially);
        lamp.build().expect("it is sound")
    };
    let one = || Composition::builder().add("lamp", &lamp(Some(())));
    let alike = Composition::builder().add_each(["lamp"; 2], &lamp(Some(())));
    for both in [one().add("lamp", &lamp(None)), alike.connect("lamp.q", "lamp.s")] {
        let refused = both.build().map(|_| ());
        assert_eq!(refused, Err(CompositionError::NameTwice { name: "lamp".to_owned() }));
    }
}

/// From 1 on by adding 1 and by doubling, as long as the number is at most 5.
#[test]
fn an_exploration_finds_all_numbers_by_the_shortest_ways() {
    let Charge { charge } = Charge::coordinates();
    let small = || charge.at_most(5.0);
    let press =
        from(Dark).on(Hand::Press).to(Dark).may(small()).then(charge.becomes(&charge + 1.0));
    let double =
        from(Dark).on(Hand::Flicker).to(Dark).may(small()).then(charge.becomes(2.0 * &charge));
    let calculator = Automaton::starting_in(Dark)
        .initially(Charge { charge: 1.0 })
        .transition(press)
        .transition(double)
        .build()
        .expect("it is sound");
    let alone = Composition::builder().add("a", &calculator).build().expect("it is one part");
    assert!(alone.explore(7).is_err(), "there are eight");
    let found = alone.explore(8).expect("no time passes");
    let number = |state: &Reached<'_>| state.value("q").expect("it is its coordinate");
    let mut numbers: Vec<f64> = found.states().map(|state| number(&state)).collect();
    numbers.sort_by(f64::total_cmp);
    assert_eq!(numbers, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0]);
    assert_eq!(found.transitions(), 10);
    let mut ends: Vec<f64> = found.deadlocks().map(|state| number(&state)).collect();
    ends.sort_by(f64::total_cmp);
    assert_eq!(ends, [6.0, 8.0, 10.0]);
    let beyond = |bound: f64| {
        let beyond = found.counterexample(&charge.at_most(bound)).expect("it has a value");
        beyond.map(|state| (number(&state), state.path().len()))
    };
    assert_eq!([beyond(7.0), beyond(8.0), beyond(10.0)], [Some((8.0, 3)), Some((10.0, 4)), None]);
}
