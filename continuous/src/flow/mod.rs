//! Flows: how a state moves while time passes, and when something happens on the way.
//!
//! A flow is given in one of three ways, and each has its own kind of solution:
//!
//! | flow | solution | accuracy |
//! | --- | --- | --- |
//! | ẋ = c | [`ConstantFlow`] | exact up to rounding |
//! | ẋ = A x + b | [`LinearFlow`] | exact up to rounding, by the matrix exponential |
//! | ẋ = f(t, x) | the [`Step`]s of an [`Integrator`] | to stated [`Tolerances`] |
//!
//! All three are [`Curve`]s: they can be evaluated at every instant, not only where a step ends.
//! That is what makes events precise. A curve comes in [`Piece`]s, polynomials with a bound on their
//! error, and on each of them [`isolate`] encloses what a predicate can do: it finds the first
//! instant at which it holds, proves that there is none, or says where it cannot tell. Where a
//! predicate is a function of which nothing is known, [`first_instant`] looks at states instead.
//!
//! A ball falls from a height of 20 m and hits the ground after 2 s:
//!
//! ```
//! use nalgebra::dmatrix;
//! use pleach_continuous::flow::{EventSearch, LinearFlow, first_instant};
//! use pleach_guards::{EvaluationError, variable};
//!
//! // Height and velocity: ḣ = v, v̇ = −10 m/s².
//! let matrix = dmatrix![0.0, 1.0; 0.0, 0.0];
//! let fall = LinearFlow::new(&matrix, &[0.0, -10.0], &[20.0, 0.0], 10.0)?;
//! let ground = variable("height").at_most(0.0);
//!
//! let impact = first_instant(&fall, 0.0, 10.0, &EventSearch::default(), &mut |state| {
//!     ground.evaluate(&[("height", state[0])])
//! })?;
//! assert!(impact.is_some_and(|impact| (impact.time - 2.0).abs() < 1e-15));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bend;
mod chebyshev;
mod composed;
mod constant;
mod controller;
mod dormand_prince;
mod event;
mod explicit;
mod factorisation;
mod implicit;
mod integrator;
mod invalid;
mod isolation;
mod linear;
mod piece;
mod root;
mod rosenbrock;
mod step;
mod suspicion;
mod tolerances;

pub use composed::Polynomial;
pub use constant::ConstantFlow;
pub use event::{EventSearch, InvalidSearch, Onset, first_instant};
pub use integrator::{IntegrationFailure, Integrator, Method};
pub use invalid::InvalidFlow;
pub use isolation::{Doubt, Finding, Lost, Uncertainty, Watch, isolate};
pub use linear::{LinearField, LinearFlow};
pub use piece::Piece;
pub use step::Step;
pub use tolerances::{InvalidTolerances, Tolerances};

/// The right-hand side f of a differential equation ẋ = f(t, x).
///
/// Closures over `(time, state, rates)` are vector fields:
///
/// ```
/// use pleach_continuous::flow::VectorField;
///
/// let pendulum = |_time: f64, state: &[f64], rates: &mut [f64]| {
///     rates[0] = state[1];
///     rates[1] = -state[0].sin();
/// };
/// let mut rates = [0.0; 2];
/// pendulum.rates(0.0, &[0.0, 1.0], &mut rates);
/// assert_eq!(rates, [1.0, 0.0]);
/// ```
pub trait VectorField {
    /// Writes f(`time`, `state`) to `rates`, in units of the state per second.
    ///
    /// `time` is in seconds since the start of the flow; both slices have the dimension of the
    /// state. A rate that is not a finite number says that the field is undefined there; nothing
    /// may be read from what `rates` held before.
    fn rates(&self, time: f64, state: &[f64], rates: &mut [f64]);

    /// Writes ∂f/∂x at `time` and `state` to `jacobian`, row by row, if the field knows it, and
    /// says so; otherwise an implicit method takes differences.
    fn jacobian(&self, _time: f64, _state: &[f64], _jacobian: &mut [f64]) -> bool {
        false
    }
}

impl<F: Fn(f64, &[f64], &mut [f64])> VectorField for F {
    fn rates(&self, time: f64, state: &[f64], rates: &mut [f64]) {
        self(time, state, rates);
    }
}

/// A piece of a solution, defined from its start to its end.
pub trait Curve {
    /// The first instant, in seconds since the start of the flow.
    fn start(&self) -> f64;

    /// The last instant, in seconds since the start of the flow; not before the start.
    fn end(&self) -> f64;

    /// The number of components of the state.
    fn dimension(&self) -> usize;

    /// Writes the state at `time` to `state`, which has the dimension of the curve.
    ///
    /// Before the start it is the state at the start, after the end the state at the end.
    fn state_at(&self, time: f64, state: &mut [f64]);

    /// How long, in seconds from an instant on, until the curve has bent noticeably: a search that
    /// looks several times in that span sees what it does. Infinite if it bends only once or so.
    fn time_scale(&self, _time: f64) -> f64 {
        self.end() - self.start()
    }
    /// The piece of the curve that begins at `time` or holds it, as polynomials; none where nothing
    /// is known but values.
    fn piece(&self, _time: f64) -> Option<Piece> {
        None
    }
}
