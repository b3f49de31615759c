//! A vector of two has two coordinates.

use pleach_automaton::Vector;

fn main() {
    let [_, _, _] = Vector::<2>::coordinates();
}
