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
    /// In seconds.
    pub(super) period: f64,
    /// When it is taken first.
    pub(super) phase: f64,
}

/// The time since the last sample.
const CLOCK: &str = "τ";

impl Sampler {
    /// The clock as a component, joined by `label`.
    pub(super) fn join(
        &self,
        builder: CompositionBuilder,
        label: &str,
    ) -> Result<CompositionBuilder, CompositionError> {
        let Sampler { event, period, phase } = self;
        let refuse = |reason| CompositionError::Sampler { event: event.clone(), reason };
        if !(period.is_finite() && *period > 0.0) {
            return Err(refuse("its period has to be a finite time above 0"));
        }
        if !(phase.is_finite() && *phase >= 0.0) {
            return Err(refuse("its phase has to be a finite time of at least 0"));
        }
        let (ticking, sample) = (Name::new("ticking"), Name::new(label));
        let clock = Coordinate::<Record>::new(kept(CLOCK));
        let state =
            Record::new([(CLOCK, period - phase)]).map_err(|_| refuse("it has two clocks"))?;
        let automaton = Automaton::<Name, Name, Record>::starting_in(ticking)
            .initially(state)
            .flow(ticking, clock.rate(1.0))
            .transition(
                from(ticking)
                    .on(sample)
                    .to(ticking)
                    .must(clock.at_least(*period))
                    .then(clock.becomes(0.0)),
            )
            .build()
            .map_err(|_| refuse("its event cannot be taken by a clock"))?;
        Ok(builder.add(&format!("clock of {event}"), &automaton).label(label))
    }
}
