//! An automaton without its types: what a composition of different automata runs.

use std::fmt;
use std::sync::Arc;

use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::expression::{BinaryOperator, UnaryOperator};
use pleach_guards::{
    CompiledPredicate, EvaluationError, Expression, LinearForm, Predicate, Program, Sides, Tape,
    Tracker, Verdict,
};

use super::kinks::Kinks;
use crate::automaton::Automaton;
use crate::coordinates::Coordinates;
use crate::diagram::sketch::Sketch;
use crate::flow::{Flow, Motion};
use crate::reset::{NewValue, Reset};

/// Locations and events are numbers here, in the order of `ALL`, and formulas are compiled against
/// the coordinates of the automaton's own state.
pub(crate) struct Blueprint {
    pub(crate) modes: Vec<Mode>,
    pub(crate) events: Vec<&'static str>,
    pub(crate) coordinates: Vec<&'static str>,
    pub(crate) initial: usize,
    /// The coordinates of which no other component may say how they move.
    pub(crate) own: Vec<&'static str>,
    /// For pictures.
    pub(crate) sketch: Sketch,
}

/// A location.
pub(crate) struct Mode {
    pub(crate) name: &'static str,
    pub(crate) motion: ModeMotion,
    /// The rates that are formulas, all together and in their order.
    pub(crate) rates: Tape,
    /// The same as smooth formulas, if some have kinks.
    pub(crate) sides: Option<Sides>,
    /// Whether they are those of all coordinates, in the order of these.
    pub(crate) is_whole: bool,
    pub(crate) invariant: Option<Condition>,
    /// In their total order.
    pub(crate) leaving: Vec<Leaving>,
}

/// A transition.
pub(crate) struct Leaving {
    pub(crate) event: usize,
    pub(crate) target: usize,
    pub(crate) urgency: Urgency,
    pub(crate) guard: Condition,
    pub(crate) change: Change,
}

/// A flow.
pub(crate) enum ModeMotion {
    Rates(Vec<RateProgram>),
    Field(Arc<FieldFunction>),
    Exact(Arc<Solution>),
}

/// A predicate ready to be evaluated in a state, and to be followed over time.
pub(crate) struct Condition {
    predicate: CompiledPredicate,
    pub(crate) tracker: Tracker,
}

/// The rate of a coordinate.
pub(crate) struct RateProgram {
    pub(crate) coordinate: usize,
    /// Where it is one.
    pub(crate) form: Option<LinearForm>,
    /// Follows the rate, where it could grow without bound.
    pub(crate) tracker: Option<Tracker>,
    /// Where it has kinks or jumps.
    pub(super) kinks: Box<[Kinks]>,
}

/// A reset.
pub(crate) enum Change {
    Assignments(Vec<(usize, Assigned)>),
    Function(Arc<ResetFunction>),
}

/// What a coordinate becomes.
pub(crate) enum Assigned {
    Value(Program),
    /// Any number between these.
    Interval([Program; 2]),
}

/// From the coordinates to their rates.
pub(crate) type FieldFunction = dyn Fn(&[f64], &mut [f64]) + Send + Sync;
/// Carries the coordinates over a duration in seconds.
pub(crate) type Solution = dyn Fn(&mut [f64], f64) + Send + Sync;
/// Turns x⁻ into x⁺.
pub(crate) type ResetFunction = dyn Fn(&mut [f64]) -> Result<(), EvaluationError> + Send + Sync;

