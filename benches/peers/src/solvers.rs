//! The same problem by each library.

use std::cell::RefCell;

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason, Vector};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, Dopri5, SVector, System};
use pleach_automaton::{Composition, Coordinates, Settings, Vector as State};
use pleach_continuous::flow::{Integrator, Tolerances, VectorField};
use pleach_guards::{Expression, Tape};

use crate::events::{Place::Here, here};
use crate::problems::Problem;

/// The absolute tolerance, as a fraction of the relative one: that of the defaults.
const ABSOLUTE_PER_RELATIVE: f64 = 1e-3;

/// The problem as `ode_solvers` wants it.
#[derive(Clone, Copy)]
struct Dop<const N: usize>(fn(&[f64; N]) -> [f64; N]);

impl<const N: usize> System<f64, SVector<f64, N>> for Dop<N> {
    fn system(&self, _time: f64, state: &SVector<f64, N>, rates: &mut SVector<f64, N>) {
        *rates = SVector::from((self.0)(&(*state).into()));
    }
}

/// Integrates by a method of `ode_solvers`: all its defaults, but with the states at the ends of
/// steps as its only output, which is its fastest way.
macro_rules! dop {
    ($stepper:ident, $problem:ident, $relative:ident, $end:ident, $beta:literal, $least:literal, $most:literal) => {{
        let mut stepper = $stepper::from_param(
            Dop($problem.field),
            0.0,
            $end,
            $end,
            SVector::from($problem.start),
            $relative,
            $relative * ABSOLUTE_PER_RELATIVE,
            0.9,
            $beta,
            $least,
            $most,
            $end,
            0.0,
            100_000,
            1000,
            OutputType::Sparse,
        );
        stepper.integrate().expect("a smooth flow");
        (*stepper.results().get().1.last().expect("the end is put out")).into()
    }};
}

/// Steps a solver of `diffsol` to the end, without any output.
macro_rules! diffsol {
    ($solver:expr, $end:expr) => {{
        let mut solver = $solver.expect("a solver");
        solver.set_stop_time($end).expect("the end is ahead");
        while !matches!(solver.step().expect("a step"), OdeSolverStopReason::TstopReached) {}
        solver.state().y.clone_as_vec()
    }};
}

/// At how many instants of a problem errors are compared: at a single one a solver may be right by
/// chance.
const INSTANTS: u32 = 8;

impl<const N: usize> Problem<N> {
    pub fn new(
        name: &'static str,
        field: fn(&[f64; N]) -> [f64; N],
        formulas: [Expression; N],
        start: [f64; N],
        end: f64,
    ) -> Self {
        let mut problem = Problem { name, field, formulas, start, end, answers: Vec::new() };
        let instants = (1..=INSTANTS).map(|k| end * f64::from(k) / f64::from(INSTANTS));
        problem.answers = instants.map(|time| (time, problem.dop853(1e-13, time))).collect();
        problem
    }

    fn integrate(&self, field: &impl VectorField, relative: f64, end: f64) -> [f64; N] {
        let tolerances =
            Tolerances::new(relative, relative * ABSOLUTE_PER_RELATIVE).expect("they are positive");
        let mut integrator = Integrator::new(field, 0.0, &self.start, tolerances);
        while integrator.time() < end {
            integrator.step(end).expect("a smooth flow");
        }
        integrator.state().try_into().expect("the dimension of the problem")
    }

    pub fn by_function(&self, relative: f64, end: f64) -> [f64; N] {
        let field = |_: f64, state: &[f64], rates: &mut [f64]| {
            let state: &[f64; N] = state.try_into().expect("the dimension of the problem");
            rates.copy_from_slice(&(self.field)(state));
        };
        self.integrate(&field, relative, end)
    }

    pub fn tape(&self) -> Tape {
        Tape::compile(&self.formulas, State::<N>::NAMES).expect("these are the names")
    }

    pub fn by_formulas(&self, tape: &Tape, relative: f64, end: f64) -> [f64; N] {
        let places = RefCell::new(tape.places());
        let field = |_: f64, state: &[f64], rates: &mut [f64]| {
            tape.evaluate(state, &mut places.borrow_mut(), rates);
        };
        self.integrate(&field, relative, end)
    }

