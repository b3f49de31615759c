//! The integrator: steps of Dormand and Prince's method, each as long as accuracy allows.

use std::cell::RefCell;
use std::mem;

use thiserror::Error;

use super::controller::Controller;
use super::dormand_prince::{
    ERROR, FIFTH, FOURTH, NODES, SECOND, SIXTH, SOLUTION, STAGES, THIRD, combine,
};
use super::step::{Inside, Step};
use super::{Tolerances, VectorField};

/// A solution of ẋ = f(t, x) in the making.
///
/// The method is Dormand and Prince's Runge–Kutta pair of orders 5 and 4
/// (doi:10.1016/0771-050X(80)90013-3), which advances with order 5; inside, a [`Step`] has order 5
/// as well. The length of the steps keeps the error within the tolerances. Made for flows that are smooth and not stiff: at a kink of the field the steps become short, and
/// in a stiff flow they stay short.
///
/// ```
/// use pleach_continuous::flow::{Curve, Integrator, Tolerances};
///
/// let growth = |_time: f64, state: &[f64], rates: &mut [f64]| rates[0] = state[0];
/// let mut integrator = Integrator::new(&growth, 0.0, &[1.0], Tolerances::default());
/// let mut state = [0.0];
/// while integrator.time() < 1.0 {
///     let step = integrator.step(1.0)?;
///     let middle = 0.5 * (step.start() + step.end());
///     step.state_at(middle, &mut state);
///     assert!((state[0] - middle.exp()).abs() < 1e-9);
/// }
/// assert!((integrator.state()[0] - 1f64.exp()).abs() < 1e-9);
/// # Ok::<(), pleach_continuous::flow::IntegrationFailure>(())
/// ```
///
/// Memory is taken at construction; a step takes none.
#[derive(Debug)]
pub struct Integrator<'f, F: ?Sized> {
    field: &'f F,
    tolerances: Tolerances,
    controller: Controller,
    /// How long the next step should be; not yet known before the first.
    proposal: Option<f64>,
    slope: Slope,
    time: f64,
    state: Vec<f64>,
    /// Where the last step began.
    origin_time: f64,
    origin: Vec<f64>,
    /// The state at which a stage is evaluated, in the end the one that may be accepted.
    trial: Vec<f64>,
    stages: [Vec<f64>; STAGES],
    inside: RefCell<Inside>,
}

/// Which stage holds the rates at the present state.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Slope {
    /// None yet.
    Unknown,
    /// The first.
    First,
    /// The last, since a step ended here.
    Last,
}

/// Steps of fewer spacings of the floating-point numbers around the present time cannot be told
/// from rounding.
const SMALLEST_STEP: f64 = 4.0 * f64::EPSILON;
/// A step that falls short of the limit by less than this fraction is stretched to end there, so
/// that no tiny step follows.
const STRETCH: f64 = 0.01;

impl<'f, F: VectorField + ?Sized> Integrator<'f, F> {
    /// The solution that is in `state` at `start_time`, in seconds since the start of the flow.
    pub fn new(field: &'f F, start_time: f64, state: &[f64], tolerances: Tolerances) -> Self {
        Integrator {
            field,
            tolerances,
            controller: Controller::new(),
            proposal: None,
            slope: Slope::Unknown,
            time: start_time,
            state: state.to_vec(),
            origin_time: start_time,
            origin: state.to_vec(),
            trial: state.to_vec(),
            stages: std::array::from_fn(|_| vec![0.0; state.len()]),
            inside: RefCell::new(Inside::new(state.len())),
        }
    }

