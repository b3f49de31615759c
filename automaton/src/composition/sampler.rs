//! Clocks that sample: components that make others take an event at even intervals.

use super::builder::{CompositionBuilder, CompositionError};
use crate::automaton::Automaton;
use crate::coordinates::Coordinate;
use crate::edge::from;
use crate::named::{Name, Record, kept};

/// When an event is taken.
pub(super) struct Sampler {
    /// `component.event`
    pub(super) event: String,
    pub(super) sampling: Sampling,
    /// Whether the event may be impossible at a sample, which then passes.
    pub(super) misses: bool,
}

/// At which instants something is sampled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampling {
    /// In seconds.
    pub(crate) period: f64,
    /// When it is sampled first.
    pub(crate) phase: f64,
}

/// The time since the last sample.
const CLOCK: &str = "τ";
/// A sample at which the event cannot be taken.
const MISSED: &str = "missed";

impl Sampler {
    /// The clock as a component, joined by `label`.
    pub(super) fn join(
        &self,
        builder: CompositionBuilder,
        label: &str,
    ) -> Result<CompositionBuilder, CompositionError> {
        let Sampler { event, sampling, misses } = self;
        let Sampling { period, phase } = *sampling;
        let refuse = |reason| CompositionError::Sampler { event: event.clone(), reason };
        if !(period.is_finite() && period > 0.0) {
            return Err(refuse("its period has to be a finite time above 0"));
        }
        if !(phase.is_finite() && phase >= 0.0) {
            return Err(refuse("its phase has to be a finite time of at least 0"));
        }
        let (ticking, sample) = (Name::new("ticking"), Name::new(label));
        let clock = Coordinate::<Record>::new(kept(CLOCK));
        let state =
            Record::new([(CLOCK, period - phase)]).map_err(|_| refuse("it has two clocks"))?;
        let tick = |event: Name| {
            let due = from(ticking).on(event).to(ticking).must(clock.at_least(period));
            due.then(clock.becomes(0.0))
        };
        let mut automaton = Automaton::<Name, Name, Record>::starting_in(ticking)
            .initially(state)
            .flow(ticking, clock.rate(1.0))
            .transition(tick(sample));
        if *misses {
            automaton = automaton.transition(tick(Name::new(MISSED)).priority(1));
        }
        let automaton =
            automaton.build().map_err(|_| refuse("its event cannot be taken by a clock"))?;
        Ok(builder.add(&format!("clock of {event}"), &automaton).label(label))
    }
}
