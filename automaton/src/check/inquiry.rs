//! Questions to a model: which states a location can be in, and whether anything holds there.

use pleach_discrete::Urgency;
use pleach_guards::{Comparison, Predicate, Relation, always};

use super::model::Model;
use super::report::{Finding, FindingPlace, Kind, Report, Severity, Shown};
use super::robustness::{is_robust, ordinary, with_room};
use crate::decision::{Decision, Doubt, Effort, State, decide};

/// A model under inquiry, and what has been found out so far.
pub(super) struct Inquiry<'a> {
    pub(super) model: &'a Model,
    pub(super) report: Report,
    effort: Effort,
}

impl<'a> Inquiry<'a> {
    pub(super) fn new(model: &'a Model, effort: Effort) -> Self {
        Inquiry { model, report: Report::default(), effort }
    }

    /// A state in which `fault` holds. That there is none is noted as an exclusion, and that
    /// is unknown as a note; functions have notes of their own.
    pub(super) fn witness(
        &mut self,
        kind: Kind,
        place: &FindingPlace,
        fault: &Predicate,
    ) -> Option<Shown> {
        match self.decide(fault) {
            Decision::Witness(state) => {
                let known = self.robust(fault, state);
                if known.is_none() {
                    let message = format!(
                        "it could be only where the last digits of numbers decide: `{fault}`"
                    );
                    self.note(kind, place.clone(), message);
                }
                known.map(|state| self.shown(state, fault))
            }
            Decision::Impossible(proof) => {
                self.report.exclude(kind, place.clone(), proof);
                None
            }
            Decision::Undecided(Doubt::Functions(_)) => None,
            undecided @ Decision::Undecided(_) => {
                self.note(kind, place.clone(), format!("whether this can be is open: {undecided}"));
                None
            }
        }
    }

    /// A witness that does not rest on the rounding of the model's numbers: the one that is known,
    /// or another one at ordinary numbers.
    fn robust(&self, fault: &Predicate, known: State) -> Option<State> {
        let fault = self.here(fault).negation_normal_form();
        if is_robust(&fault, &known) {
            return Some(known);
        }
        let region = ordinary(&self.model.region);
        match decide(&with_room(&fault), &region, &self.effort) {
            Ok(Decision::Witness(state)) => (fault.holds(&state) == Ok(true)).then_some(state),
            _ => None,
        }
    }

    /// A state in which `predicate` holds, if one is found.
    pub(super) fn example(&self, predicate: &Predicate) -> Option<Shown> {
        match self.decide(predicate) {
            Decision::Witness(state) => Some(self.shown(state, predicate)),
            Decision::Impossible(_) | Decision::Undecided(_) => None,
        }
    }

    /// A state in which `predicate` holds and does not just by rounding, if one is found.
    pub(super) fn robust_example(&self, predicate: &Predicate) -> Option<Shown> {
        let known = self.example(predicate)?.state;
        self.robust(predicate, known).map(|state| self.shown(state, predicate))
    }

    fn shown(&self, state: State, states: &Predicate) -> Shown {
        Shown { state, states: Some(states.clone()) }
    }

    /// Whether `predicate` holds somewhere, or could.
    pub(super) fn is_possible(&self, predicate: &Predicate) -> bool {
        !matches!(self.decide(predicate), Decision::Impossible(_))
    }

    /// The predicate, with what is given of all states.
    fn here(&self, predicate: &Predicate) -> Predicate {
        if self.model.given == always() {
            return predicate.clone();
        }
        predicate.clone() & self.model.given.clone()
    }

    /// A witness is evaluated once more: whatever a report shows, holds.
    fn decide(&self, predicate: &Predicate) -> Decision {
        let region = &self.model.region;
        let open = || {
            let (region, resolution) = (region.clone(), 1.0);
            Decision::Undecided(Doubt::Remainder { region, resolution })
        };
        let predicate = &self.here(predicate);
        match decide(predicate, region, &self.effort) {
            Ok(Decision::Witness(state)) if predicate.holds(&state) != Ok(true) => open(),
            Ok(decision) => decision,
            Err(_) => open(),
        }
    }

    pub(super) fn error(
        &mut self,
        kind: Kind,
        place: FindingPlace,
        message: String,
        witness: Shown,
    ) {
        let finding = Finding::new(kind, Severity::Error, place, message);
        self.report.add(finding.shown_by(witness));
    }

