//! Which transitions can ever be taken, and which locations be entered.
//!
//! A run begins in the initial state, or, where the model has none, in any state of the initial
//! location. From there on, a transition is *live* if its guard can hold, or be on the boundary of
//! holding, in a location that is reached: after time has passed there, while no forced transition
//! was due; or right on entry, in a state that a live transition lands in. What is not live is so
//! by proof; a reset that is a function can land anywhere. What a composition takes beyond an
//! accumulation of jumps is live wherever its source is reached.

use std::collections::BTreeSet;

use pleach_guards::always;

use super::inquiry::{Inquiry, closed};
use super::report::Kind;

/// What can happen, by the numbers of locations and transitions.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    pub(super) is_reached: Vec<bool>,
    pub(super) is_live: Vec<bool>,
}

/// The moments at which a transition can be taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Moment {
    /// After time has passed in its source.
    Later,
    /// In the instant in which its source is entered.
    OnEntry,
}

/// What is known so far, growing.
struct Search {
    is_reached: Vec<bool>,
    fires: BTreeSet<(usize, Moment)>,
    /// Questions that were answered with no: the transition after another at a moment of that one.
    excluded: BTreeSet<(usize, Option<(usize, Moment)>)>,
}

impl Inquiry<'_> {
    /// Goes on until nothing new is reached.
    pub(super) fn reach(&self) -> Reach {
        let (modes, transitions) = (self.model.modes.len(), self.model.transitions.len());
        let mut search = Search {
            is_reached: vec![false; modes],
            fires: BTreeSet::new(),
            excluded: BTreeSet::new(),
        };
        search.is_reached[self.model.initial] = true;
        let is_satisfiable: Vec<bool> = self
            .model
            .transitions
            .iter()
            .map(|transition| self.is_possible(transition.guard.predicate()))
            .collect();
        let mut known = usize::MAX;
        while known != search.fires.len() {
            known = search.fires.len();
            for (number, transition) in self.model.transitions.iter().enumerate() {
                if search.is_reached[transition.source] {
                    if self.goes_on(number) {
                        search.fires.insert((number, Moment::Later));
                    }
                    if is_satisfiable[number] {
                        self.look_at(number, &mut search);
                    }
                }
                search.is_reached[transition.target] |= search.is_live(number);
            }
        }
        let is_live = (0..transitions).map(|number| search.is_live(number)).collect();
        Reach { is_reached: search.is_reached, is_live }
    }

    fn look_at(&self, number: usize, search: &mut Search) {
        let source = self.model.transitions[number].source;
        if search.asks(number, Moment::Later, None) && self.fires_later(number) {
            search.fires.insert((number, Moment::Later));
        }
        if source == self.model.initial && self.fires_at_the_start(number) {
            search.fires.insert((number, Moment::OnEntry));
        }
        for (entry, moment) in search.fires.clone() {
            let arrives = self.model.transitions[entry].target == source;
            if arrives
                && search.asks(number, Moment::OnEntry, Some((entry, moment)))
                && self.fires_after(number, entry, moment)
            {
                search.fires.insert((number, Moment::OnEntry));
            }
        }
    }

    /// Whether it is what is taken beyond an accumulation of jumps, whatever its guard says.
    fn goes_on(&self, number: usize) -> bool {
        self.model.continuation == Some(self.model.transitions[number].event)
    }

    fn fires_later(&self, number: usize) -> bool {
        let transition = &self.model.transitions[number];
        let guard = closed(transition.guard.predicate());
        self.is_possible(&(self.dwelling(transition.source) & guard))
    }

    fn fires_at_the_start(&self, number: usize) -> bool {
        let guard = self.model.transitions[number].guard.predicate();
        match &self.model.initial_state {
            // Where a guard has no value, it is not excluded that it fires.
            Some(state) => guard.holds(state) != Ok(false),
            None => self.is_possible(&(self.standing(self.model.initial) & guard.clone())),
        }
    }

    /// Whether the guard of `number` can hold right after `entry` has been taken. If that was in
    /// the instant in which its own source was entered, then that may be outside its invariant.
    fn fires_after(&self, number: usize, entry: usize, moment: Moment) -> bool {
        let is_compelled = self.goes_on(entry);
        let [transition, entry] = [number, entry].map(|one| &self.model.transitions[one]);
        let guard = closed(transition.guard.predicate());
        let Some(reset) = entry.substitution() else { return self.is_possible(&guard) };
        let before = match moment {
            _ if is_compelled => always(),
            Moment::Later => self.dwelling(entry.source) & closed(entry.guard.predicate()),
            Moment::OnEntry => closed(entry.guard.predicate()),
        };
        self.is_possible(&(before & guard.substitute(&reset)))
    }

    /// Reports locations that are not reached, and transitions of the others that never fire.
    pub(super) fn report_unreached(&mut self, reach: &Reach, shadowed: &[usize]) {
        for number in 0..self.model.transitions.len() {
            let transition = &self.model.transitions[number];
            let is_due = reach.is_reached[transition.source] && !reach.is_live[number];
            if is_due && !shadowed.contains(&number) {
                let message = self.why_never(number);
                self.warning(Kind::NeverFires, self.model.place_of(&[number]), message);
            }
        }
        let in_graph = self.reached_in_graph();
        for location in (0..self.model.modes.len()).filter(|&one| !reach.is_reached[one]) {
            let message = if in_graph[location] {
                "it can only be entered by transitions that can never fire: see those"
            } else {
                "no way leads here from the initial location: add a transition, or leave it out"
            };
            self.warning(Kind::Unreachable, self.model.mode_at(location), message.to_owned());
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

impl Search {
    fn is_live(&self, number: usize) -> bool {
        [Moment::Later, Moment::OnEntry]
            .iter()
            .any(|&moment| self.fires.contains(&(number, moment)))
    }

    /// Whether it is worth asking: neither the answer to this question nor a better one is known.
    fn asks(&mut self, number: usize, moment: Moment, after: Option<(usize, Moment)>) -> bool {
        !self.fires.contains(&(number, moment)) && self.excluded.insert((number, after))
    }
}
