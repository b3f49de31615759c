//! A composition as one automaton, for whatever asks questions of automata.

use std::collections::BTreeMap;

use pleach_discrete::Urgency;
use pleach_guards::{Expression, Predicate, Substitution, always, never, not, variable};
use thiserror::Error;

use super::sampler::{SAMPLING, TICKING};
use super::{Component, Composition};
use crate::automaton::Automaton;
use crate::builder::{BuildError, Builder};
use crate::check::model::{Effect, Model, Motion, Transition};
use crate::coordinates::Coordinate;
use crate::edge::from;
use crate::named::{Name, Record, RepeatedName};

/// How many locations a product may have.
const LOCATIONS: usize = 4096;

/// Why a composition is not written as one automaton.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ProductError {
    /// A flow or a reset is a function.
    #[error("component `{component}`: {part} is a function: write it as formulas")]
    Function {
        /// The component.
        component: String,
        /// What is one.
        part: String,
    },
    /// A component goes on past accumulations of its jumps, and automata end there.
    #[error(
        "component `{component}` goes on past an accumulation of its jumps, which no product does: \
         leave `past_accumulation` out"
    )]
    Accumulation {
        /// The component.
        component: String,
    },
    /// There are too many combinations of locations.
    #[error("the components can be in more than {LOCATIONS} combinations of locations")]
    Locations,
    /// Two coordinates have one name.
    #[error(transparent)]
    Names(#[from] RepeatedName),
    /// The parts do not make an automaton: a formula names what is no coordinate, for one.
    #[error("the product is no automaton: {0}")]
    Build(#[from] BuildError),
}

impl Composition {
    /// The composition as one automaton: its locations are the combinations of locations that
    /// components can come to by their transitions, its coordinates those of the composition. A label
    /// is one transition for each choice of transitions of its participants; it is forced if one of
    /// them is.
    ///
    /// Clocks that sample are coordinates. A clock of several events stands at the end of the names of locations, as in
    /// `on (ticking)` and `on (sampling warm)`: [`without_clocks`] is what they have in common. A sample passes where its
    /// event cannot be taken.
    ///
    /// Every run of the composition is one of the product. Where guards of several transitions on one
    /// label hold at once, of which a component takes the first, the product may take each.
    ///
    /// # Errors
    ///
    /// [`ProductError`] if a flow or a reset is a function, a formula rests on propositions, a component
    /// goes on [past an accumulation](crate::CompositionBuilder::past_accumulation) of its jumps, or
    /// there are too many combinations.
    pub fn product(&self) -> Result<Automaton<Name, Name, Record>, ProductError> {
        if let Some(one) = self.components.iter().find(|one| one.continuation.is_some()) {
            return Err(ProductError::Accumulation { component: one.name.clone() });
        }
        let product = Product::of(self)?;
        let state = Record::new(self.variables.iter().zip(self.initial.iter().copied()))?;
        let coordinates = state.coordinates();
        let first = product.name(&product.combinations[0]);
        let mut builder = Automaton::<Name, Name, Record>::starting_in(first).initially(state);
        for (name, formula) in self.signals() {
            builder = builder.signal(name, formula);
        }
        for combination in &product.combinations {
            builder = product.add_location(builder, combination, &coordinates)?;
        }
        for combination in &product.combinations {
            for jump in product.jumps(combination) {
                builder = product.add_transition(builder, combination, &jump, &coordinates)?;
            }
        }
        Ok(builder.build()?)
    }
}

/// The name of a location of a [product](Composition::product) without the clocks at its end: where the components
/// are, whatever is being sampled.
pub fn without_clocks(location: &str) -> &str {
    let is_of_clocks = |(_, clocks): &(&str, &str)| {
        clocks.ends_with(')') && (clocks.starts_with(TICKING) || clocks.starts_with(SAMPLING))
    };
    location.rsplit_once(" (").filter(is_of_clocks).map_or(location, |(own, _)| own)
}

/// The transitions that are taken together: components, and for each the number of its transition.
type Jump = Vec<(usize, usize)>;

struct Product<'a> {
    composition: &'a Composition,
    models: Vec<Model>,
    /// By component: from its own names to those of the composition.
    renamings: Vec<Substitution>,
    combinations: Vec<Vec<usize>>,
}

impl<'a> Product<'a> {
    fn of(composition: &'a Composition) -> Result<Self, ProductError> {
        let renaming = |component: &Component| {
            let own = component.blueprint.coordinates.iter().zip(&component.slots);
            Substitution::new(
                own.map(|(name, slot)| (*name, variable(&composition.variables[*slot]))),
            )
        };
        let mut product = Product {
            composition,
            models: composition.models(),
            renamings: composition.components.iter().map(renaming).collect(),
            combinations: Vec::new(),
        };
        product.enumerate()?;
        Ok(product)
    }

