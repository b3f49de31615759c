//! Flows belong to locations, not to events.

use pleach_automaton::{Automaton, coordinates};
use pleach_automaton::discrete::vocabulary;

vocabulary! {
    enum Motion: Location { Falling = "falling" }
    enum Contact: Event { Bounce = "bounce" }
}
coordinates! { struct Ball { height, velocity } }

fn main() {
    let ball = Ball::coordinates();
    let _ = Automaton::<Motion, Contact, Ball>::starting_in(Motion::Falling)
        .flow(Contact::Bounce, ball.height.rate(1.0));
}
