//! Integration against `ode_solvers`, at the same achieved error and in one run.
//!
//! Both solve the same flow, ours once as a function and once as formulas on a tape. Ours runs at
//! tolerances of 1e-6 and 1e-9; those of the others, its methods of orders 5 and 8, are the loosest
//! with which their solutions end no farther from the true one than ours does. A line for each says
//! how long each takes, and the ratio of ours to the fastest other.

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::dmatrix;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, Dopri5, SVector, System};
use pleach::continuous::flow::{
    Curve, EventSearch, Integrator, LinearFlow, Tolerances, VectorField, first_instant,
};
use pleach::guards::{EvaluationError, Expression, Tape, Verdict, variable};

/// A problem with its true answer.
struct Problem<const N: usize> {
    name: &'static str,
    field: fn(&[f64; N]) -> [f64; N],
    formulas: [Expression; N],
    start: [f64; N],
    end: f64,
    answer: [f64; N],
}

fn names<const N: usize>() -> [String; N] {
    std::array::from_fn(|index| format!("x{index}"))
}

fn variables<const N: usize>() -> [Expression; N] {
    names::<N>().map(|name| variable(&name))
}

/// Lorenz's equations at his parameters.
fn lorenz() -> Problem<3> {
    let field = |x: &[f64; 3]| {
        [10.0 * (x[1] - x[0]), x[0] * (28.0 - x[2]) - x[1], x[0] * x[1] - 8.0 / 3.0 * x[2]]
    };
    let [x, y, z] = &variables();
    let formulas = [10.0 * (y - x), x * (28.0 - z) - y, x * y - (8.0 / 3.0) * z];
    Problem::new("Lorenz", field, formulas, [1.0, 1.0, 1.0], 10.0)
}

/// Four of van der Pol's oscillators with μ = 2 in a ring of springs.
fn coupled_van_der_pol() -> Problem<8> {
    let field = |x: &[f64; 8]| {
        let mut rates = [0.0; 8];
        for i in 0..4 {
            let (left, right) = (x[(i + 3) % 4], x[(i + 1) % 4]);
            rates[i] = x[4 + i];
            rates[4 + i] =
                2.0 * (1.0 - x[i] * x[i]) * x[4 + i] - x[i] + 0.3 * (left + right - 2.0 * x[i]);
        }
        rates
    };
    let x = variables::<8>();
    let formulas = std::array::from_fn(|place| {
        let Some(i) = place.checked_sub(4) else { return x[place + 4].clone() };
        let (here, left, right) = (&x[i], &x[(i + 3) % 4], &x[(i + 1) % 4]);
        2.0 * (1.0 - here * here) * &x[place] - here + 0.3 * (left + right - 2.0 * here)
    });
    let start = [2.0, 1.0, -0.5, 0.3, 0.0, 0.4, -0.2, 0.0];
    Problem::new("coupled van der Pol", field, formulas, start, 20.0)
}

/// Twenty-five masses in a row, joined by springs.
fn chain() -> Problem<50> {
    let field = |x: &[f64; 50]| {
        let mut rates = [0.0; 50];
        for i in 0..25 {
            let left = if i == 0 { 0.0 } else { x[i - 1] };
            let right = if i == 24 { 0.0 } else { x[i + 1] };
            rates[i] = x[25 + i];
            rates[25 + i] = left - 2.0 * x[i] + right;
        }
        rates
    };
    let x = variables::<50>();
    let formulas = std::array::from_fn(|place| {
        let Some(i) = place.checked_sub(25) else { return x[place + 25].clone() };
        let pulled = if i == 0 { -2.0 * &x[0] } else { &x[i - 1] - 2.0 * &x[i] };
        if i == 24 { pulled } else { pulled + &x[i + 1] }
    });
    let mut start = [0.0; 50];
    start[0] = 1.0;
    Problem::new("linear chain", field, formulas, start, 20.0)
}

/// A body on an ellipse of eccentricity 0.6 about one of unit weight: back at its start after 2π.
fn orbit() -> Problem<4> {
    let field = |x: &[f64; 4]| {
        let squared = x[0] * x[0] + x[1] * x[1];
        let cubed = squared * squared.sqrt();
        [x[2], x[3], -x[0] / cubed, -x[1] / cubed]
    };
    let [x, y, u, v] = &variables();
    let squared = x * x + y * y;
    let cubed = &squared * squared.square_root();
    let formulas = [u.clone(), v.clone(), -x / &cubed, -y / &cubed];
    let start = [0.4, 0.0, 0.0, 2.0];
    Problem { answer: start, ..Problem::new("orbit", field, formulas, start, 3.0 * TAU) }
}

/// The problem as `ode_solvers` wants it.
#[derive(Clone, Copy)]
struct Theirs<const N: usize>(fn(&[f64; N]) -> [f64; N]);

impl<const N: usize> System<f64, SVector<f64, N>> for Theirs<N> {
    fn system(&self, _time: f64, state: &SVector<f64, N>, rates: &mut SVector<f64, N>) {
        *rates = SVector::from((self.0)(&(*state).into()));
    }
}