    pub(super) fn warn_with(
        &mut self,
        kind: Kind,
        place: FindingPlace,
        message: String,
        witness: Shown,
    ) {
        let finding = Finding::new(kind, Severity::Warning, place, message);
        self.report.add(finding.shown_by(witness));
    }

    pub(super) fn warning(&mut self, kind: Kind, place: FindingPlace, message: String) {
        self.report.add(Finding::new(kind, Severity::Warning, place, message));
    }

    pub(super) fn note_with(
        &mut self,
        kind: Kind,
        place: FindingPlace,
        message: String,
        witness: Shown,
    ) {
        let finding = Finding::new(kind, Severity::Note, place, message);
        self.report.add(finding.shown_by(witness));
    }

    pub(super) fn note(&mut self, kind: Kind, place: FindingPlace, message: String) {
        self.report.add(Finding::new(kind, Severity::Note, place, message));
    }

    /// The states that a location can be in after time has passed, or on the boundary of them.
    pub(super) fn standing(&self, location: usize) -> Predicate {
        closed(&self.model.modes[location].invariant)
    }

    /// Those of them that no forced transition has left before.
    pub(super) fn dwelling(&self, location: usize) -> Predicate {
        let forced = self.model.modes[location].leaving.iter();
        let forced = forced.filter(|&&one| self.model.is_forced(one));
        let waiting = forced.map(|&one| closed(&self.model.transitions[one].refused()));
        Predicate::all([self.standing(location)].into_iter().chain(waiting))
    }

    /// The states from which a transition is taken: for one that must be taken, those in which its
    /// guard becomes true, on the boundary of the guard also where that does not belong to it. That
    /// some guard may be true already on entry is left out.
    pub(super) fn departing(&self, transition: usize) -> Predicate {
        let one = &self.model.transitions[transition];
        let guard = one.guard.predicate();
        match one.urgency {
            Urgency::AtOnce => self.standing(one.source) & guard.clone(),
            Urgency::Must => self.dwelling(one.source) & closed(&one.refused()) & closed(guard),
            Urgency::May => self.dwelling(one.source) & guard.clone(),
        }
    }

    /// None of the transitions that leave `location` has to be taken.
    pub(super) fn no_forced_way_out(&self, location: usize) -> Predicate {
        let leaving = self.model.modes[location].leaving.iter();
        let forced = leaving.filter(|&&one| self.model.is_forced(one));
        Predicate::all(forced.map(|&one| self.model.transitions[one].refused()))
    }

    /// None of the transitions that leave `location` can be taken.
    pub(super) fn no_way_out(&self, location: usize) -> Predicate {
        let leaving = self.model.modes[location].leaving.iter();
        Predicate::all(leaving.map(|&one| self.model.transitions[one].refused()))
    }
}

/// `predicate` with the boundary of every comparison: it holds wherever, and next to where,
/// `predicate` does.
pub(super) fn closed(predicate: &Predicate) -> Predicate {
    bounded(&predicate.negation_normal_form(), Boundary::In)
}

/// `predicate` without the boundary of any comparison.
pub(super) fn open(predicate: &Predicate) -> Predicate {
    bounded(&predicate.negation_normal_form(), Boundary::Out)
}

#[derive(Clone, Copy)]
enum Boundary {
    In,
    Out,
}

/// Of a predicate in negation normal form. About the boundary of a function nothing is known.
fn bounded(predicate: &Predicate, boundary: Boundary) -> Predicate {
    let parts = |parts: &[Predicate]| -> Vec<Predicate> {
        parts.iter().map(|part| bounded(part, boundary)).collect()
    };
    match (predicate, boundary) {
        (Predicate::Comparison(comparison), _) => {
            let relation = match (comparison.relation, boundary) {
                (Relation::AtMost | Relation::LessThan, Boundary::In) => Relation::AtMost,
                (Relation::AtMost | Relation::LessThan, Boundary::Out) => Relation::LessThan,
                (Relation::AtLeast | Relation::MoreThan, Boundary::In) => Relation::AtLeast,
                (Relation::AtLeast | Relation::MoreThan, Boundary::Out) => Relation::MoreThan,
            };
            Predicate::Comparison(Comparison { relation, ..comparison.clone() })
        }
        (Predicate::All(inner), _) => Predicate::all(parts(inner)),
        (Predicate::Any(inner), _) => Predicate::any(parts(inner)),
        (Predicate::Not(_), Boundary::In) => always(),
        (other, _) => other.clone(),
    }
}
