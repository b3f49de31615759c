//! Outputs: numbers without a flow, of which the invariants of all locations say what they are.
//!
//! `y == x1 + 2*x2` makes `y` a name of the formula, wherever it stands.

use std::collections::BTreeMap;

use super::{Bound, Instance, Network};
use crate::guards::{Expression, Substitution};
use crate::spaceex::SpaceExError;
use crate::spaceex::document::Location;
use crate::spaceex::formula::{Clause, Relation, Side};

type Result<T> = std::result::Result<T, SpaceExError>;

/// Puts formulas in the place of outputs.
pub(super) fn resolve(network: &mut Network<'_>) -> Result<()> {
    let mut formulas: BTreeMap<String, Expression> = BTreeMap::new();
    for name in free_names(network)? {
        if let Some(formula) = formula_of(network, &name)? {
            formulas.insert(name, formula);
        }
    }
    // One output may be a formula of others. One that comes back to itself is none.
    for _ in 0..formulas.len() {
        let substitution = Substitution::new(formulas.clone());
        for formula in formulas.values_mut() {
            *formula = formula.substitute(&substitution);
        }
        let outputs: Vec<String> = formulas.keys().cloned().collect();
        let is_done = |formula: &Expression| {
            !formula.variables().into_iter().any(|name| outputs.iter().any(|one| one == name))
        };
        if formulas.values().all(is_done) {
            break;
        }
    }
    let outputs: Vec<String> = formulas.keys().cloned().collect();
    formulas.retain(|_, formula| !outputs.iter().any(|one| formula.variables().contains(&**one)));
    let resolve = |bound: &mut Bound| {
        if let Bound::Name(name) = bound
            && let Some(formula) = formulas.get(name)
        {
            *bound = Bound::Formula(formula.clone());
        }
    };
    let of_instances = network.instances.iter_mut().flat_map(|one| one.names.values_mut());
    of_instances.chain(network.inner.values_mut()).for_each(resolve);
    network.known.retain(|name, _| !formulas.contains_key(name));
    let named = formulas.iter().map(|(name, it)| (name.clone(), Bound::Formula(it.clone())));
    network.inner.extend(named);
    network.outputs = formulas;
    Ok(())
}

/// The numbers that no flow and no assignment changes, and that are no constants.
fn free_names(network: &Network<'_>) -> Result<Vec<String>> {
    let mut changed = Vec::new();
    for instance in &network.instances {
        for place in &instance.component.locations {
            let rates = instance.rates(place)?.unwrap_or_default();
            changed.extend(rates.into_iter().map(|(name, _)| name));
        }
        for transition in &instance.component.transitions {
            changed.extend(instance.assignments(transition)?.into_iter().map(|(name, _)| name));
        }
    }
    let known = network.known.iter();
    let free =
        known.filter(|(name, it)| !(it.is_label || it.is_constant || changed.contains(name)));
    Ok(free.map(|(name, _)| name.clone()).collect())
}

/// What every location of an instance says that a number is.
fn formula_of(network: &Network<'_>, name: &str) -> Result<Option<Expression>> {
    for instance in &network.instances {
        let places = instance.component.locations.iter();
        let said: Vec<Option<Expression>> =
            places.map(|place| said(instance, place, name)).collect::<Result<_>>()?;
        if let [Some(first), others @ ..] = &said[..]
            && others.iter().all(|other| other.as_ref() == Some(first))
        {
            return Ok(Some(first.clone()));
        }
    }
    Ok(None)
}

/// What a location says that a number is.
fn said(instance: &Instance<'_>, place: &Location, name: &str) -> Result<Option<Expression>> {
    let clauses = instance.clauses(&place.invariant)?;
    Ok(clauses.into_iter().find_map(|clause| {
        let Clause::Compare { left, relation: Relation::Equal, right } = clause else {
            return None;
        };
        let other = match (left.name(), right.name()) {
            (Some(left), _) if left == name => right,
            (_, Some(right)) if right == name => left,
            _ => return None,
        };
        // A number alone is a bound of an input.
        let Side::Formula(formula) = other else { return None };
        (!formula.variables().is_empty()).then_some(formula)
    }))
}
