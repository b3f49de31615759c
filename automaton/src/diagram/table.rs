//! Tables of an automaton.

use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;

use crate::automaton::Automaton;

/// The automaton in Markdown, as two tables: the full location × event table, and below it the
/// guard and the reset of every event that occurs.
pub fn table<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    let mut text = automaton.table().to_markdown();
    text.push_str("\n| event | guard | holds where | reset |\n| --- | --- | --- | --- |\n");
    for event in E::ALL {
        let mut transitions = automaton.graph().edge_weights();
        if let Some(transition) = transitions.find(|transition| transition.event == *event) {
            let (guard, reset) = (&transition.guard, transition.reset.name());
            let cells = [
                format!("**{}**", event.name()),
                guard.name().to_owned(),
                guard.predicate().to_string(),
                if reset.is_empty() { "—".to_owned() } else { reset.into_owned() },
            ];
            text.push_str(&format!(
                "| {} |\n",
                cells.map(|cell: String| escaped(&cell)).join(" | ")
            ));
        }
    }
    text
}

/// A bar would end the cell.
fn escaped(text: &str) -> String {
    text.replace('|', r"\|")
}
