//! Graphs in the DOT language.

use petgraph::visit::EdgeRef;
use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::Valuation;

use super::label::{location_lines, transition_lines};
use crate::automaton::{Automaton, node};

/// The automaton in the DOT language. Transitions that only may be taken are dashed, and those
/// that happen at once are bold.
pub fn dot<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    let mut text = String::from(
        "digraph automaton {\n    \
         node [shape=box, style=rounded, fontname=\"sans-serif\"];\n    \
         edge [fontname=\"sans-serif\", fontsize=11];\n    \
         initial [shape=point];\n",
    );
    let graph = automaton.graph();
    for place in graph.node_indices() {
        let label = quoted(&location_lines(automaton, graph[place]));
        text.push_str(&format!("    l{} [label={label}];\n", place.index()));
    }
    if let Some(initial) = node(automaton.initial()) {
        text.push_str(&format!("    initial -> l{};\n", initial.index()));
    }
    for edge in graph.edge_references() {
        let (source, target) = (edge.source().index(), edge.target().index());
        let label = quoted(&transition_lines(edge.weight()));
        let style = style(edge.weight().urgency);
        text.push_str(&format!("    l{source} -> l{target} [label={label}, style={style}];\n"));
    }
    text.push_str("}\n");
    text
}

fn style(urgency: Urgency) -> &'static str {
    match urgency {
        Urgency::May => "dashed",
        Urgency::Must => "solid",
        Urgency::AtOnce => "bold",
    }
}

fn quoted(lines: &[String]) -> String {
    let text = lines.join("\n").replace('\\', r"\\").replace('"', "\\\"").replace('\n', r"\n");
    format!("\"{text}\"")
}
