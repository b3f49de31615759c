//! Pictures: one column a location, one row an event.
//!
//! Automata of real models have nearly as many transitions as pairs of locations. Drawn as boxes
//! and curves they become a tangle in which no label finds its edge. Here every location is a
//! column with a line downwards, and every event a row with its label at the left; the row's
//! arrows lead from the dots on the locations that it leaves to the location that it enters. An
//! event with several targets, urgencies or priorities has a row for each. A transition back to
//! its own source is a loop.

mod canvas;

use petgraph::visit::EdgeRef;
use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::Valuation;

use super::label::{location_lines, transition_lines};
use crate::automaton::{Automaton, node};
use canvas::{Canvas, LINE_HEIGHT, Place, Size, text_width};

/// Between a text and the border of its box, in pixels.
const PADDING: f64 = 10.0;
/// White between columns, in pixels.
const GAP: f64 = 22.0;
/// White around the picture, in pixels.
const MARGIN: f64 = 16.0;
/// Above the boxes, where the initial location is entered, in pixels.
const ENTRANCE: f64 = 30.0;
/// The least height of a row, in pixels: a loop fits.
const ROW_HEIGHT: f64 = 48.0;
/// Longer labels are broken, in characters.
const LINE_LENGTH: usize = 44;

/// How the picture is read, in its upper left corner.
const KEY: [&str; 2] =
    ["event [guard] / reset (urgency, priority)", "from each ● to where → points"];

/// The automaton as an SVG document. Transitions that only may be taken are dashed, and those that
/// happen at once are bold.
pub fn svg<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    let mut rows = rows(automaton);
    let labels = rows.iter().flat_map(|row| &row.label).map(String::as_str);
    let label_width = labels.chain(KEY).map(text_width).fold(0.0, f64::max);
    let columns = columns(automaton, MARGIN + label_width + GAP);
    let right = columns.last().map_or(MARGIN + label_width, |last| last.x + last.width / 2.0);
    let bottom = stack(&mut rows, MARGIN + ENTRANCE + box_height(&columns) + PADDING);

    let mut canvas = Canvas::new();
    draw_labels(&mut canvas, &rows, right);
    draw_columns(&mut canvas, &columns, bottom);
    for row in &rows {
        draw_arrows(&mut canvas, row, &columns);
    }
    if let Some(initial) = node(automaton.initial()).and_then(|node| columns.get(node.index())) {
        canvas.initial_arrow(Place { x: initial.x, y: MARGIN }, ENTRANCE);
    }
    canvas.finish(Size { width: right + MARGIN, height: bottom + LINE_HEIGHT + MARGIN })
}

/// A location: its box, and the line below it.
struct Column {
    lines: Vec<String>,
    x: f64,
    width: f64,
}

/// The transitions that share event, target, urgency and priority.
struct Row {
    label: Vec<String>,
    /// The columns that it leaves.
    sources: Vec<usize>,
    /// The column that it enters.
    target: usize,
    urgency: Urgency,
    /// Where it begins in the picture.
    top: f64,
}

impl Row {
    fn height(&self) -> f64 {
        (self.label.len() as f64 * LINE_HEIGHT + PADDING).max(ROW_HEIGHT)
    }

    fn middle(&self) -> f64 {
        self.top + self.height() / 2.0
    }
}

fn columns<L: Location, E: Event, S: Valuation>(
    automaton: &Automaton<L, E, S>,
    left: f64,
) -> Vec<Column> {
    let mut from = left;
    let places = automaton.graph().node_weights();
    places
        .map(|&location| {
            let lines = location_lines(automaton, location);
            let longest = lines.iter().map(|line| text_width(line)).fold(0.0, f64::max);
            let width = longest + 2.0 * PADDING;
            let x = from + width / 2.0;
            from += width + GAP;
            Column { lines, x, width }
        })
        .collect()
}

