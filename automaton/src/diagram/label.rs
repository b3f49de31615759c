//! What transitions and locations say about themselves, the same in every kind of diagram.

use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;

use crate::automaton::{Automaton, Transition};

/// The event, the guard in brackets, the reset after a stroke if there is one, and the urgency
/// with the priority.
pub(super) fn transition_lines<E: Event, S>(transition: &Transition<E, S>) -> Vec<String> {
    let mut lines =
        vec![transition.event.name().to_owned(), format!("[{}]", transition.guard.predicate())];
    if !transition.reset.name().is_empty() {
        lines.push(format!("/ {}", transition.reset.name()));
    }
    lines.push(format!("({}, {})", transition.urgency, transition.priority));
    lines
}

/// The name, then the flow and the invariant if there are any.
pub(super) fn location_lines<L: Location, E: Event, S: Valuation>(
    automaton: &Automaton<L, E, S>,
    location: L,
) -> Vec<String> {
    let mut lines = vec![location.name().to_owned()];
    if let Some(mode) = automaton.mode(location) {
        lines.extend(mode.flow.iter().map(|flow| flow.name().into_owned()));
        lines.extend(mode.invariant.iter().map(|invariant| format!("while {invariant}")));
    }
    lines
}
