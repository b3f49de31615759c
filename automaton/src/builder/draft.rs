//! Whether the parts of an automaton fit together.

use petgraph::graph::{EdgeIndex, NodeIndex};
use pleach_discrete::{Row, first_mentions};
use pleach_guards::{Expression, Predicate, Valuation};

use super::BuildError;
use super::parts::{Given, Parts};
use crate::composition::Sampling;
use crate::flow::Rate;
use crate::law::Command;
use crate::lists::{mapped, place_of};
use crate::named::kept;
use crate::reset::NewValue;

/// The parts, with the names that the types give to locations and events.
pub(super) struct Draft<'a> {
    parts: &'a Parts,
    /// The names of locations and events, by number.
    locations: Vec<&'static str>,
    events: Vec<&'static str>,
    /// The numbers of those that the automaton has, in its order.
    pub(super) location_order: Vec<usize>,
    pub(super) event_order: Vec<usize>,
    /// For the rows with these numbers: edges, and transfers once their rows are found.
    edges: Vec<(usize, &'a Given)>,
    exclusive: Vec<Vec<&'a str>>,
    initial_state: Option<&'a dyn Valuation>,
}

/// Locations or events without their type.
pub(super) struct Vocabulary<'a> {
    /// By number.
    pub(super) names: Vec<&'static str>,
    /// How many the type lists: the first.
    pub(super) listed: usize,
    /// Whether others may be mentioned.
    pub(super) is_open: bool,
    /// The one with a number, as `Debug` prints it.
    pub(super) debug: &'a dyn Fn(usize) -> String,
}

/// What is said of a location.
pub(super) struct Said<'a> {
    /// How the coordinates change, with what changes throughout; none if nothing is said of it, or if its flow is a
    /// function.
    pub(super) rates: Option<Vec<Rate>>,
    /// The number of the flow.
    pub(super) flow: Option<usize>,
    pub(super) invariant: Option<&'a Predicate>,
    pub(super) commands: Vec<Command>,
}

impl Vocabulary<'_> {
    /// The numbers of those that an automaton has: all that are listed, and in an open vocabulary
    /// those that are mentioned.
    fn order(&self, mentioned: impl Iterator<Item = usize>) -> Vec<usize> {
        let listed = 0..self.listed;
        if self.is_open { first_mentions(listed.chain(mentioned)) } else { listed.collect() }
    }
}

impl<'a> Draft<'a> {
    /// The draft of these parts.
    ///
    /// # Errors
    ///
    /// [`BuildError`] where a location or an event is not in its vocabulary.
    pub(super) fn of(
        parts: &'a Parts,
        locations: Vocabulary<'_>,
        events: Vocabulary<'_>,
        exclusive: Vec<Vec<&'a str>>,
        initial_state: Option<&'a dyn Valuation>,
    ) -> Result<Self, BuildError> {
        let mentioned = [parts.initial].into_iter().chain(parts.connected());
        let mentioned = mentioned.chain(parts.described()).chain(parts.restricted());
        let location_order = locations.order(mentioned);
        let event_order = events.order(parts.rows.iter().map(|row| row.event));
        let location = |number: usize| match location_order.contains(&number) {
            true => Ok(()),
            false => Err(BuildError::UnlistedLocation { location: (locations.debug)(number) }),
        };
        let event = |number: usize| match event_order.contains(&number) {
            true => Ok(()),
            false => Err(BuildError::UnlistedEvent { event: (events.debug)(number) }),
        };
        location(parts.initial)?;
        for row in &parts.rows {
            location(row.source)?;
            location(row.target)?;
            event(row.event)?;
        }
        let commanded = parts.commands.iter().map(|(location, _)| *location);
        for number in parts.described().chain(parts.restricted()).chain(commanded) {
            location(number)?;
        }
        Ok(Draft {
            parts,
            locations: locations.names,
            events: events.names,
            location_order,
            event_order,
            edges: parts.edges.iter().map(|(row, given)| (*row, given)).collect(),
            exclusive,
            initial_state,
        })
    }

    /// Whether no name stands for two things.
    ///
    /// # Errors
    ///
    /// The first parameter or signal with the name of another number.
    pub(super) fn check_names(&self) -> Result<(), BuildError> {
        let names = self.parts.known.as_deref().unwrap_or_default();
        self.check_parameters(names)?;
        self.check_signals(names)
    }

