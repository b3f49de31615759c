//! One step of an integration, to be evaluated anywhere in it.

use std::cell::RefCell;

use super::dormand_prince::cut;
use super::explicit::Explicit;
use super::implicit::Implicit;
use super::{Curve, Piece, Tolerances, VectorField};

/// One step of an [`Integrator`](super::Integrator): a curve that joins the steps beside it, of
/// which the explicit ones have a continuous first derivative there, too.
///
/// Inside it is a polynomial, the continuous extension of the method: of degree 7 and order 7 for
/// the explicit method, of degree 4 and order 4 for the implicit one. It is computed when the step
/// is first asked for a state inside it, and once; a caller that looks only at the ends does not pay
/// for it. Where the field has no value at an instant that the extension needs, the cubic with
/// states and rates of both ends takes its place.
#[derive(Debug)]
pub struct Step<'a, F: ?Sized> {
    pub(super) field: &'a F,
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) first: &'a [f64],
    pub(super) last: &'a [f64],
    /// The rates at both ends.
    pub(super) rates: [&'a [f64]; 2],
    pub(super) stages: Stages<'a>,
    pub(super) inside: &'a RefCell<Inside>,
    pub(super) tolerances: Tolerances,
}

/// What the method has computed.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stages<'a> {
    /// With whether fast motions may spoil the extension.
    Explicit {
        explicit: &'a Explicit,
        is_suspect: bool,
    },
    Implicit(&'a Implicit),
}

/// The polynomial inside a step: with θ the fraction of the step and φ = 1 − θ, it is
///
/// x₀ + θ (r₁ + φ (r₂ + θ (r₃ + φ (r₄ + θ (r₅ + φ (r₆ + θ r₇)))))).
#[derive(Clone, Debug)]
pub(super) struct Inside {
    /// How many terms count; 0 if they are not known yet.
    known: usize,
    terms: [Vec<f64>; MOST_TERMS],
    /// Room for the stages inside an explicit step.
    room: [Vec<f64>; 4],
}

const MOST_TERMS: usize = 7;
/// By how much the error inside a step may be larger than what the tolerances allow at its end: on
/// the flows of the tests it stays well below.
const INSIDE: f64 = 10.0;
/// The number of terms of the cubic through the states and rates of both ends.
const CUBIC_TERMS: usize = 3;
/// The number of terms of the extension of an implicit step.
const STIFF_TERMS: usize = 4;

impl Inside {
    pub(super) fn new(dimension: usize) -> Self {
        let zeros = |_| vec![0.0; dimension];
        Inside { known: 0, terms: std::array::from_fn(zeros), room: std::array::from_fn(zeros) }
    }

    /// The next step knows nothing about its inside.
    pub(super) fn forget(&mut self) {
        self.known = 0;
    }

    /// The state of one component, less that at the start.
    fn value(&self, component: usize, theta: f64) -> f64 {
        let rest = 1.0 - theta;
        let mut value = 0.0;
        for (number, term) in self.terms[..self.known].iter().enumerate().rev() {
            value = (value + term[component]) * if number % 2 == 0 { theta } else { rest };
        }
        value
    }

    /// The derivative with respect to θ at 1/2.
    fn slope_in_the_middle(&self, component: usize) -> f64 {
        let (mut value, mut slope) = (0.0, 0.0);
        for (number, term) in self.terms[..self.known].iter().enumerate().rev() {
            value += term[component];
            slope = 0.5 * slope + if number % 2 == 0 { value } else { -value };
            value *= 0.5;
        }
        slope
    }

    /// By component, the coefficients of the same polynomial in powers of θ, from that of θ⁰ = 1 on,
    /// which is `first`: θ, θφ, θ²φ, θ²φ², θ³φ², θ³φ³ and θ⁴φ³ are multiplied out.
    #[inline]
    fn powers(&self, first: &[f64]) -> impl Iterator<Item = [f64; MOST_TERMS + 1]> {
        let [a, b, c, d, e, f, g] = cut(self.terms.each_ref().map(Vec::as_slice), first.len());
        (0..first.len()).map(move |i| {
            [
                first[i],
                a[i] + b[i],
                c[i] - b[i] + d[i],
                e[i] - c[i] - 2.0 * d[i] + f[i],
                d[i] - 2.0 * e[i] - 3.0 * f[i] + g[i],
                e[i] + 3.0 * (f[i] - g[i]),
                3.0 * g[i] - f[i],
                -g[i],
            ]
        })
    }
}

