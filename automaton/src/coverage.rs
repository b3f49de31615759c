//! Coverage: how much of a model a set of runs has been through.
//!
//! A test of a hybrid system is as good as the situations that it leads into. [`Coverage`] counts,
//! for every component of a composition and over any number of trajectories,
//!
//! * how often each **location** was entered, the initial one included;
//! * how often each **transition** was taken;
//! * which **location pairs** (source, target) were passed, of those that transitions join;
//! * on which **sides of the boundaries** of the guards the samples lay: a comparison of a guard is
//!   seen on both sides if it was true in one sample and false in another while the source of the
//!   transition was active. Of programs one calls this condition coverage (Myers, Sandler and
//!   Badgett 2011, *The Art of Software Testing*, ch. 4).
//!
//! ```
//! use pleach_automaton::{coordinates, diagram, from, Automaton, Coverage};
//! use pleach_discrete::vocabulary;
//!
//! vocabulary! {
//!     enum Heater: Location { Off = "off", On = "on" }
//!     enum Sensed: Event { Cold = "cold", Warm = "warm" }
//! }
//! coordinates! { struct Room { temperature = "T" } }
//! let Room { temperature } = Room::coordinates();
//! let heater = Automaton::starting_in(Heater::Off)
//!     .initially(Room { temperature: 20.0 })
//!     .flow(Heater::Off, temperature.rate(-1.0))
//!     .flow(Heater::On, temperature.rate(2.0))
//!     .transition(from(Heater::Off).on(Sensed::Cold).to(Heater::On).must(temperature.at_most(18.0)))
//!     .transition(from(Heater::On).on(Sensed::Warm).to(Heater::Off).must(temperature.at_least(22.0)))
//!     .build()?;
//!
//! let mut coverage = Coverage::of_automaton(&heater)?;
//! coverage.add(&heater.run(3.0)?)?;
//!
//! let heater_coverage = &coverage.components()[0];
//! assert_eq!(heater_coverage.transitions()[0].taken(), 1);
//! assert_eq!(heater_coverage.transitions()[1].taken(), 0);
//! assert!(!coverage.is_complete());
//! assert!(diagram::coverage_svg(&heater, heater_coverage).contains("never taken"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod parts;
mod report;
pub(crate) mod tally;

use pleach_discrete::{Event, Location};
use pleach_guards::EvaluationError;
use thiserror::Error;

use crate::automaton::Automaton;
use crate::composition::Composition;
use crate::coordinates::Coordinates;
use crate::diagram::sketch::Sketch;
use crate::trajectory::{FlowInterval, Trajectory};
use parts::Parts;

pub use parts::{BoundaryCoverage, LocationCoverage, TransitionCoverage};

/// What runs of a composition have been through; see the [module](self).
#[derive(Clone, Debug)]
pub struct Coverage {
    components: Vec<ComponentCoverage>,
    runs: usize,
}

/// What runs have been through in one component.
#[derive(Clone, Debug)]
pub struct ComponentCoverage {
    name: String,
    locations: Vec<LocationCoverage>,
    /// By source and, for each, in their total order.
    transitions: Vec<TransitionCoverage>,
    /// By coordinate: where its value is in a sample.
    slots: Vec<usize>,
}

/// A trajectory does not determine the coverage of a composition.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CoverageError {
    /// The trajectory has other components, locations or variables.
    #[error("the trajectory is of another composition: its {part} differ")]
    OtherComposition {
        /// What differs: components, locations, variables or transitions.
        part: &'static str,
    },
    /// A guard has no value in a sample.
    #[error("component `{component}`: {source}")]
    Guard {
        /// The component.
        component: String,
        /// What is wrong with the guard.
        source: EvaluationError,
    },
}

impl Coverage {
    /// Nothing of `composition` is covered yet.
    ///
    /// # Errors
    ///
    /// [`CoverageError::Guard`] if a guard names a variable that the component does not have.
    pub fn of(composition: &Composition) -> Result<Coverage, CoverageError> {
        let components = composition.components.iter().map(|component| {
            let Parts { locations, transitions } =
                Parts::of(&component.blueprint, &component.events)
                    .map_err(|source| guard_error(&component.name, source))?;
            let (name, slots) = (component.name.clone(), component.slots.clone());
            Ok(ComponentCoverage { name, locations, transitions, slots })
        });
        Ok(Coverage { components: components.collect::<Result<_, _>>()?, runs: 0 })
    }

    /// Nothing of `automaton`, which runs by itself, is covered yet.
    ///
    /// # Errors
    ///
    /// As for [`of`](Self::of).
    pub fn of_automaton<L: Location, E: Event, S: Coordinates>(
        automaton: &Automaton<L, E, S>,
    ) -> Result<Coverage, CoverageError> {
        const NAME: &str = "automaton";
        let failed = |source| guard_error(NAME, source);
        let blueprint = automaton.blueprint(&[]).map_err(failed)?;
        let events: Vec<String> = blueprint.events.iter().map(ToString::to_string).collect();
        let Parts { locations, transitions } = Parts::of(&blueprint, &events).map_err(failed)?;
        let slots = (0..automaton.names().len()).collect();
        let component = ComponentCoverage { name: NAME.into(), locations, transitions, slots };
        Ok(Coverage { components: vec![component], runs: 0 })
    }

