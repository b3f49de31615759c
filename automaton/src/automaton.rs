//! The hybrid automaton: a graph of locations with guards, resets, flows and invariants.

mod step;

use std::ops::RangeInclusive;

use petgraph::graph::{DiGraph, EdgeIndex, NodeIndex};
use pleach_discrete::{Event, Location, Row, TransitionTable, Urgency};
use pleach_guards::{
    EvaluationError, Expression, Guard, Predicate, Substitution, Valuation, constant,
};
use thiserror::Error;

use crate::builder::Builder;
use crate::composition::Sampling;
use crate::coordinates::Coordinates;
use crate::coverage::tally::Tally;
use crate::flow::Flow;
use crate::law::Command;
use crate::lists::mapped;
use crate::located::{Holds, Place};
use crate::observed::{self, Exclusion, Watch};
use crate::outline::range_of;
use crate::reset::Reset;
use crate::signals::Signal;

pub use step::Step;

/// A hybrid automaton over locations `L`, events `E` and a state `S`.
///
/// It is H = (Q, X, Init, f, Inv, E, G, R) of the literature (Lygeros et al. 2003,
/// [doi:10.1109/TAC.2002.806650](https://doi.org/10.1109/TAC.2002.806650)) with typed parts: Q is
/// the enum `L`, X the state `S`, the edges E are the rows of a [`TransitionTable`], G and R come
/// with the event of an edge, f and Inv with a location.
///
/// An automaton is a description and holds no state: location and state are handed to it, so that
/// one automaton serves any number of components, and several automata may share one state.
///
/// ```
/// use pleach_automaton::{Automaton, Reset};
/// use pleach_discrete::{vocabulary, Row, TransitionTable, Urgency};
/// use pleach_guards::{variable, Guard, Valuation};
///
/// vocabulary! {
///     enum Tap: Location { Open = "open", Shut = "shut" }
///     enum Float: Event { Full = "full" }
/// }
/// struct Tank { level: f64, fillings: u32 }
/// # impl Valuation for Tank {
/// #     fn value(&self, variable: &str) -> Option<f64> { (variable == "level").then_some(self.level) }
/// # }
///
/// const TABLE: TransitionTable<Tap, Float> = TransitionTable::new(&[
///     Row { source: Tap::Open, event: Float::Full, target: Tap::Shut, urgency: Urgency::Must, priority: 0 },
/// ]);
///
/// let count = Reset::new("fillings + 1", |tank: &mut Tank| tank.fillings += 1);
/// let automaton = Automaton::builder(TABLE, Tap::Open)
///     .on(Float::Full, Guard::new("full", variable("level").at_least(2.0)), count)
///     .build()?;
///
/// let (mut location, mut tank) = (automaton.initial(), Tank { level: 2.0, fillings: 0 });
/// let jump = automaton.step(&mut location, &mut tank)?.expect("the tank is full");
/// assert_eq!((jump.source, jump.event, jump.target), (Tap::Open, Float::Full, Tap::Shut));
/// assert_eq!((location, tank.fillings), (Tap::Shut, 1));
/// assert_eq!(automaton.step(&mut location, &mut tank)?, None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Automaton<L, E, S> {
    pub(crate) rows: Vec<Row<L, E>>,
    pub(crate) initial: L,
    /// The state in which a run starts, where the model says it.
    pub(crate) initial_state: Option<S>,
    /// What the model says of the coordinates' ranges, by name.
    pub(crate) ranges: Vec<(String, RangeInclusive<f64>)>,
    /// The names of all variables, where the type of the state tells.
    pub(crate) known: Option<Vec<&'static str>>,
    /// Names that stand for numbers, with these.
    pub(crate) parameters: Vec<(String, f64)>,
    /// Names of formulas of coordinates and parameters, with these.
    pub(crate) signals: Vec<Signal>,
    /// By name the nodes of locations that drawings show together, those with more of them first.
    pub(crate) superstates: Vec<(&'static str, Vec<usize>)>,
    /// The events that are taken at samples.
    pub(crate) samplings: Vec<(E, Sampling)>,
    /// The coordinates of which no other component may say how they move.
    pub(crate) own: Vec<&'static str>,
    pub(crate) locations: Vec<L>,
    pub(crate) events: Vec<E>,
    /// The nodes stand in the order of the locations.
    pub(crate) graph: DiGraph<L, Transition<E, S>>,
    /// By node.
    pub(crate) modes: Vec<Mode<S>>,
    /// By node: the edges that leave it, in their total order.
    pub(crate) leaving: Vec<Vec<EdgeIndex>>,
    /// How often each row has been taken, if that is counted.
    pub(crate) tally: Option<Tally>,
    /// Propositions of which at most one is true at a time.
    pub(crate) exclusion: Exclusion<S>,
}

