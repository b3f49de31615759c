//! Building automata.

mod draft;
mod error;
mod parts;

use std::mem::take;
use std::ops::RangeInclusive;

use petgraph::graph::DiGraph;
use pleach_discrete::{Event, Location, Row, Source, Superstate, TransitionTable};
use pleach_guards::{Expression, Guard, Predicate, Substitution, Valuation};

pub use error::BuildError;

use crate::automaton::{Automaton, Mode, Transition};
use crate::composition::Sampling;
use crate::coordinates::{Coordinate, Coordinates};
use crate::edge::Edge;
use crate::flow::{Flow, Rate};
use crate::law::Laws;
use crate::lists::{mapped, names_of, place_of};
use crate::located::Transfer;
use crate::observed::{Exclusion, Observed, Watch};
use crate::reset::Reset;
use crate::signals::resolved;
use draft::{Draft, Said, Vocabulary};
use parts::{Given, Parts};

/// An [`Automaton`] under construction.
///
/// There are two ways to begin. [`Automaton::builder`] takes a table, and each of its events gets
/// a guard and a reset [`on`](Builder::on) all rows at once; [`Automaton::starting_in`] takes one
/// [`transition`](Builder::transition) after another. Both go on with flows and invariants.
#[derive(Clone, Debug)]
#[must_use = "an automaton is complete after `build`"]
pub struct Builder<L, E, S> {
    /// By number: those that the type lists, then others as they are mentioned.
    locations: Vec<L>,
    events: Vec<E>,
    /// All that needs no types: it is compiled once for all automata.
    parts: Parts,
    /// By number, in the order in which they are given.
    flows: Vec<Flow<S>>,
    resets: Vec<Reset<S>>,
    initial_state: Option<S>,
    /// Propositions of which at most one is true at a time.
    exclusion: Exclusion<S>,
    /// How a guard is looked up by numbers, where the state has them.
    watch: fn(&Predicate) -> Option<Watch<S>>,
    /// A reset with formulas in the place of signals, where the state has coordinates.
    substitute: fn(&Reset<S>, &Substitution) -> Reset<S>,
}

impl<L: Location, E: Event, S: Valuation> Builder<L, E, S> {
    pub(crate) fn new(table: TransitionTable<'_, L, E>, initial: L) -> Self {
        let mut locations = L::ALL.to_vec();
        let initial = number_of(initial, &mut locations);
        let mut builder = Builder {
            locations,
            events: E::ALL.to_vec(),
            parts: Parts::starting_in(initial),
            flows: Vec::new(),
            resets: Vec::new(),
            initial_state: None,
            exclusion: Exclusion::none(),
            watch: |_| None,
            substitute: |reset, _| reset.clone(),
        };
        for row in table.rows() {
            builder.add_row(row);
        }
        table.superstates().for_each(|superstate| builder.note(&superstate));
        builder
    }

    /// Drawings show this superstate.
    fn note(&mut self, superstate: &Superstate<L>) {
        let members = superstate.members().iter();
        let members = members.map(|&member| number_of(member, &mut self.locations)).collect();
        let known = (superstate.name(), members);
        if !self.parts.superstates.contains(&known) {
            self.parts.superstates.push(known);
        }
    }

    fn add_row(&mut self, row: &Row<L, E>) {
        let row = self.numbered(row);
        self.parts.rows.push(row);
    }

    /// The row with the numbers of its locations and event.
    fn numbered(&mut self, row: &Row<L, E>) -> Row<usize, usize> {
        let Row { urgency, priority, .. } = *row;
        let source = number_of(row.source, &mut self.locations);
        let target = number_of(row.target, &mut self.locations);
        let event = number_of(row.event, &mut self.events);
        Row { source, event, target, urgency, priority }
    }

    fn given(&mut self, guard: Guard, reset: Reset<S>) -> Given {
        let (assignments, number) = (reset.shared_assignments(), self.resets.len());
        self.resets.push(reset);
        Given { guard, assignments, reset: number }
    }

    /// What the row from one location on one event carries over, and when; or the rows from each location of a
    /// superstate.
    pub fn carried_out(mut self, transfer: Transfer<L, E, S>) -> Self {
        let Transfer { rule, guard, reset } = transfer;
        let given = self.given(guard, reset);
        for row in rule.rows() {
            let Row { source, event, target, .. } = self.numbered(&row);
            self.parts.transfers.push(([source, event, target], given.clone()));
        }
        self
    }

