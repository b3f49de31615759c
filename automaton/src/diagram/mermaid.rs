//! Mermaid state diagrams.

use petgraph::visit::EdgeRef;
use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;

use super::label::{location_lines, transition_lines};
use crate::automaton::{Automaton, node};

/// The automaton as a Mermaid `stateDiagram-v2`.
pub fn mermaid<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    let mut text = String::from("stateDiagram-v2\n");
    let graph = automaton.graph();
    for place in graph.node_indices() {
        for line in location_lines(automaton, graph[place]) {
            text.push_str(&format!("    l{} : {}\n", place.index(), escaped(&line)));
        }
    }
    if let Some(initial) = node(automaton.initial()) {
        text.push_str(&format!("    [*] --> l{}\n", initial.index()));
    }
    for edge in graph.edge_references() {
        let (source, target) = (edge.source().index(), edge.target().index());
        let label = escaped(&transition_lines(edge.weight()).join(" "));
        text.push_str(&format!("    l{source} --> l{target} : {label}\n"));
    }
    text
}

/// Characters that mean something to Mermaid become its entity codes.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '#' | ';' | ':' | '<' | '>' | '"' | '{' | '}' | '\\' => {
                escaped.push_str(&format!("#{};", u32::from(character)));
            }
            '\n' => escaped.push(' '),
            other => escaped.push(other),
        }
    }
    escaped
}
