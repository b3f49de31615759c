//! Predators and prey that come into a circle around their equilibrium, some of them only just
//! (LOVO25).
//!
//! Model and numbers as in the ARCH-COMP reports (NLN), where the circle has the radius 0.161. The square
//! of the distance from the equilibrium is a coordinate of its own, with the rate that follows from the
//! others: so the circle is a half-space.

use pleach_automaton::{Automaton, Name, Record, from};
use pleach_guards::Interval;
use pleach_verify::reach::{Settings, StateSet, Zonotope};

use crate::{Instance, Measure, TestResult};

const HORIZON: f64 = 3.64;
const RADIUS: f64 = 0.161;
/// The prey at the beginning, and what it may be off by.
const PREY: f64 = 1.3;
const SPREAD: f64 = 0.012;

/// A cycle from `parts` parts of the initial states.
pub fn cycle(parts: usize, settings: Settings) -> TestResult<Instance> {
    let state = Record::new([("x", PREY), ("y", 1.0), ("d", (PREY - 1.0).powi(2))])?;
    let coordinates = state.coordinates();
    let [x, y, d] = &coordinates[..] else { return Err("three coordinates".into()) };
    let [outside, inside] = ["outside", "inside"].map(Name::new);
    let [enter, leave] = ["enter", "leave"].map(Name::new);
    let (prey, predators) = (3.0 * x - 3.0 * (x * y), x * y - y);
    let circle = RADIUS.powi(2);
    let distance = 2.0 * ((x - 1.0) * &prey + (y - 1.0) * &predators);
    let flow = || [x.rate(&prey), y.rate(&predators), d.rate(&distance)];
    let automaton = Automaton::<Name, Name, Record>::starting_in(outside)
        .initially(state.clone())
        .flow(outside, flow())
        .flow(inside, flow())
        .invariant(outside, d.at_least(circle))
        .invariant(inside, d.at_most(circle))
        .transition(
            from(outside).on(enter).to(inside).must(d.at_most(circle) & distance.less_than(0.0)),
        )
        .transition(
            from(inside).on(leave).to(outside).must(d.at_least(circle) & distance.more_than(0.0)),
        )
        .build()?;
    Ok(Instance {
        automaton,
        starts: (0..parts).map(|part| start(part, parts)).collect(),
        uncertain: Vec::new(),
        forbidden: Vec::new(),
        settings: Settings { horizon: HORIZON, ..settings },
        measured: Some(Measure::Area("x", "y")),
    })
}

/// Part number `part` of `parts`: x = c + r ξ with ξ from −1 to 1, y = 1, and
/// d = (x − 1)² = (c − 1)² + 2 (c − 1) r ξ + r² ξ².
fn start(part: usize, parts: usize) -> StateSet {
    let half = Interval::point(SPREAD) / Interval::point(parts as f64);
    let offset = Interval::point(2.0 * part as f64 + 1.0) * half - Interval::point(SPREAD);
    let center = Interval::point(PREY) + offset;
    let from_equilibrium = center - Interval::point(1.0);
    let square = half * half * Interval::point(1.0).hull(Interval::point(0.0));
    let slope = Interval::point(2.0) * from_equilibrium * half;
    let nothing = Interval::point(0.0);
    StateSet::from_zonotope(Zonotope::from_intervals(
        &[center, Interval::point(1.0), from_equilibrium * from_equilibrium + square],
        &[vec![half, nothing, slope]],
    ))
}
