//! `pleach diagram`.

use super::arguments::DiagramArguments;
use super::status::{Failure, Status};

/// Prints the drawing of an automaton.
pub fn print(arguments: &DiagramArguments) -> Result<Status, Failure> {
    // HOOK(diagram): draw the automaton from its transition table and print it.
    let DiagramArguments { automaton, format } = arguments;
    Err(Failure::Internal(format!("no drawing of {automaton:?} as {format:?} yet")))
}
