//! Witnesses, tried out on the model that they speak against.

use pleach_automaton::check::{Finding, Kind, Severity};
use pleach_automaton::{Coordinates, Transition};
use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::{Expression, Predicate};

use super::{Cue, Machine, Point, Room};

/// The faults that need a witness have one, and it shows them.
pub fn confirm(machine: &Machine, finding: &Finding) {
    let Some(state) = &finding.witness else {
        let needs_none = matches!(
            finding.kind,
            Kind::Shadowed
                | Kind::NeverFires
                | Kind::Unreachable
                | Kind::EmptyInvariant
                | Kind::NoInitialState
                | Kind::NothingMoves
        );
        assert!(needs_none, "{finding} has no witness");
        return;
    };
    let values: Vec<f64> = Point::NAMES.iter().map(|name| state[*name]).collect();
    let point = Point::from_values(&values);
    let location = Room::ALL.iter().copied().find(|one| Some(one.name()) == finding.place.location);
    let location = location.unwrap_or_else(|| panic!("{finding} is nowhere"));
    let transitions: Vec<(&Transition<Cue, Point>, Room)> =
        finding.place.events.iter().map(|event| transition(machine, location, event)).collect();
    let shown = match finding.kind {
        Kind::Overlap => {
            transitions.len() == 2
                && transitions.iter().all(|(transition, _)| holds(transition, point))
        }
        Kind::Blocked => is_stuck(machine, location, point) && leaves(machine, location, point),
        Kind::LandsOutside => {
            let (transition, target) = transitions[0];
            let landing = after(transition, point);
            let is_error = finding.severity == Severity::Error;
            holds(transition, point)
                && !invariant(machine, target).holds(&landing).expect("it has a value")
                && is_stuck(machine, target, landing) == is_error
        }
        Kind::LeavesRange => {
            let (transition, _) = transitions[0];
            holds(transition, point) && !is_in_range(machine, after(transition, point))
        }
        Kind::TimelessCycle => {
            let (mut here, mut now) = (location, point);
            // Unless the state is the same again, it takes many rounds to believe it.
            for round in 0..1000 {
                for (transition, target) in &transitions {
                    let is_taken = holds(transition, now) && transition.urgency.is_forced();
                    assert!(is_taken, "{finding} is not taken in round {round}");
                    (here, now) = (*target, after(transition, now));
                }
                assert_eq!(here, location, "{finding} does not come back");
                if now == point {
                    break;
                }
            }
            true
        }
        Kind::StartsOutside => {
            let is_error = finding.severity == Severity::Error;
            !invariant(machine, location).holds(&point).expect("it has a value")
                && is_stuck(machine, location, point) == is_error
        }
        Kind::Undefined => lacks_value(machine, location, &transitions, point),
        Kind::StartsOutOfRange => !is_in_range(machine, point),
        _ => panic!("{finding} needs no witness"),
    };
    assert!(shown, "{finding} is not shown by its witness");
}

/// A rate of the location, or the guard or reset of the transition, has no finite value.
fn lacks_value(
    machine: &Machine,
    location: Room,
    transitions: &[(&Transition<Cue, Point>, Room)],
    point: Point,
) -> bool {
    let is_lacking = |formula: &Expression| !formula.evaluate(&point).is_ok_and(f64::is_finite);
    let flow = machine.mode(location).and_then(|mode| mode.flow.as_ref());
    let rates = flow.and_then(|flow| flow.rates()).unwrap_or_default();
    rates.iter().any(|one| is_lacking(one.rate()))
        || transitions.iter().any(|(transition, _)| {
            let margin = transition.guard.evaluate(&point).map(|verdict| verdict.margin);
            let assignments = transition.reset.assignments().unwrap_or_default();
            !margin.is_ok_and(f64::is_finite)
                || assignments.iter().flat_map(|one| one.value().formulas()).any(is_lacking)
        })
}

fn transition<'a>(
    machine: &'a Machine,
    location: Room,
    event: &str,
) -> (&'a Transition<Cue, Point>, Room) {
    let graph = machine.graph();
    let found = graph.edge_indices().find_map(|edge| {
        let (source, target) = graph.edge_endpoints(edge)?;
        let is_it = graph[edge].event == cue(event) && graph[source] == location;
        is_it.then(|| (&graph[edge], graph[target]))
    });
    let chained = || {
        // A cycle names its transitions in turn; only the first leaves the location.
        graph.edge_indices().find_map(|edge| {
            let (_, target) = graph.edge_endpoints(edge)?;
            (graph[edge].event == cue(event)).then(|| (&graph[edge], graph[target]))
        })
    };
    found.or_else(chained).unwrap_or_else(|| panic!("no transition on `{event}`"))
}

fn cue(name: &str) -> Cue {
    let cue = Cue::ALL.iter().copied().find(|one| one.name() == name);
    cue.unwrap_or_else(|| panic!("no event `{name}`"))
}

/// A flow makes a guard true on its boundary, and lands just beyond.
fn holds(transition: &Transition<Cue, Point>, point: Point) -> bool {
    let verdict = transition.guard.evaluate(&point).expect("the guard has a value");
    verdict.holds || verdict.margin == 0.0 && transition.urgency == Urgency::Must
}

fn after(transition: &Transition<Cue, Point>, mut point: Point) -> Point {
    transition.reset.apply(&mut point).expect("the reset has a value");
    point
}

fn invariant(machine: &Machine, location: Room) -> Predicate {
    let invariant = machine.mode(location).and_then(|mode| mode.invariant.clone());
    invariant.unwrap_or_else(pleach_guards::always)
}

fn is_stuck(machine: &Machine, location: Room, point: Point) -> bool {
    let is_none = |event: &Cue| {
        let step = machine.enabled_on(*event, location, &point);
        step.expect("the guards have values").is_none()
    };
    Cue::ALL.iter().all(is_none)
}

fn is_in_range(machine: &Machine, point: Point) -> bool {
    let mut values = Point::NAMES.iter().zip(point.to_values());
    values.all(|(name, value)| machine.range(name).contains(&value))
}

/// After a short time by the flow, the invariant does not hold any more.
fn leaves(machine: &Machine, location: Room, point: Point) -> bool {
    const SHORT: f64 = 1e-6;
    let mode = machine.mode(location).expect("the location is listed");
    let rates = mode.flow.as_ref().and_then(|flow| flow.rates()).unwrap_or_default();
    let mut values = point.to_values();
    for one in rates {
        let place = Point::NAMES.iter().position(|name| *name == one.coordinate());
        let rate = one.rate().evaluate(&point).expect("the rate has a value");
        values[place.expect("the coordinate is one")] += SHORT * rate;
    }
    let invariant = invariant(machine, location);
    let inside = invariant.margin(&point).expect("the invariant has a value");
    let later = invariant.margin(&Point::from_values(&values)).expect("it has a value");
    inside >= 0.0 && later < 0.0
}