impl<F: VectorField + ?Sized> Curve for Step<'_, F> {
    fn start(&self) -> f64 {
        self.start
    }

    fn end(&self) -> f64 {
        self.end
    }

    fn dimension(&self) -> usize {
        self.first.len()
    }

    fn state_at(&self, time: f64, state: &mut [f64]) {
        if time <= self.start {
            state.copy_from_slice(self.first);
        } else if time >= self.end {
            state.copy_from_slice(self.last);
        } else {
            let mut inside = self.inside.borrow_mut();
            self.explore(&mut inside);
            let fraction = (time - self.start) / (self.end - self.start);
            for (component, x) in state.iter_mut().enumerate() {
                *x = self.first[component] + inside.value(component, fraction);
            }
        }
    }

    /// The whole step. Its error is that which the tolerances allow at the ends.
    fn piece(&self, _time: f64) -> Option<Piece> {
        let mut inside = self.inside.borrow_mut();
        self.explore(&mut inside);
        let ends = self.first.iter().zip(self.last);
        let error = |(first, last): (&f64, &f64)| {
            INSIDE * self.tolerances.allowed(first.abs().max(last.abs()))
        };
        let (span, duration) = ([self.start, self.end], self.end - self.start);
        let (rows, errors) = (inside.powers(self.first), ends.map(error).collect());
        Some(Piece::of_rows(span, self.start, duration, rows, errors))
    }
}

impl<F: VectorField + ?Sized> Step<'_, F> {
    /// Computes the polynomial, unless that has been done.
    fn explore(&self, inside: &mut Inside) {
        if inside.known > 0 {
            return;
        }
        let step = self.end - self.start;
        let [first_rates, last_rates] = self.rates;
        for i in 0..self.first.len() {
            let change = self.last[i] - self.first[i];
            let early = step * first_rates[i] - change;
            inside.terms[0][i] = change;
            inside.terms[1][i] = early;
            inside.terms[2][i] = change - step * last_rates[i] - early;
        }
        inside.known = match self.stages {
            Stages::Explicit { explicit, is_suspect } => {
                let ends = (self.first, first_rates, last_rates);
                let [_, _, _, terms @ ..] = inside.terms.each_mut().map(Vec::as_mut_slice);
                let room = &mut inside.room;
                let extended = explicit.extend(self.field, self.start, step, ends, room, terms);
                let is_sound = extended && !(is_suspect && self.prefers_cubic(inside));
                if is_sound { MOST_TERMS } else { CUBIC_TERMS }
            }
            Stages::Implicit(implicit) => {
                let extended = implicit.extend(&mut inside.terms[1..STIFF_TERMS]);
                if extended { STIFF_TERMS } else { CUBIC_TERMS }
            }
        };
        inside.terms[inside.known..].iter_mut().for_each(|term| term.fill(0.0));
    }
}

impl<F: VectorField + ?Sized> Step<'_, F> {
    /// Whether the cubic satisfies the differential equation better in the middle than the whole
    /// extension does.
    fn prefers_cubic(&self, inside: &mut Inside) -> bool {
        let mut defect = |known: usize| -> f64 {
            inside.known = known;
            let [state, rates, ..] = &mut inside.room;
            let (mut state, mut rates) = (std::mem::take(state), std::mem::take(rates));
            for (component, x) in state.iter_mut().enumerate() {
                *x = self.first[component] + inside.value(component, 0.5);
            }
            let duration = self.end - self.start;
            self.field.rates(self.start + 0.5 * duration, &state, &mut rates);
            let apart = rates.iter().enumerate().map(|(component, rate)| {
                (rate - inside.slope_in_the_middle(component) / duration).powi(2)
            });
            let defect = apart.sum();
            (inside.room[0], inside.room[1]) = (state, rates);
            defect
        };
        defect(CUBIC_TERMS) < defect(MOST_TERMS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_the_same_polynomial() {
        let mut inside = Inside::new(1);
        for (number, term) in inside.terms.iter_mut().enumerate() {
            term[0] = [3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0][number];
        }
        for known in [7, 4, 3] {
            inside.known = known;
            inside.terms[known..].iter_mut().for_each(|term| term.fill(0.0));
            let powers = inside.powers(&[0.0]).next().expect("it has a component");
            for tenth in 0..=10 {
                let theta = 0.1 * f64::from(tenth);
                let sum = powers.iter().rev().fold(0.0, |sum, power| sum * theta + power);
                assert!((sum - inside.value(0, theta)).abs() < 1e-14, "{known} at {theta}");
            }
        }
    }
}
