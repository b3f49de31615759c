//! Plants under a controller that is sampled 1,024 times a second. The answer is where the plant is after some ticks.

use std::collections::VecDeque;

use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, Dopri5, SVector, System};
use pleach_automaton::composition::Channel;
use pleach_automaton::{Automaton, Composition, Coordinate, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, always};

use super::{Case, TOLERANCE, settings};

vocabulary! {
    enum Place: Location { Running = "running" }
    enum Cue: Event { Sample = "sample" }
}
coordinates! {
    struct Plant { place = "x", speed = "v", force = "u" }
    struct Controller { place = "x", speed = "v", integral = "I", output = "u" }
}
use Cue::Sample;
use Place::Running;

const PERIOD: f64 = 1.0 / 1024.0;
const DELAY: f64 = 0.025;
/// How many messages are under way at most, and some more.
const CAPACITY: usize = 30;
const TARGET: f64 = 1.0;

/// A plant under control.
struct Sampled {
    name: &'static str,
    acceleration: fn(&[f64; 2]) -> f64,
    formula: fn(&Coordinate<Plant>, &Coordinate<Plant>) -> Expression,
    is_delayed: bool,
}

static ALL: [Sampled; 4] = [
    Sampled { name: "tick of a servo", is_delayed: false, ..SERVO },
    Sampled { name: "tick of a servo, 25 ms late", is_delayed: true, ..SERVO },
    Sampled { name: "tick of a pendulum", is_delayed: false, ..PENDULUM },
    Sampled { name: "tick of a pendulum, 25 ms late", is_delayed: true, ..PENDULUM },
];

const SERVO: Sampled = Sampled {
    name: "servo",
    acceleration: |[x, v]| -x - 0.5 * v,
    formula: |x, v| -1.0 * x - 0.5 * v,
    is_delayed: false,
};

const PENDULUM: Sampled = Sampled {
    name: "pendulum",
    acceleration: |[x, v]| -x.sin() - 0.5 * v,
    formula: |x, v| -x.sin() - 0.5 * v,
    is_delayed: false,
};

pub fn cases() -> Vec<Case<'static>> {
    let case = |problem: &'static Sampled| {
        let composition = problem.composition();
        Case {
            name: problem.name,
            answer: Box::new(|ticks| problem.answer(ticks)),
            pleach: Box::new(move |ticks| {
                let horizon = PERIOD * f64::from(ticks);
                let end = composition.stream(settings(), horizon, &mut ()).expect("it can be run");
                end.values[0]
            }),
            ode_solvers: Some(Box::new(|ticks| problem.by_ode_solvers(ticks))),
            diffsol: Box::new(|ticks| problem.by_diffsol(ticks)),
        }
    };
    ALL.iter().map(case).collect()
}

/// Integrates a plant by a method of `ode_solvers`, in one call to it.
macro_rules! integrate {
    ($stepper:ident, $field:expr, $state:expr, $times:expr, $tolerance:expr, $beta:literal, $least:literal, $most:literal) => {{
        let [from, to] = $times;
        let mut stepper = $stepper::from_param(
            $field,
            from,
            to,
            to - from,
            SVector::from($state),
            $tolerance,
            $tolerance,
            0.9,
            $beta,
            $least,
            $most,
            to - from,
            0.0,
            100_000,
            1000,
            OutputType::Sparse,
        );
        stepper.integrate().expect("a smooth flow");
        (*stepper.results().get().1.last().expect("the end is put out")).into()
    }};
}

/// The flow of a plant as `ode_solvers` wants it.
struct Pushed<'a> {
    plant: &'a Sampled,
    force: f64,
}

impl System<f64, SVector<f64, 2>> for Pushed<'_> {
    fn system(&self, _time: f64, state: &SVector<f64, 2>, rates: &mut SVector<f64, 2>) {
        let state: [f64; 2] = (*state).into();
        *rates = SVector::from([state[1], (self.plant.acceleration)(&state) + self.force]);
    }
}

