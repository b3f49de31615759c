//! How an automaton is put together, and what can be wrong with it.

use std::ops::RangeInclusive;

use petgraph::graph::{DiGraph, EdgeIndex, NodeIndex};
use pleach_discrete::{Event, Location, Row, TransitionTable};
use pleach_guards::{Expression, Guard, Predicate, Valuation};
use thiserror::Error;

use crate::automaton::{Automaton, Mode, Transition};
use crate::coordinates::{Coordinate, Coordinates};
use crate::edge::Edge;
use crate::flow::{Flow, Rate};
use crate::law::{Command, Laws};
use crate::located::Transfer;
use crate::observed::{Observed, Watch};
use crate::reset::Reset;

/// An [`Automaton`] that is being put together.
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
    /// The names of all variables, where the type of the state tells.
    known: Option<Vec<&'static str>>,
    /// Names that stand for numbers, with these.
    parameters: Vec<(String, f64)>,
    /// What changes alike in all locations.
    throughout: Vec<Rate<S>>,
    /// Propositions of which at most one is true at a time.
    exclusive: Vec<Vec<String>>,
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

/// Why the parts do not make an automaton.
#[derive(Clone, Debug, PartialEq, Error)]
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
    /// Two rows share source and event, and do not both have a guard of their own.
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
    /// A row of the table is not carried out, although others are.
    #[error("nothing says what the row of `{location}` on event `{event}` carries over")]
    RowWithoutTransfer {
        /// The source of the row.
        location: &'static str,
        /// The event of the row.
        event: &'static str,
    },
    /// What is carried out is in no row of the table.
    #[error("no row of the table leads from `{source_location}` on event `{event}` to `{target}`")]
    TransferWithoutRow {
        /// The source.
        source_location: &'static str,
        /// The event.
        event: &'static str,
        /// The target.
        target: &'static str,
    },
    /// A guard or an invariant names a proposition that the state does not have.
    #[error("`{place}` names proposition `{proposition}`, which the state does not have")]
    UnknownProposition {
        /// The event or the location.
        place: &'static str,
        /// The name of the proposition.
        proposition: String,
    },
    /// A formula names a variable that the state does not have.
    #[error("the {part} of `{place}` names variable `{variable}`, which the state does not have")]
    UnknownVariable {
        /// The event or the location.
        place: &'static str,
        /// What names it: guard, reset, flow or invariant.
        part: &'static str,
        /// The name of the variable.
        variable: String,
    },
    /// A flow or a reset says twice what one coordinate does.
    #[error("the {part} of `{place}` gives `{coordinate}` two values: keep one")]
    CoordinateTwice {
        /// The event or the location.
        place: &'static str,
        /// Flow or reset.
        part: &'static str,
        /// The coordinate.
        coordinate: &'static str,
    },
    /// A parameter is called like a coordinate or another parameter.
    #[error("parameter `{parameter}` is called like a coordinate or another parameter: rename one")]
    ParameterNameTaken {
        /// The name.
        parameter: String,
    },
    /// A parameter is infinite or NaN.
    #[error("parameter `{parameter}` is {value}: it must be a finite number")]
    ParameterNotFinite {
        /// The name.
        parameter: String,
        /// Its value.
        value: f64,
    },
    /// Rates are given for all locations, but the flow of one is a function.
    #[error("the flow of `{location}` is a function, to which no rates can be added")]
    NoRates {
        /// The location.
        location: &'static str,
    },
    /// A range is declared for a variable that the state does not have.
    #[error("a range is declared for variable `{variable}`, which the state does not have")]
    RangeOfUnknownVariable {
        /// The name of the variable.
        variable: String,
    },
    /// A range is empty, or one of its ends is NaN.
    #[error(
        "the range of `{variable}` runs from {lower} to {upper}: the first must be at most the \
         second"
    )]
    EmptyRange {
        /// The name of the variable.
        variable: String,
        /// The lower end given.
        lower: f64,
        /// The upper end given.
        upper: f64,
    },
    /// A coordinate of the initial state is NaN or infinite.
    #[error("`{variable}` is {value} in the initial state: it must be a finite number")]
    InitialNotFinite {
        /// The name of the coordinate.
        variable: &'static str,
        /// Its value.
        value: f64,
    },
}

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
            exclusive: Vec::new(),
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
    pub fn build(mut self) -> Result<Automaton<L, E, S>, BuildError> {
        self.check_vocabulary()?;
        self.check_table()?;
        self.match_transfers()?;
        self.check_parts()?;
        self.spread_rates()?;
        if let Some(names) = &self.known {
            let is_parameter = |name: &str| self.parameters.iter().any(|(known, _)| known == name);
            self.check_parameters(names)?;
            self.check_variables(|name| names.contains(&name) || is_parameter(name))?;
            self.check_initial_state(names)?;
        }
        if let Some((variables, propositions)) = self.observed {
            self.check_variables(|name| variables.contains(&name))?;
            self.check_propositions(propositions)?;
        }
        let (locations, events) = (self.locations(), self.events());
        let mut graph = DiGraph::with_capacity(locations.len(), self.rows.len());
        for &location in &locations {
            graph.add_node(location);
        }
        for (number, row) in self.rows.iter().enumerate() {
            let source = listed(&locations, row.source)?;
            let target = listed(&locations, row.target)?;
            graph.add_edge(source, target, self.transition_of(number, row)?);
        }
        let leaving = locations.iter().map(|&location| self.leaving(location)).collect();
        let modes = locations.iter().map(|&location| self.mode(location)).collect();
        let Builder { rows, initial, initial_state, ranges, known, parameters, exclusive, .. } =
            self;
        Ok(Automaton {
            rows,
            initial,
            initial_state,
            ranges,
            known,
            parameters,
            locations,
            events,
            graph,
            modes,
            leaving,
            exclusive,
        })
    }

    /// The automaton, after a look at any one state of the model, whose values do not matter:
    /// every variable that formulas name must be there.
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build), and [`BuildError::UnknownVariable`].
    pub fn build_for(self, example: &S) -> Result<Automaton<L, E, S>, BuildError> {
        self.check_variables(|name| example.value(name).is_some())?;
        self.build()
    }

    /// Finds the row of every transfer, and a transfer for every row if there are any.
    fn match_transfers(&mut self) -> Result<(), BuildError> {
        for transfer in std::mem::take(&mut self.transfers) {
            let Transfer { source, event, target, guard, reset } = transfer;
            let fits =
                |row: &Row<L, E>| (row.source, row.event, row.target) == (source, event, target);
            let row = self.rows.iter().position(fits).ok_or(BuildError::TransferWithoutRow {
                source_location: source.name(),
                event: event.name(),
                target: target.name(),
            })?;
            if self.edges.iter().any(|(given, ..)| *given == row) {
                return Err(BuildError::GivenTwice { place: event.name(), part: "transfer" });
            }
            self.edges.push((row, guard, reset));
        }
        let lacks = |number: &usize| {
            let event = self.rows[*number].event;
            !self.edges.iter().any(|(given, ..)| given == number)
                && !self.conditions.iter().any(|(given, ..)| *given == event)
        };
        match (0..self.rows.len()).find(lacks).filter(|_| !self.edges.is_empty()) {
            Some(number) => Err(BuildError::RowWithoutTransfer {
                location: self.rows[number].source.name(),
                event: self.rows[number].event.name(),
            }),
            None => Ok(()),
        }
    }

    fn check_propositions(&self, known: &[&str]) -> Result<(), BuildError> {
        let conditions = self.conditions.iter().map(|(event, guard, _)| (event.name(), guard));
        let edges = self.edges.iter();
        let edges = edges.map(|(row, guard, _)| (self.rows[*row].event.name(), guard));
        let guards = conditions.chain(edges).map(|(place, guard)| (place, guard.predicate()));
        let invariants = self.invariants.iter();
        let invariants = invariants.map(|(location, invariant)| (location.name(), invariant));
        let commands = self.commands.iter();
        let commands = commands.map(|(location, command)| (location.name(), &command.guard));
        let unknown = self.exclusive.iter().flatten().find(|name| !known.contains(&name.as_str()));
        if let Some(name) = unknown {
            let (place, proposition) = ("propositions that exclude each other", name.clone());
            return Err(BuildError::UnknownProposition { place, proposition });
        }
        for (place, predicate) in guards.chain(invariants).chain(commands) {
            if let Some(name) =
                predicate.propositions().into_iter().find(|name| !known.contains(name))
            {
                return Err(BuildError::UnknownProposition { place, proposition: name.to_owned() });
            }
        }
        Ok(())
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

    /// Adds what changes throughout to the flow of every location.
    fn spread_rates(&mut self) -> Result<(), BuildError> {
        let throughout = std::mem::take(&mut self.throughout);
        if throughout.is_empty() {
            return Ok(());
        }
        for location in self.locations() {
            let given = self.flows.iter_mut().find(|(place, _)| *place == location);
            match given {
                Some((_, flow)) => {
                    let rates =
                        flow.rates().ok_or(BuildError::NoRates { location: location.name() })?;
                    *flow = rates.iter().chain(&throughout).cloned().collect::<Vec<_>>().into();
                }
                None => self.flows.push((location, throughout.clone().into())),
            }
        }
        Ok(())
    }

    fn check_parameters(&self, names: &[&'static str]) -> Result<(), BuildError> {
        for (position, (name, value)) in self.parameters.iter().enumerate() {
            let is_taken = names.contains(&name.as_str())
                || self.parameters[..position].iter().any(|(other, _)| other == name);
            if is_taken {
                return Err(BuildError::ParameterNameTaken { parameter: name.clone() });
            }
            if !value.is_finite() {
                let (parameter, value) = (name.clone(), *value);
                return Err(BuildError::ParameterNotFinite { parameter, value });
            }
        }
        Ok(())
    }

    fn check_vocabulary(&self) -> Result<(), BuildError> {
        let (locations, events) = (self.locations(), self.events());
        listed(&locations, self.initial)?;
        for row in &self.rows {
            listed(&locations, row.source)?;
            listed(&locations, row.target)?;
            if !events.contains(&row.event) {
                return Err(BuildError::UnlistedEvent { event: format!("{:?}", row.event) });
            }
        }
        let described = self.flows.iter().map(|(location, _)| *location);
        let restricted = self.invariants.iter().map(|(location, _)| *location);
        described
            .chain(restricted)
            .try_for_each(|location| listed(&locations, location).map(|_| ()))
    }

    fn check_table(&self) -> Result<(), BuildError> {
        let has_own = |number: usize| self.edges.iter().any(|(edge, ..)| *edge == number);
        for (number, row) in self.rows.iter().enumerate() {
            let same =
                |earlier: &Row<L, E>| (earlier.source, earlier.event) == (row.source, row.event);
            let mut earlier = (0..number).filter(|&earlier| same(&self.rows[earlier]));
            if earlier.any(|earlier| !(has_own(earlier) && has_own(number))) {
                let (location, event) = (row.source.name(), row.event.name());
                return Err(BuildError::Nondeterministic { location, event });
            }
        }
        let rows = &self.rows;
        let occurs = rows.iter().any(|row| [row.source, row.target].contains(&self.initial));
        if !rows.is_empty() && !occurs {
            return Err(BuildError::InitialNotInTable { location: self.initial.name() });
        }
        Ok(())
    }

    fn check_parts(&self) -> Result<(), BuildError> {
        for (event, guard, _) in &self.conditions {
            if !self.rows.iter().any(|row| row.event == *event) {
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

    /// Whatever flows, invariants, guards, resets and ranges name is a variable, and no coordinate
    /// is given two values at once.
    fn check_variables(&self, is_known: impl Fn(&str) -> bool) -> Result<(), BuildError> {
        for part in self.formulas() {
            if let Some(unknown) = part.variables.iter().find(|name| !is_known(name)) {
                let Part { place, part, .. } = part;
                return Err(BuildError::UnknownVariable { place, part, variable: unknown.clone() });
            }
            let mut given = part.coordinates.iter().enumerate();
            if let Some((_, coordinate)) =
                given.find(|(position, name)| part.coordinates[..*position].contains(name))
            {
                let Part { place, part, .. } = part;
                return Err(BuildError::CoordinateTwice { place, part, coordinate });
            }
        }
        for (variable, range) in &self.ranges {
            let (variable, lower, upper) = (variable.clone(), *range.start(), *range.end());
            if !is_known(&variable) {
                return Err(BuildError::RangeOfUnknownVariable { variable });
            }
            let in_order = lower <= upper;
            if !in_order {
                return Err(BuildError::EmptyRange { variable, lower, upper });
            }
        }
        Ok(())
    }

    fn check_initial_state(&self, names: &[&'static str]) -> Result<(), BuildError> {
        for &variable in names {
            let value = self.initial_state.as_ref().and_then(|state| state.value(variable));
            if let Some(value) = value.filter(|value| !value.is_finite()) {
                return Err(BuildError::InitialNotFinite { variable, value });
            }
        }
        Ok(())
    }

    fn formulas(&self) -> Vec<Part> {
        let mut parts = Vec::new();
        let conditions = self.conditions.iter().map(|(event, guard, reset)| (*event, guard, reset));
        let edges =
            self.edges.iter().map(|(row, guard, reset)| (self.rows[*row].event, guard, reset));
        for (event, guard, reset) in conditions.chain(edges) {
            parts.push(Part::reading(event.name(), "guard", guard.predicate()));
            let assignments = reset.assignments().into_iter().flatten();
            let assigned = assignments.map(|one| (one.coordinate(), one.value()));
            parts.push(Part::giving(event.name(), "reset", assigned));
        }
        for (location, flow) in &self.flows {
            let rates = flow.rates().into_iter().flatten();
            let given = rates.map(|one| (one.coordinate(), one.rate()));
            parts.push(Part::giving(location.name(), "flow", given));
        }
        for (location, invariant) in &self.invariants {
            parts.push(Part::reading(location.name(), "invariant", invariant));
        }
        for (location, command) in &self.commands {
            parts.push(Part::reading(location.name(), "law", &command.guard));
        }
        parts
    }

    fn transition_of(
        &self,
        number: usize,
        row: &Row<L, E>,
    ) -> Result<Transition<E, S>, BuildError> {
        let edge = self.edges.iter().find(|(edge, ..)| *edge == number);
        let own = edge.map(|(_, guard, reset)| (guard, reset));
        let condition = self.conditions.iter().find(|(event, ..)| *event == row.event);
        let common = condition.map(|(_, guard, reset)| (guard, reset));
        let (guard, reset) =
            own.or(common).ok_or(BuildError::EventWithoutGuard { event: row.event.name() })?;
        Ok(Transition {
            event: row.event,
            guard: guard.clone(),
            watch: (self.watch)(guard.predicate()),
            reset: reset.clone(),
            urgency: row.urgency,
            priority: row.priority,
        })
    }

    /// The edges have the numbers of their rows.
    fn leaving(&self, location: L) -> Vec<EdgeIndex> {
        let rows = &self.rows;
        let mut numbers: Vec<usize> =
            (0..rows.len()).filter(|&number| rows[number].source == location).collect();
        numbers.sort_by_key(|&number| (rows[number].priority, number));
        numbers.into_iter().map(EdgeIndex::new).collect()
    }

    fn mode(&self, location: L) -> Mode<S> {
        let flow = self.flows.iter().find(|(place, _)| *place == location);
        let invariant = self.invariants.iter().find(|(place, _)| *place == location);
        let commands = self.commands.iter().filter(|(place, _)| *place == location);
        Mode {
            flow: flow.map(|(_, flow)| flow.clone()),
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
        self.exclusive.push(propositions.iter().map(|&name| name.to_owned()).collect());
        self
    }

    /// At each sample `laws` choose a value, as far as they speak of a location. Drawings and
    /// tables show them; whoever samples asks them.
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
        self.throughout.extend(rates);
        self
    }

    /// The model is meant for values of `coordinate` in `range`: checks look there, and nowhere
    /// else, for what can go wrong.
    pub fn range(mut self, coordinate: &Coordinate<S>, range: RangeInclusive<f64>) -> Self {
        self.ranges.push((coordinate.name().to_owned(), range));
        self
    }
}

/// What one formula, or one list of formulas, names.
struct Part {
    place: &'static str,
    part: &'static str,
    variables: Vec<String>,
    /// The coordinates that are given a rate or a value.
    coordinates: Vec<&'static str>,
}

impl Part {
    fn reading(place: &'static str, part: &'static str, predicate: &Predicate) -> Part {
        let variables = predicate.variables().into_iter().map(str::to_owned).collect();
        Part { place, part, variables, coordinates: Vec::new() }
    }

    fn giving<'a>(
        place: &'static str,
        part: &'static str,
        formulas: impl Iterator<Item = (&'static str, &'a Expression)>,
    ) -> Part {
        let (mut variables, mut coordinates) = (Vec::new(), Vec::new());
        for (coordinate, formula) in formulas {
            variables.push(coordinate.to_owned());
            variables.extend(formula.variables().into_iter().map(str::to_owned));
            coordinates.push(coordinate);
        }
        Part { place, part, variables, coordinates }
    }
}

fn listed<L: Location>(locations: &[L], location: L) -> Result<NodeIndex, BuildError> {
    let place = locations.iter().position(|listed| *listed == location).map(NodeIndex::new);
    place.ok_or_else(|| BuildError::UnlistedLocation { location: format!("{location:?}") })
}

/// Those that are new, in the order in which they occur first.
fn first_mentions<T: PartialEq>(mentioned: impl Iterator<Item = T>) -> Vec<T> {
    let mut new = Vec::new();
    for one in mentioned {
        if !new.contains(&one) {
            new.push(one);
        }
    }
    new
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
