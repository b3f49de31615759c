//! Stiff flows: implicit steps, and when they are taken.

use std::cell::Cell;

use pleach_continuous::flow::{Curve, Integrator, Method, Step, Tolerances, VectorField};

use super::support::{compare_by, state, tolerances};

/// ẋ = −10⁶ (x − cos t) − sin t, which is cos t after an instant.
fn follower(time: f64, x: &[f64], rates: &mut [f64]) {
    rates[0] = -1e6 * (x[0] - time.cos()) - time.sin();
}

/// Robertson's reaction, with rates of 0.04, 10⁴ and 3·10⁷.
fn robertson(_: f64, x: &[f64], rates: &mut [f64]) {
    let slow = -0.04 * x[0] + 1e4 * x[1] * x[2];
    let fast = 3e7 * x[1] * x[1];
    rates.copy_from_slice(&[slow, -slow - fast, fast]);
}

/// Van der Pol's oscillator with μ = 1000.
fn van_der_pol(_: f64, x: &[f64], rates: &mut [f64]) {
    rates.copy_from_slice(&[x[1], 1000.0 * (1.0 - x[0] * x[0]) * x[1] - x[0]]);
}

/// The number of steps to `end`, and the state there.
fn integrate(
    field: &impl VectorField,
    start: &[f64],
    end: f64,
    tolerances: Tolerances,
) -> (usize, Vec<f64>) {
    let mut integrator = Integrator::new(field, 0.0, start, tolerances);
    let mut steps = 0;
    while integrator.time() < end {
        integrator.step(end).expect("the solution goes on");
        steps += 1;
    }
    (steps, integrator.state().to_vec())
}

#[test]
fn a_stiff_flow_is_followed_in_long_steps() {
    for relative in [1e-6, 1e-9] {
        for method in [Method::Automatic, Method::Implicit] {
            let exact = |t: f64| vec![t.cos()];
            let run = compare_by(method, &follower, 10.0, tolerances(relative), &exact);
            assert!(run.steps < 1000, "{method:?} takes {} steps", run.steps);
            assert!(run.at_ends < 20.0 * relative, "{method:?}: {:e}", run.at_ends);
            assert!(run.within < 100.0 * relative, "{method:?}: {:e}", run.within);
        }
    }
}

/// The reference is that of the *Test Set for Initial Value Problem Solvers* (Mazzia and Magherini
/// 2008), at t = 10¹¹.
#[test]
fn robertsons_reaction_goes_on_for_ages() {
    let (steps, end) = integrate(
        &robertson,
        &[1.0, 0.0, 0.0],
        1e11,
        Tolerances::new(1e-7, 1e-14).expect("positive tolerances"),
    );
    let reference = [0.2083340149701255e-7, 0.8333360770334713e-13, 0.999999979166505];
    for (found, expected) in end.iter().zip(reference) {
        assert!((found / expected - 1.0).abs() < 1e-3, "{end:?}");
    }
    assert!(steps < 3000, "{steps} steps");
}

/// The reference is that of the same test set, for the problem in scaled time.
#[test]
fn van_der_pols_oscillator_relaxes() {
    // With time in units of μ seconds and the rate in units of 1/μ, μ² = 10⁶ is their 1/ε.
    let (steps, end) = integrate(&van_der_pol, &[2.0, 0.0], 2000.0, tolerances(1e-9));
    let reference = 1.706167732170483;
    assert!((end[0] - reference).abs() < 1e-5, "{end:?}");
    assert!(steps < 6000, "{steps} steps");
}

#[test]
fn methods_change_where_the_flow_does() {
    // Stiff for ten seconds, and then an oscillation that is not.
    let field = |time: f64, x: &[f64], rates: &mut [f64]| {
        let pull = if time < 10.0 { 1e4 } else { 0.0 };
        rates.copy_from_slice(&[x[1] - pull * x[0], -x[0]]);
    };
    let mut integrator = Integrator::new(&field, 0.0, &[1.0, 1.0], Tolerances::default());
    let (mut early, mut late) = (false, true);
    while integrator.time() < 100.0 {
        integrator.step(100.0).expect("the solution goes on");
        if (5.0..10.0).contains(&integrator.time()) {
            early |= integrator.is_implicit();
        }
        if integrator.time() > 50.0 {
            late &= !integrator.is_implicit();
        }
    }
    assert!(early && late, "implicit early: {early}, explicit late: {late}");
}

/// ẋ = −λ (x − cos t) − sin t is cos t. With λ = 1000 the explicit method follows the fast motion at
/// |h λ| ≈ 2, far from the boundary of its stability, because its stages are off the slow solution.
#[test]
fn a_decay_that_has_faded_is_noticed_before_it_limits_stability() {
    for (lambda, is_stiff) in [(1000.0, true), (300.0, true), (1.0, false)] {
        let field = |time: f64, x: &[f64], rates: &mut [f64]| {
            rates[0] = -lambda * (x[0] - time.cos()) - time.sin();
        };
        let mut integrator = Integrator::new(&field, 0.0, &[1.0], Tolerances::default());
        let mut steps = 0;
        while integrator.time() < 100.0 {
            integrator.step(100.0).expect("the solution goes on");
            steps += 1;
            if integrator.time() > 1.0 {
                assert_eq!(integrator.is_implicit(), is_stiff, "λ = {lambda}");
            }
        }
        assert!(steps < if is_stiff { 10_000 } else { 300 }, "λ = {lambda}: {steps} steps");
        assert!((integrator.state()[0] - 100f64.cos()).abs() < 1e-8);
    }
}

#[test]
fn a_field_that_knows_its_slopes_is_not_asked_for_differences() {
    struct Known(Cell<u32>);
    impl VectorField for Known {
        fn rates(&self, _: f64, x: &[f64], rates: &mut [f64]) {
            self.0.set(self.0.get() + 1);
            rates.copy_from_slice(&[-1e5 * x[0] + x[1], -x[1]]);
        }

        fn jacobian(&self, _: f64, _: &[f64], jacobian: &mut [f64]) -> bool {
            jacobian.copy_from_slice(&[-1e5, 1.0, 0.0, -1.0]);
            true
        }
    }
    let field = Known(Cell::new(0));
    let mut integrator =
        Integrator::new(&field, 0.0, &[1.0, 1.0], tolerances(1e-8)).with_method(Method::Implicit);
    integrator.step(1e-3).expect("a step");
    field.0.set(0);
    integrator.step(1e-3).expect("a step");
    // Seven stages, and an evaluation each for the slope over time, in the middle and at the end.
    assert_eq!(field.0.get(), 10);
    let end = integrator.time();
    let step: Step<'_, Known> = integrator.step(1.0).expect("a step");
    assert_eq!(state(&step, end), state(&step, step.start()));
}
