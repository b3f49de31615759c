//! The transitions of a product: of one component, and of those that share a label.

use std::collections::BTreeMap;

use super::clause::predicate;
use super::{Product, Result};
use crate::automaton::{Builder, Coordinate, Name, Record, from};
use crate::guards::Predicate;
use crate::spaceex::SpaceExError;
use crate::spaceex::document::Transition;
use crate::spaceex::network::{Assigned, Bound, Instance};

impl Product<'_> {
    /// The transitions from one location: one by one, and together by labels.
    pub(super) fn add_transitions(
        &self,
        mut builder: Builder<Name, Name, Record>,
        source: usize,
        coordinates: &BTreeMap<String, Coordinate<Record>>,
    ) -> Result<Builder<Name, Name, Record>> {
        let tuple = &self.tuples[source];
        for (at, instance) in self.network.instances.iter().enumerate() {
            for transition in leaving(instance, tuple[at]) {
                let label = self.label(instance, transition);
                let partners: Vec<usize> = match &label {
                    Some(label) => self.knowing(label),
                    None => vec![at],
                };
                // Of those who take a label together, the first speaks for all.
                if partners.first() != Some(&at) {
                    continue;
                }
                let mut together = vec![vec![(at, transition)]];
                for &partner in &partners[1..] {
                    let other = &self.network.instances[partner];
                    let joining: Vec<&Transition> = leaving(other, tuple[partner])
                        .filter(|one| self.label(other, one) == label)
                        .collect();
                    together = together
                        .iter()
                        .flat_map(|group| {
                            joining.iter().map(move |one| [&group[..], &[(partner, *one)]].concat())
                        })
                        .collect();
                }
                for group in together {
                    let label = label.as_deref();
                    builder = self.add_joint(builder, source, &group, label, coordinates)?;
                }
            }
        }
        Ok(builder)
    }

    fn label(&self, instance: &Instance<'_>, transition: &Transition) -> Option<String> {
        let label = transition.label.content.trim();
        instance.global(label).map(str::to_owned)
    }

    /// The instances that know a label.
    fn knowing(&self, label: &str) -> Vec<usize> {
        let knows = |instance: &Instance<'_>| {
            instance.names.values().any(|bound| *bound == Bound::Name(label.to_owned()))
        };
        let instances = self.network.instances.iter().enumerate();
        instances.filter(|(_, instance)| knows(instance)).map(|(at, _)| at).collect()
    }

    fn add_joint(
        &self,
        builder: Builder<Name, Name, Record>,
        source: usize,
        group: &[(usize, &Transition)],
        label: Option<&str>,
        coordinates: &BTreeMap<String, Coordinate<Record>>,
    ) -> Result<Builder<Name, Name, Record>> {
        let mut target = self.tuples[source].clone();
        let shares = self.of_shares(source);
        let (mut guard, mut assignments, mut is_urgent) = (Vec::new(), Vec::new(), false);
        for (at, transition) in group {
            let instance = &self.network.instances[*at];
            let wrong = |problem: String| SpaceExError::Model { line: transition.line, problem };
            let places = &instance.component.locations;
            let place = places.iter().position(|place| place.id == transition.target);
            target[*at] = place.ok_or_else(|| {
                wrong(format!("there is no location with id {}", transition.target))
            })?;
            is_urgent |= transition.is_urgent;
            for clause in instance.clauses(&transition.guard)? {
                let wrong = |problem| SpaceExError::Model { line: transition.guard.line, problem };
                guard.extend(predicate(&clause).map_err(wrong)?);
            }
            for (name, assigned) in instance.assignments(transition)? {
                let coordinate = coordinates
                    .get(&name)
                    .ok_or_else(|| wrong(format!("`{name}` cannot be assigned")))?;
                assignments.push(match assigned {
                    Assigned::Value(value) => coordinate.becomes(value.substitute(&shares)),
                    Assigned::Within(Some(lower), Some(upper)) => coordinate
                        .becomes_within(lower.substitute(&shares), upper.substitute(&shares)),
                    Assigned::Within(..) => {
                        return Err(wrong(format!("`{name}'` is not bounded from both sides")));
                    }
                });
            }
        }
        let target = self.tuples.iter().position(|other| *other == target).unwrap_or(source);
        let event = Name::new(label.unwrap_or("jump"));
        let arrow = from(self.names[source]).on(event).to(self.names[target]);
        let guard = Predicate::all(guard).substitute(&shares);
        let edge = if is_urgent { arrow.must(guard) } else { arrow.may(guard) };
        Ok(builder.transition(edge.then(assignments)))
    }
}

/// The transitions that leave a place.
fn leaving<'a>(instance: &Instance<'a>, place: usize) -> impl Iterator<Item = &'a Transition> {
    let id = &instance.component.locations[place].id;
    instance.component.transitions.iter().filter(move |transition| transition.source == *id)
}
