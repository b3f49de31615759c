//! The integrator: steps of an explicit or an implicit method, each as long as accuracy allows.

use std::cell::RefCell;
use std::mem;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::controller::Controller;
use super::explicit::Explicit;
use super::implicit::Implicit;
use super::step::{Inside, Stages, Step};
use super::suspicion::{Advice, Suspicion};
use super::{Tolerances, VectorField};

/// How an [`Integrator`] makes its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Method {
    /// Explicit where the flow is not stiff, and implicit where it is; both are noticed.
    #[default]
    Automatic,
    /// Dormand and Prince's method of order 8.
    Explicit,
    /// The Rosenbrock method Rodas5P of order 5.
    Implicit,
}

/// A solution of ẋ = f(t, x) in the making.
///
/// Flows that are not stiff are solved by Dormand and Prince's explicit Runge–Kutta method of order
/// 8 with error estimates of orders 5 and 3 (doi:10.1016/0771-050X(81)90010-3), stiff ones by
/// Steinebach's Rosenbrock method Rodas5P of order 5 (doi:10.1007/s10543-023-00967-x), which solves
/// eight systems of linear equations per step. A flow is *stiff* where fast motions that have faded,
/// and not those that last, limit explicit steps. Inside, a [`Step`] is the continuous extension of
/// its method. The length of the steps keeps the error within the tolerances. At a kink of the field
/// the steps become short.
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
/// Memory is taken at construction, and when an implicit step is first tried; other steps take none.
#[derive(Debug)]
pub struct Integrator<'f, F: ?Sized> {
    field: &'f F,
    tolerances: Tolerances,
    method: Method,
    controller: Controller,
    /// How long the next step should be; not yet known before the first.
    proposal: Option<f64>,
    /// Whether the rates of `present` are known.
    is_begun: bool,
    /// Where the next step begins.
    present: Origin,
    /// Where the last step began.
    past: Origin,
    /// The end of a step that may be accepted.
    trial: Trial,
    explicit: Explicit,
    implicit: Option<Implicit>,
    /// Whether steps are implicit.
    is_implicit: bool,
    suspicion: Suspicion,
    inside: RefCell<Inside>,
}

/// Time, state and rates where a step begins or ends.
#[derive(Clone, Debug)]
pub(super) struct Origin {
    pub(super) time: f64,
    pub(super) state: Vec<f64>,
    pub(super) rates: Vec<f64>,
}

/// The end of a step that is being tried.
pub(super) type Trial = Origin;

/// Steps of fewer spacings of the floating-point numbers around the present time cannot be told
/// from rounding.
const SMALLEST_STEP: f64 = 4.0 * f64::EPSILON;
/// A step that falls short of the limit by less than this fraction is stretched to end there, so
/// that no tiny step follows.
const STRETCH: f64 = 0.01;
/// With |h λ| from here on, the continuous extension of an explicit step may magnify the errors of
/// its stages.
const SUSPECT: f64 = 2.0;
/// Steps that are longer by this factor are worth an implicit method.
const MUCH_LONGER: f64 = 4.0;

impl<'f, F: VectorField + ?Sized> Integrator<'f, F> {
    /// The solution that is in `state` at `start_time`, in seconds since the start of the flow, by
    /// the method that suits the flow.
    pub fn new(field: &'f F, start_time: f64, state: &[f64], tolerances: Tolerances) -> Self {
        let present = Origin { time: start_time, state: state.to_vec(), rates: state.to_vec() };
        Integrator {
            field,
            tolerances,
            method: Method::Automatic,
            controller: Controller::new(EXPLICIT_ORDER),
            proposal: None,
            is_begun: false,
            past: present.clone(),
            trial: present.clone(),
            present,
            explicit: Explicit::new(state.len()),
            implicit: None,
            is_implicit: false,
            suspicion: Suspicion::default(),
            inside: RefCell::new(Inside::new(state.len())),
        }
    }