    /// The flow as the only one of an automaton.
    pub fn automaton(&self) -> Composition {
        let rates = State::<N>::coordinates().into_iter().zip(&self.formulas);
        let flow: Vec<_> = rates.map(|(x, formula)| x.rate(formula)).collect();
        let automaton = here(State::from(self.start)).flow(Here, flow).build();
        let automaton = automaton.expect("it is sound");
        Composition::builder().add("problem", &automaton).build().expect("it fits")
    }

    pub fn by_run(&self, automaton: &Composition, relative: f64, end: f64) -> [f64; N] {
        let settings = Settings {
            relative_tolerance: relative,
            absolute_tolerance: relative * ABSOLUTE_PER_RELATIVE,
            ..Settings::default()
        };
        let trajectory = automaton.run_with(settings, end).expect("it can be run");
        let last = trajectory.values_at(end).expect("it lasts");
        last.try_into().expect("the dimension of the problem")
    }

    /// Solves the problem several times in one way, if it is one of them.
    pub fn repeat(&self, way: &str, relative: f64, times: u32) -> Option<()> {
        let (tape, automaton) = (self.tape(), self.automaton());
        for _ in 0..times {
            std::hint::black_box(match way {
                "function" => self.by_function(relative, self.end),
                "formulas" => self.by_formulas(&tape, relative, self.end),
                "run" => self.by_run(&automaton, relative, self.end),
                "peer" => self.dop853(relative, self.end),
                _ => return None,
            });
        }
        Some(())
    }

    pub fn dopri5(&self, relative: f64, end: f64) -> [f64; N] {
        dop!(Dopri5, self, relative, end, 0.04, 0.2, 10.0)
    }

    pub fn dop853(&self, relative: f64, end: f64) -> [f64; N] {
        dop!(Dop853, self, relative, end, 0.0, 0.333, 6.0)
    }

    pub fn tsit45(&self, relative: f64, end: f64) -> [f64; N] {
        let (field, start) = (self.field, self.start);
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(relative)
            .atol([relative * ABSOLUTE_PER_RELATIVE; N])
            .rhs(move |x: &[f64], _p: &[f64], _t: f64, rates: &mut [f64]| {
                rates.copy_from_slice(&field(x.try_into().expect("the dimension of the problem")));
            })
            .init(move |_p: &[f64], _t: f64, x: &mut [f64]| x.copy_from_slice(&start), N)
            .build()
            .expect("a problem");
        let last = diffsol!(problem.tsit45(), end);
        last.try_into().expect("the dimension of the problem")
    }

    /// The largest error at any of the instants.
    pub fn error(&self, relative: f64, solve: &dyn Fn(f64, f64) -> [f64; N]) -> f64 {
        let largest = |(time, answer): &(f64, [f64; N])| {
            let state = solve(relative, *time);
            state.iter().zip(answer).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
        };
        self.answers.iter().map(largest).fold(0.0, f64::max)
    }
}

/// The loosest relative tolerance, on a grid of twenty per decade, whose error is no larger.
pub fn tolerance_for(error: f64, error_with: impl Fn(f64) -> f64) -> f64 {
    let mut grid = (60..275).map(|step| 10f64.powf(-f64::from(step) / 20.0));
    grid.find(|relative| error_with(*relative) <= error).unwrap_or(1e-14)
}

/// The parameter of van der Pol's oscillator that makes it stiff.
pub const MU: f64 = 1000.0;

/// Van der Pol's oscillator by the BDF method of `diffsol`, whose Jacobian is given.
pub fn stiff_van_der_pol(end: f64, relative: f64, absolute: f64) -> Vec<f64> {
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(relative)
        .atol([absolute; 2])
        .rhs_implicit(
            |x: &[f64], _p: &[f64], _t: f64, rates: &mut [f64]| {
                rates[0] = x[1];
                rates[1] = MU * (1.0 - x[0] * x[0]) * x[1] - x[0];
            },
            |x: &[f64], _p: &[f64], _t: f64, v: &[f64], product: &mut [f64]| {
                product[0] = v[1];
                product[1] =
                    (-2.0 * MU * x[0] * x[1] - 1.0) * v[0] + MU * (1.0 - x[0] * x[0]) * v[1];
            },
        )
        .init(|_p: &[f64], _t: f64, x: &mut [f64]| x.copy_from_slice(&[2.0, 0.0]), 2)
        .build()
        .expect("a problem");
    diffsol!(problem.bdf::<NalgebraLU<f64>>(), end)
}
