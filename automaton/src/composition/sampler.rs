//! Clocks that sample: components that make others take events at even intervals.

use pleach_guards::{Predicate, always, variable};

use super::builder::{CompositionBuilder, CompositionError};
use super::{Composition, SimulationError};
use crate::automaton::Automaton;
use crate::coordinates::Coordinate;
use crate::edge::from;
use crate::named::{Name, Record, kept};

/// An event that is to be sampled.
pub(super) struct Sampler {
    /// `component.event`
    pub(super) event: String,
    pub(super) sampling: Sampling,
}

/// At which instants something is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sampling {
    /// In seconds.
    pub(crate) period: f64,
    /// When it is sampled first.
    pub(crate) phase: f64,
}

/// A clock that samples events of one component, one after the other at each of its instants: in its location of that
/// number it waits for the label, and takes it or, where it cannot be taken, lets it pass.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    pub(super) sampling: Sampling,
    pub(super) samples: Vec<Sample>,
    /// Whether the component itself has it.
    pub(super) is_own: bool,
    /// The number of the component.
    pub(super) sampled: usize,
}

/// A label that a clock samples.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub(super) label: String,
    /// Whether it may be impossible, so that the sample passes.
    pub(super) may_pass: bool,
}

/// The time since the last sample.
const CLOCK: &str = "τ";
/// A sample at which the event cannot be taken.
const MISSED: &str = "missed";
/// Where a clock waits for its instant.
pub(super) const TICKING: &str = "ticking";
/// Where it waits for a further event at that instant, whose name follows.
pub(super) const SAMPLING: &str = "sampling ";

impl Clock {
    /// The clock as a component, joined by its labels.
    pub(super) fn join(
        &self,
        builder: CompositionBuilder,
    ) -> Result<CompositionBuilder, CompositionError> {
        let Sampling { period, phase } = self.sampling;
        let events: Vec<&str> = self.samples.iter().map(|sample| &*sample.label).collect();
        let events = events.join(" and ");
        let refuse = |reason: &str| {
            let (event, reason) = (events.clone(), reason.to_owned());
            CompositionError::Sampler { event, reason }
        };
        if self.samples.iter().any(|sample| sample.label == MISSED) {
            return Err(refuse("clocks call a sample that passes so: rename the event"));
        }
        let places: Vec<Name> = (0..self.samples.len()).map(|place| self.place(place)).collect();
        let clock = Coordinate::<Record>::new(kept(CLOCK));
        let state =
            Record::new([(CLOCK, period - phase)]).map_err(|_| refuse("it has two clocks"))?;
        let mut automaton = Automaton::<Name, Name, Record>::starting_in(places[0])
            .initially(state)
            .throughout([clock.rate(1.0)]);
        for (number, Sample { label, may_pass }) in self.samples.iter().enumerate() {
            let next = (number + 1) % places.len();
            let take = |event: &str| {
                let arrow = from(places[number]).on(Name::new(event)).to(places[next]);
                match number {
                    0 => arrow.must(clock.at_least(period)).then(clock.becomes(0.0)),
                    _ => arrow.at_once(always()),
                }
            };
            automaton = automaton.transition(take(label));
            if *may_pass {
                automaton = automaton.transition(take(MISSED).priority(1));
            }
        }
        let automaton =
            automaton.build().map_err(|_| refuse("its event cannot be taken by a clock"))?;
        let labels = self.samples.iter().map(|sample| &*sample.label);
        Ok(labels.fold(
            builder.add_joint(&format!("clock of {events}"), &automaton),
            CompositionBuilder::label,
        ))
    }

    /// The location in which it waits for a sample.
    fn place(&self, number: usize) -> Name {
        match number {
            0 => Name::new(TICKING),
            _ => Name::new(&format!("{SAMPLING}{}", self.samples[number].label)),
        }
    }
}

impl Sampling {
    /// What is wrong with it, and what would be right.
    pub(crate) fn fault(self) -> Option<String> {
        let Sampling { period, phase } = self;
        if !(period.is_finite() && period > 0.0) {
            return Some(format!("its period is {period} s: it has to be finite and above 0"));
        }
        let has_phase = phase.is_finite() && phase >= 0.0;
        (!has_phase).then(|| format!("its phase is {phase} s: it has to be finite and at least 0"))
    }

    /// In which states of a clock time passes where it waits for the sample of that number: until it is due.
    pub(super) fn until_due(self, number: usize) -> Predicate {
        variable(CLOCK).at_most(if number == 0 { self.period } else { 0.0 })
    }
}

/// Whether time advances by this period at a horizon, if that is above 0.
pub(super) fn advances(horizon: f64, period: f64) -> bool {
    !(horizon > 0.0 && horizon + period == horizon)
}

impl Composition {
    /// Whether time advances from one sample to the next, up to a horizon.
    ///
    /// # Errors
    ///
    /// [`SimulationError::Sampling`] with the first clock for which it does not.
    pub(super) fn check_samplings(&self, horizon: f64) -> Result<(), SimulationError> {
        for component in &self.components {
            if let Some((Sampling { period, .. }, _)) = component.sampling
                && !advances(horizon, period)
            {
                let clock = component.name.clone();
                return Err(SimulationError::Sampling { clock, period, horizon });
            }
        }
        Ok(())
    }
}
