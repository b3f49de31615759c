//! What leaves a superstate leaves each of its locations, in runs, checks and drawings.

use pleach_automaton::{
    Automaton, BuildError, Builder, Edge, Settings, coordinates, diagram, from, from_any,
};
use pleach_discrete::{Superstate, vocabulary};
use pleach_guards::always;

vocabulary! {
    enum Pump: Location { Off = "off", Filling = "filling", Draining = "draining", Flushing = "flushing" }
    enum Command: Event { Full = "full", Empty = "empty", Stopped = "stopped", Counted = "counted" }
}
coordinates! { struct Tank { level = "l", time = "t", count = "n" } }
use Command::{Counted, Empty, Full, Stopped};
use Pump::{Draining, Filling, Flushing, Off};

const RUNNING: Superstate<Pump> = Superstate::new("running", &[Filling, Draining, Flushing]);
const OUTWARD: Superstate<Pump> = Superstate::new("outward", &[Draining, Flushing]);

type Tanks = Builder<Pump, Command, Tank>;

/// A pump without the transitions that leave all locations in which it runs.
fn pump() -> Tanks {
    let Tank { level, time, .. } = Tank::coordinates();
    Automaton::starting_in(Filling)
        .initially(Tank { level: 0.0, time: 0.0, count: 0.0 })
        .throughout([time.rate(1.0)])
        .flow(Filling, level.rate(1.0))
        .flow(Draining, level.rate(-2.0))
        .flow(Flushing, level.rate(-4.0))
        .transition(from(Filling).on(Full).to(Draining).must(level.at_least(1.0)))
        .transition(from(Draining).on(Full).to(Flushing).must(level.at_most(0.5)))
}

fn in_superstates() -> Automaton<Pump, Command, Tank> {
    let Tank { level, time, count } = Tank::coordinates();
    pump()
        .transition(from_any(OUTWARD).on(Empty).to(Filling).must(level.at_most(0.25)))
        .transition(from_any(RUNNING).on(Stopped).to(Off).must(time.at_least(5.0)))
        .transition(
            from_any(RUNNING)
                .on(Counted)
                .stay()
                .must(time.at_least(0.875 + &count))
                .then([count.becomes(1.0 + &count)])
                .priority(1),
        )
        .build()
        .expect("the parts fit")
}

/// The same, location by location.
fn one_by_one() -> Automaton<Pump, Command, Tank> {
    let Tank { level, time, count } = Tank::coordinates();
    let [filling, draining, flushing] = [Filling, Draining, Flushing].map(from);
    let counted = |location: Pump| {
        from(location)
            .on(Counted)
            .to(location)
            .must(time.at_least(0.875 + &count))
            .then([count.becomes(1.0 + &count)])
            .priority(1)
    };
    pump()
        .transition(draining.on(Empty).to(Filling).must(level.at_most(0.25)))
        .transition(flushing.on(Empty).to(Filling).must(level.at_most(0.25)))
        .transition(filling.on(Stopped).to(Off).must(time.at_least(5.0)))
        .transition(draining.on(Stopped).to(Off).must(time.at_least(5.0)))
        .transition(flushing.on(Stopped).to(Off).must(time.at_least(5.0)))
        .transition(counted(Filling))
        .transition(counted(Draining))
        .transition(counted(Flushing))
        .build()
        .expect("the parts fit")
}

#[test]
fn a_superstate_runs_like_its_locations() {
    let (together, apart) = (in_superstates(), one_by_one());
    assert_eq!(together.table().rows(), apart.table().rows());
    let runs =
        [&together, &apart].map(|pump| pump.run_with(Settings::default(), 9.0).expect("it runs"));
    let jumps = runs.each_ref().map(|run| {
        run.jumps().iter().map(|jump| (jump.at, jump.label.clone())).collect::<Vec<_>>()
    });
    assert_eq!(jumps[0], jumps[1]);
    let count = |name: &str| jumps[0].iter().filter(|(_, event)| *event == name).count();
    assert_eq!((count("stopped"), count("counted")), (1, 5));
    assert!(count("empty") > 2);
}

/// What each arrow of a Mermaid diagram leads from and to.
fn arrows(pump: &Automaton<Pump, Command, Tank>) -> Vec<String> {
    let mermaid = diagram::mermaid(pump);
    let arrows = mermaid.lines().filter(|line| line.contains("-->"));
    let ends = |line: &str| line.split(" : ").next().unwrap_or_default().trim().to_owned();
    arrows.map(ends).collect()
}

#[test]
fn diagrams_show_a_superstate_and_what_leaves_it_once() {
    let pump = in_superstates();
    let mermaid = diagram::mermaid(&pump);
    let start = "\
stateDiagram-v2
    state \"running\" as s0 {
        state \"outward\" as s1 {
            l2 : draining
";
    assert!(mermaid.starts_with(start), "{mermaid}");
    let expected =
        "[*] --> l1, l1 --> l2, l2 --> l3, s1 --> l1, s0 --> l0, l1 --> l1, l2 --> l2, l3 --> l3";
    assert_eq!(arrows(&pump).join(", "), expected);

    let dot = diagram::dot(&pump);
    assert!(dot.contains("compound=true") && dot.contains("subgraph cluster1"), "{dot}");
    assert_eq!(dot.matches("ltail=cluster").count(), 2, "{dot}");
    let opened = dot.matches('{').count();
    assert!(opened == 3 && opened == dot.matches('}').count(), "{dot}");

    let table = diagram::table(&pump);
    for line in
        ["| *running* | filling, draining, flushing |", "| *outward* | draining, flushing |"]
    {
        assert!(table.contains(line), "{table}");
    }
    for row in ["| **counted** | *running*, stays |", "| **stopped** | *running* → off |"] {
        assert!(table.contains(row), "{table}");
    }
    assert_eq!(table.matches("**full**").count(), 2, "they differ: {table}");
}

