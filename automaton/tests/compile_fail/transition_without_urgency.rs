//! Every transition says how urgent it is: an arrow alone is no edge.

use pleach_automaton::{Automaton, coordinates, from};
use pleach_automaton::discrete::vocabulary;

vocabulary! {
    enum Motion: Location { Falling = "falling" }
    enum Contact: Event { Bounce = "bounce" }
}
coordinates! { struct Ball { height, velocity } }

fn main() {
    let _ = Automaton::<Motion, Contact, Ball>::starting_in(Motion::Falling)
        .transition(from(Motion::Falling).on(Contact::Bounce).to(Motion::Falling));
}
