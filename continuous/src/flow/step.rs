//! One step of an integration, to be evaluated anywhere in it.

use std::cell::RefCell;

use super::dormand_prince::{QUARTIC, combine};
use super::{Curve, Piece, Tolerances, VectorField};

/// One step of an [`Integrator`](super::Integrator): a curve that joins the steps beside it with
/// continuous first derivative.
///
/// At its ends the step has order 5, and inside as well. The free interpolant of the method has
/// only order 4, which leaves up to a hundred times the error of the ends in the middle of a step.
/// It is good enough to evaluate the field at two more instants, though, and the states and rates
/// at the ends with these rates inside determine a polynomial of degree 5 whose error is that of
/// the ends: the bootstrapping of W. H. Enright, K. R. Jackson, S. P. Nørsett and P. G. Thomsen
/// (1986), doi:10.1145/7921.7923. The two evaluations are made when the step is first asked for a
/// state inside it, and once; who looks only at the ends does not pay for them.
#[derive(Debug)]
pub struct Step<'a, F: ?Sized> {
    pub(super) field: &'a F,
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) first: &'a [f64],
    pub(super) last: &'a [f64],
    /// Stages 1, 3, 4, 5, 6 and 7.
    pub(super) stages: [&'a [f64]; 6],
    pub(super) inside: &'a RefCell<Inside>,
    pub(super) tolerances: Tolerances,
}

/// The rates at the two instants inside a step.
#[derive(Clone, Debug)]
pub(super) struct Inside {
    knowledge: Knowledge,
    rates: [Vec<f64>; 2],
    /// Room for the state at which they are evaluated.
    state: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Knowledge {
    Unknown,
    Known,
    /// The field is not a finite number there: order 4 has to do.
    Undefined,
}

/// Where the two instants are, as fractions of the step. On several flows these gave, of a grid of
/// pairs, errors within a tenth of the smallest; they are round, and their weights are small.
const INSTANTS: [f64; 2] = [0.5, 0.75];

impl Inside {
    pub(super) fn new(dimension: usize) -> Self {
        let zeros = || vec![0.0; dimension];
        Inside { knowledge: Knowledge::Unknown, rates: [zeros(), zeros()], state: zeros() }
    }

    /// The next step knows nothing about its inside.
    pub(super) fn forget(&mut self) {
        self.knowledge = Knowledge::Unknown;
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
            if inside.knowledge == Knowledge::Known {
                self.quintic(fraction, &inside.rates, state);
            } else {
                self.quartic(fraction, state);
            }
        }
    }

    /// The whole step. Its error is that which the tolerances allow at the ends.
    fn piece(&self, _time: f64) -> Option<Piece> {
        let mut inside = self.inside.borrow_mut();
        self.explore(&mut inside);
        let duration = self.end - self.start;
        let mut piece = Piece::new(self.start, self.end, self.start, duration);
        for (component, (first, last)) in self.first.iter().zip(self.last).enumerate() {
            let weighted = match inside.knowledge {
                Knowledge::Known => self.quintic_terms(component, &inside.rates),
                _ => self.quartic_terms(component),
            };
            let mut terms = weighted.map(|term| duration * term);
            terms[0] += first;
            let error = self.tolerances.allowed(first.abs().max(last.abs()));
            piece.push(terms, error);
        }
        Some(piece)
    }
}

