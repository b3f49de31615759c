//! Components whose variables move along lines do what they do where only their rates are known, as curves
//! that happen to be straight: with labels and inputs, priorities and invariants, as late and as early as can be.

use pleach_automaton::{
    Automaton, Composition, Coordinate, Name, Policy, Reason, Record, Settings, Trajectory, from,
};
use pleach_guards::{Expression, Predicate, always, variable};
use proptest::prelude::*;
use proptest::sample::select;

use crate::common::body::instants;

const HORIZON: f64 = 12.0;
/// Together with others, by itself, and by itself in another way.
const EVENTS: [&str; 3] = ["meet", "go", "leap"];
const PLACES: [&str; 2] = ["here", "there"];

/// A way out of a location.
#[derive(Clone, Copy, Debug)]
struct Way {
    event: &'static str,
    /// Above or below which its clock and that of the component before, together, open it.
    bound: f64,
    is_above: bool,
    is_strict: bool,
    is_forced: bool,
    target: &'static str,
}

#[derive(Clone, Debug)]
struct Part {
    /// Of its clock, in each location.
    rates: [f64; 2],
    /// How much the clock of the component before counts.
    weight: f64,
    ways: [Vec<Way>; 2],
    /// Up to where time may pass here.
    bound: f64,
}

fn ways() -> impl Strategy<Value = Vec<Way>> {
    let way = (select(EVENTS.to_vec()), 0.3..4.0_f64, 0..4_u32, any::<[bool; 2]>(), 0..2_usize);
    let way = way.prop_map(|(event, bound, below, [is_strict, is_forced], target)| Way {
        event,
        bound,
        is_above: below > 0,
        is_strict,
        is_forced,
        target: PLACES[target],
    });
    // All have the label; what has to be taken above a bound is not open for ever.
    prop::collection::vec(way, 1..5).prop_map(|mut ways| {
        ways[0] = Way { event: "meet", is_above: true, ..ways[0] };
        ways.iter_mut().for_each(|way| way.is_forced &= way.is_above);
        ways
    })
}

fn part() -> impl Strategy<Value = Part> {
    let rate = || 0.4..1.6_f64;
    let parts = ([rate(), rate()], -0.3..0.5_f64, [ways(), ways()], 2.0..6.0_f64);
    parts.prop_map(|(rates, weight, ways, bound)| Part { rates, weight, ways, bound })
}

fn automaton(part: &Part, is_bent: bool) -> Automaton<Name, Name, Record> {
    let state = Record::new([("clock", 0.0), ("before", 0.0)]).expect("the names differ");
    let [clock, before]: [Coordinate<Record>; 2] =
        state.coordinates().try_into().expect("there are two");
    let [here, there] = PLACES.map(Name::new);
    let mut built = Automaton::<Name, Name, Record>::starting_in(here).initially(state);
    for (place, rate) in [here, there].into_iter().zip(part.rates) {
        let bend = 0.0 * clock.power(2.0);
        let rate = if is_bent { rate + bend } else { Expression::from(rate) };
        built = built.flow(place, clock.rate(rate));
    }
    built = built.invariant(here, clock.at_most(part.bound));
    for (place, ways) in [here, there].into_iter().zip(&part.ways) {
        for (number, way) in ways.iter().enumerate() {
            let sum = &clock + part.weight * &before;
            let guard: Predicate = match (way.is_above, way.is_strict) {
                (true, true) => sum.more_than(way.bound),
                (true, false) => sum.at_least(way.bound),
                (false, true) => sum.less_than(way.bound),
                (false, false) => sum.at_most(way.bound),
            };
            let guard = guard & clock.at_least(0.1);
            let out = from(place).on(Name::new(way.event)).to(Name::new(way.target));
            let out = if way.is_forced { out.must(guard) } else { out.may(guard) };
            let priority = u8::try_from(number).expect("they are few");
            built = built.transition(out.then(clock.becomes(0.0)).priority(priority));
        }
    }
    built.build().expect("it is sound")
}

fn composition(parts: &[Part], is_bent: bool) -> Composition {
    let mut built = Composition::builder().label("meet");
    for (number, part) in parts.iter().enumerate() {
        built = built.add(&format!("part {number}"), &automaton(part, is_bent));
        let before = (number + parts.len() - 1) % parts.len();
        built = built.connect(&format!("part {before}.clock"), &format!("part {number}.before"));
    }
    built.build().expect("the parts fit")
}