/// What an edge of the graph carries.
#[derive(Clone, Debug)]
pub struct Transition<E, S> {
    /// The event under which the transition is taken.
    pub event: E,
    /// When it may be taken.
    pub guard: Guard,
    /// The same by numbers, where the state has them.
    pub(crate) watch: Option<Watch<S>>,
    /// What it does to the state.
    pub reset: Reset<S>,
    /// Whether it has to be taken.
    pub urgency: Urgency,
    /// Which goes first: 0 before 1, and so on.
    pub priority: u8,
}

/// What a location says about time: it passes by the flow and while the invariant holds.
#[derive(Clone, Debug)]
pub struct Mode<S> {
    /// How the state changes; without a flow it rests.
    pub flow: Option<Flow<S>>,
    /// What must hold for time to pass; without an invariant, nothing must.
    pub invariant: Option<Predicate>,
    /// The same by numbers, where the state has them.
    pub(crate) watch: Option<Watch<S>>,
    /// What is chosen at each sample, case by case; see [`law`](crate::law).
    pub commands: Vec<Command>,
}

/// A transition that has been taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Jump<L, E> {
    /// The location that was left.
    pub source: L,
    /// The event.
    pub event: E,
    /// The location that was entered.
    pub target: L,
}

/// A guard or a reset could not be evaluated.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{part} of event `{event}` in location `{location}`: {source}")]
pub struct TransitionError {
    /// The location that the transition leaves.
    pub location: &'static str,
    /// The event of the transition.
    pub event: &'static str,
    /// The guard with its name, or the reset.
    pub part: String,
    /// What is wrong with the state or the formula.
    pub source: EvaluationError,
}

/// The invariant of a location does not hold although time is to pass there, or has passed.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("the invariant `{invariant}` of location `{location}` does not hold: {values}")]
pub struct InvariantError {
    /// The location.
    pub location: &'static str,
    /// What must hold.
    pub invariant: String,
    /// The variables and propositions that it names, with their values.
    pub values: String,
}

impl InvariantError {
    fn new(location: &'static str, invariant: &Predicate, state: &impl Valuation) -> Self {
        let variables = invariant.variables().into_iter().map(|name| {
            let value = state.value(name);
            value.map_or_else(|| format!("{name} is unknown"), |value| format!("{name} = {value}"))
        });
        let propositions = invariant.propositions().into_iter().map(|name| {
            let truth = state.truth(name);
            truth.map_or_else(|| format!("{name} is unknown"), |truth| format!("{name} is {truth}"))
        });
        let values: Vec<String> = variables.chain(propositions).collect();
        InvariantError { location, invariant: invariant.to_string(), values: values.join(", ") }
    }
}

impl<L: Location, E: Event, S: Valuation> Automaton<L, E, S> {
    /// Begins the automaton of `table` that starts in `initial`.
    pub fn builder(table: TransitionTable<'_, L, E>, initial: L) -> Builder<L, E, S> {
        Builder::new(table, initial)
    }

    /// The table: a row for every transition, without [superstates](Self::superstates).
    pub fn table(&self) -> TransitionTable<'_, L, E> {
        TransitionTable::new(&self.rows)
    }

    /// The superstates that transitions leave, each with its name and its locations.
    pub fn superstates(&self) -> impl Iterator<Item = (&'static str, Vec<L>)> {
        let locations = |members: &[usize]| mapped(members, |&member| self.locations[member]);
        self.superstates.iter().map(move |(name, members)| (*name, locations(members)))
    }

    /// The location in which a run starts.
    pub fn initial(&self) -> L {
        self.initial
    }

    /// The state in which a run starts, if the model says it.
    pub fn initial_state(&self) -> Option<&S> {
        self.initial_state.as_ref()
    }

    /// The range that the model declares for the variable called `name`; without a declaration,
    /// all numbers.
    pub fn range(&self, name: &str) -> RangeInclusive<f64> {
        range_of(&self.ranges, name)
    }

    /// The locations, in the order in which tables and diagrams show them.
    pub fn locations(&self) -> &[L] {
        &self.locations
    }

    /// The events, in the order in which tables and diagrams show them.
    pub fn events(&self) -> &[E] {
        &self.events
    }

    /// The names that stand for numbers, with these.
    pub fn parameters(&self) -> impl ExactSizeIterator<Item = (&str, f64)> {
        self.parameters.iter().map(|(name, value)| (name.as_str(), *value))
    }

    /// The events that are taken at [samples](crate::Builder::every).
    pub fn sampled_events(&self) -> impl ExactSizeIterator<Item = E> {
        self.samplings.iter().map(|(event, _)| *event)
    }

    /// The names of the events that are taken at samples, and when.
    pub(crate) fn samplings(&self) -> impl Iterator<Item = (&'static str, Sampling)> {
        self.samplings.iter().map(|(event, sampling)| (event.name(), *sampling))
    }

    /// The signals, each with its formula of coordinates and parameters.
    pub fn signals(&self) -> impl ExactSizeIterator<Item = (&str, &Expression)> {
        self.signals.iter().map(|(name, formula)| (name.as_str(), formula))
    }

    /// The parameters as what to put in the place of their names.
    pub(crate) fn numbers(&self) -> Substitution {
        Substitution::new(self.parameters().map(|(name, value)| (name, constant(value))))
    }

    /// The node of `location`, unless the automaton lacks it. Enums are small: looking through them
    /// is faster than any map.
    #[inline]
    pub(crate) fn node(&self, location: L) -> Option<NodeIndex> {
        if let Some(place) = location.place()
            && self.locations.get(place) == Some(&location)
        {
            return Some(NodeIndex::new(place));
        }
        self.locations.iter().position(|listed| *listed == location).map(NodeIndex::new)
    }

    /// The graph: a node for every location, in the order of [`locations`](Self::locations), and an
    /// edge for every row
    /// of the table, in the order of the rows.
    pub fn graph(&self) -> &DiGraph<L, Transition<E, S>> {
        &self.graph
    }

    /// Flow and invariant of `location`.
    pub fn mode(&self, location: L) -> Option<&Mode<S>> {
        self.modes.get(self.node(location)?.index())
    }

    /// Checks that time may pass in `location`: its invariant holds in `state`.
    ///
    /// # Errors
    ///
    /// [`InvariantError`] if it does not hold, or has no value.
    pub fn check_invariant(&self, location: L, state: &S) -> Result<(), InvariantError> {
        let Some(mode) = self.mode(location) else { return Ok(()) };
        let Some(invariant) = &mode.invariant else { return Ok(()) };
        match observed::holds(invariant, mode.watch.as_ref(), state) {
            Ok(true) => Ok(()),
            _ => Err(InvariantError::new(location.name(), invariant, state)),
        }
    }

    /// Lets `duration` ≥ 0 seconds pass in the place where `state` stands, by its
    /// [exact](Flow::exact) flow; without one the state rests.
    pub fn flow_in_place<P>(&self, state: &mut S, duration: f64)
    where
        P: Place<Location = L>,
        S: Holds<P>,
    {
        let mode = self.mode(state.current().location());
        if let Some(flow) = mode.and_then(|mode| mode.flow.as_ref()) {
            let _is_exact = flow.advance(state, duration);
        }
    }
}

