//! Which transitions can ever be taken, and which locations be entered.
//!
//! A run may begin in the initial location in any state within its invariant and the declared
//! ranges. From there on, a transition is *live* if its guard can hold in a location that is
//! reached: after time has passed there, while no forced transition was due; or right on entry, in
//! a state that a live transition lands in. What is not live is so by proof; a reset that is a
//! function can land anywhere.

use super::inquiry::Inquiry;
use super::report::Kind;

/// What can happen, by the numbers of locations and transitions.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    pub(super) is_reached: Vec<bool>,
    pub(super) is_live: Vec<bool>,
}

impl Reach {
    /// The transitions that can be taken from `location`, in their total order.
    pub(super) fn leaving<'a>(
        &'a self,
        inquiry: &'a Inquiry<'_>,
        location: usize,
    ) -> impl Iterator<Item = usize> + 'a {
        let leaving = inquiry.model.modes[location].leaving.iter().copied();
        leaving.filter(|&transition| self.is_live[transition])
    }
}

impl Inquiry<'_> {
    /// Goes on until nothing new is reached.
    pub(super) fn reach(&self) -> Reach {
        let (modes, transitions) = (self.model.modes.len(), self.model.transitions.len());
        let mut reach = Reach { is_reached: vec![false; modes], is_live: vec![false; transitions] };
        reach.is_reached[self.model.initial] = true;
        let mut after_time = vec![None; transitions];
        let mut tried = vec![vec![false; transitions]; transitions];
        loop {
            let mut grows = false;
            for number in 0..transitions {
                let transition = &self.model.transitions[number];
                if reach.is_live[number] || !reach.is_reached[transition.source] {
                    continue;
                }
                let holds_after_time =
                    *after_time[number].get_or_insert_with(|| self.can_hold_after_time(number));
                let mut on_entry = || {
                    (0..transitions).any(|entry| {
                        let arrives = reach.is_live[entry]
                            && self.model.transitions[entry].target == transition.source;
                        arrives
                            && !std::mem::replace(&mut tried[number][entry], true)
                            && self.can_hold_on_entry(number, entry)
                    })
                };
                if holds_after_time || on_entry() {
                    reach.is_live[number] = true;
                    reach.is_reached[transition.target] = true;
                    grows = true;
                }
            }
            if !grows {
                return reach;
            }
        }
    }

    fn can_hold_after_time(&self, number: usize) -> bool {
        let transition = &self.model.transitions[number];
        let guard = transition.guard.predicate().clone();
        let begins_here = transition.source == self.model.initial;
        let states = if begins_here {
            self.standing(transition.source)
        } else {
            self.dwelling(transition.source)
        };
        self.is_possible(&(states & guard))
    }

    /// Whether the guard of `number` can hold right after `entry` has been taken. Its source may
    /// itself have been entered outside its invariant.
    fn can_hold_on_entry(&self, number: usize, entry: usize) -> bool {
        let [transition, entry] = [number, entry].map(|one| &self.model.transitions[one]);
        let guard = transition.guard.predicate();
        match entry.substitution() {
            Some(reset) => {
                self.is_possible(&(entry.guard.predicate().clone() & guard.substitute(&reset)))
            }
            None => self.is_possible(guard),
        }
    }

    /// Reports locations that are not reached, and transitions of the others that never fire.
    pub(super) fn report_unreached(&mut self, reach: &Reach, shadowed: &[usize]) {
        let in_graph = self.reached_in_graph();
        for location in (0..self.model.modes.len()).filter(|&one| !reach.is_reached[one]) {
            let message = if in_graph[location] {
                "it can only be entered by transitions that can never fire: see those"
            } else {
                "no way leads here from the initial location: add a transition, or leave it out"
            };
            self.warning(Kind::Unreachable, self.model.mode_at(location), message.to_owned());
        }
        for number in 0..self.model.transitions.len() {
            let transition = &self.model.transitions[number];
            let is_due = reach.is_reached[transition.source] && !reach.is_live[number];
            if is_due && !shadowed.contains(&number) {
                let message = self.why_never(number);
                self.warning(Kind::NeverFires, self.model.place_of(&[number]), message);
            }
        }
    }

    fn why_never(&self, number: usize) -> String {
        let transition = &self.model.transitions[number];
        let guard = transition.guard.predicate();
        let invariant = &self.model.modes[transition.source].invariant;
        let standing = self.standing(transition.source);
        if !self.is_possible(guard) {
            format!("its guard `{guard}` holds nowhere in the declared ranges: correct one of them")
        } else if !self.is_possible(&(standing & guard.clone())) {
            format!(
                "its guard `{guard}` holds nowhere in the invariant `{invariant}`: \
                 let them meet"
            )
        } else {
            format!("before its guard `{guard}` holds, another transition is always due")
        }
    }

    fn reached_in_graph(&self) -> Vec<bool> {
        let mut reached = vec![false; self.model.modes.len()];
        let mut open = vec![self.model.initial];
        while let Some(location) = open.pop() {
            if !std::mem::replace(&mut reached[location], true) {
                let leaving = self.model.modes[location].leaving.iter();
                open.extend(leaving.map(|&one| self.model.transitions[one].target));
            }
        }
        reached
    }
}