impl Blueprint {
    /// # Errors
    ///
    /// The first variable that is none of the coordinates; [`Builder::build`](crate::Builder::build)
    /// refuses them for automata that begin with their coordinates.
    pub(crate) fn of<L: Location, E: Event, S: Coordinates>(
        automaton: &Automaton<L, E, S>,
    ) -> Result<Blueprint, EvaluationError> {
        let sketch = Sketch::of(automaton);
        let automaton = &automaton.with_numbers();
        let (graph, names) = (automaton.graph(), automaton.names());
        let shape = automaton.initial_state();
        let mut modes = Vec::with_capacity(automaton.locations().len());
        let locations = automaton.locations().iter();
        for (node, (&location, mode)) in locations.zip(&automaton.modes).enumerate() {
            let leaving = automaton.leaving[node].iter().map(|&edge| {
                let transition = &graph[edge];
                let (_, target) = graph.edge_endpoints(edge).unwrap_or_default();
                Ok(Leaving {
                    event: position(automaton.events(), transition.event),
                    target: target.index(),
                    urgency: transition.urgency,
                    guard: Condition::of(transition.guard.predicate(), names)?,
                    change: change(&transition.reset, names, shape)?,
                })
            });
            let motion = match &mode.flow {
                Some(flow) => motion(flow, names, shape)?,
                None => ModeMotion::Rates(Vec::new()),
            };
            modes.push(Mode {
                name: location.name(),
                rates: Tape::compile(formulas(mode.flow.as_ref()), names)?,
                sides: Sides::compile(formulas(mode.flow.as_ref()), names)?,
                is_whole: motion.is_whole(names.len()),
                motion,
                invariant: mode
                    .invariant
                    .as_ref()
                    .map(|invariant| Condition::of(invariant, names))
                    .transpose()?,
                leaving: leaving.collect::<Result<_, EvaluationError>>()?,
            });
        }
        let events = automaton.events().iter().map(|event| event.name()).collect();
        let initial = position(automaton.locations(), automaton.initial());
        let (coordinates, own) = (names.to_vec(), automaton.own.clone());
        Ok(Blueprint { modes, events, coordinates, initial, own, sketch })
    }
}

impl ModeMotion {
    /// Whether it gives the rates of this many coordinates in their order.
    fn is_whole(&self, coordinates: usize) -> bool {
        let ModeMotion::Rates(rates) = self else { return false };
        let places = rates.iter().map(|rate| rate.coordinate);
        rates.len() == coordinates && places.eq(0..coordinates)
    }
}

impl Condition {
    fn of(predicate: &Predicate, names: &[&str]) -> Result<Condition, EvaluationError> {
        Ok(Condition { predicate: predicate.compile(names)?, tracker: predicate.track(names)? })
    }

    pub(crate) fn predicate(&self) -> &Predicate {
        self.predicate.predicate()
    }

    pub(crate) fn evaluate_at(
        &self,
        values: &[f64],
        slots: &[usize],
    ) -> Result<Verdict, EvaluationError> {
        self.predicate.evaluate_at(values, slots)
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.predicate.fmt(formatter)
    }
}

impl RateProgram {
    fn of(
        coordinate: usize,
        rate: &Expression,
        names: &[&str],
    ) -> Result<RateProgram, EvaluationError> {
        let form = rate.linear_form();
        let tracker =
            may_be_unbounded(rate).then(|| rate.at_least(0.0).track(names)).transpose()?;
        Ok(RateProgram { coordinate, form, tracker, kinks: Kinks::of(rate, names)? })
    }
}

/// Whether the expression may grow without bound where its variables do not.
fn may_be_unbounded(expression: &Expression) -> bool {
    let mut parts = vec![expression];
    while let Some(part) = parts.pop() {
        match part {
            Expression::Constant(_) | Expression::Variable(_) => {}
            Expression::Unary(UnaryOperator::Logarithm | UnaryOperator::Tangent, _) => return true,
            Expression::Unary(_, operand) => parts.push(operand),
            Expression::Power(base, exponent) if *exponent >= 0.0 => parts.push(base),
            Expression::Binary(BinaryOperator::Quotient, dividend, divisor) => match &**divisor {
                Expression::Constant(value) if *value != 0.0 => parts.push(dividend),
                _ => return true,
            },
            Expression::Binary(_, left, right) => parts.extend([&**left, &**right]),
            Expression::Choice(choice) => parts.extend([&choice.then, &choice.otherwise]),
            Expression::Lookup(..) => {}
            _ => return true,
        }
    }
    false
}

fn position<T: PartialEq>(all: &[T], one: T) -> usize {
    // `build` has checked that every location and event is listed.
    all.iter().position(|listed| *listed == one).unwrap_or_default()
}

