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
    /// How much the error of this step counts, and that of the step before.
    proportional: f64,
    integral: f64,
}

/// How much the error of the step before counts, as a fraction of what that of this step does: a
/// fifth, as Hairer and Wanner recommend for order 5.
const INTEGRAL: f64 = 0.2;
/// How much of what the integral part adds the proportional part gives back.
const GIVEN_BACK: f64 = 0.75;
/// Aim a little below what is allowed, so that few steps are rejected.
const SAFETY: f64 = 0.9;
/// No step is longer than the one before by more than this factor.
const LARGEST_GROWTH: f64 = 10.0;
/// No step is shorter than the one before by more than this factor.
const LARGEST_SHRINKAGE: f64 = 0.2;
/// Smaller errors say nothing about the flow: they are remembered as this one.
const SMALLEST_ERROR: f64 = 1e-4;

impl Controller {
    /// The controller before the first step of a method whose error is of this order.
    pub(super) fn new(order: f64) -> Self {
        let integral = INTEGRAL / order;
        let proportional = 1.0 / order - GIVEN_BACK * integral;
        Controller { last_error: SMALLEST_ERROR.ln(), rejected: false, proportional, integral }
    }

    /// By which factor the next step is longer, after one with this error was accepted.
    ///
    /// The error is a fraction of what is allowed, so at most 1.
    pub(super) fn accept(&mut self, error: f64) -> f64 {
        let logarithm = error.ln();
        let wanted =
            SAFETY * (self.integral * self.last_error - self.proportional * logarithm).exp();
        let largest = if self.rejected { 1.0 } else { LARGEST_GROWTH };
        self.last_error = logarithm.max(SMALLEST_ERROR.ln());
        self.rejected = false;
        wanted.clamp(LARGEST_SHRINKAGE, largest)
    }

    /// By which factor to shorten a step whose error is more than is allowed, or not a number.
    pub(super) fn reject(&mut self, error: f64) -> f64 {
        self.rejected = true;
        // `max` ignores the NaN that an undefined error gives.
        (SAFETY * error.powf(-self.proportional)).max(LARGEST_SHRINKAGE)
    }
}
