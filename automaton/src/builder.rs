//! Building automata.

mod draft;
mod error;

use std::ops::RangeInclusive;

use petgraph::graph::{DiGraph, NodeIndex};
use pleach_discrete::{Event, Location, Row, TransitionTable, first_mentions};
use pleach_guards::{Guard, Predicate, Valuation};

pub use error::BuildError;

use crate::automaton::{Automaton, Mode, Transition};
use crate::coordinates::{Coordinate, Coordinates};
use crate::edge::Edge;
use crate::flow::{Flow, Rate};
use crate::law::{Command, Laws};
use crate::located::Transfer;
use crate::observed::{Exclusion, Observed, Watch};
use crate::reset::Reset;
use draft::Origin;

/// An [`Automaton`] under construction.
///
/// There are two ways to begin. [`Automaton::builder`] takes a table, and each of its events gets
/// a guard and a reset [`on`](Builder::on) all rows at once; [`Automaton::starting_in`] takes one
/// [`transition`](Builder::transition) after another. Both go on with flows and invariants.
#[derive(Clone, Debug)]
#[must_use = "an automaton is complete after `build`"]
pub struct Builder<L, E, S> {
    rows: Vec<Row<L, E>>,
    initial: L,
    initial_state: Option<S>,
    /// For all rows of an event.
    conditions: Vec<(E, Guard, Reset<S>)>,
    /// For the rows with these numbers.
    edges: Vec<(usize, Guard, Reset<S>)>,
    flows: Vec<(L, Flow<S>)>,
    invariants: Vec<(L, Predicate)>,
    ranges: Vec<(String, RangeInclusive<f64>)>,
    /// The names of all variables, where the type of the state has them.
    known: Option<Vec<&'static str>>,
    /// Names that stand for numbers, with these.
    parameters: Vec<(String, f64)>,
    /// What changes alike in all locations.
    throughout: Vec<Rate>,
    /// Propositions of which at most one is true at a time.
    exclusion: Exclusion<S>,
    /// What is chosen at samples.
    commands: Vec<(L, Command)>,
    /// The names of all variables and propositions, where the state is not its coordinates.
    observed: Option<Names>,
    /// How a guard is looked up by numbers, where the state has them.
    watch: fn(&Predicate) -> Option<Watch<S>>,
    transfers: Vec<Transfer<L, E, S>>,
}

/// The names of variables and of propositions.
type Names = (&'static [&'static str], &'static [&'static str]);

impl<L: Location, E: Event, S: Valuation> Builder<L, E, S> {
    pub(crate) fn new(table: TransitionTable<'_, L, E>, initial: L) -> Self {
        Builder {
            rows: table.rows().to_vec(),
            initial,
            initial_state: None,
            conditions: Vec::new(),
            edges: Vec::new(),
            flows: Vec::new(),
            invariants: Vec::new(),
            ranges: Vec::new(),
            known: None,
            parameters: Vec::new(),
            throughout: Vec::new(),
            exclusion: Exclusion::none(),
            commands: Vec::new(),
            observed: None,
            watch: |_| None,
            transfers: Vec::new(),
        }
    }

    /// What the row from one location on one event carries over, and when.
    pub fn carried_out(mut self, transfer: Transfer<L, E, S>) -> Self {
        self.transfers.push(transfer);
        self
    }

    /// The transitions on `event` may be taken where `guard` holds, and do `reset`.
    pub fn on(mut self, event: E, guard: impl Into<Guard>, reset: impl Into<Reset<S>>) -> Self {
        self.conditions.push((event, guard.into(), reset.into()));
        self
    }

    /// One more transition, with a guard and a reset of its own. Several may leave one location on
    /// one event; where the guards of more than one hold, priority and order of declaration decide.
    pub fn transition(mut self, edge: Edge<L, E, S>) -> Self {
        self.edges.push((self.rows.len(), edge.guard, edge.reset));
        self.rows.push(edge.row);
        self
    }

    /// In `location` the state changes by `flow`; without one it rests.
    pub fn flow(mut self, location: L, flow: impl Into<Flow<S>>) -> Self {
        self.flows.push((location, flow.into()));
        self
    }