    /// Whether all parts fit together, with formulas in the place of signals.
    ///
    /// # Errors
    ///
    /// The first [`BuildError`] found: in the table, the guards, then in what is said about the
    /// locations.
    pub(super) fn check(&mut self) -> Result<(), BuildError> {
        self.check_superstates()?;
        self.check_table()?;
        self.match_transfers()?;
        self.check_parts()?;
        self.check_intervals()?;
        self.check_rates()?;
        let Parts { known, observed, parameters, .. } = self.parts;
        if let Some(names) = known {
            let is_parameter = |name: &str| parameters.iter().any(|(known, _)| known == name);
            self.check_variables(&|name| names.contains(&name) || is_parameter(name))?;
            self.check_initial_state(names)?;
            if let Some(state) = self.initial_state {
                self.check_propositions(&|name| state.truth(name).is_some())?;
            }
        }
        if let Some((variables, propositions)) = observed {
            self.check_variables(&|name| variables.contains(&name))?;
            self.check_propositions(&|name| propositions.contains(&name))?;
        }
        Ok(())
    }

    fn check_table(&self) -> Result<(), BuildError> {
        let Parts { rows, initial, .. } = self.parts;
        let has_own = |number: usize| self.edges.iter().any(|(edge, _)| *edge == number);
        let leaves = |row: &Row<usize, usize>| (row.source, row.event);
        for (number, row) in rows.iter().enumerate() {
            let mut earlier = (0..number).filter(|&earlier| leaves(&rows[earlier]) == leaves(row));
            if earlier.any(|earlier| !(has_own(earlier) && has_own(number))) {
                let (location, event) = (self.locations[row.source], self.events[row.event]);
                return Err(BuildError::Nondeterministic { location, event });
            }
        }
        if !rows.is_empty() && !self.parts.connected().any(|location| location == *initial) {
            return Err(BuildError::InitialNotInTable { location: self.locations[*initial] });
        }
        Ok(())
    }

    /// Superstates have names of their own and locations, each once, and of two that share locations one contains the other.
    fn check_superstates(&self) -> Result<(), BuildError> {
        for (number, (name, members)) in self.parts.superstates.iter().enumerate() {
            let earlier = &self.parts.superstates[..number];
            let is_taken = self.locations.contains(name) || earlier.iter().any(|it| it.0 == *name);
            if is_taken {
                return Err(BuildError::SuperstateNameTaken { superstate: name });
            }
            if members.is_empty() {
                return Err(BuildError::EmptySuperstate { superstate: name });
            }
            let mut later = members.iter().enumerate();
            if let Some((_, member)) = later.find(|(at, member)| members[..*at].contains(member)) {
                let location = self.locations[*member];
                return Err(BuildError::RepeatedMember { superstate: name, location });
            }
            let includes =
                |some: &[usize], others: &[usize]| others.iter().all(|it| some.contains(it));
            let overlaps = |(_, other): &&(_, Vec<usize>)| {
                members.iter().any(|member| other.contains(member))
                    && !includes(members, other)
                    && !includes(other, members)
            };
            if let Some((other, _)) = earlier.iter().find(overlaps) {
                return Err(BuildError::SuperstatesOverlap { superstates: [other, name] });
            }
        }
        Ok(())
    }