    /// Adds what `trajectory` has been through.
    ///
    /// # Errors
    ///
    /// [`CoverageError`] if the trajectory is of something else, or a guard has no value in one of
    /// its samples; the coverage is then as before.
    pub fn add(&mut self, trajectory: &Trajectory) -> Result<(), CoverageError> {
        let mut components = self.components.clone();
        self.check(trajectory)?;
        for (number, component) in components.iter_mut().enumerate() {
            component.enter_initial(trajectory, number);
            for phase in trajectory.intervals() {
                component.see(&phase, number)?;
            }
        }
        for one in trajectory.jumps().iter().flat_map(|jump| &jump.moves) {
            let component = components.get_mut(one.component);
            let component =
                component.ok_or(CoverageError::OtherComposition { part: "components" })?;
            component.take(one.source, one.target, one.transition)?;
        }
        self.components = components;
        self.runs += 1;
        Ok(())
    }

    /// The components in their order.
    pub fn components(&self) -> &[ComponentCoverage] {
        &self.components
    }

    /// How many trajectories have been added.
    pub fn runs(&self) -> usize {
        self.runs
    }

    /// Whether every location, transition and side of a boundary is covered.
    pub fn is_complete(&self) -> bool {
        self.components.iter().all(|component| {
            let counts = component.counts();
            counts.iter().all(|(_, covered, all)| covered == all)
        })
    }

    fn check(&self, trajectory: &Trajectory) -> Result<(), CoverageError> {
        let other = |part| Err(CoverageError::OtherComposition { part });
        let theirs = trajectory.components();
        if theirs.len() != self.components.len()
            || theirs.iter().zip(&self.components).any(|(their, own)| their.name != own.name)
        {
            return other("components");
        }
        for (their, own) in theirs.iter().zip(&self.components) {
            let names = own.locations.iter().map(|location| location.name);
            if !their.locations.iter().map(String::as_str).eq(names) {
                return other("locations");
            }
        }
        let slots = self.components.iter().flat_map(|component| &component.slots);
        let width = slots.max().map_or(0, |largest| largest + 1);
        if width == trajectory.variables().len() { Ok(()) } else { other("variables") }
    }
}

impl ComponentCoverage {
    /// The name of the component.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The locations in their order.
    pub fn locations(&self) -> &[LocationCoverage] {
        &self.locations
    }

    /// The transitions by their source and, for each, in their total order.
    pub fn transitions(&self) -> &[TransitionCoverage] {
        &self.transitions
    }

    /// The pairs of source and target that transitions join, by source and target, and how often
    /// each was passed.
    pub fn pairs(&self) -> Vec<(&'static str, &'static str, usize)> {
        let mut pairs: Vec<(usize, usize, usize)> = Vec::new();
        for transition in &self.transitions {
            let ends = (transition.source, transition.target);
            match pairs.iter_mut().find(|(source, target, _)| (*source, *target) == ends) {
                Some((.., passed)) => *passed += transition.taken,
                None => pairs.push((ends.0, ends.1, transition.taken)),
            }
        }
        pairs.sort_unstable();
        let name = |location: usize| self.locations[location].name;
        pairs.iter().map(|&(source, target, passed)| (name(source), name(target), passed)).collect()
    }

    /// What there is to cover, with how much of it is covered and how much there is.
    pub fn counts(&self) -> [(&'static str, usize, usize); 4] {
        let count = |what, covered: &mut dyn Iterator<Item = bool>| {
            let (mut reached, mut all) = (0, 0);
            for is_covered in covered {
                reached += usize::from(is_covered);
                all += 1;
            }
            (what, reached, all)
        };
        let boundaries = || self.transitions.iter().flat_map(|transition| &transition.boundaries);
        [
            count("locations", &mut self.locations.iter().map(|location| location.entered > 0)),
            count("transitions", &mut self.transitions.iter().map(|one| one.taken > 0)),
            count("location pairs", &mut self.pairs().iter().map(|(.., passed)| *passed > 0)),
            count(
                "sides of boundaries",
                &mut boundaries().flat_map(|one| [one.held > 0, one.failed > 0]),
            ),
        ]
    }

    /// Marks what is left out, for diagrams.
    pub(crate) fn mark(&self, sketch: &mut Sketch) {
        for (mode, location) in sketch.modes.iter_mut().zip(&self.locations) {
            mode.is_missed = location.entered == 0;
        }
        for link in &mut sketch.links {
            let same =
                |one: &&TransitionCoverage| (one.source, one.rank) == (link.source, link.rank);
            link.is_missed = self.transitions.iter().find(same).is_none_or(|one| one.taken == 0);
        }
    }

    fn enter_initial(&mut self, trajectory: &Trajectory, number: usize) {
        let first = trajectory.initial.get(number);
        if let Some(location) = first.and_then(|&first| self.locations.get_mut(first)) {
            location.entered += 1;
        }
    }

    /// Looks at the guards of the transitions that leave the location of this phase.
    fn see(&mut self, phase: &FlowInterval, number: usize) -> Result<(), CoverageError> {
        let ComponentCoverage { name, transitions, slots, .. } = self;
        let here = phase.locations[number];
        for transition in transitions.iter_mut().filter(|transition| transition.source == here) {
            for boundary in &mut transition.boundaries {
                for sample in &phase.samples {
                    let verdict = boundary.condition.evaluate_at(&sample.values, slots);
                    let verdict = verdict.map_err(|source| guard_error(name, source))?;
                    let side =
                        if verdict.holds { &mut boundary.held } else { &mut boundary.failed };
                    *side += 1;
                }
            }
        }
        Ok(())
    }

    fn take(&mut self, source: usize, target: usize, rank: usize) -> Result<(), CoverageError> {
        let mut transitions = self.transitions.iter_mut();
        let transition = transitions
            .find(|one| (one.source, one.target, one.rank) == (source, target, rank))
            .ok_or(CoverageError::OtherComposition { part: "transitions" })?;
        transition.taken += 1;
        self.locations[target].entered += 1;
        Ok(())
    }
}

fn guard_error(component: &str, source: EvaluationError) -> CoverageError {
    CoverageError::Guard { component: component.to_owned(), source }
}
