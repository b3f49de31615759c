//! The integrator against closed forms.

use std::cell::Cell;

use pleach_continuous::flow::{
    Curve, IntegrationFailure, Integrator, Method, Tolerances, VectorField,
};

use super::support::{compare, distance, state, tolerances};

/// ẍ = −x
fn oscillator(_time: f64, state: &[f64], rates: &mut [f64]) {
    rates[0] = state[1];
    rates[1] = -state[0];
}

/// ẋ = x (1 − x)
fn logistic(_time: f64, state: &[f64], rates: &mut [f64]) {
    rates[0] = state[0] * (1.0 - state[0]);
}

fn turned(time: f64) -> Vec<f64> {
    vec![time.sin(), time.cos()]
}

/// A field given as a plain function.
type Field = fn(f64, &[f64], &mut [f64]);
type Solution = fn(f64) -> Vec<f64>;

#[test]
fn solutions_agree_with_closed_forms() {
    let cases: [(&str, Field, Solution); 6] = [
        ("oscillator", oscillator, turned),
        (
            "damped oscillator",
            |_, x, rates| {
                rates[0] = x[1];
                rates[1] = -1.0625 * x[0] - 0.5 * x[1];
            },
            |t| {
                let (sin, cos) = t.sin_cos();
                let shrunk = (-0.25 * t).exp();
                vec![shrunk * sin, shrunk * (cos - 0.25 * sin)]
            },
        ),
        ("growth", |_, x, rates| rates[0] = x[0], |t| vec![t.exp()]),
        ("decay", |_, x, rates| rates[0] = -x[0], |t| vec![(-t).exp()]),
        ("logistic", logistic, |t| vec![1.0 / (1.0 + 9.0 * (-t).exp())]),
        ("forced by time", |t, _, rates| rates[0] = t.cos(), |t| vec![t.sin()]),
    ];
    for relative in [1e-6, 1e-9, 1e-12] {
        for (name, field, exact) in &cases {
            let run = compare(field, 10.0, tolerances(relative), exact);
            // The largest value, which growth multiplies errors by.
            let size = exact(10.0).into_iter().map(f64::abs).fold(1.0, f64::max);
            for (place, error) in [("ends", run.at_ends), ("inner points", run.within)] {
                assert!(
                    error < 20.0 * relative * size,
                    "{name} to {relative:e}: error {error:e} at {place} of {} steps",
                    run.steps
                );
            }
        }
    }
}

#[test]
fn free_flight_is_exact_up_to_rounding() {
    let flight = |_: f64, x: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[x[1], -9.81]);
    };
    let exact = |t: f64| vec![5.0 + 3.0 * t - 0.5 * 9.81 * t * t, 3.0 - 9.81 * t];
    let run = compare(&flight, 2.0, Tolerances::default(), exact);
    assert!(run.at_ends < 2e-13 && run.within < 2e-13, "{:e} {:e}", run.at_ends, run.within);
}

/// The errors of one step of length h from time 0, at its end and at most within.
fn errors_of_one_step(step: f64) -> (f64, f64) {
    let (field, exact) = (logistic, |t: f64| vec![1.0 / (1.0 + 9.0 * (-t).exp())]);
    let loose = Tolerances::new(0.5, 1e3).unwrap();
    let run = compare(&field, step, loose, exact);
    assert_eq!(run.steps, 1);
    (run.at_ends, run.within)
}

#[test]
fn an_explicit_step_has_order_8_at_its_end_and_7_within() {
    let (coarse, fine) = (errors_of_one_step(1.0), errors_of_one_step(0.5));
    let (at_end, within) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
    // The error that one step adds has one order more.
    assert!((7.8..10.0).contains(&at_end), "local order {at_end} at the end");
    assert!((6.8..9.0).contains(&within), "local order {within} within");
}

/// The error at time 2 after `steps` steps of one length.
fn error_after(count: u32, method: Method) -> f64 {
    let loose = Tolerances::new(0.5, 1e3).unwrap();
    let mut integrator = Integrator::new(&oscillator, 0.0, &[0.0, 1.0], loose).with_method(method);
    for i in 1..=count {
        let limit = 2.0 * f64::from(i) / f64::from(count);
        assert_eq!(integrator.step(limit).unwrap().end(), limit);
    }
    distance(integrator.state(), &turned(2.0))
}