    /// In `location` time may pass while `invariant` holds; without one it always may.
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
        let (locations, events) = (self.locations(), self.events());
        let mut draft = self.draft(&locations, &events)?;
        draft.check()?;
        let mut graph = DiGraph::with_capacity(locations.len(), self.rows.len());
        let (mut modes, mut leaving) = (Vec::new(), Vec::new());
        for (number, &location) in locations.iter().enumerate() {
            graph.add_node(location);
            modes.push(self.mode(location, draft.rates(number)));
            leaving.push(draft.leaving(number));
        }
        for (number, row) in self.rows.iter().enumerate() {
            let [source, target] = draft.ends(number).map(NodeIndex::new);
            graph.add_edge(source, target, self.transition_of(row, draft.origin(number))?);
        }
        let Builder { rows, initial, initial_state, ranges, known, parameters, .. } = self;
        Ok(Automaton {
            rows,
            initial,
            initial_state,
            ranges,
            known,
            parameters,
            own: Vec::new(),
            locations,
            events,
            graph,
            modes,
            leaving,
            tally: None,
            exclusion: self.exclusion,
        })
    }

    /// The automaton, after a look at any one state of the model, whose values do not matter:
    /// every variable that formulas name must be there.
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build), and [`BuildError::UnknownVariable`].
    pub fn build_for(self, example: &S) -> Result<Automaton<L, E, S>, BuildError> {
        let draft = self.draft(&self.locations(), &self.events())?;
        draft.check_variables(&|name| example.value(name).is_some())?;
        self.build()
    }

    /// All locations, or those that are mentioned.
    fn locations(&self) -> Vec<L> {
        let in_rows = self.rows.iter().flat_map(|row| [row.source, row.target]);
        let described = self.flows.iter().map(|(location, _)| *location);
        let restricted = self.invariants.iter().map(|(location, _)| *location);
        let mentioned =
            [self.initial].into_iter().chain(in_rows).chain(described).chain(restricted);
        let all = L::ALL.iter().copied();
        if L::IS_OPEN { first_mentions(all.chain(mentioned)) } else { all.collect() }
    }

    /// All events, or those that are mentioned.
    fn events(&self) -> Vec<E> {
        let all = E::ALL.iter().copied();
        let mentioned = self.rows.iter().map(|row| row.event);
        if E::IS_OPEN { first_mentions(all.chain(mentioned)) } else { all.collect() }
    }

    fn transition_of(
        &self,
        row: &Row<L, E>,
        origin: Option<Origin>,
    ) -> Result<Transition<E, S>, BuildError> {
        let (guard, reset) = match origin {
            Some(Origin::Condition(number)) => {
                let (_, guard, reset) = &self.conditions[number];
                (guard, reset)
            }
            Some(Origin::Edge(number)) => {
                let (_, guard, reset) = &self.edges[number];
                (guard, reset)
            }
            Some(Origin::Transfer(number)) => {
                let Transfer { guard, reset, .. } = &self.transfers[number];
                (guard, reset)
            }
            None => return Err(BuildError::EventWithoutGuard { event: row.event.name() }),
        };
        Ok(Transition {
            event: row.event,
            guard: guard.clone(),
            watch: (self.watch)(guard.predicate()),
            reset: reset.clone(),
            urgency: row.urgency,
            priority: row.priority,
        })
    }

    /// What is said of a location, where these are the rates in it, if they are formulas.
    fn mode(&self, location: L, rates: Option<Vec<Rate>>) -> Mode<S> {
        let flow = self.flows.iter().find(|(place, _)| *place == location);
        let invariant = self.invariants.iter().find(|(place, _)| *place == location);
        let commands = self.commands.iter().filter(|(place, _)| *place == location);
        Mode {
            flow: rates.map(Flow::of_rates).or_else(|| flow.map(|(_, flow)| flow.clone())),
            invariant: invariant.map(|(_, invariant)| invariant.clone()),
            watch: invariant.and_then(|(_, invariant)| (self.watch)(invariant)),
            commands: commands.map(|(_, command)| command.clone()).collect(),
        }
    }
}

impl<L: Location, E: Event, S: Observed> Builder<L, E, S> {
    /// No formula may name anything but the quantities and propositions of the state, and guards
    /// are evaluated by their numbers.
    pub fn observing(mut self) -> Self {
        self.observed = Some((S::VARIABLES, S::PROPOSITIONS));
        self.watch = Watch::of;
        self
    }

    /// States are made such that at most one of these propositions is true at a time: checks look
    /// nowhere else, and in builds with debug assertions every step of the automaton watches it.
    pub fn at_most_one(mut self, propositions: &[&str]) -> Self {
        self.exclusion = self.exclusion.and(propositions);
        self
    }

    /// At each sample `laws` choose a value, as far as they speak of a location. Drawings and
    /// tables show them; the component evaluates them at its samples.
    pub fn commanding<T>(mut self, laws: &Laws<L, S, T>) -> Self {
        let commands = laws.commands();
        self.commands.extend(commands.map(|(location, command)| (location, command.clone())));
        self
    }
}

impl<L: Location, E: Event, S: Coordinates> Builder<L, E, S> {
    pub(crate) fn over_coordinates(initial: L) -> Self {
        let known = Some(S::NAMES.to_vec());
        Builder { known, ..Builder::new(TransitionTable::new(&[]), initial) }
    }

    /// One over the same states, with the same parameters and ranges, that starts in `initial`.
    pub(crate) fn after<M: Location>(automaton: &Automaton<M, E, S>, initial: L) -> Self {
        Builder {
            initial_state: automaton.initial_state.clone(),
            known: automaton.known.clone(),
            parameters: automaton.parameters.clone(),
            ranges: automaton.ranges.clone(),
            exclusion: automaton.exclusion.clone(),
            ..Builder::new(TransitionTable::new(&[]), initial)
        }
    }

    /// Runs start in `state`, unless they are given another one.
    pub fn initially(mut self, state: S) -> Self {
        self.known = Some(state.names().to_vec());
        self.initial_state = Some(state);
        self
    }

    /// In all formulas of the model `name` stands for `value`, which
    /// [`Automaton::with`](crate::Automaton::with) changes. Texts and drawings show the name.
    pub fn parameter(mut self, name: &str, value: f64) -> Self {
        self.parameters.push((name.to_owned(), value));
        self
    }

    /// In every location, beside its flow, this changes, too: such as a clock that shows the time,
    /// `time.rate(1.0)`.
    pub fn throughout(mut self, rates: impl IntoIterator<Item = Rate<S>>) -> Self {
        self.throughout.extend(rates.into_iter().map(Rate::untyped));
        self
    }

    /// The model is meant for values of `coordinate` in `range`: checks look there, and nowhere
    /// else, for what can go wrong.
    pub fn range(mut self, coordinate: &Coordinate<S>, range: RangeInclusive<f64>) -> Self {
        self.ranges.push((coordinate.name().to_owned(), range));
        self
    }
}
