//! A transition leads to a location of its own model.

use pleach_automaton::{Automaton, coordinates, from};
use pleach_automaton::discrete::vocabulary;

vocabulary! {
    enum Motion: Location { Falling = "falling" }
    enum Contact: Event { Bounce = "bounce" }
}
coordinates! { struct Ball { height, velocity } }

vocabulary! { enum Hose: Location { Left = "left", Right = "right" } }

fn main() {
    let ball = Ball::coordinates();
    let bounce = from(Motion::Falling)
        .on(Contact::Bounce)
        .to(Hose::Left)
        .must(ball.height.at_most(0.0));
    let _ = Automaton::<Motion, Contact, Ball>::starting_in(Motion::Falling).transition(bounce);
}
