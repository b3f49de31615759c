//! Two coordinates have two names.

use pleach_automaton::{Coordinates, coordinates};

coordinates! { struct Ball { height = "h", velocity = "h" } }

fn main() {
    let _ = Ball::NAMES;
}
