//! The way from one jump to the next: the flow of all components together, up to the first instant
//! at which a transition has to be taken or an invariant ends.

use std::cell::RefCell;

use nalgebra::{DMatrix, DVector};
use pleach_continuous::flow::{ConstantFlow, Curve, Integrator, LinearFlow, Onset, first_instant};
use pleach_guards::Verdict;

use super::blueprint::{Place, PlaceMotion, Solution};
use super::simulation::{Failure, Simulation};
use super::{Component, Composition};
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

/// The most variables for which the matrix exponential is cheaper than an integrator.
const LARGEST_LINEAR: usize = 16;
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
            let search = self.settings.resolution.max(2.0 * f64::EPSILON * onset.time);
            if onset.before <= search {
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

/// What the rates are made of.
enum Kind {
    /// ẋ = c
    Constant(Vec<f64>),
    /// ẋ = A x + b
    Linear(DMatrix<f64>, DVector<f64>),
    General,
}

/// The flow of all components in their locations.
pub(super) struct Field<'a> {
    composition: &'a Composition,
    /// With their place, and whether they solve their flow themselves.
    moving: Vec<(&'a Component, &'a Place)>,
    exact: Vec<(&'a Component, &'a Solution)>,
    start: &'a [f64],
    /// Room for the coordinates of a component and their rates.
    scratch: RefCell<(Vec<f64>, Vec<f64>)>,
}

impl<'a> Field<'a> {
    pub(super) fn of(composition: &'a Composition, locations: &[usize], start: &'a [f64]) -> Self {
        let (mut moving, mut exact) = (Vec::new(), Vec::new());
        for (component, &location) in composition.components.iter().zip(locations) {
            let place = component.place(location);
            match &place.motion {
                PlaceMotion::Exact(advance) => exact.push((component, &**advance)),
                PlaceMotion::Rates(rates) if rates.is_empty() => {}
                PlaceMotion::Rates(_) | PlaceMotion::Field(_) => moving.push((component, place)),
            }
        }
        Field { composition, moving, exact, start, scratch: RefCell::default() }
    }

    fn kind(&self) -> Kind {
        match self.linear() {
            Some((matrix, offset)) if matrix.iter().all(|entry| *entry == 0.0) => {
                Kind::Constant(offset.iter().copied().collect())
            }
            Some((matrix, offset)) if offset.len() <= LARGEST_LINEAR => {
                Kind::Linear(matrix, offset)
            }
            _ => Kind::General,
        }
    }