    /// The transitions on `event` may be taken where `guard` holds, and do `reset`.
    pub fn on(mut self, event: E, guard: impl Into<Guard>, reset: impl Into<Reset<S>>) -> Self {
        let event = number_of(event, &mut self.events);
        let given = self.given(guard.into(), reset.into());
        self.parts.conditions.push((event, given));
        self
    }

    /// One more transition, with a guard and a reset of its own, or [one for each location](crate::from_any) of a
    /// superstate. Several may leave one location on one event; where the guards of more than one hold, priority and
    /// order of declaration decide.
    pub fn transition(mut self, edge: Edge<L, E, S>) -> Self {
        let Edge { rule, guard, reset } = edge;
        let given = self.given(guard, reset);
        for row in rule.rows() {
            self.parts.edges.push((self.parts.rows.len(), given.clone()));
            self.add_row(&row);
        }
        if let Source::Superstate(superstate) = rule.source() {
            self.note(superstate);
        }
        self
    }

    /// In `location` the state changes by `flow`; without one it rests.
    pub fn flow(mut self, location: L, flow: impl Into<Flow<S>>) -> Self {
        let (location, flow) = (number_of(location, &mut self.locations), flow.into());
        self.parts.flows.push((location, flow.shared_rates()));
        self.flows.push(flow);
        self
    }

    /// In `location` time may pass while `invariant` holds; without one it always may.
    pub fn invariant(mut self, location: L, invariant: Predicate) -> Self {
        let location = number_of(location, &mut self.locations);
        self.parts.invariants.push((location, invariant));
        self
    }

    /// The automaton.
    ///
    /// # Errors
    ///
    /// The first [`BuildError`] found: in the vocabularies, the names, the table, the guards, then in what
    /// is said about the locations.
    pub fn build(mut self) -> Result<Automaton<L, E, S>, BuildError> {
        self.draft()?.check_names()?;
        self.resolve_signals()?;
        let mut draft = self.draft()?;
        draft.check()?;
        Ok(Automaton {
            graph: self.graph(&draft)?,
            modes: self.modes(&draft),
            leaving: draft.leaving(),
            superstates: draft.superstates(),
            rows: self.rows(),
            initial: self.locations[self.parts.initial],
            locations: chosen(&self.locations, &draft.location_order),
            events: chosen(&self.events, &draft.event_order),
            // Taken, not moved: the builder is dropped as a whole then, which compiles to less.
            initial_state: self.initial_state.take(),
            ranges: take(&mut self.parts.ranges),
            known: self.parts.known.take(),
            parameters: take(&mut self.parts.parameters),
            signals: take(&mut self.parts.signals),
            samplings: mapped(&self.parts.samplings, |(event, it)| (self.events[*event], *it)),
            own: Vec::new(),
            tally: None,
            exclusion: self.exclusion.clone(),
        })
    }

    /// Puts formulas in the place of signals, wherever they are named.
    fn resolve_signals(&mut self) -> Result<(), BuildError> {
        let Builder { parts, flows, resets, substitute, .. } = self;
        if parts.signals.is_empty() {
            return Ok(());
        }
        parts.signals =
            resolved(&parts.signals).map_err(|signals| BuildError::SignalCycle { signals })?;
        let formulas = Substitution::new(parts.signals.iter().cloned());
        for reset in resets.iter_mut() {
            *reset = substitute(reset, &formulas);
        }
        for given in parts.given_mut() {
            let Given { guard, assignments, reset } = given;
            *guard = Guard::new(guard.name(), guard.predicate().substitute(&formulas));
            *assignments = resets[*reset].shared_assignments();
        }
        for (flow, (_, rates)) in flows.iter_mut().zip(&mut parts.flows) {
            *flow = flow.substitute(&formulas);
            *rates = flow.shared_rates();
        }
        for (_, invariant) in &mut parts.invariants {
            *invariant = invariant.substitute(&formulas);
        }
        for rate in &mut parts.throughout {
            *rate = rate.substitute(&formulas);
        }
        Ok(())
    }