/// Integrates by a method of `ode_solvers`: all its defaults, but with the states at the ends of
/// steps as its only output, which is its fastest way.
macro_rules! theirs {
    ($stepper:ident, $problem:ident, $relative:ident, $beta:literal, $least:literal, $most:literal) => {{
        let mut stepper = $stepper::from_param(
            Theirs($problem.field),
            0.0,
            $problem.end,
            $problem.end,
            SVector::from($problem.start),
            $relative,
            $relative * ABSOLUTE_PER_RELATIVE,
            0.9,
            $beta,
            $least,
            $most,
            $problem.end,
            0.0,
            100_000,
            1000,
            OutputType::Sparse,
        );
        stepper.integrate().expect("a smooth flow");
        (*stepper.results().get().1.last().expect("the end is put out")).into()
    }};
}

impl<const N: usize> Problem<N> {
    fn new(
        name: &'static str,
        field: fn(&[f64; N]) -> [f64; N],
        formulas: [Expression; N],
        start: [f64; N],
        end: f64,
    ) -> Self {
        let mut problem = Problem { name, field, formulas, start, end, answer: [0.0; N] };
        problem.answer = problem.ours(1e-14);
        problem
    }

    fn integrate(&self, field: &impl VectorField, relative: f64) -> [f64; N] {
        let tolerances =
            Tolerances::new(relative, relative * ABSOLUTE_PER_RELATIVE).expect("they are positive");
        let mut integrator = Integrator::new(field, 0.0, &self.start, tolerances);
        while integrator.time() < self.end {
            integrator.step(self.end).expect("a smooth flow");
        }
        integrator.state().try_into().expect("the dimension of the problem")
    }

    fn ours(&self, relative: f64) -> [f64; N] {
        let field = |_: f64, state: &[f64], rates: &mut [f64]| {
            let state: &[f64; N] = state.try_into().expect("the dimension of the problem");
            rates.copy_from_slice(&(self.field)(state));
        };
        self.integrate(&field, relative)
    }

    fn by_formulas(&self, tape: &Tape, relative: f64) -> [f64; N] {
        let places = RefCell::new(tape.places());
        let field = |_: f64, state: &[f64], rates: &mut [f64]| {
            tape.evaluate(state, &mut places.borrow_mut(), rates);
        };
        self.integrate(&field, relative)
    }

    fn dopri5(&self, relative: f64) -> [f64; N] {
        theirs!(Dopri5, self, relative, 0.04, 0.2, 10.0)
    }

    fn dop853(&self, relative: f64) -> [f64; N] {
        theirs!(Dop853, self, relative, 0.0, 0.333, 6.0)
    }

    fn error(&self, end: [f64; N]) -> f64 {
        let differences = end.iter().zip(&self.answer).map(|(x, y)| (x - y).abs());
        differences.fold(0.0, f64::max)
    }

    /// The loosest relative tolerance, on a grid of twenty per decade, that gives this error.
    fn tolerance_for(&self, error: f64, solve: fn(&Self, f64) -> [f64; N]) -> f64 {
        let grid = (60..280).map(|step| 10f64.powf(-f64::from(step) / 20.0));
        let good = |relative: &f64| self.error(solve(self, *relative)) <= error;
        grid.into_iter().find(good).unwrap_or(1e-14)
    }

    fn compare(&self) {
        let tape = Tape::compile(&self.formulas, &names::<N>()).expect("these are the names");
        for relative in [1e-6, 1e-9] {
            let error = self.error(self.ours(relative));
            let ours = fastest(|| self.ours(black_box(relative)));
            let formulas = fastest(|| self.by_formulas(&tape, black_box(relative)));
            let [dopri5, dop853] = [Self::dopri5, Self::dop853].map(|solve| {
                let relative = self.tolerance_for(error, solve);
                fastest(|| solve(self, black_box(relative)))
            });
            let other = dopri5.min(dop853).as_secs_f64();
            println!(
                "{} to {relative:e}, error {error:.1e}: pleach {ours:.1?}, by formulas \
                 {formulas:.1?}, dopri5 {dopri5:.1?}, dop853 {dop853:.1?}; ratio {:.2}, by formulas \
                 {:.2}",
                self.name,
                ours.as_secs_f64() / other,
                formulas.as_secs_f64() / other,
            );
        }
    }
}

/// The shortest of forty times.
fn fastest<T>(mut run: impl FnMut() -> T) -> Duration {
    let time = |_| {
        let start = Instant::now();
        black_box(run());
        start.elapsed()
    };
    (0..40).map(time).min().unwrap_or_default()
}

/// The absolute tolerance, as a fraction of the relative one: that of the defaults.
const ABSOLUTE_PER_RELATIVE: f64 = 1e-3;

fn integration(_: &mut Criterion) {
    lorenz().compare();
    coupled_van_der_pol().compare();
    chain().compare();
    orbit().compare();
}

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

criterion_group!(benches, integration, stiff, crowd, events);
criterion_main!(benches);
