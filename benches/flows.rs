//! Integration against `ode_solvers`, at the same achieved error and in one run.
//!
//! Both solve the same flow. Ours runs at its default tolerances; those of the other are the
//! loosest with which its solution ends no farther from the true one than ours does. Before the
//! times, the errors and numbers of steps are printed.

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::dmatrix;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dopri5, SVector, System};
use pleach::continuous::flow::{
    Curve, EventSearch, Integrator, LinearFlow, Tolerances, first_instant,
};
use pleach::guards::{EvaluationError, Verdict};

/// A problem with its true answer.
struct Problem<const N: usize> {
    name: &'static str,
    field: fn(&[f64; N]) -> [f64; N],
    start: [f64; N],
    end: f64,
    answer: [f64; N],
}

/// Van der Pol's oscillator, ẍ = μ (1 − x²) ẋ − x, with μ = 2 over two and a half periods.
fn van_der_pol() -> Problem<2> {
    let field = |x: &[f64; 2]| [x[1], 2.0 * (1.0 - x[0] * x[0]) * x[1] - x[0]];
    let mut problem =
        Problem { name: "van_der_pol", field, start: [2.0, 0.0], end: 20.0, answer: [0.0; 2] };
    let strict = Tolerances::new(1e-14, 1e-16).expect("positive tolerances");
    problem.answer = problem.ours(strict).end;
    problem
}

/// A body on an ellipse of eccentricity 0.6 about one of unit weight: back at its start after 2π.
fn orbit() -> Problem<4> {
    let field = |x: &[f64; 4]| {
        let squared = x[0] * x[0] + x[1] * x[1];
        let cubed = squared * squared.sqrt();
        [x[2], x[3], -x[0] / cubed, -x[1] / cubed]
    };
    let start = [0.4, 0.0, 0.0, 2.0];
    Problem { name: "orbit", field, start, end: 3.0 * TAU, answer: start }
}

/// Where a solution ends, and after how many steps.
struct Solution<const N: usize> {
    end: [f64; N],
    steps: usize,
}

/// The problem as `ode_solvers` wants it.
#[derive(Clone, Copy)]
struct Theirs<const N: usize>(fn(&[f64; N]) -> [f64; N]);

impl<const N: usize> System<f64, SVector<f64, N>> for Theirs<N> {
    fn system(&self, _time: f64, state: &SVector<f64, N>, rates: &mut SVector<f64, N>) {
        *rates = SVector::from((self.0)(&(*state).into()));
    }
}

impl<const N: usize> Problem<N> {
    fn ours(&self, tolerances: Tolerances) -> Solution<N> {
        let field = |_: f64, state: &[f64], rates: &mut [f64]| {
            let state: &[f64; N] = state.try_into().expect("the dimension of the problem");
            rates.copy_from_slice(&(self.field)(state));
        };
        let mut integrator = Integrator::new(&field, 0.0, &self.start, tolerances);
        let mut steps = 0;
        while integrator.time() < self.end {
            integrator.step(self.end).expect("a smooth flow");
            steps += 1;
        }
        let end = integrator.state().try_into().expect("the dimension of the problem");
        Solution { end, steps }
    }

    fn theirs(&self, relative: f64) -> Solution<N> {
        // All its defaults, but with the states at the ends of steps as its only output, which is
        // its fastest way.
        let mut stepper = Dopri5::from_param(
            Theirs(self.field),
            0.0,
            self.end,
            self.end,
            SVector::from(self.start),
            relative,
            relative * ABSOLUTE_PER_RELATIVE,
            0.9,
            0.04,
            0.2,
            10.0,
            self.end,
            0.0,
            100_000,
            1000,
            OutputType::Sparse,
        );
        let statistics = stepper.integrate().expect("a smooth flow");
        let end = *stepper.y_out().last().expect("the end is put out");
        Solution { end: end.into(), steps: statistics.accepted_steps as usize }
    }

    fn error(&self, solution: &Solution<N>) -> f64 {
        let differences = solution.end.iter().zip(&self.answer).map(|(x, y)| (x - y).abs());
        differences.fold(0.0, f64::max)
    }

    /// The loosest relative tolerance, on a grid of twenty per decade, that gives this error.
    fn their_tolerance(&self, error: f64) -> f64 {
        let grid = (80..260).map(|step| 10f64.powf(-f64::from(step) / 20.0));
        let good = |relative: &f64| self.error(&self.theirs(*relative)) <= error;
        grid.into_iter().find(good).expect("some tolerance is strict enough")
    }

    fn compare(&self, criterion: &mut Criterion) {
        let mut group = criterion.benchmark_group(self.name);
        for relative in [1e-6, 1e-9] {
            let tolerances = Tolerances::new(relative, relative * ABSOLUTE_PER_RELATIVE)
                .expect("positive tolerances");
            let ours = self.ours(tolerances);
            let their_relative = self.their_tolerance(self.error(&ours));
            for (name, relative, solution) in [
                ("pleach", relative, &ours),
                ("ode_solvers, same tolerances", relative, &self.theirs(relative)),
                ("ode_solvers, same error", their_relative, &self.theirs(their_relative)),
            ] {
                let error = self.error(solution);
                println!(
                    "{} with {name}: relative tolerance {relative:.1e}, error {error:.1e}, \
                     {} steps",
                    self.name, solution.steps
                );
            }
            group.bench_function(BenchmarkId::new("pleach", relative), |bencher| {
                bencher.iter(|| self.ours(black_box(tolerances)))
            });
            group.bench_function(BenchmarkId::new("ode_solvers, same tolerances", relative), |b| {
                b.iter(|| self.theirs(black_box(relative)))
            });
            group.bench_function(BenchmarkId::new("ode_solvers, same error", relative), |b| {
                b.iter(|| self.theirs(black_box(their_relative)))
            });
        }
        group.finish();
    }
}

/// The absolute tolerance, as a fraction of the relative one: that of the defaults.
const ABSOLUTE_PER_RELATIVE: f64 = 1e-3;

fn integration(criterion: &mut Criterion) {
    van_der_pol().compare(criterion);
    orbit().compare(criterion);
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

criterion_group!(benches, integration, crowd, events);
criterion_main!(benches);