impl<F: VectorField + ?Sized> Step<'_, F> {
    /// Evaluates the field inside the step, unless that has been done.
    fn explore(&self, inside: &mut Inside) {
        if inside.knowledge != Knowledge::Unknown {
            return;
        }
        for (fraction, rates) in INSTANTS.into_iter().zip(&mut inside.rates) {
            self.quartic(fraction, &mut inside.state);
            let time = self.start + fraction * (self.end - self.start);
            self.field.rates(time, &inside.state, rates);
        }
        let finite = inside.rates.iter().flatten().all(|rate| rate.is_finite());
        inside.knowledge = if finite { Knowledge::Known } else { Knowledge::Undefined };
    }

    /// The method's own interpolant, of order 4. With θ the fraction, θ + φ = 1, Δ the change of
    /// state and Q the quartic term it is
    ///
    /// x₀ + θ Δ + θφ (h k₁ − Δ) + θ²φ (2Δ − h k₁ − h k₇) + θ²φ² Q.
    fn quartic(&self, theta: f64, state: &mut [f64]) {
        let rest = 1.0 - theta;
        let (second, third) = (theta * rest, theta * theta * rest);
        let mut weights = QUARTIC.map(|weight| third * rest * weight);
        weights[0] += second - third;
        weights[5] -= third;
        combine(state, self.first, self.end - self.start, weights, self.stages);
        self.add_change(theta - second + 2.0 * third, state);
    }

    /// The polynomial of degree 5 with the states and rates of both ends and the rates inside.
    fn quintic(&self, theta: f64, inside: &[Vec<f64>; 2], state: &mut [f64]) {
        let [at_start, .., at_end] = self.stages;
        let rates = [at_start, &inside[0], &inside[1], at_end];
        let weights = quintic_weights(theta);
        combine(state, self.first, self.end - self.start, weights, rates);
        self.add_change(theta - weights.iter().sum::<f64>(), state);
    }

    /// The polynomial of degree 5 of a component, less the state at the start, per second.
    fn quintic_terms(&self, component: usize, inside: &[Vec<f64>; 2]) -> [f64; 6] {
        let [at_start, .., at_end] = self.stages;
        let rates =
            [at_start[component], inside[0][component], inside[1][component], at_end[component]];
        self.terms(component, QUINTIC_TERMS, rates)
    }

    /// The polynomial of degree 4 of a component, less the state at the start, per second.
    fn quartic_terms(&self, component: usize) -> [f64; 6] {
        let mut table = QUARTIC.map(|weight| [0.0, 0.0, weight, -2.0 * weight, weight, 0.0]);
        // θφ − θ²φ for the first stage, −θ²φ for the last.
        for (power, [first, last]) in [(1, [1.0, 0.0]), (2, [-2.0, -1.0]), (3, [1.0, 1.0])] {
            table[0][power] += first;
            table[5][power] += last;
        }
        self.terms(component, table, self.stages.map(|stage| stage[component]))
    }

    /// The sum of rates, each times its polynomial, and of the mean rate times what these leave.
    fn terms<const N: usize>(
        &self,
        component: usize,
        table: [[f64; 6]; N],
        rates: [f64; N],
    ) -> [f64; 6] {
        let mean = (self.last[component] - self.first[component]) / (self.end - self.start);
        let mut terms = [0.0, mean, 0.0, 0.0, 0.0, 0.0];
        for (weights, rate) in table.iter().zip(rates) {
            for (term, weight) in terms.iter_mut().zip(weights) {
                *term += weight * (rate - mean);
            }
        }
        terms
    }

    fn add_change(&self, weight: f64, state: &mut [f64]) {
        for ((x, first), last) in state.iter_mut().zip(self.first).zip(self.last) {
            *x += weight * (last - first);
        }
    }
}

/// The polynomials of [`quintic_weights`] by their coefficients, the constant first.
const QUINTIC_TERMS: [[f64; 6]; 4] = [
    [0.0, 1.0, -71.0 / 12.0, 77.0 / 6.0, -143.0 / 12.0, 4.0],
    [0.0, 0.0, -9.0, 34.0, -41.0, 16.0],
    [0.0, 0.0, -16.0 / 3.0, 32.0 / 3.0, -16.0 / 3.0, 0.0],
    [0.0, 0.0, -9.0 / 4.0, 15.0 / 2.0, -37.0 / 4.0, 4.0],
];

/// The weights of the rates at 0, 1/2, 3/4 and 1 in the polynomial of degree 5.
///
/// All vanish at both ends, and the derivative of each is 1 at its own instant and 0 at the others.
/// That leaves θ less their sum for the weight of the change of state: straight motion is exact,
/// and rounding counts only in how far the motion is not straight.
fn quintic_weights(theta: f64) -> [f64; 4] {
    let rest = 1.0 - theta;
    let both = theta * rest;
    [
        both * rest * (1.0 - theta * (47.0 / 12.0 - theta * 4.0)),
        both * both * (16.0 * theta - 9.0),
        both * both * (-16.0 / 3.0),
        both * theta * (theta * (21.0 / 4.0 - theta * 4.0) - 9.0 / 4.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_make_up_the_weights() {
        for tenth in 0..=10 {
            let theta = 0.1 * f64::from(tenth);
            for (terms, weight) in QUINTIC_TERMS.iter().zip(quintic_weights(theta)) {
                let sum = terms.iter().rev().fold(0.0, |sum, term| sum * theta + term);
                assert!((sum - weight).abs() < 1e-14, "{sum} for {weight} at {theta}");
            }
        }
    }

    #[test]
    fn weights_meet_what_defines_them() {
        assert_eq!((quintic_weights(0.0), quintic_weights(1.0)), ([0.0; 4], [0.0; 4]));
        // The central difference of a polynomial of degree 5 is off by about its square.
        let reach = 1e-5;
        for (node, instant) in [0.0, INSTANTS[0], INSTANTS[1], 1.0].into_iter().enumerate() {
            let (after, before) =
                (quintic_weights(instant + reach), quintic_weights(instant - reach));
            for weight in 0..4 {
                let derivative = (after[weight] - before[weight]) / (2.0 * reach);
                let expected = if weight == node { 1.0 } else { 0.0 };
                assert!((derivative - expected).abs() < 1e-8, "{weight} at {instant}");
            }
        }
    }
}