/// What happens: who goes where, in words.
fn happenings(trajectory: &Trajectory) -> Vec<String> {
    let told = trajectory.jumps().iter().map(|jump| format!("{}: {:?}", jump.label, jump.moves));
    told.collect()
}

proptest! {
    #![proptest_config(cases::usually(48))]

    #[test]
    fn what_moves_along_lines_does_what_straight_curves_do(
        parts in prop::collection::vec(part(), 2..4),
    ) {
        let pair = [false, true].map(|is_bent| composition(&parts, is_bent));
        for policy in [Policy::Late, Policy::Early] {
            let settings = Settings { policy, jump_limit: 40, ..Settings::default() };
            let runs = pair.each_ref().map(|one| one.run_with(settings, HORIZON));
            let [lines, curves] = runs.map(|run| run.expect("it can be run"));
            prop_assert_eq!(happenings(&lines), happenings(&curves), "{:?}", policy);
            let ends = [&lines, &curves].map(|run| std::mem::discriminant(&run.ending().reason));
            prop_assert_eq!(ends[0], ends[1], "{:?} {:?}", lines.ending(), curves.ending());
            prop_assert!((lines.ending().at.t - curves.ending().at.t).abs() < 1e-9);
            let instants = [&lines, &curves].map(instants);
            let mut pairs = instants[0].iter().zip(&instants[1]);
            let are_near = pairs.all(|(line, curve)| (line - curve).abs() < 1e-9);
            prop_assert!(are_near, "{:?}: {:?}", policy, instants);
        }
    }
}

/// Whatever happens, and however often: nothing needs to be solved.
#[test]
fn what_moves_along_lines_takes_no_steps() {
    let way = |event: &'static str, bound: f64| {
        let [is_above, is_strict, is_forced] = [true, bound > 1.0, true];
        Way { event, bound, is_above, is_strict, is_forced, target: "here" }
    };
    let part = |weight: f64| Part {
        rates: [1.0, 0.75],
        weight,
        ways: [vec![way("meet", 0.5), way("go", 1.25)], vec![way("meet", 2.0)]],
        bound: 1.5,
    };
    let settings = Settings { step_limit: 1, ..Settings::default() };
    let pair = [part(0.25), part(-0.125)];
    let runs = [false, true].map(|is_bent| composition(&pair, is_bent).run_with(settings, 100.0));
    let [lines, curves] = runs.map(|run| run.expect("it can be run"));
    assert_eq!(lines.ending().reason, Reason::Horizon);
    assert!(lines.jumps().len() > 100, "{} jumps", lines.jumps().len());
    assert!(matches!(curves.ending().reason, Reason::Limit(_)), "{:?}", curves.ending());
}

/// A component for which no time can pass, on the bound of its location or beyond it, leaves at once if it may,
/// however often, and goes on from there.
#[test]
fn what_has_no_time_where_it_is_leaves_and_goes_on() {
    for bound in [0.0, -1.0] {
        for rate in [Expression::from(1.0), 1.0 + 0.0 * variable("clock").power(2.0)] {
            let state = Record::new([("clock", 0.0)]).expect("there is one name");
            let [clock]: [Coordinate<Record>; 1] = state.coordinates().try_into().expect("one");
            let [here, there] = PLACES.map(Name::new);
            let [leave, back] = ["leave", "back"].map(Name::new);
            let in_time = from(there).on(back).to(here).must(clock.at_least(1.0));
            let automaton = Automaton::<Name, Name, Record>::starting_in(here)
                .initially(state)
                .flow(here, clock.rate(rate.clone()))
                .flow(there, clock.rate(rate.clone()))
                .invariant(here, clock.at_most(bound))
                .transition(from(here).on(leave).to(there).may(always()))
                .transition(in_time.then(clock.becomes(0.0)))
                .build()
                .expect("it is sound");
            for policy in [Policy::Late, Policy::Early, Policy::Random { seed: 1 }] {
                let settings = Settings { policy, ..Settings::default() };
                let run = automaton.run_with(settings, 2.5).expect("it can be run");
                let told = run.jumps().iter().map(|jump| (jump.at.t.round(), &*jump.label));
                let expected = [(0.0, "leave"), (1.0, "back"), (1.0, "leave")];
                let expected = expected.into_iter().chain([(2.0, "back"), (2.0, "leave")]);
                assert!(told.eq(expected), "{policy:?}: {:?}", run.jumps());
                assert_eq!(run.ending().reason, Reason::Horizon);
            }
        }
    }
}
