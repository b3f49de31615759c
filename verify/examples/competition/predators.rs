//! Predators and prey that come into a circle around their equilibrium, some of them only just
//! (LOVO25).
//!
//! Model and numbers as in the ARCH-COMP reports (NLN), where the circle has the radius 0.161. The square
//! of the distance from the equilibrium is a coordinate of its own, with the rate that follows from the
//! others: so the circle is a half-space. A cycle touches the circle above and below its center; a run
//! that has left it above comes back below, so each side has a location of its own, and no run enters
//! twice where it only touches.

use pleach_automaton::{Automaton, Name, Record, from};
use pleach_guards::{Interval, Predicate};
use pleach_verify::reach::{Settings, StateSet, Zonotope};

use crate::{Instance, Measure, TestResult};

const HORIZON: f64 = 3.64;
const RADIUS: f64 = 0.161;
/// The prey at the beginning, and what it may be off by.
const PREY: f64 = 1.3;
const SPREAD: f64 = 0.012;

/// A cycle from `parts` parts of the initial states.
pub fn cycle(parts: usize, settings: Settings) -> TestResult<Instance> {
    let start_distance = (PREY - 1.0).powi(2);
    let state = Record::new([("x", PREY), ("y", 1.0), ("d", start_distance), ("inside", 0.0)])?;
    let coordinates = state.coordinates();
    let [x, y, d, inside] = &coordinates[..] else { return Err("four coordinates".into()) };
    let [begin, above, left, below, right] =
        ["begin", "in the circle above", "left", "in the circle below", "right"].map(Name::new);
    let [enter, leave] = ["enter", "leave"].map(Name::new);
    let (prey, predators) = (3.0 * x - 3.0 * (x * y), x * y - y);
    let circle = RADIUS.powi(2);
    let growth = 2.0 * ((x - 1.0) * &prey + (y - 1.0) * &predators);
    let flow =
        |clock: f64| [x.rate(&prey), y.rate(&predators), d.rate(&growth), inside.rate(clock)];
    let [in_circle, out_of_circle] = [d.at_most(circle), d.at_least(circle)];
    let [upper, lower] = [y.at_least(1.0), y.at_most(1.0)];
    let entered = |side: &Predicate| in_circle.clone() & growth.less_than(0.0) & side.clone();
    let left_again = || out_of_circle.clone() & growth.more_than(0.0);
    let automaton = Automaton::<Name, Name, Record>::starting_in(begin)
        .initially(state.clone())
        .flow(begin, flow(0.0))
        .flow(above, flow(1.0))
        .flow(left, flow(0.0))
        .flow(below, flow(1.0))
        .flow(right, flow(0.0))
        .invariant(begin, out_of_circle.clone())
        .invariant(above, in_circle.clone())
        .invariant(left, upper.clone() | out_of_circle.clone())
        .invariant(below, in_circle.clone())
        .invariant(right, lower.clone() | out_of_circle.clone())
        .transition(from(begin).on(enter).to(above).must(entered(&upper)))
        .transition(from(begin).on(enter).to(below).must(entered(&lower)))
        .transition(from(above).on(leave).to(left).must(left_again()))
        .transition(from(left).on(enter).to(below).must(entered(&lower)))
        .transition(from(below).on(leave).to(right).must(left_again()))
        .transition(from(right).on(enter).to(above).must(entered(&upper)))
        .build()?;
    Ok(Instance {
        automaton,
        starts: (0..parts).map(|part| start(part, parts)).collect(),
        uncertain: Vec::new(),
        forbidden: Vec::new(),
        settings: Settings { horizon: HORIZON, ..settings },
        measured: vec![Measure::Area("x", "y"), Measure::Clock("inside")],
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
        &[center, Interval::point(1.0), from_equilibrium * from_equilibrium + square, nothing],
        &[vec![half, nothing, slope, nothing]],
    ))
}
