//! Pictures: one column a location, one row an event.
//!
//! Automata of real models have nearly as many transitions as pairs of locations. Drawn as boxes
//! and curves they become a tangle in which no label finds its edge. Here every location is a
//! column with a line downwards, and every event a row with its label at the left; the row's
//! arrows lead from the dots on the locations that it leaves to the location that it enters. An
//! event with several targets, urgencies or priorities has a row for each. A transition back to
//! its own source is a loop. A superstate is a bracket over its locations.

use pleach_discrete::Urgency;

use super::canvas::{Canvas, LINE_HEIGHT, MARGIN, Pixel, Size, number, text_width};
use super::{label_class, stroke_class, wrapped};
use crate::diagram::sketch::{Mode, Sketch};

/// Between a text and the border of its box, in pixels.
const PADDING: f64 = 10.0;
/// White between columns, in pixels.
const GAP: f64 = 22.0;
/// Above the boxes, where the initial location is entered, in pixels.
const ENTRANCE: f64 = 30.0;
/// The height of a superstate above the boxes, in pixels: its name, and a line with two feet.
const BRACKET: f64 = 28.0;
/// The least height of a row, in pixels: a loop fits.
const ROW_HEIGHT: f64 = 48.0;
/// Longer labels are broken, in characters.
const LINE_LENGTH: usize = 44;
/// Longer flows and invariants in the boxes of locations are broken, in characters.
const BOX_LINE_LENGTH: usize = 26;

/// How the picture is read, in its upper left corner.
const KEY: [&str; 2] =
    ["event [guard] / reset (urgency, priority)", "from each ● to where → points"];

/// Draws the columns and rows; also says how large the picture is.
pub(super) fn draw(sketch: &Sketch) -> (Canvas, Size) {
    let mut rows = rows(sketch);
    let labels = rows.iter().flat_map(|row| &row.label).map(String::as_str);
    let label_width = labels.chain(KEY).map(text_width).fold(0.0, f64::max);
    let columns = columns(sketch, MARGIN + label_width + GAP);
    let right = columns.iter().map(Column::right).fold(MARGIN + label_width, f64::max);
    let brackets = brackets(sketch, &columns);
    let right = brackets.iter().map(Bracket::right_of_name).fold(right, f64::max);
    let levels = brackets.iter().map(|bracket| bracket.level + 1).max().unwrap_or_default();
    let top = MARGIN + ENTRANCE + levels as f64 * BRACKET;
    let bottom = stack(&mut rows, top + box_height(&columns) + PADDING);

    let mut canvas = Canvas::new();
    draw_labels(&mut canvas, &rows, top, right);
    draw_columns(&mut canvas, &columns, top, bottom);
    brackets.iter().for_each(|bracket| draw_bracket(&mut canvas, bracket));
    for row in &rows {
        draw_arrows(&mut canvas, row, &columns);
    }
    if let Some(initial) = columns.get(sketch.initial) {
        canvas.initial_arrow(Pixel { x: initial.x, y: top - ENTRANCE }, ENTRANCE);
    }
    (canvas, Size { width: right + MARGIN, height: bottom + LINE_HEIGHT + MARGIN })
}

/// A location: its box, and the line below it.
struct Column {
    name: &'static str,
    lines: Vec<String>,
    is_missed: bool,
    x: f64,
    width: f64,
}

/// The transitions that share event, target, urgency and priority.
struct Row {
    label: Vec<String>,
    /// The columns that it leaves.
    sources: Vec<usize>,
    /// The column that it enters; none: it returns to each that it leaves.
    target: Option<usize>,
    urgency: Urgency,
    is_missed: bool,
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

impl Column {
    fn left(&self) -> f64 {
        self.x - self.width / 2.0
    }

    fn right(&self) -> f64 {
        self.x + self.width / 2.0
    }
}

/// By location; those of a superstate stand beside each other.
fn columns(sketch: &Sketch, left: f64) -> Vec<Column> {
    let modes = sketch.modes.iter();
    let column = |mode: &Mode| {
        let lines = mode.lines();
        let lines: Vec<String> =
            lines.iter().flat_map(|line| wrapped(line, BOX_LINE_LENGTH)).collect();
        let longest = lines.iter().map(|line| text_width(line)).fold(0.0, f64::max);
        let width = longest + 2.0 * PADDING;
        Column { name: mode.name, lines, is_missed: mode.is_missed, x: 0.0, width }
    };
    let mut columns: Vec<Column> = modes.map(column).collect();
    let mut from = left;
    for location in sketch.order() {
        let column = &mut columns[location];
        column.x = from + column.width / 2.0;
        from += column.width + GAP;
    }
    columns
}

/// A superstate: a bracket over the columns of its locations.
struct Bracket {
    name: &'static str,
    left: f64,
    right: f64,
    /// How many superstates contain it.
    level: usize,
}

impl Bracket {
    fn middle(&self) -> f64 {
        (self.left + self.right) / 2.0
    }

