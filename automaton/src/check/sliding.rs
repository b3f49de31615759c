//! Boundaries to which the flows of both sides lead.

use pleach_guards::{
    Comparison, Expression, LinearForm, Predicate, Relation, Substitution, constant, variable,
};

use super::inquiry::{Inquiry, closed};
use super::model::Motion;
use super::reachability::Reach;
use super::report::Kind;

impl Inquiry<'_> {
    /// Pairs of forced transitions, there and back, that share a boundary without any room between
    /// their guards: where the vector fields of both locations face each other, runs can follow neither.
    pub(super) fn report_sliding(&mut self, reach: &Reach) {
        let transitions = &self.model.transitions;
        let forced = |&one: &usize| reach.is_live[one] && self.model.is_forced(one);
        let pairs: Vec<[usize; 2]> = (0..transitions.len())
            .filter(forced)
            .flat_map(|there| {
                (there + 1..transitions.len()).filter(forced).map(move |back| [there, back])
            })
            .filter(|&[there, back]| {
                let (there, back) = (&transitions[there], &transitions[back]);
                let returns = (there.source, there.target) == (back.target, back.source);
                returns && there.source != there.target
            })
            .collect();
        for [there, back] in pairs {
            self.report_facing(there, back);
        }
    }

    fn report_facing(&mut self, there: usize, back: usize) {
        let [one, other] = [there, back].map(|number| &self.model.transitions[number]);
        // A reset moves the state away from the boundary, or is no matter of flows alone.
        if !(one.assignments().is_empty() && other.assignments().is_empty()) {
            return;
        }
        let faced = [one, other].map(|transition| closed(transition.guard.predicate()));
        let fault = comparisons(one.guard.predicate()).into_iter().find_map(|here| {
            let margin = margin_of(here).linear_form()?;
            let opposite = |beyond: &&Comparison| is_opposite(&margin, beyond);
            comparisons(other.guard.predicate()).into_iter().find(opposite)?;
            let rises = self.derivative(&margin, one.source)?.more_than(0.0);
            let falls = self.derivative(&margin, other.source)?.less_than(0.0);
            let stands = [one.source, other.source].map(|location| self.standing(location));
            let parts = [rises, falls].into_iter().chain(stands).chain(faced.clone());
            Some(Predicate::all(parts).substitute(&on_boundary(&margin)?))
        });
        let Some(witness) = fault.and_then(|fault| self.robust_example(&fault)) else { return };
        let beyond = self.model.modes[one.target].name;
        let message = format!(
            "the flows here and in `{beyond}` lead to the boundary between the two from both sides, where \
             a run can follow neither: leave room between the guards, or see `Automaton::with_sliding`"
        );
        self.warn_with(Kind::Sliding, self.model.place_of(&[there, back]), message, witness);
    }

    /// How fast a linear form rises in a location; none where that is not known.
    fn derivative(&self, form: &LinearForm, location: usize) -> Option<Expression> {
        let mode = &self.model.modes[location];
        let Motion::Rates(rates) = &mode.motion else { return None };
        let terms = form.coefficients().map(|(name, coefficient)| {
            let is_input = self.model.inputs.iter().any(|input| input == name);
            let rate = rates.iter().find(|(moved, _)| moved == name);
            let rate = rate.map_or(constant(0.0), |(_, rate)| rate.clone());
            (!is_input).then(|| *coefficient * rate)
        });
        terms.sum()
    }
}

/// The comparisons of which all have to hold.
fn comparisons(guard: &Predicate) -> Vec<&Comparison> {
    match guard {
        Predicate::Comparison(comparison) => vec![comparison],
        Predicate::All(parts) => parts.iter().flat_map(comparisons).collect(),
        _ => Vec::new(),
    }
}

/// What is positive where a comparison holds.
fn margin_of(comparison: &Comparison) -> Expression {
    let (left, right) = (&comparison.left, &comparison.right);
    match comparison.relation {
        Relation::AtMost | Relation::LessThan => right - left,
        Relation::AtLeast | Relation::MoreThan => left - right,
    }
}

/// Whether a comparison has the boundary of a margin, and holds on its other side.
fn is_opposite(margin: &LinearForm, beyond: &Comparison) -> bool {
    let Some(other) = margin_of(beyond).linear_form() else { return false };
    let opposite = other.coefficients().all(|(name, own)| {
        margin.coefficients().any(|(one, coefficient)| one == name && *coefficient == -own)
    });
    opposite
        && margin.coefficients().count() == other.coefficients().count()
        && *margin.constant() == -*other.constant()
}

/// The first of the variables, as where the margin is 0.
fn on_boundary(margin: &LinearForm) -> Option<Substitution> {
    let mut terms = margin.coefficients();
    let (name, coefficient) = terms.next()?;
    let others = terms.map(|(name, coefficient)| *coefficient * variable(name)).sum::<Expression>();
    let value = (others + *margin.constant()) / -coefficient;
    Some(Substitution::new([(name, value)]))
}
