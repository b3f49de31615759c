//! What clauses say: as predicates, and as bounds on one variable.

use crate::guards::{Expression, Interval, Predicate};
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

/// Between which numbers clauses keep a variable, over all alternatives.
pub(super) fn fixed(alternatives: &[Vec<Clause>], name: &str) -> Option<Interval> {
    let within = |clauses: &Vec<Clause>| -> Option<Interval> {
        let (mut lower, mut upper) = (f64::NEG_INFINITY, f64::INFINITY);
        for clause in clauses {
            let Clause::Compare {
                left: Side::Formula(left),
                relation,
                right: Side::Formula(right),
            } = clause
            else {
                continue;
            };
            let is_name =
                |side: &Expression| matches!(side, Expression::Variable(own) if **own == *name);
            let (value, relation) = match (left.evaluate(&()), right.evaluate(&())) {
                (_, Ok(value)) if is_name(left) => (value, *relation),
                (Ok(value), _) if is_name(right) => (
                    value,
                    match relation {
                        Relation::AtMost | Relation::LessThan => Relation::AtLeast,
                        Relation::AtLeast | Relation::MoreThan => Relation::AtMost,
                        equal => *equal,
                    },
                ),
                _ => continue,
            };
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
