//! Pictures, laid out by `layout-rs` without any other program.
//!
//! Locations are boxes, and so are the labels of transitions: an edge of the automaton leads from
//! its source to its label and on to its target. That way no label can lie on another, however
//! many transitions there are between two locations. A transition back to its own source would be
//! two edges on the same line; it is one, and its label begins with ↺.

mod canvas;

use layout::core::base::Orientation;
use layout::core::color::Color;
use layout::core::geometry::Point;
use layout::core::style::{LineStyleKind, StyleAttr};
use layout::std_shapes::shapes::{Arrow, Element, LineEndKind, ShapeKind};
use layout::topo::layout::VisualGraph;
use petgraph::visit::EdgeRef;
use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::Valuation;

use super::label::{location_lines, transition_lines};
use crate::automaton::{Automaton, node};
use canvas::Canvas;

/// Size of the text of locations, in pixels.
const LOCATION_FONT: usize = 15;
/// Size of the text of transitions, in pixels.
const TRANSITION_FONT: usize = 12;
/// The mean width of a character of a sans-serif font, as a share of its size, on the safe side.
const CHARACTER_WIDTH: f64 = 0.65;
/// The height of a line of text, as a share of the size of the font.
const LINE_HEIGHT: f64 = 1.3;
/// Between the text of a box and its border, in pixels.
const PADDING: f64 = 12.0;
/// Longer lines are broken, in characters.
const LINE_LENGTH: usize = 34;
/// The diameter of the dot from which the initial location is entered, in pixels.
const INITIAL_DOT: f64 = 12.0;

/// The automaton as an SVG document. Transitions that only may be taken are dashed, and those that
/// happen at once are bold.
pub fn svg<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    let mut picture = VisualGraph::new(Orientation::TopToBottom);
    let graph = automaton.graph();
    let dot = picture.add_node(dot());
    let places: Vec<_> = graph
        .node_indices()
        .map(|place| {
            let lines = location_lines(automaton, graph[place]);
            picture.add_node(text_box(&lines, LOCATION_FONT, "location"))
        })
        .collect();
    if let Some(initial) = node(automaton.initial()) {
        let entry = Arrow { end: LineEndKind::Arrow, ..line(Urgency::Must) };
        picture.add_edge(entry, dot, places[initial.index()]);
    }
    for edge in graph.edge_references() {
        let urgency = edge.weight().urgency;
        let mut lines = transition_lines(edge.weight());
        let returns = edge.source() == edge.target();
        if returns {
            lines[0].insert_str(0, "↺ ");
        }
        let label = picture.add_node(text_box(&lines, TRANSITION_FONT, "transition"));
        let (source, target) = (places[edge.source().index()], places[edge.target().index()]);
        let line = line(urgency);
        if returns {
            picture.add_edge(Arrow { start: LineEndKind::Arrow, ..line }, source, label);
        } else {
            picture.add_edge(line.clone(), source, label);
            picture.add_edge(Arrow { end: LineEndKind::Arrow, ..line }, label, target);
        }
    }
    let mut canvas = Canvas::new();
    picture.do_it(false, false, false, &mut canvas);
    canvas.finish()
}

fn dot() -> Element {
    let (shape, size) = (ShapeKind::new_circle(""), Point::splat(INITIAL_DOT));
    let look = look(LOCATION_FONT);
    Element::create_with_properties(shape, look, Orientation::TopToBottom, size, "initial")
}

fn text_box(lines: &[String], font: usize, class: &str) -> Element {
    let lines: Vec<String> = lines.iter().flat_map(|line| wrapped(line)).collect();
    let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
    let size = Point::new(
        longest as f64 * font as f64 * CHARACTER_WIDTH + 2.0 * PADDING,
        lines.len() as f64 * font as f64 * LINE_HEIGHT + PADDING,
    );
    let shape = ShapeKind::new_box(&lines.join("\n"));
    Element::create_with_properties(shape, look(font), Orientation::TopToBottom, size, class)
}

fn line(urgency: Urgency) -> Arrow {
    let class = match urgency {
        Urgency::May => "may",
        Urgency::Must => "must",
        Urgency::AtOnce => "at-once",
    };
    let look = look(TRANSITION_FONT);
    let (none, solid) = (LineEndKind::None, LineStyleKind::Normal);
    Arrow::with_properties(none, none, solid, "", &look, class, &None, &None)
}

/// Only the size of the font matters: colours and lines are up to the style sheet of the canvas.
fn look(font: usize) -> StyleAttr {
    StyleAttr::new(Color::fast("black"), 1, None, 0, font)
}

/// Breaks a line between words, where it becomes too long.
fn wrapped(line: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in line.split(' ') {
        match lines.last_mut() {
            Some(last) if last.chars().count() + 1 + word.chars().count() <= LINE_LENGTH => {
                last.push(' ');
                last.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