    /// The automaton, after a look at any one state of the model, whose values do not matter:
    /// every variable that formulas name must be there.
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build), and [`BuildError::UnknownVariable`].
    pub fn build_for(self, example: &S) -> Result<Automaton<L, E, S>, BuildError> {
        self.draft()?.check_variables(&|name| example.value(name).is_some())?;
        self.build()
    }

    fn draft(&self) -> Result<Draft<'_>, BuildError> {
        let locations = Vocabulary {
            names: names_of(&self.locations, L::name),
            listed: L::ALL.len(),
            is_open: L::IS_OPEN,
            debug: &|number| format!("{:?}", self.locations[number]),
        };
        let events = Vocabulary {
            names: names_of(&self.events, E::name),
            listed: E::ALL.len(),
            is_open: E::IS_OPEN,
            debug: &|number| format!("{:?}", self.events[number]),
        };
        let initial_state = self.initial_state.as_ref().map(|state| state as &dyn Valuation);
        Draft::of(&self.parts, locations, events, self.exclusion.names(), initial_state)
    }

    fn graph(&self, draft: &Draft<'_>) -> Result<DiGraph<L, Transition<E, S>>, BuildError> {
        let mut graph = DiGraph::new();
        for &location in &draft.location_order {
            graph.add_node(self.locations[location]);
        }
        for (number, row) in self.parts.rows.iter().enumerate() {
            let [source, target] = draft.ends(number);
            let Given { guard, reset, .. } = draft.given_for(number)?;
            let transition = Transition {
                event: self.events[row.event],
                guard: guard.clone(),
                watch: (self.watch)(guard.predicate()),
                reset: self.resets[*reset].clone(),
                urgency: row.urgency,
                priority: row.priority,
            };
            graph.add_edge(source, target, transition);
        }
        Ok(graph)
    }

    fn modes(&self, draft: &Draft<'_>) -> Vec<Mode<S>> {
        mapped(&draft.location_order, |location| {
            let Said { rates, flow, invariant, commands } = draft.said(*location);
            let flow = match (rates, flow) {
                (Some(rates), _) => Some(Flow::of_rates(rates)),
                (None, Some(number)) => Some(self.flows[number].clone()),
                (None, None) => None,
            };
            let watch = invariant.and_then(self.watch);
            Mode { flow, invariant: invariant.cloned(), watch, commands }
        })
    }

    fn rows(&self) -> Vec<Row<L, E>> {
        mapped(&self.parts.rows, |row| Row {
            source: self.locations[row.source],
            event: self.events[row.event],
            target: self.locations[row.target],
            urgency: row.urgency,
            priority: row.priority,
        })
    }
}

impl<L: Location, E: Event, S: Observed> Builder<L, E, S> {
    /// No formula may name anything but the quantities and propositions of the state, and guards
    /// are evaluated by their numbers.
    pub fn observing(mut self) -> Self {
        self.parts.observed = Some((S::VARIABLES, S::PROPOSITIONS));
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
        for (location, command) in laws.commands() {
            let location = number_of(location, &mut self.locations);
            self.parts.commands.push((location, command.clone()));
        }
        self
    }
}

impl<L: Location, E: Event, S: Coordinates> Builder<L, E, S> {
    pub(crate) fn over_coordinates(initial: L) -> Self {
        let mut builder = Builder::new(TransitionTable::new(&[]), initial);
        builder.parts.known = Some(S::NAMES.to_vec());
        builder
    }

    /// One over the same states, with the same parameters and ranges, that starts in `initial`.
    pub(crate) fn after<M: Location>(automaton: &Automaton<M, E, S>, initial: L) -> Self {
        let mut builder = Builder::new(TransitionTable::new(&[]), initial);
        builder.initial_state = automaton.initial_state.clone();
        builder.exclusion = automaton.exclusion.clone();
        builder.parts.known = automaton.known.clone();
        builder.parts.parameters = automaton.parameters.clone();
        builder.parts.signals = automaton.signals.clone();
        builder.substitute = Reset::substitute;
        builder.parts.ranges = automaton.ranges.clone();
        for (event, sampling) in &automaton.samplings {
            builder = builder.sampled(*event, *sampling);
        }
        builder
    }

    /// Runs start in `state`, unless they are given another one.
    pub fn initially(mut self, state: S) -> Self {
        self.parts.known = Some(state.names().to_vec());
        self.initial_state = Some(state);
        self
    }

