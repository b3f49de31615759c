//! The parts of an automaton under construction without their types, and whether they fit together.

use std::ops::RangeInclusive;

use petgraph::graph::EdgeIndex;
use pleach_discrete::{Event, Location};
use pleach_guards::{Expression, Guard, Predicate, Valuation};

use super::{BuildError, Builder, Names};
use crate::flow::{Flow, Rate};
use crate::law::Command;
use crate::outline::{Effect, Motion, names_of};
use crate::reset::NewValue;

/// Locations and events are numbers here, in the order in which the automaton has them.
pub(super) struct Draft<'a> {
    locations: Vec<&'static str>,
    events: Vec<&'static str>,
    initial: usize,
    rows: Vec<Row>,
    /// For all rows of an event.
    conditions: Vec<Given<'a>>,
    /// For the rows with these numbers.
    edges: Vec<Given<'a>>,
    /// The rows that are carried out, and how; they become edges.
    transfers: Vec<(Row, Given<'a>)>,
    flows: Vec<(usize, Motion<'a>)>,
    invariants: Vec<(usize, &'a Predicate)>,
    commands: Vec<(usize, &'a Command)>,
    throughout: &'a [Rate],
    ranges: &'a [(String, RangeInclusive<f64>)],
    parameters: &'a [(String, f64)],
    exclusive: Vec<Vec<&'a str>>,
    known: Option<&'a [&'static str]>,
    observed: Option<Names>,
    initial_state: Option<&'a dyn Valuation>,
}

/// A row of the table.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Row {
    source: usize,
    event: usize,
    target: usize,
    priority: u8,
}

/// When a row, or each row of an event, may be taken, and what it does.
#[derive(Clone, Copy)]
struct Given<'a> {
    number: usize,
    guard: &'a Guard,
    effect: Effect<'a>,
}

/// Where guard and reset of a row are given.
#[derive(Clone, Copy)]
pub(super) enum Origin {
    Condition(usize),
    Edge(usize),
    Transfer(usize),
}

impl<L: Location, E: Event, S: Valuation> Builder<L, E, S> {
    /// The parts with these locations and events for numbers.
    ///
    /// # Errors
    ///
    /// [`BuildError`] where a location or an event is not among them.
    pub(super) fn draft(&self, locations: &[L], events: &[E]) -> Result<Draft<'_>, BuildError> {
        let location = |one: L| {
            let place = locations.iter().position(|listed| *listed == one);
            place.ok_or_else(|| BuildError::UnlistedLocation { location: format!("{one:?}") })
        };
        let event = |one: E| {
            let place = events.iter().position(|listed| *listed == one);
            place.ok_or_else(|| BuildError::UnlistedEvent { event: format!("{one:?}") })
        };
        let row = |source: L, taken: E, target: L, priority: u8| -> Result<Row, BuildError> {
            let (source, target) = (location(source)?, location(target)?);
            Ok(Row { source, event: event(taken)?, target, priority })
        };
        let mut draft = Draft {
            locations: names_of(locations, L::name),
            events: names_of(events, E::name),
            initial: location(self.initial)?,
            rows: Vec::with_capacity(self.rows.len()),
            conditions: Vec::with_capacity(self.conditions.len()),
            edges: Vec::with_capacity(self.edges.len()),
            transfers: Vec::with_capacity(self.transfers.len()),
            flows: Vec::with_capacity(self.flows.len()),
            invariants: Vec::with_capacity(self.invariants.len()),
            commands: Vec::with_capacity(self.commands.len()),
            throughout: &self.throughout,
            ranges: &self.ranges,
            parameters: &self.parameters,
            exclusive: self.exclusion.names(),
            known: self.known.as_deref(),
            observed: self.observed,
            initial_state: self.initial_state.as_ref().map(|state| state as &dyn Valuation),
        };
        for one in &self.rows {
            draft.rows.push(row(one.source, one.event, one.target, one.priority)?);
        }
        for (place, flow) in &self.flows {
            draft.flows.push((location(*place)?, Flow::outline(flow)));
        }
        for (place, invariant) in &self.invariants {
            draft.invariants.push((location(*place)?, invariant));
        }
        for (place, command) in &self.commands {
            draft.commands.push((location(*place)?, command));
        }
        for (number, guard, reset) in &self.edges {
            draft.edges.push(Given { number: *number, guard, effect: reset.outline() });
        }
        for (taken, guard, reset) in &self.conditions {
            let Some(number) = events.iter().position(|listed| listed == taken) else {
                return Err(without_row(guard, taken.name()));
            };
            draft.conditions.push(Given { number, guard, effect: reset.outline() });
        }
        for one in &self.transfers {
            let (source, event, target) = (one.source, one.event, one.target);
            let Ok(row) = row(source, event, target, 0) else {
                return Err(BuildError::TransferWithoutRow {
                    source_location: source.name(),
                    event: event.name(),
                    target: target.name(),
                });
            };
            let (guard, effect) = (&one.guard, one.reset.outline());
            draft.transfers.push((row, Given { number: 0, guard, effect }));
        }
        Ok(draft)
    }
}

