//! How long the next step should be.

/// A proportional–integral controller of the step size.
///
/// It chooses the next step such that its error is expected to be just allowed, from the errors of
/// the last two steps; looking at both keeps the steps from swinging where stability and not
/// accuracy limits them. Gustafsson's control in the form of Hairer and Wanner, *Solving Ordinary
/// Differential Equations II*, 2nd ed., section IV.2, doi:10.1007/978-3-642-05221-7.
#[derive(Clone, Copy, Debug)]
pub(super) struct Controller {
    /// The natural logarithm of the error of the last accepted step.
    last_error: f64,
    /// Whether the step before was rejected, after which the next must not grow.
    rejected: bool,
}

/// How much the error of this step counts. An error of order 5 suggests 1/5; what the integral
/// part adds, the proportional part gives back.
const PROPORTIONAL: f64 = 0.2 - 0.75 * INTEGRAL;
/// How much the error of the step before counts: the value that Hairer and Wanner recommend.
const INTEGRAL: f64 = 0.04;
/// Aim a little below what is allowed, so that few steps are rejected.
const SAFETY: f64 = 0.9;
/// No step is longer than the one before by more than this factor.
const LARGEST_GROWTH: f64 = 10.0;
/// No step is shorter than the one before by more than this factor.
const LARGEST_SHRINKAGE: f64 = 0.2;
/// Smaller errors say nothing about the flow: they are remembered as this one.
const SMALLEST_ERROR: f64 = 1e-4;

impl Controller {
    /// The controller before the first step.
    pub(super) fn new() -> Self {
        Controller { last_error: SMALLEST_ERROR.ln(), rejected: false }
    }

    /// By which factor the next step is longer, after one with this error was accepted.
    ///
    /// The error is a fraction of what is allowed, so at most 1.
    pub(super) fn accept(&mut self, error: f64) -> f64 {
        let logarithm = error.ln();
        let wanted = SAFETY * (INTEGRAL * self.last_error - PROPORTIONAL * logarithm).exp();
        let largest = if self.rejected { 1.0 } else { LARGEST_GROWTH };
        self.last_error = logarithm.max(SMALLEST_ERROR.ln());
        self.rejected = false;
        wanted.clamp(LARGEST_SHRINKAGE, largest)
    }

    /// By which factor to shorten a step whose error is more than is allowed, or not a number.
    pub(super) fn reject(&mut self, error: f64) -> f64 {
        self.rejected = true;
        // `max` ignores the NaN that an undefined error gives.
        (SAFETY * error.powf(-PROPORTIONAL)).max(LARGEST_SHRINKAGE)
    }
}
