//! Steps of the integrator, and events. Beside other libraries they are measured by the package in
//! `peers`.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::dmatrix;
use pleach::continuous::flow::{
    Curve, EventSearch, Integrator, LinearFlow, Tolerances, first_instant,
};
use pleach::guards::{EvaluationError, Verdict};

/// Van der Pol's oscillator with μ = 1000 over two periods and a half, which explicit methods take a
/// million steps for.
fn stiff(criterion: &mut Criterion) {
    let field = |_: f64, x: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[x[1], 1000.0 * (1.0 - x[0] * x[0]) * x[1] - x[0]]);
    };
    criterion.bench_function("stiff_van_der_pol", |bencher| {
        bencher.iter(|| {
            let mut integrator = Integrator::new(&field, 0.0, &[2.0, 0.0], Tolerances::default());
            while integrator.time() < 4000.0 {
                integrator.step(4000.0).expect("the solution goes on");
            }
            integrator.state()[0]
        })
    });
}

/// A thousand oscillators in one state: the time per step.
fn crowd(criterion: &mut Criterion) {
    let field = |_: f64, state: &[f64], rates: &mut [f64]| {
        for (x, rate) in state.chunks_exact(2).zip(rates.chunks_exact_mut(2)) {
            (rate[0], rate[1]) = (x[1], -x[0]);
        }
    };
    let start = [0.0, 1.0].repeat(1000);
    let mut integrator = Integrator::new(&field, 0.0, &start, Tolerances::default());
    criterion.bench_function("step_of_1000_oscillators", |bencher| {
        bencher.iter(|| integrator.step(f64::INFINITY).map(|step| step.end()))
    });
}

/// A ball's impact on the ground, from a flight of ten seconds.
fn events(criterion: &mut Criterion) {
    let matrix = dmatrix![0.0, 1.0; 0.0, 0.0];
    let flight = LinearFlow::new(&matrix, &[0.0, -9.81], &[7.0, 0.0], 10.0).expect("a flow");
    let ground = |x: &[f64]| Ok(Verdict { margin: -x[0], holds: x[0] <= 0.0 });
    criterion.bench_function("impact_of_a_ball", |bencher| {
        bencher.iter(|| -> Result<_, EvaluationError> {
            first_instant(&flight, 0.0, 10.0, &EventSearch::default(), &mut { ground })
        })
    });
    let matrix = dmatrix![0.0, 1.0, 0.0, 0.0; -4.0, -0.1, 1.0, 0.0;
                          0.0, 0.0, 0.0, 1.0; 0.5, 0.0, -9.0, -0.1];
    let coupled =
        LinearFlow::new(&matrix, &[0.0, 1.0, 0.0, -1.0], &[1.0; 4], 100.0).expect("a flow");
    let mut state = [0.0; 4];
    criterion.bench_function("state_of_two_coupled_oscillators", |bencher| {
        bencher.iter(|| coupled.state_at(black_box(71.3), &mut state))
    });
}

criterion_group!(benches, stiff, crowd, events);
criterion_main!(benches);