    /// Finds the combinations, the initial one first.
    fn enumerate(&mut self) -> Result<(), ProductError> {
        let initial: Vec<usize> = self.models.iter().map(|model| model.initial).collect();
        let mut known = BTreeMap::from([(initial.clone(), ())]);
        self.combinations.push(initial);
        let mut next = 0;
        while let Some(combination) = self.combinations.get(next).cloned() {
            for jump in self.jumps(&combination) {
                let target = self.target(&combination, &jump);
                if known.insert(target.clone(), ()).is_none() {
                    self.combinations.push(target);
                }
            }
            if self.combinations.len() > LOCATIONS {
                return Err(ProductError::Locations);
            }
            next += 1;
        }
        Ok(())
    }

    fn transition(&self, (component, number): (usize, usize)) -> &Transition {
        &self.models[component].transitions[number]
    }

    fn target(&self, combination: &[usize], jump: &Jump) -> Vec<usize> {
        let mut target = combination.to_vec();
        for &part in jump {
            target[part.0] = self.transition(part).target;
        }
        target
    }

    /// The jumps from a combination: of single components, then by labels.
    fn jumps(&self, combination: &[usize]) -> Vec<Jump> {
        let leaving =
            |component: usize| self.models[component].modes[combination[component]].leaving.iter();
        let mut jumps: Vec<Jump> = Vec::new();
        for (component, model) in self.models.iter().enumerate() {
            let own = leaving(component).filter(|number| model.is_own(**number));
            let is_possible = self.alone(combination, component) != never();
            jumps.extend(own.filter(|_| is_possible).map(|number| vec![(component, *number)]));
        }
        for label in 0..self.composition.labels.len() {
            jumps.extend(self.together(combination, label));
        }
        jumps
    }

    /// The jumps from a combination by a label.
    fn together(&self, combination: &[usize], label: usize) -> Vec<Jump> {
        let mut together: Vec<Jump> = vec![Vec::new()];
        for &(component, event) in &self.composition.labels[label].participants {
            let model = &self.models[component];
            let leaving = model.modes[combination[component]].leaving.iter();
            let joining = leaving.filter(|number| model.transitions[**number].event == event);
            let joining: Vec<usize> = joining.copied().collect();
            together = together
                .iter()
                .flat_map(|jump| {
                    joining.iter().map(move |number| [&jump[..], &[(component, *number)]].concat())
                })
                .collect();
        }
        together
    }

    /// When a transition may be taken, over variables of the composition.
    fn guard(&self, (component, number): (usize, usize)) -> Predicate {
        let guard = self.transition((component, number)).guard.predicate();
        guard.substitute(&self.renamings[component])
    }

    /// What has to hold for a component to jump by itself: a clock lets a sample pass where it cannot be taken.
    fn alone(&self, combination: &[usize], component: usize) -> Predicate {
        let Some((_, labels)) = &self.composition.components[component].sampling else {
            return always();
        };
        let sampled = self.together(combination, labels[combination[component]]);
        let possible = sampled.into_iter().map(|jump| {
            let others = jump.into_iter().filter(|(other, _)| *other != component);
            Predicate::all(others.map(|part| self.guard(part)))
        });
        let possible: Vec<Predicate> = possible.collect();
        let is_sure = possible.contains(&always());
        if is_sure { never() } else { not(Predicate::any(possible)).negation_normal_form() }
    }

    /// Where time passes in a location of a component: of a clock, until a sample is due.
    fn invariant(&self, component: usize, mode: usize) -> Predicate {
        let invariant = self.models[component].modes[mode].invariant.clone();
        let sampling = self.composition.components[component].sampling.as_ref();
        let until_due = sampling.map(|(sampling, _)| sampling.until_due(mode));
        Predicate::all([invariant].into_iter().chain(until_due))
            .substitute(&self.renamings[component])
    }

    fn name(&self, combination: &[usize]) -> Name {
        let parts = self.composition.components.iter().zip(combination);
        let (clocks, own): (Vec<_>, Vec<_>) =
            parts.partition(|(component, _)| component.sampling.is_some());
        let named = |parts: &[(&Component, &usize)]| {
            let names = parts.iter().map(|(component, mode)| component.mode(**mode).name);
            names.collect::<Vec<_>>().join(", ")
        };
        // A clock of one event has one location.
        let is_shared = |(component, _): &(&Component, _)| component.blueprint.modes.len() > 1;
        let clocks: Vec<_> = clocks.into_iter().filter(is_shared).collect();
        Name::new(&match clocks.is_empty() {
            true => named(&own),
            false => format!("{} ({})", named(&own), named(&clocks)),
        })
    }

    fn function(&self, component: usize, part: &str) -> ProductError {
        let component = self.composition.components[component].name.clone();
        ProductError::Function { component, part: part.to_owned() }
    }