    /// The same solution by `method`.
    #[must_use]
    pub fn with_method(mut self, method: Method) -> Self {
        self.method = method;
        self.turn(method == Method::Implicit);
        self
    }

    /// The present time, in seconds since the start of the flow.
    pub fn time(&self) -> f64 {
        self.present.time
    }

    /// The present state.
    pub fn state(&self) -> &[f64] {
        &self.present.state
    }

    /// Whether the next step is implicit.
    pub fn is_implicit(&self) -> bool {
        self.is_implicit
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
        let time = self.present.time;
        let remaining = limit - time;
        if remaining.is_nan() || remaining <= 0.0 {
            return Err(IntegrationFailure::LimitNotAhead { time, limit });
        }
        self.begin()?;
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
            self.trial.time = if lands { limit } else { time + step };
            let error = self.attempt(step);
            if error <= 1.0 {
                let next = step * self.controller.accept(error);
                self.proposal = Some(if lands { next.max(proposal) } else { next });
                return Ok(self.accept(step, limit));
            }
            step *= self.controller.reject(error);
            if step < self.smallest_step() {
                return Err(self.failure(error, step));
            }
        }
    }

    /// Goes back to where the last step began, which is taken again or in part.
    pub fn undo(&mut self) {
        if self.present.time > self.past.time {
            mem::swap(&mut self.past, &mut self.present);
        }
    }

    /// Goes on from another time and state, of the dimension of the present one, or with a field that
    /// has changed.
    pub fn restart(&mut self, time: f64, state: &[f64]) {
        self.present.time = time;
        self.present.state.copy_from_slice(state);
        self.is_begun = false;
        if let Some(implicit) = &mut self.implicit {
            implicit.forget();
        }
    }

    /// Evaluates the field at the start, unless that has been done.
    fn begin(&mut self) -> Result<(), IntegrationFailure> {
        if !self.is_begun {
            let Origin { time, state, rates } = &mut self.present;
            self.field.rates(*time, state, rates);
            if !rates.iter().all(|rate| rate.is_finite()) {
                return Err(self.undefined());
            }
            self.is_begun = true;
        }
        Ok(())
    }

    /// A first guess for the length of a step: of Hairer, Nørsett and Wanner, *Solving Ordinary
    /// Differential Equations I*, section II.4.
    ///
    /// An explicit Euler step, in which the state changes by a hundredth of its size, measures the
    /// second derivative; the guess is a step whose error these two derivatives suggest to be a
    /// hundredth of what is allowed.
    fn first_step(&mut self, longest: f64) -> f64 {
        let Origin { time, state, rates } = &self.present;
        let size = weighted_norm(&self.tolerances, state, |i| state[i]);
        let speed = weighted_norm(&self.tolerances, state, |i| rates[i]);
        let small = size < 1e-5 || speed < 1e-5;
        let euler = if small { 1e-6 } else { 0.01 * size / speed }.min(longest);

        let moved = state.iter().zip(rates).map(|(x, rate)| x + euler * rate);
        self.trial.state.iter_mut().zip(moved).for_each(|(place, x)| *place = x);
        self.field.rates(time + euler, &self.trial.state, &mut self.trial.rates);
        let change = |i: usize| (self.trial.rates[i] - rates[i]) / euler;
        let bend = weighted_norm(&self.tolerances, state, change);

        let largest = speed.max(bend);
        let exponent = 1.0 / self.order();
        let guess = if largest <= 1e-15 { euler * 1e-3 } else { (0.01 / largest).powf(exponent) };
        guess.max(1e-6).min(100.0 * euler)
    }

    /// The error of a step as a fraction of what is allowed; not finite where the field is not.
    fn attempt(&mut self, step: f64) -> f64 {
        let (field, tolerances, present) = (self.field, &self.tolerances, &self.present);
        let error = match &mut self.implicit {
            Some(implicit) if self.is_implicit => {
                implicit.attempt(field, tolerances, present, step, &mut self.trial)
            }
            _ => self.explicit.attempt(field, tolerances, present, step, &mut self.trial),
        };
        if error <= 1.0 {
            let Trial { time, state, rates } = &mut self.trial;
            field.rates(*time, state, rates);
            // The next step begins with these rates, and the sum is finite only if all are.
            return error + 0.0 * rates.iter().sum::<f64>();
        }
        error
    }

    /// Makes the trial the present.
    fn accept(&mut self, step: f64, limit: f64) -> Step<'_, F> {
        let was_implicit = self.is_implicit;
        let (advice, is_suspect) = match &mut self.implicit {
            Some(implicit) if was_implicit => {
                let advice = self.suspicion.after_implicit(implicit.stiffness(step));
                implicit.forget();
                (advice, false)
            }
            _ => {
                let motion = self.explicit.motion(step, &self.trial);
                (self.suspicion.after_explicit(motion), motion.speed > SUSPECT)
            }
        };
        mem::swap(&mut self.past, &mut self.present);
        mem::swap(&mut self.present, &mut self.trial);
        self.inside.get_mut().forget();
        if self.method == Method::Automatic {
            self.heed(advice, step, limit);
        }
        let stages = match &self.implicit {
            Some(implicit) if was_implicit => Stages::Implicit(implicit),
            _ => Stages::Explicit { explicit: &self.explicit, is_suspect },
        };
        Step {
            field: self.field,
            start: self.past.time,
            end: self.present.time,
            first: &self.past.state,
            last: &self.present.state,
            rates: [&self.past.rates, &self.present.rates],
            stages,
            inside: &self.inside,
            tolerances: self.tolerances,
        }
    }

    /// Turns to the other method if that is advised.
    fn heed(&mut self, advice: Advice, step: f64, limit: f64) {
        match advice {
            Advice::Stay => {}
            Advice::Turn => self.turn(!self.is_implicit),
            Advice::Try => {
                let much = MUCH_LONGER * step;
                if self.present.time + much <= limit && self.can_be_implicit(much) {
                    self.turn(true);
                    self.proposal = Some(much);
                }
            }
        }
    }

    /// Whether an implicit step of this length is accurate enough.
    fn can_be_implicit(&mut self, step: f64) -> bool {
        let dimension = self.present.state.len();
        let implicit = self.implicit.get_or_insert_with(|| Implicit::new(dimension));
        implicit.forget();
        self.trial.time = self.present.time + step;
        let (field, tolerances) = (self.field, &self.tolerances);
        implicit.attempt(field, tolerances, &self.present, step, &mut self.trial) <= 1.0
    }

    fn turn(&mut self, to_implicit: bool) {
        let dimension = self.present.state.len();
        if to_implicit {
            self.implicit.get_or_insert_with(|| Implicit::new(dimension)).forget();
        }
        self.is_implicit = to_implicit;
        self.suspicion = Suspicion::default();
        self.controller = Controller::new(self.order());
    }

    fn order(&self) -> f64 {
        if self.is_implicit { IMPLICIT_ORDER } else { EXPLICIT_ORDER }
    }

    fn smallest_step(&self) -> f64 {
        (SMALLEST_STEP * self.present.time.abs()).max(f64::MIN_POSITIVE)
    }

    fn failure(&self, error: f64, step: f64) -> IntegrationFailure {
        if error.is_finite() {
            let Origin { time, state, .. } = self.present.clone();
            IntegrationFailure::StepTooSmall { time, state, step }
        } else {
            self.undefined()
        }
    }

    fn undefined(&self) -> IntegrationFailure {
        let Origin { time, state, .. } = self.present.clone();
        IntegrationFailure::Undefined { time, state }
    }
}

/// The order of the error that the explicit method estimates.
const EXPLICIT_ORDER: f64 = 8.0;
/// The order of the error that the implicit method estimates.
const IMPLICIT_ORDER: f64 = 5.0;

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