impl<L: Location, E: Event, S: Coordinates> Automaton<L, E, S> {
    /// Begins the automaton over states with coordinates that starts in `initial`; its transitions
    /// and what is said of its locations follow.
    pub fn starting_in(initial: L) -> Builder<L, E, S> {
        Builder::over_coordinates(initial)
    }

    /// The names of the coordinates, in their order.
    pub fn names(&self) -> &[&'static str] {
        self.known.as_deref().unwrap_or(S::NAMES)
    }

    /// The same automaton with another value of a parameter.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] if it has no parameter of that name, or `value` is not finite.
    pub fn with(&self, parameter: &str, value: f64) -> Result<Self, ParameterError> {
        let Some(place) = self.parameters.iter().position(|(name, _)| name == parameter) else {
            let known = self.parameters.iter().map(|(name, _)| name.clone()).collect();
            return Err(ParameterError::Unknown { parameter: parameter.to_owned(), known });
        };
        if !value.is_finite() {
            return Err(ParameterError::NotFinite { parameter: parameter.to_owned(), value });
        }
        let mut changed = self.clone();
        changed.parameters[place].1 = value;
        Ok(changed)
    }

    /// The same automaton with numbers in the place of its parameters: for
    /// [`step`](Self::step) and other evaluations on states, which know coordinates only.
    #[must_use]
    pub fn with_numbers(&self) -> Self {
        let numbers = self.numbers();
        let mut changed = self.clone();
        if changed.parameters.is_empty() {
            return changed;
        }
        changed.parameters.clear();
        for (_, formula) in &mut changed.signals {
            *formula = formula.substitute(&numbers);
        }
        for transition in changed.graph.edge_weights_mut() {
            let guard = transition.guard.predicate().substitute(&numbers);
            transition.guard = Guard::new(transition.guard.name(), guard);
            transition.reset = transition.reset.substitute(&numbers);
        }
        for mode in &mut changed.modes {
            mode.flow = mode.flow.take().map(|flow| flow.substitute(&numbers));
            mode.invariant = mode.invariant.take().map(|it| it.substitute(&numbers));
        }
        changed
    }
}

/// Why a parameter cannot be set.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ParameterError {
    /// The model has no such parameter.
    #[error("there is no parameter `{parameter}`: {}", listed(known))]
    Unknown {
        /// The name.
        parameter: String,
        /// The names of those that there are.
        known: Vec<String>,
    },
    /// The value is not finite.
    #[error("parameter `{parameter}` cannot be {value}: give it a finite number")]
    NotFinite {
        /// The name.
        parameter: String,
        /// The value.
        value: f64,
    },
}

/// Which names there are, as the end of a sentence.
fn listed(known: &[String]) -> String {
    let names: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
    match &*names {
        [] => "the model has none".to_owned(),
        [only] => format!("there is {only}"),
        _ => format!("there are {}", names.join(", ")),
    }
}
