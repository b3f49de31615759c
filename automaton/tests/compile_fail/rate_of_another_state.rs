//! A flow gives rates to coordinates of its own state only.

use pleach_automaton::{Automaton, coordinates};
use pleach_automaton::discrete::vocabulary;

vocabulary! {
    enum Motion: Location { Falling = "falling" }
    enum Contact: Event { Bounce = "bounce" }
}
coordinates! { struct Ball { height, velocity } }

coordinates! { struct Tank { level } }

fn main() {
    let tank = Tank::coordinates();
    let _ = Automaton::<Motion, Contact, Ball>::starting_in(Motion::Falling)
        .flow(Motion::Falling, tank.level.rate(1.0));
}
