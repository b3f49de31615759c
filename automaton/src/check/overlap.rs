//! Transitions of one location that can be due together.
//!
//! Two forced transitions overlap if their guards can hold in one state of the location, their
//! priorities are the same, and it makes a difference which is taken: they lead to different
//! locations or reset differently. Where one *may* be taken and another *must*, the latter goes
//! first, which is no fault. Where several *may* be taken, the caller says which; that is
//! a freedom of the model, and worth one note for each location.

use pleach_discrete::Urgency;
use pleach_guards::Predicate;

use super::inquiry::Inquiry;
use super::reachability::Reach;
use super::report::Kind;

impl Inquiry<'_> {
    pub(super) fn report_overlaps(&mut self, reach: &Reach) {
        for location in (0..self.model.modes.len()).filter(|&one| reach.is_reached[one]) {
            let leaving = &self.model.modes[location].leaving;
            let mut free = Vec::new();
            for (position, &first) in leaving.iter().enumerate() {
                for &second in &leaving[position + 1..] {
                    if !self.is_ambiguous(first, second) {
                        continue;
                    }
                    match self.model.transitions[first].urgency {
                        Urgency::May => free.push((first, second)),
                        Urgency::Must | Urgency::AtOnce => {
                            self.report_overlap(location, first, second);
                        }
                    }
                }
            }
            self.report_choice(location, &free);
        }
    }

    /// Whether the order in which two transitions are looked at decides which is taken.
    fn is_ambiguous(&self, first: usize, second: usize) -> bool {
        let [one, other] = [first, second].map(|number| &self.model.transitions[number]);
        one.priority == other.priority
            && one.urgency.is_forced() == other.urgency.is_forced()
            && (one.target != other.target || one.effect != other.effect)
    }

    fn both(&self, location: usize, first: usize, second: usize) -> Predicate {
        let [one, other] =
            [first, second].map(|number| self.model.transitions[number].guard.predicate().clone());
        self.standing(location) & one & other
    }

    fn report_overlap(&mut self, location: usize, first: usize, second: usize) {
        let place = self.model.place_of(&[first, second]);
        let fault = self.both(location, first, second);
        if let Some(witness) = self.witness(Kind::Overlap, &place, &fault) {
            let message = "both have to be taken in one state, and nothing says which goes first: \
                           give them priorities, or guards that exclude each other"
                .to_owned();
            self.warn_with(Kind::Overlap, place, message, witness);
        }
    }

    /// One note for all pairs; a label is chosen by the components that offer it.
    fn report_choice(&mut self, location: usize, pairs: &[(usize, usize)]) {
        let mut open: Vec<usize> = Vec::new();
        for &(first, second) in pairs {
            let is_own = self.model.is_own(first) && self.model.is_own(second);
            let is_new = !(open.contains(&first) && open.contains(&second));
            if is_own && is_new && self.is_possible(&self.both(location, first, second)) {
                open.extend([first, second]);
            }
        }
        open.sort_unstable();
        open.dedup();
        if !open.is_empty() {
            let message = "each of them may be taken in one state; a run that is not asked takes \
                           the one given first"
                .to_owned();
            self.note(Kind::Choice, self.model.place_of(&open), message);
        }
    }

    /// The transitions that can be due only where a forced one of a better priority is due, too.
    pub(super) fn report_shadowed(&mut self, reach: &Reach) -> Vec<usize> {
        let mut shadowed = Vec::new();
        for location in (0..self.model.modes.len()).filter(|&one| reach.is_reached[one]) {
            for &number in &self.model.modes[location].leaving {
                if self.report_shadow(location, number) {
                    shadowed.push(number);
                }
            }
        }
        shadowed
    }

    fn report_shadow(&mut self, location: usize, number: usize) -> bool {
        let (model, transition) = (self.model, &self.model.transitions[number]);
        let before: Vec<usize> = model.modes[location]
            .leaving
            .iter()
            .copied()
            .filter(|&other| model.transitions[other].priority < transition.priority)
            .filter(|&other| model.is_forced(other))
            .collect();
        let due = self.standing(location) & transition.guard.predicate().clone();
        let alone = before.iter().map(|&other| model.transitions[other].refused());
        let seen = Predicate::all([due.clone()].into_iter().chain(alone));
        if before.is_empty() || !self.is_possible(&due) || self.is_possible(&seen) {
            return false;
        }
        let names: Vec<String> =
            before.iter().map(|&other| format!("`{}`", model.event(other))).collect();
        let message = format!(
            "wherever its guard `{}` holds, {} goes first: make it the first, or leave it out",
            transition.guard.predicate(),
            names.join(" or ")
        );
        self.warning(Kind::Shadowed, model.place_of(&[number]), message);
        true
    }
}