fn without_row(guard: &Guard, event: &'static str) -> BuildError {
    BuildError::GuardWithoutRow { guard: guard.name().to_owned(), event }
}

impl<'a> Draft<'a> {
    /// Whether all parts fit together.
    ///
    /// # Errors
    ///
    /// The first [`BuildError`] found: in the table, the guards, then in what is said about the
    /// locations.
    pub(super) fn check(&mut self) -> Result<(), BuildError> {
        self.check_table()?;
        self.match_transfers()?;
        self.check_parts()?;
        self.check_intervals()?;
        self.check_rates()?;
        if let Some(names) = self.known {
            let is_parameter = |name: &str| self.parameters.iter().any(|(known, _)| known == name);
            self.check_parameters(names)?;
            self.check_variables(&|name| names.contains(&name) || is_parameter(name))?;
            self.check_initial_state(names)?;
            if let Some(state) = self.initial_state {
                self.check_propositions(&|name| state.truth(name).is_some())?;
            }
        }
        if let Some((variables, propositions)) = self.observed {
            self.check_variables(&|name| variables.contains(&name))?;
            self.check_propositions(&|name| propositions.contains(&name))?;
        }
        Ok(())
    }

    fn check_table(&self) -> Result<(), BuildError> {
        let has_own = |number: usize| self.edges.iter().any(|edge| edge.number == number);
        for (number, row) in self.rows.iter().enumerate() {
            let same = |earlier: &Row| (earlier.source, earlier.event) == (row.source, row.event);
            let mut earlier = (0..number).filter(|&earlier| same(&self.rows[earlier]));
            if earlier.any(|earlier| !(has_own(earlier) && has_own(number))) {
                let (location, event) = (self.locations[row.source], self.events[row.event]);
                return Err(BuildError::Nondeterministic { location, event });
            }
        }
        let occurs = self.rows.iter().any(|row| [row.source, row.target].contains(&self.initial));
        if !self.rows.is_empty() && !occurs {
            return Err(BuildError::InitialNotInTable { location: self.locations[self.initial] });
        }
        Ok(())
    }

    /// Finds the row of every transfer, and a transfer for every row if there are any.
    fn match_transfers(&mut self) -> Result<(), BuildError> {
        for number in 0..self.transfers.len() {
            let Row { source, event, target, .. } = self.transfers[number].0;
            let fits = |row: &Row| (row.source, row.event, row.target) == (source, event, target);
            let row = self.rows.iter().position(fits).ok_or(BuildError::TransferWithoutRow {
                source_location: self.locations[source],
                event: self.events[event],
                target: self.locations[target],
            })?;
            let earlier = self.transfers[..number].iter().map(|(_, given)| given);
            if self.edges.iter().chain(earlier).any(|given| given.number == row) {
                return Err(BuildError::GivenTwice { place: self.events[event], part: "transfer" });
            }
            self.transfers[number].1.number = row;
        }
        let lacks = |number: &usize| self.origin(*number).is_none();
        let are_given = !(self.edges.is_empty() && self.transfers.is_empty());
        match (0..self.rows.len()).find(lacks).filter(|_| are_given) {
            Some(number) => Err(BuildError::RowWithoutTransfer {
                location: self.locations[self.rows[number].source],
                event: self.events[self.rows[number].event],
            }),
            None => Ok(()),
        }
    }

