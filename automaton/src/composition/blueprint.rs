//! An automaton without its types: what a composition of different automata runs.

use std::sync::Arc;

use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::{CompiledPredicate, EvaluationError, LinearForm, Program};

use crate::automaton::Automaton;
use crate::coordinates::Coordinates;
use crate::diagram::sketch::Sketch;
use crate::flow::{Flow, Motion};
use crate::reset::Reset;

/// Locations and events are numbers here, in the order of `ALL`, and formulas are compiled against
/// the coordinates of the automaton's own state.
pub(crate) struct Blueprint {
    pub(crate) places: Vec<Place>,
    pub(crate) events: Vec<&'static str>,
    pub(crate) coordinates: Vec<&'static str>,
    pub(crate) initial: usize,
    /// For pictures.
    pub(crate) sketch: Sketch,
}

/// A location.
pub(crate) struct Place {
    pub(crate) name: &'static str,
    pub(crate) motion: PlaceMotion,
    pub(crate) invariant: Option<CompiledPredicate>,
    /// In their total order.
    pub(crate) leaving: Vec<Leaving>,
}

/// A transition.
pub(crate) struct Leaving {
    pub(crate) event: usize,
    pub(crate) target: usize,
    pub(crate) urgency: Urgency,
    pub(crate) guard: CompiledPredicate,
    pub(crate) change: Change,
}

/// A flow.
pub(crate) enum PlaceMotion {
    /// Coordinate, and its rate as a program and, where it is one, as a linear form.
    Rates(Vec<(usize, Program, Option<LinearForm>)>),
    Field(Arc<FieldFunction>),
    Exact(Arc<Solution>),
}

/// A reset.
pub(crate) enum Change {
    Assignments(Vec<(usize, Program)>),
    Function(Arc<ResetFunction>),
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
        let mut places = Vec::with_capacity(automaton.locations().len());
        let locations = automaton.locations().iter();
        for (node, (&location, mode)) in locations.zip(&automaton.modes).enumerate() {
            let leaving = automaton.leaving[node].iter().map(|&edge| {
                let transition = &graph[edge];
                let (_, target) = graph.edge_endpoints(edge).unwrap_or_default();
                Ok(Leaving {
                    event: position(automaton.events(), transition.event),
                    target: target.index(),
                    urgency: transition.urgency,
                    guard: transition.guard.predicate().compile(names)?,
                    change: change(&transition.reset, names, shape)?,
                })
            });
            places.push(Place {
                name: location.name(),
                motion: match &mode.flow {
                    Some(flow) => motion(flow, names, shape)?,
                    None => PlaceMotion::Rates(Vec::new()),
                },
                invariant: mode.invariant.as_ref().map(|it| it.compile(names)).transpose()?,
                leaving: leaving.collect::<Result<_, EvaluationError>>()?,
            });
        }
        let events = automaton.events().iter().map(|event| event.name()).collect();
        let initial = position(automaton.locations(), automaton.initial());
        Ok(Blueprint { places, events, coordinates: names.to_vec(), initial, sketch })
    }
}

fn position<T: PartialEq>(all: &[T], one: T) -> usize {
    // `build` has checked that every location and event is listed.
    all.iter().position(|listed| *listed == one).unwrap_or_default()
}

/// A state of the automaton with these coordinates.
fn state_of<S: Coordinates>(shape: Option<&S>, values: &[f64]) -> S {
    shape.map_or_else(|| S::from_values(values), |shape| shape.like(values))
}

fn motion<S: Coordinates>(
    flow: &Flow<S>,
    names: &[&'static str],
    shape: Option<&S>,
) -> Result<PlaceMotion, EvaluationError> {
    let shape = shape.cloned();
    Ok(match flow.motion() {
        Motion::Rates(rates) => {
            let compile = |rate: &crate::flow::Rate<S>| {
                let coordinate = place_of(names, rate.coordinate())?;
                Ok((coordinate, rate.rate().compile(names)?, rate.rate().linear_form()))
            };
            PlaceMotion::Rates(rates.iter().map(compile).collect::<Result<_, EvaluationError>>()?)
        }
        Motion::Field(_, field) => {
            let field = field.clone();
            PlaceMotion::Field(Arc::new(move |values: &[f64], rates: &mut [f64]| {
                field(&state_of(shape.as_ref(), values)).write(rates);
            }))
        }
        Motion::Exact(_, advance) => {
            let advance = advance.clone();
            PlaceMotion::Exact(Arc::new(move |values: &mut [f64], duration: f64| {
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
            let value = assignment.value().compile(names)?;
            Ok((place_of(names, assignment.coordinate())?, value))
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
