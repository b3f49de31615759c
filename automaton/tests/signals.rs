//! Signals: named formulas that are read in guards, flows and invariants, connected and recorded.

use pleach_automaton::composition::Channel;
use pleach_automaton::composition::stream::CsvLog;
use pleach_automaton::trajectory::NoValue;
use pleach_automaton::{
    Automaton, BuildError, Builder, Composition, CompositionError, Settings, Trajectory,
    coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{always, constant, variable};

vocabulary! {
    enum Place: Location { Running = "running", Done = "done" }
    enum Cue: Event { Finish = "finish", Sample = "sample" }
}
coordinates! {
    struct Coil { current = "i", charge = "q" }
    struct Meter { power = "p", energy = "E" }
    struct Pair { one = "x", other = "y" }
}
use {
    Cue::{Finish, Sample},
    Place::{Done, Running},
};

/// A current that decays from 2 A by R ÷ L = 1 ÷ s, with its voltage and its power.
fn coil() -> Builder<Place, Cue, Coil> {
    let Coil { current, charge } = Coil::coordinates();
    let [voltage, power, resistance] = ["u", "P", "R"].map(variable);
    Automaton::starting_in(Running)
        .initially(Coil { current: 2.0, charge: 0.0 })
        .parameter("R", 3.0)
        .signal("P", &voltage * &current)
        .signal("u", &resistance * &current)
        .flow(Running, [current.rate(-&voltage / 3.0), charge.rate(&current)])
        .invariant(Running, power.at_least(1.5))
        .transition(
            from(Running)
                .on(Finish)
                .to(Done)
                .must(power.at_most(3.0))
                .then(charge.becomes(&charge + &voltage)),
        )
}

/// 12 exp(−2t) W are 3 W after ln 2 s, where the voltage is 3 V and the charge 1 As.
#[test]
fn signals_are_read_in_guards_flows_invariants_and_resets_and_are_recorded() {
    let coil = coil().build().expect("it is sound");
    assert!(coil.signals().map(|(name, _)| name).eq(["P", "u"]));
    let run = coil.run(2.0).expect("it runs");
    let end = 2f64.ln();
    assert_eq!(run.jumps().len(), 1);
    assert!((run.jumps()[0].at.t - end).abs() < 1e-12);
    let value = |name: &str, t: f64| run.value(name, t).expect("it lasts");
    assert!((value("P", 0.25) - 12.0 * (-0.5f64).exp()).abs() < 1e-12);
    assert!((value("u", 1.5) - 3.0).abs() < 1e-12);
    assert!((value("q", 1.5) - 4.0).abs() < 1e-12);
    assert!(coil.check().is_sound(), "{}", coil.check());

    let doubled = coil.with("R", 6.0).expect("there is one").run(2.0).expect("it runs");
    assert!((doubled.value("P", 0.0).expect("it lasts") - 24.0).abs() < 1e-12);

    let account = run.account(&variable("P").at_least(6.0), &[]).expect("it has a value");
    let ends = account.looks.windows(2).find(|pair| pair[0].margin >= 0.0 && pair[1].margin < 0.0);
    assert!(ends.is_some_and(|pair| pair[0].at.t <= 0.5 * end && 0.5 * end <= pair[1].at.t));

    let mut file = Vec::new();
    run.write(&mut file).expect("it is written");
    assert_eq!(Trajectory::read(&file[..]).expect("it is a trajectory"), run);
    let text = String::from_utf8(file).expect("it is text").replace("3 · i", "3 · u");
    let fault = Trajectory::read(text.as_bytes()).expect_err("u is no variable");
    assert!(fault.to_string().contains("signals must be formulas of the variables"), "{fault}");
}

#[test]
fn a_wrong_name_and_a_wrong_time_are_different_errors() {
    let run = coil().build().expect("it is sound").run(2.0).expect("it runs");
    let Err(NoValue::Unknown { known, .. }) = run.value("typo", 1.0) else { panic!("it exists") };
    assert_eq!(known, ["i", "q", "P", "u"]);
    for name in ["i", "P"] {
        assert_eq!(run.value(name, 3.0), Err(NoValue::Outside { t: 3.0, end: 2.0 }));
    }
}

/// What a signal of the coil says is integrated by a meter, and sent to a display.
#[test]
fn signals_are_connected_carried_and_written() {
    let coil = coil().build().expect("it is sound");
    let Meter { power, energy } = Meter::coordinates();
    let meter = Automaton::<_, Cue, _>::starting_in(Running)
        .initially(Meter { power: 0.0, energy: 0.0 })
        .signal("twice", 2 * &power)
        .flow(Running, energy.rate(&power))
        .transition(from(Running).on(Sample).to(Running).may(always()))
        .build()
        .expect("it is sound");
    let both = Composition::builder()
        .add("coil", &coil)
        .add("meter", &meter)
        .add("display", &meter)
        .connect("coil.P", "meter.p")
        .every("meter.sample", 0.25)
        .channel(
            Channel::holding_last("meter.sample")
                .held("meter.twice", "display.p", 5.0)
                .taking(0.1, 0.1),
        )
        .build()
        .expect("they fit together");
    let run = both.run(0.5).expect("it runs");
    let value = |name: &str, t: f64| run.value(name, t).expect("it lasts");
    let exact = |t: f64| 12.0 * (-2.0 * t).exp();
    assert!((value("meter.E", 0.5) - (exact(0.0) - exact(0.5)) / 2.0).abs() < 1e-9);
    assert!((value("meter.twice", 0.5) - 2.0 * exact(0.5)).abs() < 1e-9);
    // What arrives is twice the power, and what the display calls twice is twice that.
    assert_eq!(value("display.twice", 0.05), 10.0);
    assert!((value("display.twice", 0.3) - 4.0 * exact(0.0)).abs() < 1e-9);
    assert!((value("display.twice", 0.4) - 4.0 * exact(0.25)).abs() < 1e-9);

    let first = run.jumps()[0].to_string();
    assert!(first.starts_with("(0 s, 0) meter, clock of meter.sample, "), "{first}");
    let product = both.product().expect("it is data");
    assert!(product.signals().any(|(name, _)| name == "meter.twice"));

    let mut log = CsvLog::every(0.5, Vec::new());
    both.stream(Settings::default(), 0.5, &mut log).expect("it runs");
    let text = String::from_utf8(log.finish().expect("it is written")).expect("it is text");
    let header: Vec<&str> = text.lines().next().expect("a header").split(',').collect();
    let place = header.iter().position(|name| *name == "meter.twice").expect("it is there");
    let first = text.lines().nth(1).and_then(|line| line.split(',').nth(place));
    assert_eq!(first, Some("24"));
}

#[test]
fn signals_that_depend_on_themselves_are_refused_by_name() {
    let [a, b, c] = ["a", "b", "c"].map(variable);
    let begin = || Automaton::<Place, Cue, Pair>::starting_in(Running);
    let built = begin().signal("c", &a + 1).signal("a", &b + 1).signal("b", a.sin()).build();
    let error = built.expect_err("it is a cycle");
    assert!(error.to_string().contains("`a` → `b` → `a`"), "{error}");
    for formula in [constant(1.0), 2.0 * variable("x")] {
        let error = begin().signal("x", formula).build().expect_err("x is a coordinate");
        assert!(matches!(error, BuildError::SignalNameTaken { .. }), "{error}");
    }
    let error = begin().signal("a", &c).build().expect_err("there is no c");
    assert!(matches!(error, BuildError::UnknownVariable { place: "a", .. }), "{error}");
}

/// Each reads the sum of the other.
#[test]
fn signals_of_components_that_depend_on_each_other_are_refused_by_name() {
    let Pair { one, other } = Pair::coordinates();
    let adder = Automaton::<_, Cue, _>::starting_in(Running)
        .initially(Pair { one: 1.0, other: 0.0 })
        .signal("sum", &one + &other)
        .build()
        .expect("it is sound");
    let pair = || Composition::builder().add("p", &adder).add("q", &adder);
    let error = pair().connect("p.sum", "q.y").connect("q.sum", "p.y").build();
    let error = error.err().expect("it is a cycle");
    assert!(matches!(error, CompositionError::SignalCycle { .. }), "{error}");
    for name in ["`p.sum`", "`q.sum`", "`p.y`", "`q.y`"] {
        assert!(error.to_string().contains(name), "{error}");
    }
    let one_way = pair().connect("p.sum", "q.y").build().expect("they fit together");
    let run = one_way.run(1.0).expect("it runs");
    assert_eq!(run.value("q.sum", 1.0), Ok(2.0));
    let error = pair().connect("p.sum", "q.y").connect("p.x", "q.y").build().err();
    assert!(matches!(error, Some(CompositionError::Connection { .. })), "{error:?}");
}
