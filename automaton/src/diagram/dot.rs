//! Graphs in the DOT language.

use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::Valuation;

use super::sketch::Sketch;
use crate::automaton::Automaton;

/// The automaton in the DOT language. Transitions that only may be taken are dashed, and those
/// that happen at once are bold.
pub fn dot<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    graph(&Sketch::of(&automaton.outline()))
}

fn graph(sketch: &Sketch) -> String {
    let mut text = String::from(
        "digraph automaton {\n    \
         node [shape=box, style=rounded, fontname=\"sans-serif\"];\n    \
         edge [fontname=\"sans-serif\", fontsize=11];\n    \
         initial [shape=point];\n",
    );
    for (number, mode) in sketch.modes.iter().enumerate() {
        text.push_str(&format!("    l{number} [label={}];\n", quoted(&mode.lines())));
    }
    text.push_str(&format!("    initial -> l{};\n", sketch.initial));
    for link in &sketch.links {
        let (source, target) = (link.source, link.target);
        let (label, style) = (quoted(&link.lines()), style(link.urgency));
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
