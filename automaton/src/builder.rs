//! How an automaton is put together, and what can be wrong with it.

use petgraph::graph::{DiGraph, EdgeIndex, NodeIndex};
use pleach_discrete::{Event, Location, Row, TransitionTable};
use pleach_guards::{Guard, Predicate, Valuation};
use thiserror::Error;

use crate::automaton::{Automaton, Mode, Transition, node};
use crate::reset::{Flow, Reset};

/// An [`Automaton`] that is being put together: a table, then for each event a guard and a reset,
/// and for the locations that need it a flow and an invariant.
#[derive(Clone, Debug)]
#[must_use = "an automaton is complete after `build`"]
pub struct Builder<L: 'static, E: 'static, S> {
    table: TransitionTable<L, E>,
    initial: L,
    conditions: Vec<(E, Guard, Reset<S>)>,
    flows: Vec<(L, Flow<S>)>,
    invariants: Vec<(L, Predicate)>,
}

/// Why the parts do not make an automaton.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// `Location::ALL` lacks a location.
    #[error("location {location} is missing in `Location::ALL` of its type")]
    UnlistedLocation {
        /// The location, as its `Debug` prints it.
        location: String,
    },
    /// `Event::ALL` lacks an event.
    #[error("event {event} is missing in `Event::ALL` of its type")]
    UnlistedEvent {
        /// The event, as its `Debug` prints it.
        event: String,
    },
    /// The table has transitions, but none of them enters or leaves the initial location.
    #[error("the initial location `{location}` occurs in no row of the table")]
    InitialNotInTable {
        /// The location.
        location: &'static str,
    },
    /// Two rows share source and event.
    #[error("two rows of the table leave location `{location}` on event `{event}`: keep one")]
    Nondeterministic {
        /// The source of the rows.
        location: &'static str,
        /// The event of the rows.
        event: &'static str,
    },
    /// An event of the table has no guard.
    #[error("event `{event}` has no guard: say when it happens with `on`")]
    EventWithoutGuard {
        /// The event.
        event: &'static str,
    },
    /// A guard is given for an event that is in no row.
    #[error("guard `{guard}` is given for event `{event}`, which is in no row of the table")]
    GuardWithoutRow {
        /// The name of the guard.
        guard: String,
        /// The event.
        event: &'static str,
    },
    /// An event has two guards, or a location two flows or two invariants.
    #[error("`{place}` is given its {part} twice: keep one")]
    GivenTwice {
        /// The event or the location.
        place: &'static str,
        /// What is given twice: guard, flow or invariant.
        part: &'static str,
    },
    /// The state has no variable of a name that is asked for.
    #[error("the {part} of `{place}` reads variable `{variable}`, which the state does not have")]
    UnknownVariable {
        /// The event or the location.
        place: &'static str,
        /// What reads it: guard or invariant.
        part: &'static str,
        /// The name of the variable.
        variable: String,
    },
}

impl<L: Location, E: Event, S: Valuation> Builder<L, E, S> {
    pub(crate) fn new(table: TransitionTable<L, E>, initial: L) -> Self {
        Builder {
            table,
            initial,
            conditions: Vec::new(),
            flows: Vec::new(),
            invariants: Vec::new(),
        }
    }

    /// The transitions on `event` may be taken where `guard` holds, and do `reset`.
    pub fn on(mut self, event: E, guard: Guard, reset: Reset<S>) -> Self {
        self.conditions.push((event, guard, reset));
        self
    }

    /// In `location` the state changes by `flow`.
    pub fn flow(mut self, location: L, flow: Flow<S>) -> Self {
        self.flows.push((location, flow));
        self
    }

    /// In `location` time may pass while `invariant` holds.
    pub fn invariant(mut self, location: L, invariant: Predicate) -> Self {
        self.invariants.push((location, invariant));
        self
    }

    /// The automaton.
    ///
    /// # Errors
    ///
    /// The first [`BuildError`] found: in the vocabularies, the table, the guards, then in what
    /// is said about the locations.
    pub fn build(self) -> Result<Automaton<L, E, S>, BuildError> {
        self.check_vocabulary()?;
        self.check_table()?;
        self.check_parts()?;
        let mut graph = DiGraph::with_capacity(L::ALL.len(), self.table.rows().len());
        for &location in L::ALL {
            graph.add_node(location);
        }
        for row in self.table.rows() {
            let (source, target) = (listed(row.source)?, listed(row.target)?);
            graph.add_edge(source, target, self.transition(row)?);
        }
        let leaving = L::ALL.iter().map(|&location| self.leaving(location)).collect();
        let modes = L::ALL.iter().map(|&location| self.mode(location)).collect();
        Ok(Automaton { table: self.table, initial: self.initial, graph, modes, leaving })
    }

