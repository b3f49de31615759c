//! Guarantees of runs, as `docs/guarantees.md` states it: no event is missed in silence, instants do
//! not drift, trajectories are the flows, and every run returns.

mod accumulation;
mod choice;
mod components;
mod endings;
mod events;
mod instants;
mod trajectories;

use pleach_automaton::{
    Automaton, Builder, Coordinate, Coordinates, Trajectory, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::Predicate;

vocabulary! {
    enum Place: Location { Here = "here", There = "there" }
    enum Cue: Event { Go = "go", Rest = "rest" }
}
use Cue::Go;
use Place::{Here, There};

coordinates! {
    struct One { x }
    struct Body { h, v, clock = "τ" }
    struct Plane { px = "x", py = "y" }
}

type Machine<S> = Automaton<Place, Cue, S>;

fn x() -> Coordinate<One> {
    One::coordinates().x
}

/// x = t, with nothing else yet.
fn ramp() -> Builder<Place, Cue, One> {
    Automaton::starting_in(Here).initially(One { x: 0.0 }).flow(Here, x().rate(1.0))
}

fn built<S: Coordinates>(builder: Builder<Place, Cue, S>) -> Machine<S> {
    builder.build().expect("the model is sound")
}

fn go(guard: Predicate) -> Machine<One> {
    built(ramp().transition(from(Here).on(Go).to(There).must(guard)))
}

fn run<S: Coordinates>(machine: &Machine<S>, horizon: f64) -> Trajectory {
    machine.run(horizon).expect("the model can be run")
}

fn times(trajectory: &Trajectory) -> Vec<f64> {
    trajectory.jumps().iter().map(|jump| jump.at.t).collect()
}

/// A ball above a table that moves by a sin ωt: on impact, its velocity relative to the table turns
/// and shrinks by e.
fn ball_and_table(omega: f64) -> Machine<Body> {
    let Body { h, v, clock } = Body::coordinates();
    let (a, e) = (0.05, 0.8);
    let table = || a * (omega * &clock).sin();
    let speed = || a * omega * (omega * &clock).cos();
    let bounce = [v.becomes(speed() - e * (&v - speed())), h.becomes(table())];
    built(
        Automaton::starting_in(Here)
            .initially(Body { h: 10.0, v: 0.0, clock: 0.0 })
            .flow(Here, [h.rate(&v), v.rate(-1.0), clock.rate(1.0)])
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(h.at_most(table()) & v.less_than(speed()))
                    .then(bounce),
            ),
    )
}

/// A clock that is set back to 0 when it reaches the period.
fn metronome(period: f64, rate: f64) -> Machine<One> {
    built(
        Automaton::starting_in(Here)
            .initially(One { x: 0.0 })
            .flow(Here, x().rate(rate))
            .transition(
                from(Here).on(Go).to(Here).must(x().at_least(period)).then(x().becomes(0.0)),
            ),
    )
}
