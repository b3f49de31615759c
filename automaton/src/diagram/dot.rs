//! Graphs in the DOT language.

use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::Valuation;

use super::sketch::{Contents, Sketch};
use crate::automaton::Automaton;
use crate::outline::Source;

/// The automaton in the DOT language. Transitions that only may be taken are dashed, and those
/// that happen at once are bold. A superstate is a cluster, from whose border transitions
/// lead to the outside.
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
    if !sketch.superstates.is_empty() {
        text.push_str("    compound=true;\n    fontname=\"sans-serif\";\n");
    }
    put_contents(sketch, None, 1, &mut text);
    text.push_str(&format!("    initial -> l{};\n", sketch.initial));
    for (source, link) in sketch.drawn_links() {
        let (label, style) = (quoted(&link.lines()), style(link.urgency));
        let tail = match source {
            Source::Superstate(number) => format!(", ltail=cluster{number}"),
            Source::Location(_) => String::new(),
        };
        let (from, to) = (link.source, link.target);
        text.push_str(&format!("    l{from} -> l{to} [label={label}, style={style}{tail}];\n"));
    }
    text.push_str("}\n");
    text
}

/// The locations, those of a superstate in a cluster.
fn put_contents(sketch: &Sketch, outer: Option<usize>, depth: usize, text: &mut String) {
    let indent = "    ".repeat(depth);
    let Contents { superstates, locations } = sketch.within(outer);
    for number in superstates {
        let name = quoted(&[sketch.superstates[number].0.to_owned()]);
        text.push_str(&format!("{indent}subgraph cluster{number} {{\n{indent}    label={name};\n"));
        put_contents(sketch, Some(number), depth + 1, text);
        text.push_str(&format!("{indent}}}\n"));
    }
    for number in locations {
        let label = quoted(&sketch.modes[number].lines());
        text.push_str(&format!("{indent}l{number} [label={label}];\n"));
    }
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