    fn right_of_name(&self) -> f64 {
        self.middle() + text_width(self.name) / 2.0
    }
}

fn brackets(sketch: &Sketch, columns: &[Column]) -> Vec<Bracket> {
    let superstates = sketch.superstates.iter().enumerate();
    let bracket = |(number, (name, members)): (usize, &(&'static str, Vec<usize>))| {
        let outer = sketch.superstates[..number].iter();
        Bracket {
            name,
            left: members.iter().map(|&it| columns[it].left()).fold(f64::INFINITY, f64::min),
            right: members.iter().map(|&it| columns[it].right()).fold(0.0, f64::max),
            level: outer.filter(|(_, others)| others.contains(&members[0])).count(),
        }
    };
    superstates.map(bracket).collect()
}

fn draw_bracket(canvas: &mut Canvas, bracket: &Bracket) {
    let y = MARGIN + bracket.level as f64 * BRACKET + LINE_HEIGHT / 2.0;
    canvas.label(Pixel { x: bracket.middle(), y }, bracket.name, "key middle");
    let [left, right] = [bracket.left, bracket.right].map(number);
    let [top, foot] = [y + LINE_HEIGHT / 2.0, y + LINE_HEIGHT / 2.0 + BRACKET / 4.0].map(number);
    canvas.enrich();
    canvas.path(&format!("M {left} {foot} V {top} H {right} V {foot}"), "frame", false);
}

/// The rows in the order in which their events are declared.
fn rows(sketch: &Sketch) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    let links = sketch.arrows.iter().flat_map(|arrow| {
        arrow.transitions.iter().map(|&number| (&sketch.links[number], arrow.target))
    });
    let mut links: Vec<_> = links.collect();
    links.sort_by_key(|(link, _)| link.event_number);
    for (link, target) in links {
        let lines = link.lines();
        let label: Vec<String> = lines.iter().flat_map(|line| wrapped(line, LINE_LENGTH)).collect();
        let known = rows.iter_mut().find(|row| row.target == target && row.label == label);
        match known {
            Some(row) => row.sources.push(link.source),
            None => rows.push(Row {
                label,
                sources: vec![link.source],
                target,
                urgency: link.urgency,
                is_missed: link.is_missed,
                top: 0.0,
            }),
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
fn draw_labels(canvas: &mut Canvas, rows: &[Row], top: f64, right: f64) {
    for (number, line) in KEY.iter().enumerate() {
        let y = top + (number as f64 + 0.5) * LINE_HEIGHT;
        canvas.label(Pixel { x: MARGIN, y }, line, "key");
    }
    for (number, row) in rows.iter().enumerate() {
        if number % 2 == 0 {
            let corner = Pixel { x: MARGIN / 2.0, y: row.top };
            canvas.stripe(corner, Size { width: right, height: row.height() });
        }
        let first = row.middle() - (row.label.len() as f64 - 1.0) / 2.0 * LINE_HEIGHT;
        for (at, line) in row.label.iter().enumerate() {
            let class = label_class(at, line);
            canvas.label(Pixel { x: MARGIN, y: first + at as f64 * LINE_HEIGHT }, line, class);
        }
    }
}

fn draw_arrows(canvas: &mut Canvas, row: &Row, columns: &[Column]) {
    let y = row.middle();
    if row.is_missed {
        canvas.enrich();
    }
    let class = stroke_class(row.urgency, row.is_missed);
    let places = || row.sources.iter().map(|&source| columns[source].x);
    let Some(target) = row.target.map(|target| columns[target].x) else {
        places().for_each(|x| canvas.returning_arrow(Pixel { x, y }, &class));
        return;
    };
    let [leftmost, rightmost] = [places().fold(target, f64::min), places().fold(target, f64::max)];
    for outermost in [leftmost, rightmost] {
        if outermost != target {
            canvas.arrow(Pixel { x: outermost, y }, Pixel { x: target, y }, &class);
        }
    }
    for x in places() {
        match x == target {
            true => canvas.returning_arrow(Pixel { x, y }, &class),
            false => canvas.dot(Pixel { x, y }),
        }
    }
}

/// The boxes, and the lines down to where the names stand again.
fn draw_columns(canvas: &mut Canvas, columns: &[Column], top: f64, bottom: f64) {
    let height = box_height(columns);
    for column in columns {
        let corner = Pixel { x: column.left(), y: top };
        canvas.column_line(column.x, top + height, bottom);
        let size = Size { width: column.width, height };
        canvas.location(corner, size, column.name, column.is_missed);
        let lines = column.lines.len() as f64;
        let first = top + height / 2.0 - (lines - 1.0) / 2.0 * LINE_HEIGHT;
        for (at, line) in column.lines.iter().enumerate() {
            let class = if at == 0 { "name middle" } else { "middle" };
            canvas.label(Pixel { x: column.x, y: first + at as f64 * LINE_HEIGHT }, line, class);
        }
        if let Some(name) = column.lines.first() {
            let y = bottom + LINE_HEIGHT / 2.0;
            canvas.label(Pixel { x: column.x, y }, name, "name middle");
        }
    }
}

fn box_height(columns: &[Column]) -> f64 {
    let lines = columns.iter().map(|column| column.lines.len()).max().unwrap_or(1);
    (lines as f64 * LINE_HEIGHT).max(KEY.len() as f64 * LINE_HEIGHT) + PADDING
}
