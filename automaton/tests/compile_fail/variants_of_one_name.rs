//! Two locations have two names.

use pleach_automaton::discrete::{Location, vocabulary};

vocabulary! {
    enum Heater: Location { Off = "off", On = "off" }
}

fn main() {
    let _ = Heater::On.name();
}
