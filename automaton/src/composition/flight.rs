//! The way from one jump to the next: the flow of all components together, up to the first instant
//! at which a transition has to be taken or an invariant ends.

use pleach_continuous::flow::{ConstantFlow, Curve, Integrator, LinearFlow, Onset, first_instant};
use pleach_guards::Verdict;

use super::field::{Field, Kind, Overlaid};
use super::simulation::{Failure, Simulation};
use crate::trajectory::Sample;

/// A flow that has been looked at in advance.
pub(super) struct Flight {
    /// How long it takes, in seconds.
    pub(super) duration: f64,
    /// Whether something happens at its end; otherwise it ends at the horizon.
    pub(super) is_eventful: bool,
    /// From the start to the end, both included; times count from the start of the flow.
    pub(super) samples: Vec<Sample>,
}

/// Samples per time scale of a linear flow: enough that the cubics between them agree with it to
/// the width of a line.
const SAMPLES_PER_SCALE: f64 = 16.0;
/// The most samples that a linear flow is recorded with.
const MOST_SAMPLES: f64 = 1000.0;

impl Simulation<'_> {
    /// The flow from here on, up to an event and for at most `limit` seconds.
    pub(super) fn plan(&self, limit: f64) -> Result<Flight, Failure> {
        let field = Field::of(self.composition, &self.locations, &self.values);
        if !self.invariants(&self.values)?.holds {
            return Ok(field.no_time());
        }
        match field.kind() {
            Kind::Constant(rates) => {
                let curve = ConstantFlow::new(&rates, &self.values, limit)
                    .map_err(|fault| self.failure(fault.to_string()))?;
                self.follow(&field, curve, limit)
            }
            Kind::Linear(matrix, offset) => {
                let curve = LinearFlow::new(&matrix, offset.as_slice(), &self.values, limit)
                    .map_err(|fault| self.failure(fault.to_string()))?;
                self.follow(&field, curve, limit)
            }
            Kind::General => self.integrate(&field, limit),
        }
    }

    /// A flow that is known as a whole.
    fn follow(&self, field: &Field<'_>, curve: impl Curve, limit: f64) -> Result<Flight, Failure> {
        let curve = Overlaid { curve, field };
        let onset = match self.look(&curve) {
            Ok(onset) => onset,
            Err(failure) => return self.fail_on(field, &curve, vec![field.at_start()], failure),
        };
        let end = onset.map_or(limit, |onset| onset.time);
        let most = (end / curve.time_scale(0.0) * SAMPLES_PER_SCALE).min(MOST_SAMPLES);
        let pieces = if most > 1.0 { most.ceil() } else { 1.0 };
        let mut number = 0.0;
        let mut samples = Vec::new();
        while number < pieces {
            samples.push(field.sample(&curve, end * number / pieces));
            number += 1.0;
        }
        self.land(field, &curve, samples, onset, limit)
    }

    /// A flow that is known step by step.
    fn integrate(&self, field: &Field<'_>, limit: f64) -> Result<Flight, Failure> {
        let rates = |time: f64, state: &[f64], rates: &mut [f64]| field.rates(time, state, rates);
        let mut integrator = Integrator::new(&rates, 0.0, &self.values, self.settings.tolerances());
        let mut samples = vec![field.at_start()];
        loop {
            let step = match integrator.step(limit) {
                Ok(step) => Overlaid { curve: step, field },
                Err(fault) => return self.cut_short(samples, self.failure(fault.to_string())),
            };
            let onset = match self.look(&step) {
                Ok(onset) => onset,
                Err(failure) => return self.fail_on(field, &step, samples, failure),
            };
            if onset.is_some() || step.end() >= limit {
                return self.land(field, &step, samples, onset, limit);
            }
            samples.push(field.sample(&step, step.end()));
        }
    }

    /// Goes as far on the curve as every formula has a value; the run fails there and not before.
    fn fail_on(
        &self,
        field: &Field<'_>,
        curve: &impl Curve,
        mut samples: Vec<Sample>,
        failure: Failure,
    ) -> Result<Flight, Failure> {
        let (mut defined, mut undefined) = (curve.start(), curve.end());
        let mut state = vec![0.0; curve.dimension()];
        loop {
            let middle = defined + (undefined - defined) / 2.0;
            if middle <= defined || middle >= undefined {
                break;
            }
            curve.state_at(middle, &mut state);
            if self.tension(&state).is_ok() { defined = middle } else { undefined = middle }
        }
        if defined > curve.start() {
            samples.retain(|sample| sample.t < defined);
            samples.push(field.sample(curve, defined));
        }
        self.cut_short(samples, failure)
    }

    /// The flow up to the last sample, beyond which it fails; if that changes no clock, the failure.
    fn cut_short(&self, samples: Vec<Sample>, failure: Failure) -> Result<Flight, Failure> {
        match samples.last() {
            Some(last) if self.now.t + last.t > self.now.t => {
                Ok(Flight { duration: last.t, is_eventful: true, samples })
            }
            _ => Err(failure),
        }
    }

    /// The first instant on the curve at which something has to happen.
    fn look(&self, curve: &impl Curve) -> Result<Option<Onset>, Failure> {
        let search = self.settings.search();
        first_instant(curve, curve.start(), curve.end(), &search, &mut |state| self.tension(state))
    }

    /// Ends the flow on the side of the event on which a transition can be taken; if none can and
    /// an invariant ends, on the side on which it still holds.
    fn land(
        &self,
        field: &Field<'_>,
        curve: &impl Curve,
        mut samples: Vec<Sample>,
        onset: Option<Onset>,
        limit: f64,
    ) -> Result<Flight, Failure> {
        let Some(onset) = onset else {
            samples.push(field.sample(curve, limit));
            return Ok(Flight { duration: limit, is_eventful: false, samples });
        };
        let beyond = field.sample(curve, onset.time);
        let landing = if self.can_jump(&beyond.values)? {
            beyond
        } else {
            // At the very start of a flow there is nothing before the end of an invariant.
            if onset.before <= self.settings.search().tolerance(0.0, onset.time) {
                return Ok(field.no_time());
            }
            field.sample(curve, onset.before)
        };
        let duration = landing.t;
        samples.retain(|sample| sample.t < duration);
        samples.push(landing);
        Ok(Flight { duration, is_eventful: true, samples })
    }

    /// Holds where time has to stop: a transition is due or an invariant has ended.
    fn tension(&self, state: &[f64]) -> Result<Verdict, Failure> {
        Ok(self.forced(state)?.or(self.invariants(state)?.opposite()))
    }
}

impl Field<'_> {
    /// The flow that does not flow.
    fn no_time(&self) -> Flight {
        Flight { duration: 0.0, is_eventful: true, samples: vec![self.at_start()] }
    }
}
