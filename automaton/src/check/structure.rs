//! What can be seen without asking about states: the start, functions, and flows that are missing.

use pleach_discrete::Urgency;
use pleach_guards::Valuation;

use super::inquiry::Inquiry;
use super::model::{Effect, Motion};
use super::reachability::Reach;
use super::report::{Finding, FindingPlace, Kind, Severity, Shown};

impl Inquiry<'_> {
    /// The initial state is there, and a run can begin in it.
    pub(super) fn report_start(&mut self) {
        let model = self.model;
        let place = model.mode_at(model.initial);
        let Some(state) = &model.initial_state else {
            if model.has_coordinates {
                let message = "runs do not know where to begin: say it with `initially`";
                self.warning(Kind::NoInitialState, place, message.to_owned());
            }
            return;
        };
        let mode = &model.modes[model.initial];
        let is_inside = mode.invariant.holds(state);
        let is_stuck = self.no_way_out(model.initial).holds(state) == Ok(true);
        if is_inside == Ok(false) {
            let (invariant, start) = (&mode.invariant, place.clone());
            let message = format!(
                "the initial state is outside the invariant `{invariant}`: begin inside it"
            );
            if is_stuck {
                self.error(Kind::StartsOutside, start, message, Shown::alone(state));
            } else {
                self.warn_with(Kind::StartsOutside, start, message, Shown::alone(state));
            }
        }
        for (name, range) in &model.region {
            if state.value(name).is_some_and(|value| !range.contains(value)) {
                let message = format!(
                    "the initial state is outside the declared range `{}`: begin inside it",
                    model.range_of(name)
                );
                let place = FindingPlace { variable: Some(name.clone()), ..place.clone() };
                self.warn_with(Kind::StartsOutOfRange, place, message, Shown::alone(state));
            }
        }
    }

    /// One note for every function, with all transitions that it stands at.
    pub(super) fn report_functions(&mut self) {
        let model = self.model;
        let mut notes: Vec<(FindingPlace, String)> = Vec::new();
        let mut note = |place: FindingPlace, part: &str, name: &str| {
            let message = format!("the {part} `{name}` is a function, which no check can see into");
            match notes.iter_mut().find(|(_, other)| *other == message) {
                Some((known, _)) => {
                    let new = place.events.into_iter().filter(|one| !known.events.contains(one));
                    known.events.extend(new.collect::<Vec<_>>());
                    known.location = known.location.filter(|one| Some(*one) == place.location);
                }
                None => notes.push((place, message)),
            }
        };
        for (location, mode) in model.modes.iter().enumerate() {
            let place = model.mode_at(location);
            if let Motion::Function(name) = &mode.motion {
                note(place.clone(), "flow", name);
            }
            for name in mode.invariant.functions() {
                note(place.clone(), "part of an invariant", name);
            }
        }
        for (number, transition) in model.transitions.iter().enumerate() {
            let place = model.place_of(&[number]);
            for name in transition.guard.predicate().functions() {
                note(place.clone(), "part of a guard", name);
            }
            if let Effect::Function(name) = &transition.effect {
                note(place, "reset", name);
            }
        }
        for (place, message) in notes {
            self.report.add(Finding::new(Kind::Unchecked, Severity::Note, place, message));
        }
    }

    /// Locations without a flow that wait for a guard whose variables move in other locations.
    pub(super) fn report_rest(&mut self, reach: &Reach) {
        let model = self.model;
        let moves = |name: &str| {
            let mut rates = model.modes.iter().flat_map(|mode| mode.rates());
            rates.any(|(moved, _)| moved == name)
        };
        let waits = |number: &usize| {
            let transition = &model.transitions[*number];
            let variables = transition.guard.predicate().variables();
            transition.urgency == Urgency::Must
                && model.is_own(*number)
                && !variables.is_empty()
                && variables.into_iter().all(moves)
        };
        for (location, mode) in model.modes.iter().enumerate() {
            let waiting: Vec<usize> = mode.leaving.iter().copied().filter(waits).collect();
            if reach.is_reached[location] && mode.rests() && !waiting.is_empty() {
                let message = "it has no flow, so that the guard changes only by jumps, but its \
                               variables move in other locations: give it a flow, or say `at once`"
                    .to_owned();
                self.warning(Kind::NothingMoves, model.place_of(&waiting), message);
            }
        }
    }
}