/// Locations of a superstate have their columns beside each other, and those of an inner one within.
#[test]
fn columns_of_a_superstate_are_neighbours() {
    const OUTER: Superstate<Pump> = Superstate::new("outer", &[Off, Draining, Flushing]);
    const INNER: Superstate<Pump> = Superstate::new("inner", &[Off, Flushing]);
    let stop = |superstate: Superstate<Pump>| from_any(superstate).on(Stopped).stay().may(always());
    let pump =
        pump().transition(stop(INNER)).transition(stop(OUTER)).build().expect("the parts fit");
    let svg = diagram::svg(&pump);
    let boxes = svg.split("<rect").filter(|part| part.contains("data-location"));
    let attribute = |part: &str, name: &str| -> String {
        let value = part.split(&format!(" {name}=\"")).nth(1).unwrap_or_default();
        value.split('"').next().unwrap_or_default().to_owned()
    };
    let mut places: Vec<(f64, String)> = boxes
        .map(|part| {
            (attribute(part, "x").parse().expect("a number"), attribute(part, "data-location"))
        })
        .collect();
    places.sort_by(|one, other| one.0.total_cmp(&other.0));
    let names: Vec<&str> = places.iter().map(|(_, name)| &**name).collect();
    assert_eq!(names, ["off", "flushing", "draining", "filling"]);
}

/// A drawing shows one arrow only where all locations have it, and as many as they have.
#[test]
fn a_superstate_of_which_one_location_differs_is_not_left_as_one() {
    let Tank { level, .. } = Tank::coordinates();
    let stopped = |location: Pump| from(location).on(Stopped).to(Off).may(always());
    let drawn = |third: Vec<Edge<Pump, Command, Tank>>| {
        let pump = pump()
            .transition(from_any(OUTWARD).on(Empty).to(Off).must(level.at_most(0.25)))
            .transition(from_any(RUNNING).on(Counted).to(Off).may(always()))
            .transition(stopped(Draining));
        let pump = third.into_iter().fold(pump, |pump, edge| pump.transition(edge)).build();
        let arrows = arrows(&pump.expect("the parts fit"));
        arrows.into_iter().filter(|arrow| arrow.ends_with("--> l0")).collect::<Vec<_>>().join(", ")
    };
    assert_eq!(drawn(vec![stopped(Flushing)]), "s1 --> l0, s0 --> l0, s1 --> l0");
    let apart = "s1 --> l0, s0 --> l0, l2 --> l0, l3 --> l0";
    for differs in [
        from(Flushing).on(Stopped).to(Off).may(level.at_most(0.3)),
        from(Flushing).on(Stopped).to(Off).must(always()),
        stopped(Flushing).priority(1),
        stopped(Flushing).then([level.becomes(0.0)]),
    ] {
        assert_eq!(drawn(vec![differs]), apart);
    }
    let elsewhere = from(Flushing).on(Stopped).to(Filling).may(always());
    assert_eq!(drawn(vec![elsewhere]), "s1 --> l0, s0 --> l0, l2 --> l0");
    let twice = vec![stopped(Flushing), stopped(Draining), stopped(Flushing)];
    assert_eq!(drawn(twice), "s1 --> l0, s0 --> l0, s1 --> l0, s1 --> l0");
}

/// Two transitions from one location on one event are two rows, whatever they have in common.
#[test]
fn a_table_shows_every_transition() {
    let pump = pump()
        .transition(from_any(OUTWARD).on(Stopped).to(Off).may(always()))
        .transition(from_any(OUTWARD).on(Stopped).to(Filling).may(always()))
        .build()
        .expect("the parts fit");
    let table = diagram::table(&pump);
    for way in ["*outward* → off", "*outward* → filling"] {
        assert!(table.contains(way), "{table}");
    }
}

#[test]
fn superstates_that_do_not_nest_are_refused() {
    const TWO: Superstate<Pump> = Superstate::new("inward", &[Filling, Draining]);
    const NONE: Superstate<Pump> = Superstate::new("none", &[]);
    const OFF: Superstate<Pump> = Superstate::new("off", &[Filling]);
    let with = |superstates: &[Superstate<Pump>]| {
        let all = superstates.iter().fold(pump(), |pump, superstate| {
            pump.transition(from_any(*superstate).on(Stopped).to(Off).may(always()))
        });
        all.build().map(drop)
    };
    assert_eq!(with(&[RUNNING, OUTWARD]), Ok(()));
    assert_eq!(with(&[RUNNING, TWO]), Ok(()));
    let overlap = BuildError::SuperstatesOverlap { superstates: ["outward", "inward"] };
    assert_eq!(with(&[OUTWARD, TWO]), Err(overlap));
    const TWICE: Superstate<Pump> = Superstate::new("twice", &[Filling, Draining, Filling]);
    let repeated = BuildError::RepeatedMember { superstate: "twice", location: "filling" };
    assert_eq!(with(&[TWICE]), Err(repeated));
    assert_eq!(with(&[NONE]), Err(BuildError::EmptySuperstate { superstate: "none" }));
    assert_eq!(with(&[OFF]), Err(BuildError::SuperstateNameTaken { superstate: "off" }));
}
