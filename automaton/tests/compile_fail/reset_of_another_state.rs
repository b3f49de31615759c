//! A reset assigns to coordinates of its own state only.

use pleach_automaton::{Automaton, coordinates, from};
use pleach_automaton::discrete::vocabulary;

vocabulary! {
    enum Motion: Location { Falling = "falling" }
    enum Contact: Event { Bounce = "bounce" }
}
coordinates! { struct Ball { height, velocity } }

coordinates! { struct Tank { level } }

fn main() {
    let (ball, tank) = (Ball::coordinates(), Tank::coordinates());
    let bounce = from(Motion::Falling)
        .on(Contact::Bounce)
        .to(Motion::Falling)
        .must(ball.height.at_most(0.0))
        .then([ball.velocity.becomes(0.0), tank.level.becomes(0.0)]);
    let _ = Automaton::<Motion, Contact, Ball>::starting_in(Motion::Falling).transition(bounce);
}