fn rows<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> Vec<Row> {
    let mut rows = Vec::new();
    for event in E::ALL {
        let of_event = rows.len();
        for edge in automaton.graph().edge_references() {
            let transition = edge.weight();
            if transition.event != *event {
                continue;
            }
            let (source, target) = (edge.source().index(), edge.target().index());
            let lines = transition_lines(transition);
            let label: Vec<String> = lines.iter().flat_map(|line| wrapped(line)).collect();
            let known = rows[of_event..]
                .iter_mut()
                .find(|row: &&mut Row| row.target == target && row.label == label);
            match known {
                Some(row) => row.sources.push(source),
                None => {
                    let urgency = transition.urgency;
                    rows.push(Row { label, sources: vec![source], target, urgency, top: 0.0 });
                }
            }
        }
    }
    rows
}

/// Puts the rows below each other; returns where they end.
fn stack(rows: &mut [Row], mut top: f64) -> f64 {
    for row in rows {
        row.top = top;
        top += row.height();
    }
    top + PADDING
}

/// The key, and the labels of the rows on a ground of alternating colour.
fn draw_labels(canvas: &mut Canvas, rows: &[Row], right: f64) {
    for (number, line) in KEY.iter().enumerate() {
        let y = MARGIN + ENTRANCE + (number as f64 + 0.5) * LINE_HEIGHT;
        canvas.label(Place { x: MARGIN, y }, line, "key");
    }
    for (number, row) in rows.iter().enumerate() {
        if number % 2 == 0 {
            let corner = Place { x: MARGIN / 2.0, y: row.top };
            canvas.stripe(corner, Size { width: right, height: row.height() });
        }
        let first = row.middle() - (row.label.len() as f64 - 1.0) / 2.0 * LINE_HEIGHT;
        for (at, line) in row.label.iter().enumerate() {
            let class = if at == 0 { "name" } else { "condition" };
            canvas.label(Place { x: MARGIN, y: first + at as f64 * LINE_HEIGHT }, line, class);
        }
    }
}

fn draw_arrows(canvas: &mut Canvas, row: &Row, columns: &[Column]) {
    let y = row.middle();
    let target = columns[row.target].x;
    let class = match row.urgency {
        Urgency::May => "may",
        Urgency::Must => "must",
        Urgency::AtOnce => "at-once",
    };
    let places = || row.sources.iter().map(|&source| columns[source].x);
    let [leftmost, rightmost] = [places().fold(target, f64::min), places().fold(target, f64::max)];
    for outermost in [leftmost, rightmost] {
        if outermost != target {
            canvas.arrow(Place { x: outermost, y }, Place { x: target, y }, class);
        }
    }
    for x in places() {
        match x == target {
            true => canvas.returning_arrow(Place { x, y }, class),
            false => canvas.dot(Place { x, y }),
        }
    }
}

/// The boxes, and the lines down to where the names stand again.
fn draw_columns(canvas: &mut Canvas, columns: &[Column], bottom: f64) {
    let (top, height) = (MARGIN + ENTRANCE, box_height(columns));
    for column in columns {
        let corner = Place { x: column.x - column.width / 2.0, y: top };
        canvas.column_line(column.x, top + height, bottom);
        canvas.location(corner, Size { width: column.width, height });
        let lines = column.lines.len() as f64;
        let first = top + height / 2.0 - (lines - 1.0) / 2.0 * LINE_HEIGHT;
        for (at, line) in column.lines.iter().enumerate() {
            let class = if at == 0 { "name middle" } else { "middle" };
            canvas.label(Place { x: column.x, y: first + at as f64 * LINE_HEIGHT }, line, class);
        }
        if let Some(name) = column.lines.first() {
            let y = bottom + LINE_HEIGHT / 2.0;
            canvas.label(Place { x: column.x, y }, name, "name middle");
        }
    }
}

fn box_height(columns: &[Column]) -> f64 {
    let lines = columns.iter().map(|column| column.lines.len()).max().unwrap_or(1);
    (lines as f64 * LINE_HEIGHT).max(KEY.len() as f64 * LINE_HEIGHT) + PADDING
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
