//! The vector field of a composition: the flows of all components in their locations, as one.

use std::cell::RefCell;

use nalgebra::{DMatrix, DVector};
use pleach_continuous::flow::Curve;

use super::blueprint::{Place, PlaceMotion, Solution};
use super::{Component, Composition};
use crate::trajectory::Sample;

/// The most variables for which the matrix exponential is cheaper than an integrator.
const LARGEST_LINEAR: usize = 16;

/// What the rates are made of.
pub(super) enum Kind {
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

    pub(super) fn kind(&self) -> Kind {
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
            // Several inputs may read one coordinate.
            matrix[(row, column)] += coefficient;
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
    pub(super) fn rates(&self, time: f64, state: &[f64], rates: &mut [f64]) {
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

    pub(super) fn sample(&self, curve: &impl Curve, time: f64) -> Sample {
        let mut values = vec![0.0; self.start.len()];
        curve.state_at(time, &mut values);
        let mut rates = vec![0.0; values.len()];
        self.rates(time, &values, &mut rates);
        Sample { t: time, values, rates }
    }

    pub(super) fn at_start(&self) -> Sample {
        let mut rates = vec![0.0; self.start.len()];
        self.rates(0.0, self.start, &mut rates);
        Sample { t: 0.0, values: self.start.to_vec(), rates }
    }
}

/// A curve on which components that solve their flow themselves are put where they are.
pub(super) struct Overlaid<'a, C> {
    pub(super) curve: C,
    pub(super) field: &'a Field<'a>,
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