    /// The coordinate that a component calls `name`.
    fn coordinate<'c>(
        &self,
        component: usize,
        name: &str,
        coordinates: &'c [Coordinate<Record>],
    ) -> Option<&'c Coordinate<Record>> {
        let component = &self.composition.components[component];
        let place = component.blueprint.coordinates.iter().position(|own| *own == name)?;
        coordinates.get(component.slots[place])
    }

    fn add_location(
        &self,
        mut builder: Builder<Name, Name, Record>,
        combination: &[usize],
        coordinates: &[Coordinate<Record>],
    ) -> Result<Builder<Name, Name, Record>, ProductError> {
        let name = self.name(combination);
        let (mut rates, mut invariant) = (Vec::new(), Vec::new());
        for (component, number) in combination.iter().enumerate() {
            let mode = &self.models[component].modes[*number];
            let renaming = &self.renamings[component];
            let Motion::Rates(listed) = &mode.motion else {
                return Err(self.function(component, &format!("the flow of `{}`", mode.name)));
            };
            for (own, rate) in listed {
                if let Some(coordinate) = self.coordinate(component, own, coordinates) {
                    rates.push(coordinate.rate(rate.substitute(renaming)));
                }
            }
            invariant.push(self.invariant(component, *number));
        }
        builder = builder.flow(name, rates);
        let invariant = Predicate::all(invariant);
        Ok(if invariant == pleach_guards::always() {
            builder
        } else {
            builder.invariant(name, invariant)
        })
    }

    fn add_transition(
        &self,
        builder: Builder<Name, Name, Record>,
        combination: &[usize],
        jump: &Jump,
        coordinates: &[Coordinate<Record>],
    ) -> Result<Builder<Name, Name, Record>, ProductError> {
        let (mut guards, mut values, mut urgency) = (Vec::new(), Vec::new(), Urgency::May);
        for &(component, number) in jump {
            let transition = self.transition((component, number));
            let renaming = &self.renamings[component];
            let renamed = |formula: &Expression| formula.substitute(renaming);
            guards.push(self.guard((component, number)));
            urgency = match (urgency, transition.urgency) {
                (Urgency::AtOnce, _) | (_, Urgency::AtOnce) => Urgency::AtOnce,
                (Urgency::Must, _) | (_, Urgency::Must) => Urgency::Must,
                _ => Urgency::May,
            };
            let Effect::Assignments(assignments) = &transition.effect else {
                let event = &self.composition.components[component].events[transition.event];
                return Err(self.function(component, &format!("the reset of `{event}`")));
            };
            let between = |name: &String| {
                transition.intervals.iter().find(|(own, _)| own == name).map(|(_, ends)| ends)
            };
            for (own, value) in assignments {
                let Some(coordinate) = self.coordinate(component, own, coordinates) else {
                    continue;
                };
                values.push(match between(own) {
                    Some([lower, upper]) => {
                        coordinate.becomes_within(renamed(lower), renamed(upper))
                    }
                    None => coordinate.becomes(renamed(value)),
                });
            }
        }
        let (component, number) = jump[0];
        if jump.len() == 1 {
            guards.push(self.alone(combination, component));
        }
        let event = self.transition((component, number)).event;
        let event = Name::new(&self.composition.components[component].events[event]);
        let target = self.name(&self.target(combination, jump));
        let arrow = from(self.name(combination)).on(event).to(target);
        let guard = Predicate::all(guards);
        let edge = match urgency {
            Urgency::May => arrow.may(guard),
            Urgency::Must => arrow.must(guard),
            Urgency::AtOnce => arrow.at_once(guard),
        };
        Ok(builder.transition(edge.then(values)))
    }
}

#[cfg(test)]
mod tests {
    use pleach_discrete::vocabulary;

    use super::*;

    vocabulary! {
        enum Lamp: Location { Off = "off", On = "on" }
        enum Press: Event { Press = "press" }
    }

    #[test]
    fn a_product_may_have_all_its_locations_and_not_one_more() {
        let switch = Automaton::starting_in(Lamp::Off)
            .initially(())
            .transition(from(Lamp::Off).on(Press::Press).to(Lamp::On).may(always()))
            .build()
            .expect("it is sound");
        let combinations = |count: u32| {
            let names = (0..count).map(|number| number.to_string());
            let switches = Composition::builder().add_each(names, &switch).build();
            let switches = switches.expect("the names differ");
            Product::of(&switches).map(|product| product.combinations.len())
        };
        assert_eq!(combinations(5).ok(), Some(32));
        assert_eq!(combinations(LOCATIONS.ilog2()).ok(), Some(LOCATIONS));
        let more = combinations(LOCATIONS.ilog2() + 1);
        assert!(matches!(more, Err(ProductError::Locations)), "{more:?}");
    }
}
