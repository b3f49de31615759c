//! Whether the parts of an automaton fit together.

use pleach_discrete::{Event, Location, Row};
use pleach_guards::{Expression, Predicate, Valuation};

use super::{BuildError, Builder, listed};
use crate::reset::NewValue;

impl<L: Location, E: Event, S: Valuation> Builder<L, E, S> {
    pub(super) fn check_parameters(&self, names: &[&'static str]) -> Result<(), BuildError> {
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

    pub(super) fn check_vocabulary(&self) -> Result<(), BuildError> {
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

    pub(super) fn check_table(&self) -> Result<(), BuildError> {
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

    pub(super) fn check_parts(&self) -> Result<(), BuildError> {
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
    pub(super) fn check_variables(
        &self,
        is_known: impl Fn(&str) -> bool,
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

    /// Intervals between two numbers hold some; of others this is known when they are used.
    pub(super) fn check_intervals(&self) -> Result<(), BuildError> {
        let conditions = self.conditions.iter().map(|(event, _, reset)| (event.name(), reset));
        let edges = self.edges.iter().map(|(row, _, reset)| (self.rows[*row].event.name(), reset));
        for (event, reset) in conditions.chain(edges) {
            for one in reset.assignments().into_iter().flatten() {
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

    pub(super) fn check_initial_state(&self, names: &[&'static str]) -> Result<(), BuildError> {
        for &variable in names {
            let value = self.initial_state.as_ref().and_then(|state| state.value(variable));
            if let Some(value) = value.filter(|value| !value.is_finite()) {
                return Err(BuildError::InitialNotFinite { variable, value });
            }
        }
        Ok(())
    }

    pub(super) fn check_propositions(&self, known: &[&str]) -> Result<(), BuildError> {
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

    fn formulas(&self) -> Vec<Part> {
        let mut parts = Vec::new();
        let conditions = self.conditions.iter().map(|(event, guard, reset)| (*event, guard, reset));
        let edges =
            self.edges.iter().map(|(row, guard, reset)| (self.rows[*row].event, guard, reset));
        for (event, guard, reset) in conditions.chain(edges) {
            parts.push(Part::reading(event.name(), "guard", guard.predicate()));
            let assignments = reset.assignments().into_iter().flatten();
            let assigned = assignments.map(|one| (one.coordinate(), one.value().formulas()));
            parts.push(Part::giving(event.name(), "reset", assigned));
        }
        for (location, flow) in &self.flows {
            let rates = flow.rates().into_iter().flatten();
            let given = rates.map(|one| (one.coordinate(), std::iter::once(one.rate())));
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
