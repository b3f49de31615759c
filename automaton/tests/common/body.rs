//! A body in the time t, at rates that a test gives, until an event that it asks for.

use pleach_automaton::{Automaton, Builder, Coordinate, Trajectory, coordinates};
use pleach_discrete::vocabulary;
use pleach_guards::Expression;

vocabulary! {
    pub enum Place: Location { Here = "here", There = "there" }
    pub enum Cue: Event { Go = "go", Back = "back" }
}
coordinates! {
    pub struct Body { place = "p", speed = "s", time = "t" }
}

/// Place, speed and time.
pub fn coordinates() -> [Coordinate<Body>; 3] {
    let Body { place, speed, time } = Body::coordinates();
    [place, speed, time]
}

/// A body with these rates of place and speed.
pub fn body(start: [f64; 2], rates: [Expression; 2]) -> Builder<Place, Cue, Body> {
    let Body { place, speed, time } = Body::coordinates();
    let [moves, speeds] = rates;
    Automaton::starting_in(Place::Here)
        .initially(Body { place: start[0], speed: start[1], time: 0.0 })
        .flow(Place::Here, [place.rate(moves), speed.rate(speeds), time.rate(1.0)])
}

/// p = t, s = 0.
pub fn line() -> Builder<Place, Cue, Body> {
    body([0.0; 2], [1.0.into(), 0.0.into()])
}

/// The instants of the jumps, in seconds.
pub fn instants(trajectory: &Trajectory) -> Vec<f64> {
    trajectory.jumps().iter().map(|jump| jump.at.t).collect()
}

pub fn assert_near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() <= tolerance, "{found} is not {exact}");
}
