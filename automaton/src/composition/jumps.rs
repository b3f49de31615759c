//! Which jumps can be taken from where a composition stands, and what they lead to.
//!
//! Running a composition and exploring it both go by this.

use pleach_guards::{EvaluationError, Verdict};

use super::blueprint::{Assigned, Change, Leaving};
use super::simulation::{Failure, Move, Taken};
use super::{Component, Composition};

/// The locations of all components.
#[derive(Clone, Copy)]
pub(super) struct Standing<'a> {
    pub(super) composition: &'a Composition,
    /// By component.
    pub(super) locations: &'a [usize],
    /// Whether states hold the variables of one group alone.
    pub(super) is_local: bool,
}

/// A jump that can be taken: components, each with one of its transitions.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    pub(super) label: Option<usize>,
    pub(super) parts: Vec<(usize, usize)>,
}

impl<'a> Standing<'a> {
    /// The composition with its components in these locations.
    pub(super) fn new(composition: &'a Composition, locations: &'a [usize]) -> Self {
        Standing { composition, locations, is_local: false }
    }

    /// Where states hold the coordinates of a component.
    pub(super) fn slots(self, component: usize) -> &'a [usize] {
        let component = &self.composition.components[component];
        if self.is_local { &component.places } else { &component.slots }
    }

    /// The transitions that leave the location of `component`, in their total order.
    pub(super) fn leaving(self, component: usize) -> &'a [Leaving] {
        &self.composition.components[component].mode(self.locations[component]).leaving
    }

    /// Those of them on an event.
    pub(super) fn on_event(
        self,
        component: usize,
        event: usize,
    ) -> impl Iterator<Item = &'a Leaving> {
        self.leaving(component).iter().filter(move |leaving| leaving.event == event)
    }

    /// Whether the guard of a transition of `component` holds in `state`.
    pub(super) fn allows(
        self,
        component: usize,
        leaving: &Leaving,
        state: &[f64],
    ) -> Result<Verdict, Failure> {
        let part = || format!("the guard `{}`", leaving.guard);
        leaving
            .guard
            .evaluate_at(state, self.slots(component))
            .map_err(|fault| self.formula(component, self.locations[component], part(), &fault))
    }

    /// The jump that `component` takes by itself with one of its transitions, if the guard holds.
    pub(super) fn alone(
        self,
        component: usize,
        transition: usize,
        state: &[f64],
    ) -> Result<Option<Joint>, Failure> {
        let leaving = &self.leaving(component)[transition];
        let is_possible =
            self.allows(component, leaving, state)?.holds && !self.can_sample(component, state)?;
        Ok(is_possible.then(|| Joint { label: None, parts: vec![(component, transition)] }))
    }

    /// Whether `component` is a clock whose sample can be taken, and so does not pass.
    fn can_sample(self, component: usize, state: &[f64]) -> Result<bool, Failure> {
        match &self.composition.components[component].sampling {
            Some((_, labels)) => {
                Ok(self.together(labels[self.locations[component]], state)?.is_some())
            }
            None => Ok(false),
        }
    }

    /// The jump that all participants of a label take together, if the guards of all hold.
    pub(super) fn together(self, label: usize, state: &[f64]) -> Result<Option<Joint>, Failure> {
        let participants = &self.composition.labels[label].participants;
        let mut parts = Vec::with_capacity(participants.len());
        for &(component, event) in participants {
            let mut on_event = self
                .leaving(component)
                .iter()
                .enumerate()
                .filter(|(_, leaving)| leaving.event == event);
            let transition = loop {
                let Some((transition, leaving)) = on_event.next() else { return Ok(None) };
                if self.allows(component, leaving, state)?.holds {
                    break transition;
                }
            };
            parts.push((component, transition));
        }
        Ok(Some(Joint { label: Some(label), parts }))
    }

    /// Every jump that can be taken in `state`: by component and in the order of its transitions,
    /// then by label.
    pub(super) fn all(self, state: &[f64]) -> Result<Vec<Joint>, Failure> {
        let mut jumps = Vec::new();
        for (index, component) in self.composition.components.iter().enumerate() {
            for (transition, leaving) in self.leaving(index).iter().enumerate() {
                if component.labels[leaving.event].is_none() {
                    jumps.extend(self.alone(index, transition, state)?);
                }
            }
        }
        for label in 0..self.composition.labels.len() {
            jumps.extend(self.together(label, state)?);
        }
        Ok(jumps)
    }

    /// The transitions that make up a jump.
    pub(super) fn parts(self, jump: &Joint) -> impl Iterator<Item = &'a Leaving> {
        jump.parts.iter().map(move |&(component, transition)| &self.leaving(component)[transition])
    }

    /// Whether one of the transitions that allow a jump is as `is_one` asks. A participant of a label takes the first
    /// of its transitions that are allowed, and any of them may be why the label is taken.
    pub(super) fn is_for_one(
        self,
        jump: &Joint,
        state: &[f64],
        is_one: impl Fn(&Leaving) -> bool,
    ) -> Result<bool, Failure> {
        let Some(label) = jump.label else { return Ok(self.parts(jump).any(is_one)) };
        for &(component, event) in &self.composition.labels[label].participants {
            for leaving in self.on_event(component, event).filter(|leaving| is_one(leaving)) {
                if self.allows(component, leaving, state)?.holds {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// A variable that the jump gives any number of an interval.
    pub(super) fn chosen(self, jump: &Joint) -> Option<&'a str> {
        jump.parts.iter().zip(self.parts(jump)).find_map(|(&(component, _), leaving)| {
            let Change::Assignments(assignments) = &leaving.change else { return None };
            let mut intervals =
                assignments.iter().filter(|(_, one)| matches!(one, Assigned::Interval(_)));
            let slots = &self.composition.components[component].slots;
            intervals.next().map(|(coordinate, _)| &*self.composition.variables[slots[*coordinate]])
        })
    }

    /// What a jump does in `state`. All parts find x⁻ and change only what belongs to them, so that
    /// their order is no matter. Of each interval it takes the `share` that is given next.
    pub(super) fn taken(
        self,
        jump: &Joint,
        state: &[f64],
        share: &mut dyn FnMut() -> f64,
    ) -> Result<Taken, Failure> {
        let mut changes = Vec::new();
        let mut moves = Vec::with_capacity(jump.parts.len());
        for (&(component, transition), leaving) in jump.parts.iter().zip(self.parts(jump)) {
            let source = self.locations[component];
            self.composition.components[component]
                .change(&leaving.change, state, share, &mut changes)
                .map_err(|fault| self.formula(component, source, "the reset".into(), &fault))?;
            moves.push(Move { component, source, target: leaving.target, transition });
        }
        let label = match jump.label {
            Some(label) => self.composition.labels[label].name.clone(),
            None => self.composition.event_of(&moves[0]),
        };
        Ok(Taken { label, moves, changes })
    }

    /// A formula of `component` that has no value.
    pub(super) fn formula(
        self,
        component: usize,
        location: usize,
        part: String,
        fault: &EvaluationError,
    ) -> Failure {
        let component = &self.composition.components[component];
        Failure::Formula {
            component: component.name.clone(),
            location: component.mode(location).name.to_owned(),
            part,
            reason: fault.to_string(),
        }
    }

    /// The locations of some components by name, for messages.
    pub(super) fn names(self, components: &[usize]) -> String {
        let names = components.iter().map(|&index| {
            let component = &self.composition.components[index];
            let mode = component.mode(self.locations[index]);
            format!("`{}` of `{}`", mode.name, component.name)
        });
        names.collect::<Vec<_>>().join(", ")
    }
}

/// The number so far on the way from the lower to the upper end; no number if there is none, because
/// the interval is empty or infinite.
fn within([lower, upper]: [f64; 2], share: f64) -> f64 {
    let width = upper - lower;
    if width >= 0.0 && width.is_finite() {
        // Rounding must not lead out of the interval.
        if share < 1.0 { share.mul_add(width, lower).min(upper) } else { upper }
    } else {
        f64::NAN
    }
}

impl Component {
    /// Adds what becomes of the coordinates that are assigned to.
    fn change(
        &self,
        change: &Change,
        before: &[f64],
        share: &mut dyn FnMut() -> f64,
        changes: &mut Vec<(usize, f64)>,
    ) -> Result<(), EvaluationError> {
        match change {
            Change::Assignments(assignments) => {
                changes.reserve(assignments.len());
                for (coordinate, assigned) in assignments {
                    let (new, source) = match assigned {
                        Assigned::Value(value) => {
                            (value.evaluate_at(before, &self.slots), String::new())
                        }
                        Assigned::Interval(ends) => {
                            let [lower, upper] =
                                ends.each_ref().map(|end| end.evaluate_at(before, &self.slots));
                            let source = || format!(" between {lower} and {upper}");
                            let number = within([lower, upper], share());
                            (number, if number.is_nan() { source() } else { String::new() })
                        }
                    };
                    // Infinite values come from infinite ones only.
                    let overflows = || self.slots.iter().all(|&slot| before[slot].is_finite());
                    if new.is_nan() || new.is_infinite() && overflows() {
                        let expression =
                            format!("the new {}{source}", self.blueprint.coordinates[*coordinate]);
                        return Err(EvaluationError::NotANumber { expression });
                    }
                    changes.push((self.slots[*coordinate], new));
                }
            }
            Change::Function(function) => {
                let mut own = Vec::with_capacity(self.slots.len());
                self.gather(before, &self.slots, &mut own);
                function(&mut own)?;
                let places = self.slots.iter().zip(&own).zip(&self.owned);
                changes.extend(places.filter(|(_, owned)| **owned).map(|((&s, &x), _)| (s, x)));
            }
        }
        Ok(())
    }

    /// The coordinates as the component sees them.
    pub(super) fn gather(&self, values: &[f64], slots: &[usize], own: &mut Vec<f64>) {
        own.clear();
        own.extend(slots.iter().map(|&slot| values[slot]));
    }

    /// Writes back the coordinates that belong to the component.
    pub(super) fn scatter(&self, own: &[f64], slots: &[usize], values: &mut [f64]) {
        for ((&slot, &value), &owned) in slots.iter().zip(own).zip(&self.owned) {
            if owned {
                values[slot] = value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::within;

    #[test]
    fn shares_of_an_interval_lie_between_its_ends() {
        assert_eq!(within([2.0, 6.0], 0.25), 3.0);
        assert_eq!(within([-6.0, -2.0], 0.75), -3.0);
        for ends in [[0.1, 0.3], [-1e20, 1.0], [1.0, 1.0], [-0.7, 0.1], [1e-3, 1e9]] {
            let [lower, upper] = ends;
            assert_eq!(within(ends, 0.0), lower);
            assert_eq!(within(ends, 1.0), upper, "also where the width is rounded");
            for share in [0.1, 0.3, 0.999_999_999_999] {
                let number = within(ends, share);
                assert!((lower..=upper).contains(&number), "{number} of {ends:?}");
            }
        }
    }

    #[test]
    fn intervals_without_numbers_or_without_end_have_no_share() {
        for ends in [[2.0, 1.0], [0.0, f64::INFINITY], [f64::NEG_INFINITY, 0.0], [f64::NAN, 1.0]] {
            for share in [0.0, 0.5, 1.0] {
                assert!(within(ends, share).is_nan(), "{ends:?}");
            }
        }
    }
}
