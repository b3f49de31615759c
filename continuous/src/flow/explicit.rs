//! Steps of the explicit method, for flows that are not stiff.

use super::dormand_prince::{
    EIGHTH, ELEVENTH, EXTENSION, FIFTEENTH, FIFTH, FIFTH_ORDER_ERROR, FOURTEENTH, FOURTH, NINTH,
    NODES, NODES_INSIDE, SECOND, SEVENTH, SIXTEENTH, SIXTH, SOLUTION, TENTH, THIRD, THIRD_ORDER,
    TWELFTH, combine, combine_differences, cut,
};
use super::integrator::{Origin, Trial};
use super::{Tolerances, VectorField};

/// The stages of a step: the first is that of its [`Origin`].
#[derive(Debug)]
pub(super) struct Explicit {
    /// Stages 2 to 12.
    stages: [Vec<f64>; 11],
    /// The state at which stage 12 is evaluated, which is at the end of the step.
    end_of_twelfth: Vec<f64>,
    /// By component: the square of its error, as a fraction of what is allowed and per second.
    fractions: Vec<f64>,
}

/// A motion λ of a flow, as two states near each other show it during a step of length h.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// |h λ|.
    pub(super) speed: f64,
    /// By how much the states approach each other: about |h λ| if λ is real and negative, and 0 if it
    /// is imaginary.
    pub(super) decay: f64,
}

impl Explicit {
    pub(super) fn new(dimension: usize) -> Self {
        let zeros = || vec![0.0; dimension];
        Explicit {
            stages: std::array::from_fn(|_| zeros()),
            end_of_twelfth: zeros(),
            fractions: zeros(),
        }
    }

    /// Computes all stages of a step and the state at its end, and its error as a fraction of what
    /// is allowed; not finite where a stage is not.
    pub(super) fn attempt<F: VectorField + ?Sized>(
        &mut self,
        field: &F,
        tolerances: &Tolerances,
        origin: &Origin,
        step: f64,
        trial: &mut Trial,
    ) -> f64 {
        let Origin { time, state, rates: k1 } = origin;
        let at = |stage: usize| time + NODES[stage - 2] * step;
        let (end, probe) = (trial.time, &mut self.end_of_twelfth);
        let [k2, k3, k4, k5, k6, k7, k8, k9, k10, k11, k12] = &mut self.stages;

        combine(probe, state, step, SECOND, [k1]);
        field.rates(at(2), probe, k2);
        combine(probe, state, step, THIRD, [k1, k2]);
        field.rates(at(3), probe, k3);
        combine(probe, state, step, FOURTH, [k1, k3]);
        field.rates(at(4), probe, k4);
        combine(probe, state, step, FIFTH, [k1, k3, k4]);
        field.rates(at(5), probe, k5);
        combine(probe, state, step, SIXTH, [k1, k4, k5]);
        field.rates(at(6), probe, k6);
        combine(probe, state, step, SEVENTH, [k1, k4, k5, k6]);
        field.rates(at(7), probe, k7);
        combine(probe, state, step, EIGHTH, [k1, k4, k5, k6, k7]);
        field.rates(at(8), probe, k8);
        combine(probe, state, step, NINTH, [k1, k4, k5, k6, k7, k8]);
        field.rates(at(9), probe, k9);
        combine(probe, state, step, TENTH, [k1, k4, k5, k6, k7, k8, k9]);
        field.rates(at(10), probe, k10);
        combine(probe, state, step, ELEVENTH, [k1, k4, k5, k6, k7, k8, k9, k10]);
        field.rates(at(11), probe, k11);
        combine(probe, state, step, TWELFTH, [k1, k4, k5, k6, k7, k8, k9, k10, k11]);
        field.rates(end, probe, k12);
        let stages = [k1, k6, k7, k8, k9, k10, k11, k12].map(Vec::as_slice);
        combine(&mut trial.state, state, step, SOLUTION, stages);
        estimate(tolerances, state, &trial.state, step, stages, &mut self.fractions)
    }

