//! States that neither time nor a transition can leave.
//!
//! Time passes in a location while its invariant holds. It stops on the boundary of the invariant
//! where the flow leads outside: where a comparison of the invariant holds with margin 0, and the
//! derivative of the margin along the flow is negative (the Lie derivative, Σ ∂m/∂xᵢ · ẋᵢ). Such a
//! state blocks if no guard holds there, which is what is asked.
//!
//! Not asked is what the flow does where that derivative is 0, such as at the top of a parabola or
//! for a ball that lies on the floor; whether a run comes to the state; and whether the partners in
//! a label are there. A flow that is a function has no derivative, and the variables that a
//! component reads from others have none that it knows of.

use pleach_guards::{Comparison, Expression, Predicate, Relation, always, constant, not};

use super::inquiry::{Inquiry, closed};
use super::model::Mode;
use super::reachability::Reach;
use super::report::Kind;

/// The most alternatives of an invariant that are looked at.
const ALTERNATIVES: usize = 64;

impl Inquiry<'_> {
    pub(super) fn report_blocking(&mut self, reach: &Reach) {
        for location in (0..self.model.modes.len()).filter(|&one| reach.is_reached[one]) {
            let invariant = &self.model.modes[location].invariant;
            if *invariant == always() {
                continue;
            }
            if self.is_possible(&closed(invariant)) {
                self.report_blocked(location);
            } else {
                let message = format!(
                    "its invariant `{invariant}` holds nowhere in the declared ranges, so that no \
                     time can pass: correct one of them"
                );
                let place = self.model.mode_at(location);
                self.warning(Kind::EmptyInvariant, place, message);
            }
        }
    }

    fn report_blocked(&mut self, location: usize) {
        let mode = &self.model.modes[location];
        let place = self.model.mode_at(location);
        let Ok(alternatives) = mode.invariant.disjunctive_form(ALTERNATIVES) else { return };
        let whole = |alternative: &[Comparison]| {
            Predicate::all(alternative.iter().cloned().map(Predicate::Comparison))
        };
        for (position, alternative) in alternatives.iter().enumerate() {
            let others = alternatives.iter().enumerate().filter(|(other, _)| *other != position);
            let elsewhere = Predicate::all(others.map(|(_, other)| not(whole(other))));
            for comparison in alternative {
                let Some(leaving) = self.leaving(mode, comparison) else { continue };
                let fault = leaving
                    & closed(&whole(alternative))
                    & elsewhere.clone()
                    & self.no_way_out(location);
                if let Some(witness) = self.witness(Kind::Blocked, &place, &fault) {
                    let boundary = Predicate::Comparison(comparison.clone());
                    let message = format!(
                        "the flow leaves the invariant through `{boundary}`, and no guard holds \
                         there: add a transition, or widen a guard"
                    );
                    self.error(Kind::Blocked, place, message, witness);
                    return;
                }
            }
        }
    }

    /// The states on the boundary of `comparison` in which the flow leads outside.
    fn leaving(&self, mode: &Mode, comparison: &Comparison) -> Option<Predicate> {
        let Comparison { left, relation, right } = comparison;
        let margin = match relation {
            Relation::AtMost | Relation::LessThan => right - left,
            Relation::AtLeast | Relation::MoreThan => left - right,
        };
        let variables = margin.variables();
        if self.model.inputs.iter().any(|input| variables.contains(input.as_str())) {
            return None;
        }
        let moved = mode.rates().iter().filter(|(name, _)| variables.contains(name.as_str()));
        let terms = moved.map(|(name, rate)| (margin.derivative(name), rate));
        let derivative: Expression = terms
            .map(|(slope, rate)| slope * rate)
            .reduce(|sum, term| sum + term)
            .unwrap_or_else(|| constant(0.0));
        let boundary = left.at_most(right.clone()) & left.at_least(right.clone());
        Some(boundary & derivative.less_than(0.0))
    }
}