    /// The present time, in seconds since the start of the flow.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The present state.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Takes the longest step that the tolerances allow, at most to `limit`.
    ///
    /// The field is never evaluated beyond `limit`, and a step that reaches it ends there exactly.
    /// The length of the next step is not forgotten over one that the limit cut short.
    ///
    /// # Errors
    ///
    /// [`IntegrationFailure`]; time and state then remain as they were.
    pub fn step(&mut self, limit: f64) -> Result<Step<'_, F>, IntegrationFailure> {
        let remaining = limit - self.time;
        if remaining.is_nan() || remaining <= 0.0 {
            return Err(IntegrationFailure::LimitNotAhead { time: self.time, limit });
        }
        self.know_first_stage()?;
        let longest = remaining.min(self.tolerances.largest_step());
        let proposal = match self.proposal {
            Some(proposal) => proposal,
            None => self.first_step(longest),
        };
        let mut step = proposal.max(self.smallest_step()).min(longest);
        loop {
            let lands = step * (1.0 + STRETCH) >= remaining;
            if lands {
                step = remaining;
            }
            let end = if lands { limit } else { self.time + step };
            let error = self.attempt(step, end);
            if error <= 1.0 {
                let next = step * self.controller.accept(error);
                self.proposal = Some(if lands { next.max(proposal) } else { next });
                self.accept(end);
                return Ok(self.last_step());
            }
            step *= self.controller.reject(error);
            if step < self.smallest_step() {
                return Err(self.failure(error, step));
            }
        }
    }

    /// Evaluates the field at the present state, unless the last step has done so.
    fn know_first_stage(&mut self) -> Result<(), IntegrationFailure> {
        match self.slope {
            Slope::First => {}
            Slope::Last => self.stages.swap(0, STAGES - 1),
            Slope::Unknown => {
                self.field.rates(self.time, &self.state, &mut self.stages[0]);
                if !self.stages[0].iter().all(|rate| rate.is_finite()) {
                    return Err(self.undefined());
                }
            }
        }
        self.slope = Slope::First;
        Ok(())
    }

    /// A first guess for the length of a step: of Hairer, Nørsett and Wanner, *Solving Ordinary
    /// Differential Equations I*, section II.4.
    ///
    /// An explicit Euler step, in which the state changes by a hundredth of its size, measures the
    /// second derivative; the guess is a step whose error these two derivatives suggest to be a
    /// hundredth of what is allowed.
    fn first_step(&mut self, longest: f64) -> f64 {
        let [rates, moved_rates, ..] = &mut self.stages;
        let size = weighted_norm(&self.tolerances, &self.state, |i| self.state[i]);
        let speed = weighted_norm(&self.tolerances, &self.state, |i| rates[i]);
        let small = size < 1e-5 || speed < 1e-5;
        let euler = if small { 1e-6 } else { 0.01 * size / speed }.min(longest);

        combine(&mut self.trial, &self.state, euler, [1.0], [rates]);
        self.field.rates(self.time + euler, &self.trial, moved_rates);
        let change = |i: usize| (moved_rates[i] - rates[i]) / euler;
        let bend = weighted_norm(&self.tolerances, &self.state, change);

        let largest = speed.max(bend);
        let guess = if largest <= 1e-15 { euler * 1e-3 } else { (0.01 / largest).powf(0.2) };
        guess.max(1e-6).min(100.0 * euler)
    }

    /// Computes all stages of a step to `end`, and its error as a fraction of what is allowed.
    fn attempt(&mut self, step: f64, end: f64) -> f64 {
        let (field, time, state, trial) = (self.field, self.time, &self.state, &mut self.trial);
        let at = |stage: usize| time + NODES[stage] * step;
        let [k1, k2, k3, k4, k5, k6, k7] = &mut self.stages;

        combine(trial, state, step, SECOND, [k1]);
        field.rates(at(1), trial, k2);
        combine(trial, state, step, THIRD, [k1, k2]);
        field.rates(at(2), trial, k3);
        combine(trial, state, step, FOURTH, [k1, k2, k3]);
        field.rates(at(3), trial, k4);
        combine(trial, state, step, FIFTH, [k1, k2, k3, k4]);
        field.rates(at(4), trial, k5);
        combine(trial, state, step, SIXTH, [k1, k2, k3, k4, k5]);
        field.rates(end, trial, k6);
        combine(trial, state, step, SOLUTION, [k1, k3, k4, k5, k6]);
        field.rates(end, trial, k7);
        estimate(&self.tolerances, state, trial, step, [k1, k3, k4, k5, k6, k7])
    }

    /// Makes the trial state the present one.
    fn accept(&mut self, end: f64) {
        self.origin_time = mem::replace(&mut self.time, end);
        mem::swap(&mut self.origin, &mut self.state);
        mem::swap(&mut self.state, &mut self.trial);
        self.slope = Slope::Last;
        self.inside.get_mut().forget();
    }

    fn last_step(&self) -> Step<'_, F> {
        let [k1, _, k3, k4, k5, k6, k7] = &self.stages;
        Step {
            field: self.field,
            start: self.origin_time,
            end: self.time,
            first: &self.origin,
            last: &self.state,
            stages: [k1, k3, k4, k5, k6, k7],
            inside: &self.inside,
            tolerances: self.tolerances,
        }
    }

    fn smallest_step(&self) -> f64 {
        (SMALLEST_STEP * self.time.abs()).max(f64::MIN_POSITIVE)
    }

    fn failure(&self, error: f64, step: f64) -> IntegrationFailure {
        if error.is_finite() {
            IntegrationFailure::StepTooSmall { time: self.time, state: self.state.clone(), step }
        } else {
            self.undefined()
        }
    }

    fn undefined(&self) -> IntegrationFailure {
        IntegrationFailure::Undefined { time: self.time, state: self.state.clone() }
    }
}