    /// By name the nodes of the locations of each superstate, those with more of them first.
    pub(super) fn superstates(&self) -> Vec<(&'static str, Vec<usize>)> {
        let place =
            |&location: &usize| place_of(&self.location_order, location).unwrap_or_default();
        let mut superstates: Vec<(&'static str, Vec<usize>)> =
            mapped(&self.parts.superstates, |it| {
                let (name, members) = it;
                (*name, mapped(members, place))
            });
        superstates.sort_by_key(|(_, members)| std::cmp::Reverse(members.len()));
        superstates
    }

    /// Finds the row of every transfer; and, if there are any, a transfer for every row and a row for every location.
    fn match_transfers(&mut self) -> Result<(), BuildError> {
        let Parts { rows, transfers, .. } = self.parts;
        for (ends @ [source, event, target], given) in transfers {
            let fits = |row: &Row<_, _>| [row.source, row.event, row.target] == *ends;
            let row = rows.iter().position(fits).ok_or(BuildError::TransferWithoutRow {
                source_location: self.locations[*source],
                event: self.events[*event],
                target: self.locations[*target],
            })?;
            if self.edges.iter().any(|(edge, _)| *edge == row) {
                return Err(BuildError::GivenTwice {
                    place: self.events[*event],
                    part: "transfer",
                });
            }
            self.edges.push((row, given));
        }
        let mut locations = self.location_order.iter().filter(|_| !transfers.is_empty());
        let is_in_row = |number: usize| self.parts.connected().any(|location| location == number);
        if let Some(&number) = locations.find(|number| !is_in_row(**number)) {
            return Err(BuildError::LocationWithoutRow { location: self.locations[number] });
        }
        let lacks = |number: &usize| self.given_for(*number).is_err();
        match (0..rows.len()).find(lacks).filter(|_| !self.edges.is_empty()) {
            Some(number) => Err(BuildError::RowWithoutTransfer {
                location: self.locations[rows[number].source],
                event: self.events[rows[number].event],
            }),
            None => Ok(()),
        }
    }

    fn check_parts(&self) -> Result<(), BuildError> {
        for (event, Given { guard, .. }) in &self.parts.conditions {
            if !self.parts.rows.iter().any(|row| row.event == *event) {
                let (guard, event) = (guard.name().to_owned(), self.events[*event]);
                return Err(BuildError::GuardWithoutRow { guard, event });
            }
        }
        let is_row = |event: usize| self.parts.rows.iter().any(|row| row.event == event);
        if let Some((event, _)) = self.parts.samplings.iter().find(|(event, _)| !is_row(*event)) {
            return Err(BuildError::SampledWithoutRow { event: self.events[*event] });
        }
        let fault = |(event, sampling): &(usize, Sampling)| Some((*event, sampling.fault()?));
        if let Some((event, reason)) = self.parts.samplings.iter().find_map(fault) {
            return Err(BuildError::Sampling { event: self.events[event], reason });
        }
        once(self.parts.samplings.iter().map(|(event, _)| *event), "samples", &self.events)?;
        once(self.parts.conditions.iter().map(|(event, _)| *event), "guard", &self.events)?;
        once(self.parts.described(), "flow", &self.locations)?;
        once(self.parts.restricted(), "invariant", &self.locations)
    }

    /// Intervals between two numbers hold some; of others this is known when they are used.
    fn check_intervals(&self) -> Result<(), BuildError> {
        for (event, given) in self.given() {
            for one in given.assignments.iter() {
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
        let Parts { flows, throughout, .. } = self.parts;
        let function = flows.iter().find(|(_, rates)| rates.is_none());
        match function.filter(|_| !throughout.is_empty()) {
            Some((location, _)) => Err(BuildError::NoRates { location: self.locations[*location] }),
            None => Ok(()),
        }
    }

    fn check_parameters(&self, names: &[&'static str]) -> Result<(), BuildError> {
        let Parts { parameters, .. } = self.parts;
        for (position, (name, value)) in parameters.iter().enumerate() {
            let is_taken = names.contains(&name.as_str())
                || parameters[..position].iter().any(|(other, _)| other == name);
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

    fn check_signals(&self, names: &[&'static str]) -> Result<(), BuildError> {
        let Parts { parameters, signals, .. } = self.parts;
        for (position, (name, _)) in signals.iter().enumerate() {
            let is_taken = names.contains(&name.as_str())
                || parameters.iter().any(|(other, _)| other == name)
                || signals[..position].iter().any(|(other, _)| other == name);
            if is_taken {
                return Err(BuildError::SignalNameTaken { signal: name.clone() });
            }
        }
        Ok(())
    }

    /// Whatever signals, flows, invariants, guards, resets and ranges name is a variable, and no coordinate
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
        for (variable, range) in &self.parts.ranges {
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
        let invariants = self.parts.invariants.iter();
        let invariants = invariants.map(|(location, one)| (self.locations[*location], one));
        let commands = self.parts.commands.iter();
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
    fn given(&self) -> impl Iterator<Item = (&'static str, &'a Given)> {
        let Parts { rows, conditions, edges, transfers, .. } = self.parts;
        let conditions = conditions.iter().map(|(event, given)| (*event, given));
        let edges = edges.iter().map(|(row, given)| (rows[*row].event, given));
        let transfers = transfers.iter().map(|([_, event, _], given)| (*event, given));
        let given = conditions.chain(edges).chain(transfers);
        given.map(|(event, given)| (self.events[event], given))
    }

    fn formulas(&self) -> Vec<Part> {
        let mut parts = Vec::new();
        for (name, formula) in &self.parts.signals {
            let variables = formula.variables().into_iter().map(str::to_owned).collect();
            parts.push(Part {
                place: kept(name),
                part: "formula",
                variables,
                coordinates: Vec::new(),
            });
        }
        for (event, given) in self.given() {
            parts.push(Part::reading(event, "guard", given.guard.predicate()));
            let assignments = given.assignments.iter();
            let assigned = assignments.map(|one| (one.coordinate(), one.value().formulas()));
            parts.push(Part::giving(event, "reset", assigned));
        }
        for &location in &self.location_order {
            let rates = self.rates(location).unwrap_or_default();
            let given = rates.iter().map(|one| (one.coordinate(), std::iter::once(one.rate())));
            parts.push(Part::giving(self.locations[location], "flow", given));
        }
        for (location, invariant) in &self.parts.invariants {
            parts.push(Part::reading(self.locations[*location], "invariant", invariant));
        }
        for (location, command) in &self.parts.commands {
            parts.push(Part::reading(self.locations[*location], "law", &command.guard));
        }
        parts
    }

    /// How the coordinates change in a location, with what changes throughout; none if nothing is
    /// said, or by a function.
    fn rates(&self, location: usize) -> Option<Vec<Rate>> {
        let Parts { flows, throughout, .. } = self.parts;
        let own = match flows.iter().find(|(place, _)| *place == location) {
            Some((_, rates)) => rates.as_deref()?,
            None if throughout.is_empty() => return None,
            None => &[],
        };
        Some(own.iter().chain(throughout).cloned().collect())
    }

    /// When a row may be taken, and what it does: given for itself, or for its event.
    ///
    /// # Errors
    ///
    /// [`BuildError::EventWithoutGuard`] if it is given for neither.
    pub(super) fn given_for(&self, number: usize) -> Result<&'a Given, BuildError> {
        let Row { event, .. } = self.parts.rows[number];
        let of_row = self.edges.iter().find(|(row, _)| *row == number).map(|(_, given)| *given);
        let mut conditions = self.parts.conditions.iter();
        let of_event = || conditions.find(|(taken, _)| *taken == event).map(|(_, given)| given);
        let without_guard = BuildError::EventWithoutGuard { event: self.events[event] };
        of_row.or_else(of_event).ok_or(without_guard)
    }

    /// What is said of a location.
    pub(super) fn said(&self, location: usize) -> Said<'a> {
        let Parts { invariants, commands, .. } = self.parts;
        let invariant = invariants.iter().find(|(place, _)| *place == location);
        let commands = commands.iter().filter(|(place, _)| *place == location);
        Said {
            rates: self.rates(location),
            flow: self.parts.described().position(|place| place == location),
            invariant: invariant.map(|(_, invariant)| invariant),
            commands: commands.map(|(_, command)| command.clone()).collect(),
        }
    }

    /// By location the rows that leave it, in their total order; edges have the numbers of their
    /// rows.
    pub(super) fn leaving(&self) -> Vec<Vec<EdgeIndex>> {
        let Parts { rows, .. } = self.parts;
        let leaving = |&location: &usize| {
            let mut numbers: Vec<usize> =
                (0..rows.len()).filter(|&number| rows[number].source == location).collect();
            numbers.sort_by_key(|&number| (rows[number].priority, number));
            numbers.into_iter().map(EdgeIndex::new).collect()
        };
        self.location_order.iter().map(leaving).collect()
    }

    /// The nodes of the locations that a row leads from and to.
    pub(super) fn ends(&self, number: usize) -> [NodeIndex; 2] {
        let Row { source, target, .. } = self.parts.rows[number];
        // Every location of a row has a place.
        let place = |location| place_of(&self.location_order, location).unwrap_or_default();
        [source, target].map(|location| NodeIndex::new(place(location)))
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
