//! The locations of a product.

use std::collections::BTreeMap;

use super::clause::predicate;
use super::{Product, Result};
use crate::automaton::{Builder, Coordinate, Name, Rate, Record};
use crate::guards::{Expression, Predicate};
use crate::spaceex::SpaceExError;
use crate::spaceex::formula::{Clause, Side};

/// Whether both sides are the same.
fn is_identity(clause: &Clause) -> bool {
    matches!(clause, Clause::Compare { left, right, .. } if left == right)
}

impl Product<'_> {
    /// Adds a location with the rates and invariants of its parts.
    pub(super) fn add_location(
        &self,
        mut builder: Builder<Name, Name, Record>,
        location: usize,
        coordinates: &BTreeMap<String, Coordinate<Record>>,
    ) -> Result<Builder<Name, Name, Record>> {
        let (mut rates, mut invariant): (Option<BTreeMap<String, Expression>>, Vec<Predicate>) =
            (Some(BTreeMap::new()), Vec::new());
        let (name, mut line) = (self.names[location], self.line);
        for (instance, place) in self.network.instances.iter().zip(&self.tuples[location]) {
            let place = &instance.component.locations[*place];
            line = place.line;
            match (instance.rates(place)?, &mut rates) {
                (Some(listed), Some(rates)) => {
                    for (variable, rate) in listed {
                        if let Some(known) = rates.insert(variable.clone(), rate.clone())
                            && known != rate
                        {
                            let problem =
                                format!("two components give different rates of `{variable}`");
                            return Err(SpaceExError::Model { line, problem });
                        }
                    }
                }
                _ => rates = None,
            }
            for clause in instance.clauses(&place.invariant)? {
                // Bounds on inputs say what inputs are, and outputs are what they are.
                if !self.is_input_bound(&clause) && !is_identity(&clause) {
                    let wrong =
                        |problem| SpaceExError::Model { line: place.invariant.line, problem };
                    invariant.extend(predicate(&clause).map_err(wrong)?);
                }
            }
        }
        let shares = self.of_shares(location);
        let mut listed: Vec<Rate<Record>> = Vec::new();
        for (variable, coordinate) in coordinates {
            match &rates {
                None => {}
                Some(rates) => match rates.get(variable) {
                    Some(rate) => listed.push(coordinate.rate(rate.substitute(&shares))),
                    None => {
                        return Err(SpaceExError::Model {
                            line,
                            problem: format!(
                                "location `{name}` says nothing of `{variable}'`: write `{variable}' == 0` if it rests"
                            ),
                        });
                    }
                },
            }
        }
        builder = builder.flow(name, listed);
        if !invariant.is_empty() {
            let invariant = Predicate::all(invariant).substitute(&shares);
            builder = builder.invariant(name, invariant);
        }
        Ok(builder)
    }

    /// A bound on an input alone.
    pub(super) fn is_input_bound(&self, clause: &Clause) -> bool {
        let Clause::Compare { left, right, .. } = clause else { return false };
        let is_input = |side: &Side| side.name().is_some_and(|name| self.is_input(name));
        let is_number =
            |side: &Side| matches!(side, Side::Formula(formula) if formula.evaluate(&()).is_ok());
        is_input(left) && is_number(right) || is_input(right) && is_number(left)
    }
}
