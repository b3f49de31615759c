//! Graphs in the DOT language.

use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::Valuation;

use super::sketch::{Contents, Sketch};
use crate::automaton::Automaton;
use crate::outline::Source;

/// The automaton in the DOT language. Transitions that only may be taken are dashed, and those
/// that happen at once are bold. A superstate is a cluster, from whose border its transitions
/// lead; of one that ends inside, the label names the superstate.
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
    for arrow in &sketch.arrows {
        let link = &sketch.links[arrow.transitions[0]];
        let (mut lines, style) = (link.lines(), style(link.urgency));
        let (source, target) = (link.source, arrow.target.unwrap_or(link.source));
        let mut tail = String::new();
        if let Source::Superstate(number) = arrow.source {
            let (name, members) = &sketch.superstates[number];
            // Graphviz draws no edge from the border of a cluster to its inside.
            match members.contains(&target) {
                true => lines[0] = format!("{name}: {}", lines[0]),
                false => tail = format!(", ltail=cluster{number}"),
            }
        }
        let label = quoted(&lines);
        text.push_str(&format!(
            "    l{source} -> l{target} [label={label}, style={style}{tail}];\n"
        ));
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