    /// In all formulas of the model `name` stands for `value`, which
    /// [`Automaton::with`](crate::Automaton::with) changes. Texts and drawings show the name.
    pub fn parameter(mut self, name: &str, value: f64) -> Self {
        self.parts.parameters.push((name.to_owned(), value));
        self
    }

    /// In all formulas of the model `name` stands for `formula`, of coordinates, parameters and other
    /// signals: an output, or what several guards and flows read. Runs record it, and
    /// [compositions](crate::CompositionBuilder::connect) can connect it, like a coordinate.
    pub fn signal(mut self, name: &str, formula: impl Into<Expression>) -> Self {
        self.parts.signals.push((name.to_owned(), formula.into()));
        self.substitute = Reset::substitute;
        self
    }

    /// Transitions on `event` are taken at 0, `period`, 2 `period`, … seconds and at no other time, without a
    /// clock in the state: where the guard of one of them holds at such an instant, it is taken, and else the
    /// sample passes. A [composition](crate::CompositionBuilder::every) can say the same of its components.
    ///
    /// A thermostat that looks at the temperature once a second:
    ///
    /// ```
    /// use pleach_automaton::{Automaton, coordinates, from};
    /// use pleach_discrete::vocabulary;
    ///
    /// vocabulary! {
    ///     enum Heater: Location { Off = "off", On = "on" }
    ///     enum Sensed: Event { Cold = "cold", Warm = "warm" }
    /// }
    /// coordinates! { struct Room { temperature = "T" } }
    /// use {Heater::{Off, On}, Sensed::{Cold, Warm}};
    ///
    /// let Room { temperature } = Room::coordinates();
    /// let thermostat = Automaton::starting_in(Off)
    ///     .initially(Room { temperature: 20.0 })
    ///     .flow(Off, temperature.rate(-0.75))
    ///     .flow(On, temperature.rate(0.75))
    ///     .transition(from(Off).on(Cold).to(On).may(temperature.at_most(18.0)))
    ///     .transition(from(On).on(Warm).to(Off).may(temperature.at_least(22.0)))
    ///     .every(Cold, 1.0)
    ///     .every(Warm, 1.0)
    ///     .build()?;
    /// // It is at 18 degrees after 2.67 s, and looks at 3 s.
    /// let trajectory = thermostat.run(4.0)?;
    /// assert_eq!(trajectory.value("T", 3.0)?, 17.75);
    /// assert_eq!(trajectory.location(0, 2.9), Some("off"));
    /// assert_eq!(trajectory.location(0, 3.1), Some("on"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn every(self, event: E, period: f64) -> Self {
        self.every_from(event, period, 0.0)
    }

    /// As [`every`](Self::every), at `phase` ≥ 0, `phase` + `period`, … seconds.
    ///
    /// [`build`](Self::build) refuses a period that is not finite and above 0, and an event that is sampled twice.
    pub fn every_from(self, event: E, period: f64, phase: f64) -> Self {
        self.sampled(event, Sampling { period, phase })
    }

    fn sampled(mut self, event: E, sampling: Sampling) -> Self {
        let event = number_of(event, &mut self.events);
        self.parts.samplings.push((event, sampling));
        self
    }

    /// In every location, beside its flow, this changes, too: such as a clock that shows the time,
    /// `time.rate(1.0)`.
    pub fn throughout(mut self, rates: impl IntoIterator<Item = Rate<S>>) -> Self {
        self.parts.throughout.extend(rates.into_iter().map(Rate::untyped));
        self
    }

    /// The model is meant for values of `coordinate` in `range`: checks look there, and nowhere
    /// else, for what can go wrong.
    pub fn range(mut self, coordinate: &Coordinate<S>, range: RangeInclusive<f64>) -> Self {
        self.parts.ranges.push((coordinate.name().to_owned(), range));
        self
    }
}

/// The number of `one` among the known, which it joins if it is new.
fn number_of<T: Copy + PartialEq>(one: T, known: &mut Vec<T>) -> usize {
    place_of(known, one).unwrap_or_else(|| {
        known.push(one);
        known.len() - 1
    })
}

/// Those with these numbers.
fn chosen<T: Copy>(known: &[T], numbers: &[usize]) -> Vec<T> {
    mapped(numbers, |number| known[*number])
}