/// A state of the automaton with these coordinates.
fn state_of<S: Coordinates>(shape: Option<&S>, values: &[f64]) -> S {
    shape.map_or_else(|| S::from_values(values), |shape| shape.like(values))
}

fn formulas<S>(flow: Option<&Flow<S>>) -> impl Iterator<Item = &Expression> {
    let rates = flow.and_then(Flow::rates).unwrap_or_default();
    rates.iter().map(crate::flow::Rate::rate)
}

fn motion<S: Coordinates>(
    flow: &Flow<S>,
    names: &[&'static str],
    shape: Option<&S>,
) -> Result<ModeMotion, EvaluationError> {
    let shape = shape.cloned();
    Ok(match flow.motion() {
        Motion::Rates(rates) => {
            let compile = |rate: &crate::flow::Rate<S>| {
                RateProgram::of(place_of(names, rate.coordinate())?, rate.rate(), names)
            };
            ModeMotion::Rates(rates.iter().map(compile).collect::<Result<_, EvaluationError>>()?)
        }
        Motion::Field(_, field) => {
            let field = field.clone();
            ModeMotion::Field(Arc::new(move |values: &[f64], rates: &mut [f64]| {
                field(&state_of(shape.as_ref(), values)).write(rates);
            }))
        }
        Motion::Exact(_, advance) => {
            let advance = advance.clone();
            ModeMotion::Exact(Arc::new(move |values: &mut [f64], duration: f64| {
                let mut state = state_of(shape.as_ref(), values);
                advance(&mut state, duration);
                state.write(values);
            }))
        }
    })
}

fn change<S: Coordinates>(
    reset: &Reset<S>,
    names: &[&'static str],
    shape: Option<&S>,
) -> Result<Change, EvaluationError> {
    if let Some(assignments) = reset.assignments() {
        let compile = |assignment: &crate::reset::Assignment<S>| {
            let assigned = match assignment.value() {
                NewValue::Exactly(value) => Assigned::Value(value.compile(names)?),
                NewValue::Within(lower, upper) => {
                    Assigned::Interval([lower.compile(names)?, upper.compile(names)?])
                }
            };
            Ok((place_of(names, assignment.coordinate())?, assigned))
        };
        return Ok(Change::Assignments(assignments.iter().map(compile).collect::<Result<_, _>>()?));
    }
    let (reset, shape) = (reset.clone(), shape.cloned());
    Ok(Change::Function(Arc::new(move |values: &mut [f64]| {
        let mut state = state_of(shape.as_ref(), values);
        reset.apply(&mut state)?;
        state.write(values);
        Ok(())
    })))
}

fn place_of(names: &[&'static str], name: &str) -> Result<usize, EvaluationError> {
    let unknown = || EvaluationError::UnknownVariable { variable: name.to_owned() };
    names.iter().position(|listed| *listed == name).ok_or_else(unknown)
}

#[cfg(test)]
mod tests {
    use pleach_guards::{Table, constant, piecewise, variable};

    use super::*;

    #[test]
    fn what_may_grow_without_bound_are_logarithms_tangents_and_quotients() {
        let [x, y] = ["x", "y"].map(variable);
        let table = Table::linear([(0.0, 1.0), (1.0, 2.0)]).expect("its points are in order");
        let cases = |then: Expression, otherwise: &Expression| {
            piecewise([(x.at_most(0.0), then)], otherwise).expect("there is a comparison")
        };
        let bounded = [
            constant(1.0),
            x.sin() * y.exp() - x.min(&y),
            x.power(2.0) + x.power(0.5) + x.power(0.0),
            &x / 2.0,
            table.at(1.0 / &x),
            cases(y.power(3.0), &x),
        ];
        let unbounded = [x.ln(), x.tan(), 1.0 / &x, &x / 0.0, x.power(-1.0)];
        assert!(!bounded.iter().any(may_be_unbounded));
        for formula in &unbounded {
            let around = [
                formula.clone(),
                formula.sin(),
                formula.power(2.0),
                formula / 2.0,
                &x + formula,
                formula * &x,
                cases(formula.clone(), &x),
                cases(x.clone(), formula),
            ];
            assert!(around.iter().all(may_be_unbounded), "{formula}");
        }
    }
}