    /// The fastest motion that the last stages show.
    ///
    /// Stages 12 and 13 are evaluated at the same instant at two states: Hairer and Wanner, *Solving
    /// Ordinary Differential Equations II*, 2nd ed., section IV.2, doi:10.1007/978-3-642-05221-7.
    pub(super) fn motion(&self, step: f64, trial: &Trial) -> Motion {
        let states = trial.state.iter().zip(&self.end_of_twelfth);
        let rates = trial.rates.iter().zip(&self.stages[10]);
        let (mut apart, mut along, mut faster) = (0.0, 0.0, 0.0);
        for ((x, other_x), (rate, other_rate)) in states.zip(rates) {
            let (state, rate) = (x - other_x, rate - other_rate);
            apart += state * state;
            along += state * rate;
            faster += rate * rate;
        }
        if apart > 0.0 {
            Motion { speed: step * (faster / apart).sqrt(), decay: -step * along / apart }
        } else {
            Motion { speed: 0.0, decay: 0.0 }
        }
    }

    /// Evaluates three more stages inside the step and writes the terms of the extension from the
    /// fourth power on; says whether all of it is finite.
    pub(super) fn extend<F: VectorField + ?Sized>(
        &self,
        field: &F,
        start: f64,
        step: f64,
        (first, first_rates, last_rates): (&[f64], &[f64], &[f64]),
        room: &mut [Vec<f64>; 4],
        terms: [&mut [f64]; 4],
    ) -> bool {
        let at = |stage: usize| start + NODES_INSIDE[stage - 14] * step;
        let [probe, k14, k15, k16] = room;
        let (k1, k13) = (first_rates, last_rates);
        let [_, _, _, _, k6, k7, k8, k9, k10, k11, k12] = self.stages.each_ref().map(Vec::as_slice);

        combine(probe, first, step, FOURTEENTH, [k1, k7, k8, k9, k10, k11, k12, k13]);
        field.rates(at(14), probe, k14);
        combine(probe, first, step, FIFTEENTH, [k1, k6, k7, k8, k11, k12, k13, k14]);
        field.rates(at(15), probe, k15);
        combine(probe, first, step, SIXTEENTH, [k1, k6, k7, k8, k9, k13, k14, k15]);
        field.rates(at(16), probe, k16);

        let stages = [k1, k6, k7, k8, k9, k10, k11, k12, k13, k14, k15, k16];
        combine_differences(terms, step, EXTENSION, stages)
    }
}

/// The largest error of a component, as a fraction of what is allowed.
///
/// A component's error combines those of orders 5 and 3 as Hairer, Nørsett and Wanner do, which
/// behaves like one of order 8.
fn estimate(
    tolerances: &Tolerances,
    before: &[f64],
    after: &[f64],
    step: f64,
    stages: [&[f64]; 8],
    fractions: &mut [f64],
) -> f64 {
    let dimension = after.len();
    let before = &before[..dimension];
    let fractions = &mut fractions[..dimension];
    let stages = cut(stages, dimension);
    let [first, _, _, _, ninth, _, _, twelfth] = stages;
    for i in 0..dimension {
        let (mut solution, mut fifth) = (0.0, 0.0);
        for stage in 0..8 {
            solution += SOLUTION[stage] * stages[stage][i];
            fifth += FIFTH_ORDER_ERROR[stage] * stages[stage][i];
        }
        let [one, nine, twelve] = THIRD_ORDER;
        let third = solution - one * first[i] - nine * ninth[i] - twelve * twelfth[i];
        let allowed = 1.0 / tolerances.allowed(before[i].abs().max(after[i].abs()));
        let (fifth, third) = (fifth * allowed, third * allowed);
        let squared = fifth * fifth;
        // Not 0 ÷ 0 where there is no error.
        fractions[i] = squared * squared / (squared + 0.01 * third * third + f64::MIN_POSITIVE);
    }
    // `max` ignores NaN; the sum does not.
    let (mut largest, mut sum) = (0.0_f64, 0.0);
    for (fraction, after) in fractions.iter().zip(after) {
        largest = largest.max(*fraction);
        sum += fraction + 0.0 * after;
    }
    let largest = step.abs() * largest.sqrt();
    if sum.is_finite() { largest } else { sum }
}