    /// A and b, if the rates are linear. What is solved by itself has no rate here.
    fn linear(&self) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let size = self.start.len();
        let mut entries = Vec::new();
        let mut offset = DVector::zeros(size);
        for (component, place) in &self.moving {
            let PlaceMotion::Rates(rates) = &place.motion else { return None };
            for (coordinate, _, form) in rates {
                let (form, row) = (form.as_ref()?, component.slots[*coordinate]);
                offset[row] = *form.constant();
                for (name, coefficient) in form.coefficients() {
                    let named =
                        component.blueprint.coordinates.iter().position(|one| *one == name)?;
                    let column = component.slots[named];
                    // What a component reads of one that solves its flow itself changes in a way
                    // that no matrix knows.
                    if self.is_exact(column) {
                        return None;
                    }
                    entries.push((row, column, *coefficient));
                }
            }
        }
        // A large system of constant rates needs no matrix.
        if size > LARGEST_LINEAR {
            return entries.is_empty().then(|| (DMatrix::zeros(0, 0), offset));
        }
        let mut matrix = DMatrix::zeros(size, size);
        for (row, column, coefficient) in entries {
            matrix[(row, column)] = coefficient;
        }
        Some((matrix, offset))
    }

    fn is_exact(&self, slot: usize) -> bool {
        self.exact.iter().any(|(component, _)| {
            component.slots.iter().zip(&component.owned).any(|(one, owned)| *one == slot && *owned)
        })
    }

    /// ẋ, at `time` after the start. What is solved by itself has rate 0 here, and others see it
    /// where it is at `time`.
    fn rates(&self, time: f64, state: &[f64], rates: &mut [f64]) {
        rates.fill(0.0);
        if self.exact.is_empty() {
            return self.add_rates(state, rates);
        }
        let mut state = state.to_vec();
        self.overlay(time, &mut state);
        self.add_rates(&state, rates);
    }

    fn add_rates(&self, state: &[f64], rates: &mut [f64]) {
        for (component, place) in &self.moving {
            match &place.motion {
                PlaceMotion::Rates(formulas) => {
                    for (coordinate, rate, _) in formulas {
                        rates[component.slots[*coordinate]] =
                            rate.evaluate_at(state, &component.slots);
                    }
                }
                PlaceMotion::Field(field) => {
                    let (own, change) = &mut *self.scratch.borrow_mut();
                    component.gather(state, own);
                    change.resize(own.len(), 0.0);
                    field(own, change);
                    component.scatter(change, rates);
                }
                PlaceMotion::Exact(_) => {}
            }
        }
    }

    /// The name of what changes while time passes, if anything does: a variable that has a rate,
    /// or a component that solves its flow itself.
    pub(super) fn mover(&self) -> Option<String> {
        let mut rates = vec![0.0; self.start.len()];
        self.rates(0.0, self.start, &mut rates);
        let moving = rates.iter().position(|rate| *rate != 0.0);
        let variable = moving.map(|slot| self.composition.variables[slot].clone());
        variable.or_else(|| self.exact.first().map(|(component, _)| component.name.clone()))
    }

    /// Puts what is solved by itself where it is at `time`.
    fn overlay(&self, time: f64, state: &mut [f64]) {
        for (component, advance) in &self.exact {
            let (own, _) = &mut *self.scratch.borrow_mut();
            component.gather(self.start, own);
            advance(own, time);
            component.scatter(own, state);
        }
    }

    fn sample(&self, curve: &impl Curve, time: f64) -> Sample {
        let mut values = vec![0.0; self.start.len()];
        curve.state_at(time, &mut values);
        let mut rates = vec![0.0; values.len()];
        self.rates(time, &values, &mut rates);
        Sample { t: time, values, rates }
    }

    fn at_start(&self) -> Sample {
        let mut rates = vec![0.0; self.start.len()];
        self.rates(0.0, self.start, &mut rates);
        Sample { t: 0.0, values: self.start.to_vec(), rates }
    }

    /// The flow that does not flow.
    fn no_time(&self) -> Flight {
        Flight { duration: 0.0, is_eventful: true, samples: vec![self.at_start()] }
    }
}

/// A curve on which components that solve their flow themselves are put where they are.
struct Overlaid<'a, C> {
    curve: C,
    field: &'a Field<'a>,
}

/// What solves itself may bend as it likes: it is looked at this often in a flow.
const LOOKS_AT_THE_UNKNOWN: f64 = 64.0;

impl<C: Curve> Curve for Overlaid<'_, C> {
    fn start(&self) -> f64 {
        self.curve.start()
    }

    fn end(&self) -> f64 {
        self.curve.end()
    }

    fn dimension(&self) -> usize {
        self.curve.dimension()
    }

    fn state_at(&self, time: f64, state: &mut [f64]) {
        self.curve.state_at(time, state);
        self.field.overlay(time, state);
    }

    fn time_scale(&self, time: f64) -> f64 {
        let scale = self.curve.time_scale(time);
        if self.field.exact.is_empty() {
            scale
        } else {
            scale.min((self.end() - self.start()) / LOOKS_AT_THE_UNKNOWN)
        }
    }
}

impl Component {
    /// The coordinates as the component sees them.
    pub(super) fn gather(&self, values: &[f64], own: &mut Vec<f64>) {
        own.clear();
        own.extend(self.slots.iter().map(|&slot| values[slot]));
    }

    /// Writes back the coordinates that belong to the component.
    pub(super) fn scatter(&self, own: &[f64], values: &mut [f64]) {
        for ((&slot, &value), &owned) in self.slots.iter().zip(own).zip(&self.owned) {
            if owned {
                values[slot] = value;
            }
        }
    }
}
