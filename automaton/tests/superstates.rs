//! What leaves a superstate leaves each of its locations, in runs, checks and drawings.

use pleach_automaton::{
    Automaton, BuildError, Builder, Settings, coordinates, diagram, from, from_any,
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
    let arrows: Vec<&str> = mermaid.lines().filter(|line| line.contains("-->")).collect();
    let ends = |line: &str| line.split(" : ").next().unwrap_or_default().trim().to_owned();
    assert_eq!(
        arrows.into_iter().map(ends).collect::<Vec<_>>(),
        ["[*] --> l1", "l1 --> l2", "l2 --> l3", "s1 --> l1", "s0 --> l0", "s0 --> s0"]
    );

    let dot = diagram::dot(&pump);
    assert!(dot.contains("compound=true") && dot.contains("subgraph cluster1"), "{dot}");
    assert_eq!(dot.matches("ltail=cluster0").count(), 1, "{dot}");
    assert!(dot.contains("running: counted"), "{dot}");
    let opened = dot.matches('{').count();
    assert!(opened == 3 && opened == dot.matches('}').count(), "{dot}");

    let svg = diagram::svg(&pump);
    assert!(svg.contains("running") && svg.contains("outward"), "{svg}");

    let table = diagram::table(&pump);
    for line in
        ["| *running* | filling, draining, flushing |", "| *outward* | draining, flushing |"]
    {
        assert!(table.contains(line), "{table}");
    }
    assert_eq!(table.matches("**full**").count(), 2, "they differ: {table}");
    assert_eq!(table.matches("**counted**").count(), 1, "{table}");
}

/// A drawing shows one arrow only where all locations have it.
#[test]
fn a_superstate_of_which_one_location_differs_is_not_left_as_one() {
    let Tank { level, .. } = Tank::coordinates();
    let pump = pump()
        .transition(from_any(OUTWARD).on(Empty).to(Filling).must(level.at_most(0.25)))
        .transition(from(Filling).on(Stopped).to(Off).may(always()))
        .transition(from(Draining).on(Stopped).to(Off).may(always()))
        .transition(from(Flushing).on(Stopped).to(Off).may(level.at_most(0.3)))
        .build()
        .expect("the parts fit");
    let mermaid = diagram::mermaid(&pump);
    assert_eq!(mermaid.matches("stopped").count(), 3, "{mermaid}");
    assert_eq!(mermaid.matches("empty").count(), 1, "{mermaid}");
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
    assert_eq!(with(&[NONE]), Err(BuildError::EmptySuperstate { superstate: "none" }));
    assert_eq!(with(&[OFF]), Err(BuildError::SuperstateNameTaken { superstate: "off" }));
}
