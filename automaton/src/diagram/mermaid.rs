//! Mermaid diagrams.

use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;

use super::sketch::{Contents, Sketch};
use crate::automaton::Automaton;
use crate::composition::Composition;
use crate::outline::Source;

/// The automaton as a Mermaid `stateDiagram-v2`. A superstate is a composite state, from which transitions
/// lead to the outside.
pub fn mermaid<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    states(&Sketch::of(&automaton.outline()))
}

fn states(sketch: &Sketch) -> String {
    let mut text = String::from("stateDiagram-v2\n");
    put_contents(sketch, None, 1, &mut text);
    text.push_str(&format!("    [*] --> l{}\n", sketch.initial));
    for (source, link) in sketch.drawn_links() {
        let source = match source {
            Source::Location(source) => format!("l{source}"),
            Source::Superstate(number) => format!("s{number}"),
        };
        let (target, label) = (link.target, escaped(&link.lines().join(" ")));
        text.push_str(&format!("    {source} --> l{target} : {label}\n"));
    }
    text
}

/// The locations, those of a superstate within it.
fn put_contents(sketch: &Sketch, outer: Option<usize>, depth: usize, text: &mut String) {
    let indent = "    ".repeat(depth);
    let Contents { superstates, locations } = sketch.within(outer);
    for number in superstates {
        let name = escaped(sketch.superstates[number].0);
        text.push_str(&format!("{indent}state \"{name}\" as s{number} {{\n"));
        put_contents(sketch, Some(number), depth + 1, text);
        text.push_str(&format!("{indent}}}\n"));
    }
    for number in locations {
        for line in sketch.modes[number].lines() {
            text.push_str(&format!("{indent}l{number} : {}\n", escaped(&line)));
        }
    }
}

/// The composition as a Mermaid flow chart: a frame around each component, a hexagon for each
/// label with dotted lines to those who take it together, and thick arrows from what is read to
/// who reads it.
pub fn composition_mermaid(composition: &Composition) -> String {
    let mut text = String::from("flowchart LR\n");
    for (component, (name, sketch)) in composition.sketches().iter().enumerate() {
        text.push_str(&format!("    subgraph c{component}[\"{}\"]\n", escaped(name)));
        for (number, mode) in sketch.modes.iter().enumerate() {
            let lines: Vec<String> = mode.lines().iter().map(|line| escaped(line)).collect();
            let lines = lines.join("<br>");
            text.push_str(&format!("        c{component}l{number}(\"{lines}\")\n"));
        }
        let initial = sketch.initial;
        text.push_str(&format!("        c{component}start(( )) --> c{component}l{initial}\n"));
        for link in &sketch.links {
            let (source, target) = (link.source, link.target);
            let lines: Vec<String> = link.lines().iter().map(|line| escaped(line)).collect();
            let lines = lines.join("<br>");
            text.push_str(&format!(
                "        c{component}l{source} -- \"{lines}\" --> c{component}l{target}\n"
            ));
        }
        text.push_str("    end\n");
    }
    for (number, (label, participants)) in composition.labels().enumerate() {
        text.push_str(&format!("    label{number}{{{{\"{}\"}}}}\n", escaped(label)));
        for component in participants {
            text.push_str(&format!("    label{number} -.- c{component}\n"));
        }
    }
    for connection in composition.connections() {
        let (from, to) = (connection.output, connection.input);
        let label = escaped(&connection.label());
        text.push_str(&format!("    c{from} == \"{label}\" ==> c{to}\n"));
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
