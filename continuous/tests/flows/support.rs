//! What the tests share.

use pleach_continuous::flow::{Curve, Integrator, Method, Tolerances, VectorField};
use pleach_guards::Verdict;

/// The state of a curve at one instant.
pub fn state(curve: &(impl Curve + ?Sized), time: f64) -> Vec<f64> {
    let mut state = vec![0.0; curve.dimension()];
    curve.state_at(time, &mut state);
    state
}

/// The verdict of "margin ≥ 0".
pub fn reached(margin: f64) -> Verdict {
    Verdict { margin, holds: margin >= 0.0 }
}

pub fn tolerances(relative: f64) -> Tolerances {
    Tolerances::new(relative, relative * 1e-3).unwrap()
}

/// What an integration to `end` amounts to.
pub struct Run {
    pub steps: usize,
    /// The largest error at the ends of the steps.
    pub at_ends: f64,
    /// The largest error at nine instants within each step.
    pub within: f64,
}

/// Integrates from `exact(0)` and compares with `exact` everywhere.
pub fn compare(
    field: &impl VectorField,
    end: f64,
    tolerances: Tolerances,
    exact: impl Fn(f64) -> Vec<f64>,
) -> Run {
    compare_by(Method::Automatic, field, end, tolerances, &exact)
}

/// As [`compare`], by one method.
pub fn compare_by(
    method: Method,
    field: &impl VectorField,
    end: f64,
    tolerances: Tolerances,
    exact: &impl Fn(f64) -> Vec<f64>,
) -> Run {
    let mut integrator = Integrator::new(field, 0.0, &exact(0.0), tolerances).with_method(method);
    let mut run = Run { steps: 0, at_ends: 0.0, within: 0.0 };
    while integrator.time() < end {
        let step = integrator.step(end).unwrap();
        run.steps += 1;
        for tenth in 1..=10 {
            let time = step.start() + 0.1 * f64::from(tenth) * (step.end() - step.start());
            let error = distance(&state(&step, time), &exact(time));
            let worst = if tenth == 10 { &mut run.at_ends } else { &mut run.within };
            *worst = worst.max(error);
        }
    }
    run
}

/// The largest difference of two components.
pub fn distance(left: &[f64], right: &[f64]) -> f64 {
    assert_eq!(left.len(), right.len());
    left.iter().zip(right).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
