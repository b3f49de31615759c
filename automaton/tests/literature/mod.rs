//! Models of the literature, each with an answer that is known from elsewhere: a closed form, a number
//! that mpmath computes, or digits that are published.

mod control;
mod flows;
mod hybrid;
mod stiff;

use pleach_automaton::{
    Automaton, Builder, Coordinate, Coordinates, Flow, Trajectory, Vector, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, Predicate};

vocabulary! {
    enum Place: Location { Here = "here", There = "there" }
    enum Cue: Event { Go = "go", Back = "back" }
}
use Cue::{Back, Go};
use Place::{Here, There};

type State<const N: usize> = Vector<N>;

fn x<const N: usize>() -> [Coordinate<State<N>>; N] {
    State::<N>::coordinates()
}

/// A flow from a state on, with the rates of all coordinates in order.
fn moving<const N: usize>(
    start: [f64; N],
    rates: [Expression; N],
) -> Builder<Place, Cue, State<N>> {
    Automaton::starting_in(Here).initially(State::from(start)).flow(Here, flow(rates))
}

fn flow<const N: usize>(rates: [Expression; N]) -> Flow<State<N>> {
    let rates = x::<N>().into_iter().zip(rates).map(|(x, rate)| x.rate(rate));
    rates.collect::<Vec<_>>().into()
}

fn run<S: Coordinates>(model: Builder<Place, Cue, S>, horizon: f64) -> Trajectory {
    let automaton = model.build().expect("the model is sound");
    let trajectory = automaton.run(horizon).expect("it can be run");
    assert!(trajectory.doubts().is_empty(), "{:?}", trajectory.doubts());
    trajectory
}

/// The instants at which a condition comes to hold, while the flow goes on.
fn instants<const N: usize>(
    start: [f64; N],
    rates: [Expression; N],
    condition: Predicate,
    horizon: f64,
) -> Vec<f64> {
    let there = from(Here).on(Go).to(There).must(condition.clone());
    let back = from(There).on(Back).to(Here).must(!condition);
    let model = moving(start, rates.clone()).flow(There, flow(rates));
    let trajectory = run(model.transition(there).transition(back), horizon);
    let comes = trajectory.jumps().iter().filter(|jump| jump.label == "go");
    comes.map(|jump| jump.at.t).collect()
}

fn assert_near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() < tolerance, "{found} is not {exact}");
}
