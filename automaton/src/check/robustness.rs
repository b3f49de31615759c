//! Witnesses that do not rest on rounding.
//!
//! The numbers of a model are rounded: tan θ as a number times cos θ as a number is not sin θ as a
//! number. Two formulas that say the same can then differ by the last digits of their coefficients,
//! and where variables are unbounded that is enough for a "witness" at which they differ by any
//! amount: somewhere at 10¹⁷. A witness counts only if every strict comparison that it rests on
//! still holds when all terms are off by a little; comparisons that are not strict may be touched.

use pleach_guards::{Comparison, Expression, Interval, Predicate, Ranges, Relation, constant};

use crate::decision::{Region, State};

/// By how much terms may be off, relative to the largest number that occurs in them.
const DOUBT: f64 = 1e-13;
/// Where a variable has no range, values up to this magnitude are looked for instead.
const ORDINARY: f64 = 1e6;
/// By how much strict comparisons have to hold there.
const ROOM: f64 = 1e-9;

/// Whether a witness of `predicate`, which is in negation normal form, does not rest on rounding.
pub(super) fn is_robust(predicate: &Predicate, state: &State) -> bool {
    match predicate {
        Predicate::Comparison(comparison) if comparison.relation.is_strict() => {
            has_room(comparison, state)
        }
        Predicate::All(parts) => parts.iter().all(|part| is_robust(part, state)),
        Predicate::Any(parts) => {
            let holds = |part: &Predicate| part.holds(state) == Ok(true);
            parts.iter().any(|part| holds(part) && is_robust(part, state))
        }
        _ => true,
    }
}

/// Whether a strict comparison holds by more than its terms can be off.
fn has_room(comparison: &Comparison, state: &State) -> bool {
    let margin = Predicate::Comparison(comparison.clone()).margin(state);
    let [left, right] = [&comparison.left, &comparison.right].map(|side| size(side, state));
    // Where no variable occurs nothing is rounded but numbers that were meant so.
    let is_fixed = [&comparison.left, &comparison.right].iter().all(|it| it.variables().is_empty());
    margin.is_ok_and(|margin| is_fixed || margin > DOUBT * left.max(right))
}

/// A bound on the numbers that occur in a formula: its range where every variable may have either
/// sign, so that nothing cancels.
fn size(formula: &Expression, state: &State) -> f64 {
    struct Magnitudes<'a>(&'a State);
    impl Ranges for Magnitudes<'_> {
        fn range(&self, variable: &str) -> Option<Interval> {
            let size = self.0.get(variable)?.abs();
            Interval::new(-size, size).ok()
        }
    }
    match formula.range(&Magnitudes(state)) {
        Ok(range) if range.width().is_finite() => range.lower().abs().max(range.upper().abs()),
        _ => 0.0,
    }
}

/// The region with ordinary numbers where a variable has no bound.
pub(super) fn ordinary(region: &Region) -> Region {
    let bounded = |range: &Interval| {
        let (lower, upper) = (range.lower(), range.upper());
        let least = if lower.is_finite() { lower } else { upper.min(0.0) - ORDINARY };
        let most = if upper.is_finite() { upper } else { lower.max(0.0) + ORDINARY };
        Interval::new(least, most).unwrap_or(*range)
    };
    region.iter().map(|(name, range)| (name.clone(), bounded(range))).collect()
}

/// The predicate, which is in negation normal form, with room in every strict comparison.
pub(super) fn with_room(predicate: &Predicate) -> Predicate {
    let parts = |parts: &[Predicate]| parts.iter().map(with_room).collect::<Vec<_>>();
    match predicate {
        Predicate::Comparison(comparison) if comparison.relation.is_strict() => {
            let Comparison { left, relation, right } = comparison;
            let lower = matches!(relation, Relation::LessThan);
            let room = constant(if lower { ROOM } else { -ROOM });
            let left = left + room;
            Predicate::Comparison(Comparison { left, relation: *relation, right: right.clone() })
        }
        Predicate::All(inner) => Predicate::all(parts(inner)),
        Predicate::Any(inner) => Predicate::any(parts(inner)),
        other => other.clone(),
    }
}