    fn check_parts(&self) -> Result<(), BuildError> {
        for condition in &self.conditions {
            if !self.rows.iter().any(|row| row.event == condition.number) {
                return Err(without_row(condition.guard, self.events[condition.number]));
            }
        }
        let events = self.conditions.iter().map(|condition| condition.number);
        let described = self.flows.iter().map(|(location, _)| *location);
        let restricted = self.invariants.iter().map(|(location, _)| *location);
        once(events, "guard", &self.events)?;
        once(described, "flow", &self.locations)?;
        once(restricted, "invariant", &self.locations)
    }

    /// Intervals between two numbers hold some; of others this is known when they are used.
    fn check_intervals(&self) -> Result<(), BuildError> {
        for (event, Given { effect, .. }) in self.given() {
            for one in effect.assignments().into_iter().flatten() {
                let NewValue::Within(Expression::Constant(lower), Expression::Constant(upper)) =
                    one.value()
                else {
                    continue;
                };
                let (lower, upper, coordinate) = (*lower, *upper, one.coordinate());
                if !(lower <= upper && lower.is_finite() && upper.is_finite()) {
                    return Err(BuildError::EmptyInterval { event, coordinate, lower, upper });
                }
            }
        }
        Ok(())
    }

    /// What changes throughout can be added to every flow.
    fn check_rates(&self) -> Result<(), BuildError> {
        let function = self.flows.iter().find(|(_, flow)| flow.rates().is_none());
        match function.filter(|_| !self.throughout.is_empty()) {
            Some((location, _)) => Err(BuildError::NoRates { location: self.locations[*location] }),
            None => Ok(()),
        }
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

    /// Whatever flows, invariants, guards, resets and ranges name is a variable, and no coordinate
    /// is given two values at once.
    pub(super) fn check_variables(
        &self,
        is_known: &dyn Fn(&str) -> bool,
    ) -> Result<(), BuildError> {
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
        for (variable, range) in self.ranges {
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
            let value = self.initial_state.and_then(|state| state.value(variable));
            if let Some(value) = value.filter(|value| !value.is_finite()) {
                return Err(BuildError::InitialNotFinite { variable, value });
            }
        }
        Ok(())
    }

    fn check_propositions(&self, is_known: &dyn Fn(&str) -> bool) -> Result<(), BuildError> {
        let guards = self.given().map(|(event, given)| (event, given.guard.predicate()));
        let invariants = self.invariants.iter();
        let invariants = invariants.map(|(location, one)| (self.locations[*location], *one));
        let commands = self.commands.iter();
        let commands = commands.map(|(location, one)| (self.locations[*location], &one.guard));
        let unknown = self.exclusive.iter().flatten().find(|name| !is_known(name));
        if let Some(&name) = unknown {
            let (place, proposition) = ("propositions that exclude each other", name.to_owned());
            return Err(BuildError::UnknownProposition { place, proposition });
        }
        for (place, predicate) in guards.chain(invariants).chain(commands) {
            if let Some(name) = predicate.propositions().into_iter().find(|name| !is_known(name)) {
                return Err(BuildError::UnknownProposition { place, proposition: name.to_owned() });
            }
        }
        Ok(())
    }

    /// Guards and resets, each with its event.
    fn given(&self) -> impl Iterator<Item = (&'static str, Given<'a>)> {
        let of_row = |given: &Given<'a>| (self.events[self.rows[given.number].event], *given);
        let conditions = self.conditions.iter().map(|given| (self.events[given.number], *given));
        let transfers = self.transfers.iter().map(|(_, given)| given);
        conditions.chain(self.edges.iter().chain(transfers).map(of_row))
    }

    fn formulas(&self) -> Vec<Part> {
        let mut parts = Vec::new();
        for (event, Given { guard, effect, .. }) in self.given() {
            parts.push(Part::reading(event, "guard", guard.predicate()));
            let assignments = effect.assignments().into_iter().flatten();
            let assigned = assignments.map(|one| (one.coordinate(), one.value().formulas()));
            parts.push(Part::giving(event, "reset", assigned));
        }
        for (location, name) in self.locations.iter().enumerate() {
            let rates = self.rates(location).unwrap_or_default();
            let given = rates.iter().map(|one| (one.coordinate(), std::iter::once(one.rate())));
            parts.push(Part::giving(name, "flow", given));
        }
        for (location, invariant) in &self.invariants {
            parts.push(Part::reading(self.locations[*location], "invariant", invariant));
        }
        for (location, command) in &self.commands {
            parts.push(Part::reading(self.locations[*location], "law", &command.guard));
        }
        parts
    }

    /// How the coordinates change in a location, with what changes throughout; none if nothing is
    /// said, or by a function.
    pub(super) fn rates(&self, location: usize) -> Option<Vec<Rate>> {
        let flow = self.flows.iter().find(|(place, _)| *place == location);
        let own = match flow {
            Some((_, flow)) => flow.rates()?,
            None if self.throughout.is_empty() => return None,
            None => &[],
        };
        Some(own.iter().chain(self.throughout).cloned().collect())
    }

    /// The locations that a row leads from and to.
    pub(super) fn ends(&self, number: usize) -> [usize; 2] {
        [self.rows[number].source, self.rows[number].target]
    }

    /// Where guard and reset of a row are given: for itself, or for its event.
    pub(super) fn origin(&self, number: usize) -> Option<Origin> {
        let is_of_row = |given: &Given<'_>| given.number == number;
        let is_of_event = |given: &Given<'_>| given.number == self.rows[number].event;
        let edge = || self.edges.iter().position(is_of_row).map(Origin::Edge);
        let transfers = || self.transfers.iter().position(|(_, given)| is_of_row(given));
        let condition = || self.conditions.iter().position(is_of_event).map(Origin::Condition);
        edge().or_else(|| transfers().map(Origin::Transfer)).or_else(condition)
    }

    /// The rows that leave a location, in their total order; edges have the numbers of their rows.
    pub(super) fn leaving(&self, location: usize) -> Vec<EdgeIndex> {
        let rows = &self.rows;
        let mut numbers: Vec<usize> =
            (0..rows.len()).filter(|&number| rows[number].source == location).collect();
        numbers.sort_by_key(|&number| (rows[number].priority, number));
        numbers.into_iter().map(EdgeIndex::new).collect()
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
        given: impl Iterator<Item = (&'static str, impl Iterator<Item = &'a Expression>)>,
    ) -> Part {
        let (mut variables, mut coordinates) = (Vec::new(), Vec::new());
        for (coordinate, formulas) in given {
            variables.push(coordinate.to_owned());
            let named = formulas.flat_map(Expression::variables);
            variables.extend(named.map(str::to_owned));
            coordinates.push(coordinate);
        }
        Part { place, part, variables, coordinates }
    }
}

fn once(
    places: impl Iterator<Item = usize>,
    part: &'static str,
    names: &[&'static str],
) -> Result<(), BuildError> {
    let mut seen = Vec::new();
    for place in places {
        if seen.contains(&place) {
            return Err(BuildError::GivenTwice { place: names[place], part });
        }
        seen.push(place);
    }
    Ok(())
}
