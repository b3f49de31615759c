//! Flows that are reset where a margin falls through zero. The answer is the instant of the last event.

use std::f64::consts::PI;

use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};
use pleach_automaton::composition::stream::{Jumping, RunObserver};
use pleach_automaton::{
    Assignment, Automaton, Builder, Composition, Coordinates, Rate, coordinates, from,
};
use pleach_discrete::vocabulary;

use super::{Case, TOLERANCE, settings};

vocabulary! {
    enum Place: Location { Here = "here", There = "there" }
    enum Cue: Event { Turn = "turn", Back = "back" }
}
coordinates! {
    struct Body { height, velocity }
    struct Room { temperature }
}
use Cue::{Back, Turn};
use Place::{Here, There};

/// A flow that is reset where a margin falls through zero.
struct Impacts {
    name: &'static str,
    field: fn(&[f64]) -> [f64; 2],
    margin: fn(&[f64]) -> f64,
    /// It puts a body above the floor, as the documentation of `diffsol` does: no root is at a start.
    reset: fn(&[f64]) -> [f64; 2],
    start: [f64; 2],
    /// When the event with a number happens; the first has number 1.
    instant: fn(u32) -> f64,
    composition: fn() -> Composition,
}

/// How fast the pendulum is after a kick.
const SPEED: f64 = 1.5;

static ALL: [Impacts; 3] = [
    Impacts {
        name: "bounce of a ball",
        field: |x| [x[1], -2.0],
        margin: |x| x[0],
        reset: |x| [f64::EPSILON, -x[1]],
        start: [1.0, 0.0],
        instant: |number| f64::from(2 * number - 1),
        composition: ball,
    },
    Impacts {
        name: "kick of a pendulum",
        field: |x| [x[1], -x[0].sin()],
        margin: |x| x[0],
        reset: |_| [f64::EPSILON, SPEED],
        start: [0.0, SPEED],
        instant: |number| f64::from(number) * half_period(),
        composition: pendulum,
    },
    Impacts {
        name: "switch of a thermostat",
        // Whether it heats is a variable that rests.
        field: |x| [5.0 * x[1] - 0.1 * x[0], 0.0],
        margin: |x| if x[1] > 0.5 { 22.0 - x[0] } else { x[0] - 18.0 },
        reset: |x| [x[0], 1.0 - x[1]],
        start: [20.0, 0.0],
        instant: |number| {
            let (cooling, heating) = ((22.0_f64 / 18.0).ln(), (32.0_f64 / 28.0).ln());
            let rounds = f64::from((number - 1) / 2) * (cooling + heating);
            let rest = if number % 2 == 0 { heating } else { 0.0 };
            10.0 * ((20.0_f64 / 18.0).ln() + rounds + rest)
        },
        composition: thermostat,
    },
];

pub fn cases() -> Vec<Case<'static>> {
    let case = |problem: &'static Impacts| {
        let composition = (problem.composition)();
        Case {
            name: problem.name,
            answer: Box::new(problem.instant),
            pleach: Box::new(move |number| {
                let mut latest = Latest(0.0);
                let horizon = 0.5 * ((problem.instant)(number) + (problem.instant)(number + 1));
                composition.stream(settings(), horizon, &mut latest).expect("it can be run");
                latest.0
            }),
            // It has no events.
            ode_solvers: None,
            diffsol: Box::new(|number| problem.by_diffsol(number)),
        }
    };
    ALL.iter().map(case).collect()
}

/// When something has jumped last.
struct Latest(f64);

impl RunObserver for Latest {
    fn jumps(&mut self, jump: &Jumping<'_>) {
        self.0 = jump.at.t;
    }
}

/// A ball that bounces without loss.
fn ball() -> Composition {
    let Body { velocity, .. } = Body::coordinates();
    let start = Body { height: 1.0, velocity: 0.0 };
    kicked(start, velocity.rate(-2.0), velocity.becomes(-&velocity))
}

/// A pendulum that is kicked back at its lowest point.
fn pendulum() -> Composition {
    let Body { height: angle, velocity } = Body::coordinates();
    let start = Body { height: 0.0, velocity: SPEED };
    kicked(start, velocity.rate(-angle.sin()), velocity.becomes(SPEED))
}

/// A body that is accelerated, and kicked where it falls through zero.
fn kicked(start: Body, acceleration: Rate<Body>, kick: Assignment<Body>) -> Composition {
    let Body { height, velocity } = Body::coordinates();
    let body = Automaton::starting_in(Here)
        .initially(start)
        .flow(Here, [height.rate(&velocity), acceleration])
        .transition(
            from(Here)
                .on(Turn)
                .to(Here)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then([height.becomes(0.0), kick]),
        );
    alone(body)
}

fn thermostat() -> Composition {
    let Room { temperature } = Room::coordinates();
    let room = Automaton::starting_in(Here)
        .initially(Room { temperature: 20.0 })
        .flow(Here, temperature.rate(-0.1 * &temperature))
        .flow(There, temperature.rate(5.0 - 0.1 * &temperature))
        .transition(from(Here).on(Turn).to(There).must(temperature.at_most(18.0)))
        .transition(from(There).on(Back).to(Here).must(temperature.at_least(22.0)));
    alone(room)
}

fn alone<S: Coordinates>(automaton: Builder<Place, Cue, S>) -> Composition {
    automaton.build().expect("it is sound").alone().expect("it has an initial state")
}

/// Half a period of a pendulum that leaves its lowest point at this speed: 2 K(k) with k half the speed, by the
/// arithmetic-geometric mean.
fn half_period() -> f64 {
    let modulus = 0.5 * SPEED;
    let (mut one, mut other) = (1.0, (1.0 - modulus * modulus).sqrt());
    while f64::abs(one - other) > 1e-15 {
        (one, other) = (0.5 * (one + other), f64::sqrt(one * other));
    }
    PI / one
}

impl Impacts {
    fn by_diffsol(&self, number: u32) -> f64 {
        let (field, margin, reset, start) = (self.field, self.margin, self.reset, self.start);
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(TOLERANCE)
            .atol([TOLERANCE; 2])
            .rhs(move |x: &[f64], _p: &[f64], _t: f64, rates: &mut [f64]| {
                rates.copy_from_slice(&field(x));
            })
            .init(move |_p: &[f64], _t: f64, x: &mut [f64]| x.copy_from_slice(&start), 2)
            .root(move |x: &[f64], _p: &[f64], _t: f64, g: &mut [f64]| g[0] = margin(x), 1)
            .reset(move |x: &[f64], _p: &[f64], _t: f64, after: &mut [f64]| {
                after.copy_from_slice(&reset(x));
            })
            .build()
            .expect("a problem");
        let mut solver = problem.tsit45().expect("a solver");
        let mut latest = 0.0;
        solver.set_stop_time((self.instant)(number + 1)).expect("it is ahead");
        for _ in 0..number {
            latest = loop {
                match solver.step().expect("a step") {
                    OdeSolverStopReason::InternalTimestep => {}
                    OdeSolverStopReason::RootFound(time, _) => break time,
                    OdeSolverStopReason::TstopReached => return latest,
                }
            };
            solver.state_mut_back(latest).expect("it is within the step");
            solver.apply_reset().expect("there is a reset");
        }
        latest
    }
}
