//! The hybrid automaton: a graph of locations with guards, resets, flows and invariants.

use petgraph::graph::{DiGraph, EdgeIndex, NodeIndex};
use pleach_discrete::{Event, Location, TransitionTable, Urgency};
use pleach_guards::{EvaluationError, Guard, Predicate, Valuation};
use thiserror::Error;

use crate::builder::Builder;
use crate::reset::{Flow, Reset};

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
/// use pleach_discrete::{Event, Location, Row, TransitionTable, Urgency};
/// use pleach_guards::{variable, Guard, Valuation};
///
/// # #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
/// enum Tap { Open, Shut }
/// # impl Location for Tap {
/// #     const ALL: &'static [Self] = &[Tap::Open, Tap::Shut];
/// #     fn name(self) -> &'static str { match self { Tap::Open => "open", Tap::Shut => "shut" } }
/// # }
/// # #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
/// enum Float { Full }
/// # impl Event for Float {
/// #     const ALL: &'static [Self] = &[Float::Full];
/// #     fn name(self) -> &'static str { "full" }
/// # }
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
pub struct Automaton<L: 'static, E: 'static, S> {
    pub(crate) table: TransitionTable<L, E>,
    pub(crate) initial: L,
    /// The nodes stand in the order of `L::ALL`.
    pub(crate) graph: DiGraph<L, Transition<E, S>>,
    /// By node.
    pub(crate) modes: Vec<Mode<S>>,
    /// By node: the edges that leave it, in their total order.
    pub(crate) leaving: Vec<Vec<EdgeIndex>>,
}

/// What an edge of the graph carries.
#[derive(Clone, Debug)]
pub struct Transition<E, S> {
    /// The event under which the transition is taken.
    pub event: E,
    /// When it may be taken.
    pub guard: Guard,
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

/// A transition that can be taken now: its guard holds in the state it was found for.
#[derive(Debug)]
pub struct Step<'a, L, E, S> {
    source: L,
    target: L,
    transition: &'a Transition<E, S>,
}

/// A guard could not be evaluated.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("guard `{guard}` of event `{event}` in location `{location}`: {source}")]
pub struct GuardError {
    /// The location that the transition leaves.
    pub location: &'static str,
    /// The event of the transition.
    pub event: &'static str,
    /// The name of the guard.
    pub guard: String,
    /// What is wrong with the state or the guard.
    pub source: EvaluationError,
}

impl<L: Location, E: Event, S: Valuation> Automaton<L, E, S> {
    /// Begins the automaton of `table` that starts in `initial`.
    pub fn builder(table: TransitionTable<L, E>, initial: L) -> Builder<L, E, S> {
        Builder::new(table, initial)
    }

    /// The table that the automaton was built from.
    pub fn table(&self) -> TransitionTable<L, E> {
        self.table
    }

    /// The location in which a run starts.
    pub fn initial(&self) -> L {
        self.initial
    }

    /// The graph: a node for every location, in the order of `L::ALL`, and an edge for every row
    /// of the table, in the order of the rows.
    pub fn graph(&self) -> &DiGraph<L, Transition<E, S>> {
        &self.graph
    }

    /// Flow and invariant of `location`.
    pub fn mode(&self, location: L) -> Option<&Mode<S>> {
        self.modes.get(node(location)?.index())
    }

    /// The first transition in total order that leaves `location`, has to be taken (*must* or *at
    /// once*), and whose guard holds in `state`.
    ///
    /// # Errors
    ///
    /// [`GuardError`] for the first guard before it that cannot be evaluated.
    pub fn enabled(&self, location: L, state: &S) -> Result<Option<Step<'_, L, E, S>>, GuardError> {
        self.first(location, state, |transition| transition.urgency.is_forced())
    }

    /// The first transition in total order that leaves `location` on `event` and whose guard
    /// holds in `state`, whatever its urgency: for those that *may* be taken, and for events that
    /// several components take together.
    ///
    /// # Errors
    ///
    /// [`GuardError`] if the guard cannot be evaluated.
    pub fn enabled_on(
        &self,
        event: E,
        location: L,
        state: &S,
    ) -> Result<Option<Step<'_, L, E, S>>, GuardError> {
        self.first(location, state, |transition| transition.event == event)
    }

    /// Takes the transition that [`enabled`](Self::enabled) finds, if there is one.
    ///
    /// # Errors
    ///
    /// As for [`enabled`](Self::enabled); location and state are then as before.
    pub fn step(&self, location: &mut L, state: &mut S) -> Result<Option<Jump<L, E>>, GuardError> {
        let step = self.enabled(*location, state)?;
        Ok(step.map(|step| step.fire(location, state)))
    }

    /// Lets `duration` seconds pass in `location`.
    pub fn flow(&self, location: L, state: &mut S, duration: f64) {
        if let Some(flow) = self.mode(location).and_then(|mode| mode.flow.as_ref()) {
            flow.advance(state, duration);
        }
    }

    fn first(
        &self,
        location: L,
        state: &S,
        eligible: impl Fn(&Transition<E, S>) -> bool,
    ) -> Result<Option<Step<'_, L, E, S>>, GuardError> {
        let leaving = node(location).and_then(|node| self.leaving.get(node.index()));
        for &edge in leaving.into_iter().flatten() {
            let transition = &self.graph[edge];
            if eligible(transition) && transition.allows(location, state)? {
                let target = self.table.rows()[edge.index()].target;
                return Ok(Some(Step { source: location, target, transition }));
            }
        }
        Ok(None)
    }
}

impl<E: Event, S: Valuation> Transition<E, S> {
    fn allows<L: Location>(&self, location: L, state: &S) -> Result<bool, GuardError> {
        self.guard.holds(state).map_err(|source| GuardError {
            location: location.name(),
            event: self.event.name(),
            guard: self.guard.name().to_owned(),
            source,
        })
    }
}

impl<'a, L: Location, E: Event, S> Step<'a, L, E, S> {
    /// The transition.
    pub fn transition(&self) -> &'a Transition<E, S> {
        self.transition
    }

    /// The jump that [`fire`](Self::fire) makes.
    pub fn jump(&self) -> Jump<L, E> {
        Jump { source: self.source, event: self.transition.event, target: self.target }
    }

    /// Takes the transition: resets the state and enters the target.
    pub fn fire(self, location: &mut L, state: &mut S) -> Jump<L, E> {
        self.transition.reset.apply(state);
        *location = self.target;
        self.jump()
    }
}

/// The node of `location`, unless `L::ALL` lacks it. Enums are small: looking through them is
/// faster than any map.
pub(crate) fn node<L: Location>(location: L) -> Option<NodeIndex> {
    L::ALL.iter().position(|listed| *listed == location).map(NodeIndex::new)
}