#[test]
fn halving_all_steps_divides_the_error_by_the_power_of_the_order() {
    for (method, count, order) in [(Method::Explicit, 4, 8.0), (Method::Implicit, 20, 5.0)] {
        let found = (error_after(count, method) / error_after(2 * count, method)).log2();
        // The implicit method does better on linear flows.
        assert!((order - 0.3..order + 1.0).contains(&found), "{method:?}: order {found}");
    }
}

#[test]
fn the_energy_of_an_orbit_stays() {
    // An ellipse of eccentricity 0.6 about a body of unit weight, from its nearest point.
    let orbit = |_: f64, x: &[f64], rates: &mut [f64]| {
        let cubed = (x[0] * x[0] + x[1] * x[1]).powf(1.5);
        rates.copy_from_slice(&[x[2], x[3], -x[0] / cubed, -x[1] / cubed]);
    };
    let energy = |x: &[f64]| 0.5 * (x[2] * x[2] + x[3] * x[3]) - x[0].hypot(x[1]).recip();
    let start = [0.4, 0.0, 0.0, 2.0];
    let mut integrator = Integrator::new(&orbit, 0.0, &start, tolerances(1e-10));
    let period = std::f64::consts::TAU;
    while integrator.time() < period {
        let step = integrator.step(period).unwrap();
        let middle = state(&step, 0.5 * (step.start() + step.end()));
        assert!((energy(&middle) - energy(&start)).abs() < 1e-8);
    }
    assert!((energy(integrator.state()) - energy(&start)).abs() < 1e-9);
    assert!(distance(integrator.state(), &start) < 1e-7, "{:?}", integrator.state());
}

#[test]
fn steps_join_smoothly_and_end_exactly_where_they_say() {
    let mut integrator = Integrator::new(&oscillator, 0.0, &[0.0, 1.0], Tolerances::default());
    let (mut reached, mut last) = (0.0, vec![0.0, 1.0]);
    while reached < 3.0 {
        let step = integrator.step(3.0).unwrap();
        assert_eq!((step.start(), state(&step, step.start())), (reached, last));
        (reached, last) = (step.end(), state(&step, step.end()));
        // Just before the end, the interpolation meets the end.
        let inside = state(&step, reached - 1e-9);
        assert!(distance(&inside, &turned(reached - 1e-9)) < 1e-8);
        assert!(distance(&inside, &last) < 2e-9);
        assert_eq!((integrator.time(), integrator.state()), (reached, &last[..]));
    }
    assert_eq!(reached, 3.0);
}

#[test]
fn the_field_is_not_asked_beyond_the_limit() {
    let field = |time: f64, x: &[f64], rates: &mut [f64]| {
        assert!((0.0..=0.1).contains(&time));
        rates[0] = -1e-3 * x[0];
    };
    let mut integrator = Integrator::new(&field, 0.0, &[1.0], Tolerances::default());
    while integrator.time() < 0.1 {
        integrator.step(0.1).unwrap();
    }
}

#[test]
fn a_limit_that_cuts_a_step_short_does_not_shorten_the_next() {
    let mut integrator = Integrator::new(&oscillator, 0.0, &[0.0, 1.0], tolerances(1e-6));
    let usual = (0..5).map(|_| {
        let step = integrator.step(100.0).unwrap();
        step.end() - step.start()
    });
    let usual = usual.last().unwrap();
    let limit = integrator.time() + 1e-6;
    assert_eq!(integrator.step(limit).unwrap().end(), limit);
    let next = integrator.step(100.0).unwrap();
    assert!(next.end() - next.start() > 0.5 * usual);
}

#[test]
fn no_step_is_longer_than_allowed() {
    let rest = |_: f64, _: &[f64], rates: &mut [f64]| rates[0] = 0.0;
    let tolerances = Tolerances::default().with_largest_step(0.25).unwrap();
    let mut integrator = Integrator::new(&rest, 0.0, &[1.0], tolerances);
    while integrator.time() < 10.0 {
        let step = integrator.step(10.0).unwrap();
        assert!(step.end() - step.start() <= 0.25 * (1.0 + 1e-12));
    }
}

