//! What clauses say: as predicates, and as bounds on one variable.

use crate::guards::{Interval, Predicate};
use crate::spaceex::formula::{Clause, Relation, Side};

/// A clause as a predicate; nothing for one about locations.
pub(super) fn predicate(clause: &Clause) -> Result<Option<Predicate>, String> {
    Ok(match clause {
        Clause::Always | Clause::Location { .. } => None,
        Clause::Never => Some(crate::guards::never()),
        Clause::Compare { left: Side::Formula(left), relation, right: Side::Formula(right) } => {
            Some(relation.predicate(left, right))
        }
        Clause::Compare { left, right, .. } => {
            let primed = [left, right].into_iter().find_map(|side| match side {
                Side::Primed(name) => Some(name.as_str()),
                Side::Formula(_) => None,
            });
            return Err(format!("`{}'` cannot stand in a condition", primed.unwrap_or_default()));
        }
    })
}

/// The bound that a clause puts on a single variable, which stands alone on its side: variable, relation and number.
pub(super) fn bound(clause: &Clause) -> Option<(&str, Relation, f64)> {
    let Clause::Compare { left, relation, right } = clause else { return None };
    let number = |side: &Side| match side {
        Side::Formula(formula) => formula.evaluate(&()).ok().filter(|value| !value.is_nan()),
        Side::Primed(_) => None,
    };
    match (left.name(), right.name()) {
        (Some(name), _) => Some((name, *relation, number(right)?)),
        (None, Some(name)) => Some((name, relation.turned(), number(left)?)),
        (None, None) => None,
    }
}

/// Between which numbers clauses keep a variable, over all alternatives; clauses that are no
/// [`bound`] on it do not count.
pub(super) fn fixed(alternatives: &[Vec<Clause>], name: &str) -> Option<Interval> {
    let within = |clauses: &Vec<Clause>| -> Option<Interval> {
        let (mut lower, mut upper) = (f64::NEG_INFINITY, f64::INFINITY);
        for (own, relation, value) in clauses.iter().filter_map(bound) {
            if own != name {
                continue;
            }
            match relation {
                Relation::AtMost | Relation::LessThan => upper = upper.min(value),
                Relation::AtLeast | Relation::MoreThan => lower = lower.max(value),
                Relation::Equal | Relation::Assigned => {
                    (lower, upper) = (lower.max(value), upper.min(value));
                }
            }
        }
        let is_known = lower.is_finite() || upper.is_finite();
        is_known.then(|| Interval::new(lower, upper).ok()).flatten()
    };
    let mut hull: Option<Interval> = None;
    for clauses in alternatives {
        let within = within(clauses)?;
        hull = Some(hull.map_or(within, |known| known.hull(within)));
    }
    hull
}