/// The largest error of a component, as a fraction of what is allowed; not finite where a stage is
/// not.
fn estimate(
    tolerances: &Tolerances,
    before: &[f64],
    after: &[f64],
    step: f64,
    stages: [&[f64]; 6],
) -> f64 {
    let dimension = after.len();
    let before = &before[..dimension];
    let stages = stages.map(|stage| &stage[..dimension]);
    let weights = ERROR.map(|weight| step * weight);
    // `max` ignores NaN; the sum does not.
    let (mut largest, mut sum) = (0.0_f64, 0.0);
    for i in 0..dimension {
        let mut error = 0.0;
        for stage in 0..6 {
            error += weights[stage] * stages[stage][i];
        }
        let fraction = error.abs() / tolerances.allowed(before[i].abs().max(after[i].abs()));
        largest = largest.max(fraction);
        sum += fraction + 0.0 * after[i];
    }
    if sum.is_finite() { largest } else { sum }
}

/// The largest component, as a multiple of the error allowed in `state`.
fn weighted_norm(tolerances: &Tolerances, state: &[f64], component: impl Fn(usize) -> f64) -> f64 {
    let fractions =
        state.iter().enumerate().map(|(i, x)| component(i).abs() / tolerances.allowed(x.abs()));
    fractions.fold(0.0, f64::max)
}

/// Why an integration cannot go on.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IntegrationFailure {
    /// However short the step, its error is more than is allowed: the solution runs off to
    /// infinity here, or the field jumps.
    #[error("no step from {time} s on is accurate enough, not even one of {step:e} s")]
    StepTooSmall {
        /// In seconds since the start of the flow.
        time: f64,
        /// The state there.
        state: Vec<f64>,
        /// The step that would have been next, in seconds.
        step: f64,
    },
    /// The field is not a finite number here, or right after.
    #[error("the flow is undefined at or right after {time} s, in state {state:?}")]
    Undefined {
        /// In seconds since the start of the flow.
        time: f64,
        /// The state there.
        state: Vec<f64>,
    },
    /// There is no time left to take a step in.
    #[error("a step must end after it starts: it is {time} s, and the limit is {limit} s")]
    LimitNotAhead {
        /// The present time, in seconds since the start of the flow.
        time: f64,
        /// The limit given.
        limit: f64,
    },
}