    /// The automaton, after a look at any one state of the model, whose values do not matter:
    /// every variable that guards and invariants read must be there.
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build), and [`BuildError::UnknownVariable`].
    pub fn build_for(self, example: &S) -> Result<Automaton<L, E, S>, BuildError> {
        let guards = self
            .conditions
            .iter()
            .map(|(event, guard, _)| (event.name(), "guard", guard.predicate()));
        let invariants = self
            .invariants
            .iter()
            .map(|(location, invariant)| (location.name(), "invariant", invariant));
        for (place, part, predicate) in guards.chain(invariants) {
            for variable in predicate.variables() {
                if example.value(variable).is_none() {
                    let variable = variable.to_owned();
                    return Err(BuildError::UnknownVariable { place, part, variable });
                }
            }
        }
        self.build()
    }

    fn check_vocabulary(&self) -> Result<(), BuildError> {
        listed(self.initial)?;
        for row in self.table.rows() {
            listed(row.source)?;
            listed(row.target)?;
            if !E::ALL.contains(&row.event) {
                return Err(BuildError::UnlistedEvent { event: format!("{:?}", row.event) });
            }
        }
        let described = self.flows.iter().map(|(location, _)| *location);
        let restricted = self.invariants.iter().map(|(location, _)| *location);
        described.chain(restricted).try_for_each(|location| listed(location).map(|_| ()))
    }

    fn check_table(&self) -> Result<(), BuildError> {
        if let Some(row) = self.table.conflict() {
            let (location, event) = (row.source.name(), row.event.name());
            return Err(BuildError::Nondeterministic { location, event });
        }
        let rows = self.table.rows();
        let occurs = rows.iter().any(|row| [row.source, row.target].contains(&self.initial));
        if !rows.is_empty() && !occurs {
            return Err(BuildError::InitialNotInTable { location: self.initial.name() });
        }
        Ok(())
    }

    fn check_parts(&self) -> Result<(), BuildError> {
        for (event, guard, _) in &self.conditions {
            if !self.table.rows().iter().any(|row| row.event == *event) {
                let (guard, event) = (guard.name().to_owned(), event.name());
                return Err(BuildError::GuardWithoutRow { guard, event });
            }
        }
        let events = self.conditions.iter().map(|(event, ..)| *event);
        let described = self.flows.iter().map(|(location, _)| *location);
        let restricted = self.invariants.iter().map(|(location, _)| *location);
        once(events, "guard", E::name)?;
        once(described, "flow", L::name)?;
        once(restricted, "invariant", L::name)
    }

    fn transition(&self, row: &Row<L, E>) -> Result<Transition<E, S>, BuildError> {
        let condition = self.conditions.iter().find(|(event, ..)| *event == row.event);
        let (event, guard, reset) =
            condition.ok_or(BuildError::EventWithoutGuard { event: row.event.name() })?;
        Ok(Transition {
            event: *event,
            guard: guard.clone(),
            reset: reset.clone(),
            urgency: row.urgency,
            priority: row.priority,
        })
    }

    /// The edges have the numbers of their rows.
    fn leaving(&self, location: L) -> Vec<EdgeIndex> {
        let rows = self.table.rows();
        let mut numbers: Vec<usize> =
            (0..rows.len()).filter(|&number| rows[number].source == location).collect();
        numbers.sort_by_key(|&number| (rows[number].priority, number));
        numbers.into_iter().map(EdgeIndex::new).collect()
    }

    fn mode(&self, location: L) -> Mode<S> {
        let flow = self.flows.iter().find(|(place, _)| *place == location);
        let invariant = self.invariants.iter().find(|(place, _)| *place == location);
        Mode {
            flow: flow.map(|(_, flow)| flow.clone()),
            invariant: invariant.map(|(_, invariant)| invariant.clone()),
        }
    }
}

fn listed<L: Location>(location: L) -> Result<NodeIndex, BuildError> {
    node(location).ok_or_else(|| BuildError::UnlistedLocation { location: format!("{location:?}") })
}

fn once<P: PartialEq + Copy>(
    places: impl Iterator<Item = P>,
    part: &'static str,
    name: fn(P) -> &'static str,
) -> Result<(), BuildError> {
    let mut seen = Vec::new();
    for place in places {
        if seen.contains(&place) {
            return Err(BuildError::GivenTwice { place: name(place), part });
        }
        seen.push(place);
    }
    Ok(())
}