impl Sampled {
    /// As an automaton of the plant and one of the controller.
    fn composition(&self) -> Composition {
        let Plant { place, speed, force } = Plant::coordinates();
        let acceleration = (self.formula)(&place, &speed) + &force;
        let plant = Automaton::<Place, Cue, _>::starting_in(Running)
            .initially(Plant { place: 0.0, speed: 0.0, force: 0.0 })
            .flow(Running, [place.rate(&speed), speed.rate(acceleration)])
            .build()
            .expect("it is sound");
        let Controller { place, speed, integral, output } = Controller::coordinates();
        let error = TARGET - &place;
        let wanted = 4.0 * &error + &integral - 2.0 * speed;
        let possible = wanted.max(-5.0).min(5.0);
        let unwound = PERIOD * (2.0 * error + (&possible - wanted));
        let samples = from(Running).on(Sample).to(Running).may(always());
        let controller = Automaton::starting_in(Running)
            .initially(Controller { place: 0.0, speed: 0.0, integral: 0.0, output: 0.0 })
            .transition(
                samples.then([output.becomes(possible), integral.becomes(&integral + unwound)]),
            )
            .build()
            .expect("it is sound");
        let loop_of_both = Composition::builder()
            .add("plant", &plant)
            .add("pid", &controller)
            .connect("plant.x", "pid.x")
            .connect("plant.v", "pid.v")
            .every("pid.sample", PERIOD);
        let joined = match self.is_delayed {
            false => loop_of_both.connect("pid.u", "plant.u"),
            true => loop_of_both.channel(
                Channel::holding_last("pid.sample")
                    .held("pid.u", "plant.u", 0.0)
                    .taking(DELAY, DELAY)
                    .holding(CAPACITY),
            ),
        };
        joined.build().expect("they fit together")
    }

    /// Runs the loop with a plant that `advance` carries from one instant to another under a force.
    fn run(&self, ticks: u32, mut advance: impl FnMut([f64; 2], f64, [f64; 2]) -> [f64; 2]) -> f64 {
        let (mut state, mut force) = ([0.0, 0.0], 0.0);
        let (mut integral, mut output) = (0.0, 0.0);
        let mut under_way: VecDeque<(f64, f64)> = VecDeque::new();
        for tick in 0..ticks {
            let mut now = PERIOD * f64::from(tick);
            let next = PERIOD * f64::from(tick + 1);
            if self.is_delayed {
                under_way.push_back((now + DELAY, output));
            }
            let error = TARGET - state[0];
            let wanted = 4.0 * error + integral - 2.0 * state[1];
            output = f64::clamp(wanted, -5.0, 5.0);
            integral += PERIOD * (2.0 * error + (output - wanted));
            if !self.is_delayed {
                force = output;
            }
            while let Some(&(arrival, message)) = under_way.front().filter(|it| it.0 < next) {
                under_way.pop_front();
                state = advance(state, force, [now, arrival]);
                (now, force) = (arrival, message);
            }
            state = advance(state, force, [now, next]);
        }
        state[0]
    }

    /// By a method of high order with its smallest tolerance.
    fn answer(&self, ticks: u32) -> f64 {
        self.run(ticks, |state, force, times| {
            let field = Pushed { plant: self, force };
            integrate!(Dop853, field, state, times, 1e-13, 0.0, 0.333, 6.0)
        })
    }

    fn by_ode_solvers(&self, ticks: u32) -> f64 {
        self.run(ticks, |state, force, times| {
            let field = Pushed { plant: self, force };
            integrate!(Dopri5, field, state, times, TOLERANCE, 0.04, 0.2, 10.0)
        })
    }

    /// The force is a variable that rests.
    fn by_diffsol(&self, ticks: u32) -> f64 {
        let acceleration = self.acceleration;
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(TOLERANCE)
            .atol([TOLERANCE; 3])
            .rhs(move |x: &[f64], _p: &[f64], _t: f64, rates: &mut [f64]| {
                rates.copy_from_slice(&[x[1], acceleration(&[x[0], x[1]]) + x[2], 0.0]);
            })
            .init(|_p: &[f64], _t: f64, x: &mut [f64]| x.fill(0.0), 3)
            .build()
            .expect("a problem");
        let mut solver = problem.tsit45().expect("a solver");
        self.run(ticks, |_, force, [_, to]| {
            solver.state_mut().y[2] = force;
            solver.set_stop_time(to).expect("it is ahead");
            while !matches!(solver.step().expect("a step"), OdeSolverStopReason::TstopReached) {}
            let state = solver.state().y;
            [state[0], state[1]]
        })
    }
}