#[test]
fn what_is_asked_of_a_component_does_not_depend_on_the_others() {
    let crowd = |_: f64, x: &[f64], rates: &mut [f64]| {
        rates.fill(0.0);
        oscillator(0.0, &x[..2], &mut rates[..2]);
    };
    let mut start = vec![1.0; 1000];
    start[0] = 0.0;
    let mut alone = Integrator::new(&oscillator, 0.0, &[0.0, 1.0], Tolerances::default());
    let mut together = Integrator::new(&crowd, 0.0, &start, Tolerances::default());
    while alone.time() < 1.0 {
        alone.step(1.0).unwrap();
        together.step(1.0).unwrap();
        assert_eq!(alone.time(), together.time());
        assert_eq!(alone.state(), &together.state()[..2]);
    }
}

#[test]
fn a_state_without_components_has_steps_too() {
    let nothing = |_: f64, _: &[f64], _: &mut [f64]| {};
    let mut integrator = Integrator::new(&nothing, 0.0, &[], Tolerances::default());
    while integrator.time() < 1e9 {
        integrator.step(1e9).unwrap();
    }
}

/// The failure that ends an integration to time 10.
fn failure(field: &dyn VectorField, start: f64) -> IntegrationFailure {
    let mut integrator = Integrator::new(field, 0.0, &[start], Tolerances::default());
    loop {
        let before = (integrator.time(), integrator.state().to_vec());
        assert!(before.0 < 10.0, "no failure");
        if let Err(failure) = integrator.step(10.0) {
            assert_eq!((integrator.time(), integrator.state()), (before.0, &before.1[..]));
            return failure;
        }
    }
}

#[test]
fn a_solution_that_runs_to_infinity_fails_where_it_does() {
    // ẋ = x² from 1 is 1/(1 − t).
    let explosion = |_: f64, x: &[f64], rates: &mut [f64]| rates[0] = x[0] * x[0];
    let IntegrationFailure::StepTooSmall { time, state, step } = failure(&explosion, 1.0) else {
        panic!("the step becomes too small");
    };
    assert!((time - 1.0).abs() < 1e-8 && state[0] > 1e8 && step < 1e-14, "{time} {state:?}");
}

#[test]
fn a_field_that_ends_fails_where_it_does() {
    // ẋ = −√(1 − t), undefined from time 1 on.
    let ending = |t: f64, _: &[f64], rates: &mut [f64]| rates[0] = -(1.0 - t).sqrt();
    let IntegrationFailure::Undefined { time, state } = failure(&ending, 1.0) else {
        panic!("the field is undefined");
    };
    assert!((time - 1.0).abs() < 1e-6 && (state[0] - 1.0 / 3.0).abs() < 1e-6, "{time} {state:?}");

    let nowhere = |_: f64, _: &[f64], rates: &mut [f64]| rates[0] = f64::NAN;
    assert_eq!(
        failure(&nowhere, 1.0),
        IntegrationFailure::Undefined { time: 0.0, state: vec![1.0] }
    );
}

#[test]
fn a_step_whose_field_ends_inside_is_still_a_curve() {
    let ended = Cell::new(false);
    let field = |time: f64, x: &[f64], rates: &mut [f64]| {
        oscillator(time, x, rates);
        if ended.get() {
            rates[1] = f64::NAN;
        }
    };
    let mut integrator = Integrator::new(&field, 0.0, &[0.0, 1.0], tolerances(1e-6));
    integrator.step(0.1).unwrap();
    let step = integrator.step(0.2).unwrap();
    ended.set(true);
    let middle = 0.5 * (step.start() + step.end());
    assert!(distance(&state(&step, middle), &turned(middle)) < 1e-5);
}

#[test]
fn a_step_needs_time() {
    let mut integrator = Integrator::new(&oscillator, 1.0, &[0.0, 1.0], Tolerances::default());
    for limit in [1.0, 0.0, f64::NAN] {
        assert!(matches!(
            integrator.step(limit),
            Err(IntegrationFailure::LimitNotAhead { time: 1.0, .. })
        ));
    }
}

#[test]
fn tolerances_are_checked() {
    assert!(Tolerances::new(1e-15, 1.0).is_err());
    assert!(Tolerances::new(f64::NAN, 1.0).is_err());
    assert!(Tolerances::new(1e-6, 0.0).is_err());
    assert!(Tolerances::default().with_largest_step(0.0).is_err());
}
