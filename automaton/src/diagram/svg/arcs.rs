//! Boxes in a row, joined by arcs: the picture that textbooks show of small automata.
//!
//! The initial location stands at the left. Arcs to the right run above the boxes and arcs to the
//! left below them, so that every label has a place of its own:
//!
//! * between neighbours an arc stays in their gap, and its label lies on its outer side;
//! * an arc that passes over a location runs on a level of its own beyond all that, and its label
//!   stands on the level, over a gap, where no other arc comes down;
//! * loops stand on top of their location, and those of the last one at its right.

mod path;
mod strokes;

use super::canvas::{Canvas, LINE_HEIGHT, MARGIN, Pixel, Size, text_width};
use super::{broken, stroke_class};
use crate::diagram::sketch::{Link, Sketch};

/// The most locations.
const MOST_PLACES: usize = 4;
/// The most transitions.
const MOST_LINKS: usize = 12;
/// Between a text and the border of its box, in pixels.
const PADDING: f64 = 14.0;
/// Longer lines are broken, in characters.
const LINE_LENGTH: usize = 34;
/// The least width of a box, in pixels.
const LEAST_BOX: f64 = 84.0;
/// The least width of a gap, in pixels.
const LEAST_GAP: f64 = 80.0;
/// Between a label and what stands at its sides, in pixels.
const AIR: f64 = 22.0;
/// Between an arc and its label, and from a label to the next arc, in pixels.
const LEADING: f64 = 6.0;
/// From the line through the middle of the boxes to the first arc, in pixels.
const FIRST_PORT: f64 = 9.0;
/// From port to port along a side of a box, in pixels.
const PORT: f64 = 15.0;
/// How far a loop reaches out of its box, and half of how far it spreads along it, in pixels.
const LOOP: [f64; 2] = [34.0, 9.0];
/// Between two labels of loops on one side of a box, in pixels.
const LOOP_GAP: f64 = 14.0;

/// Whether the picture does not become a tangle.
pub(super) fn suit(sketch: &Sketch) -> bool {
    (1..=MOST_PLACES).contains(&sketch.modes.len())
        && sketch.links.len() <= MOST_LINKS
        && sketch.superstates.is_empty()
}

/// Draws boxes and arcs; also says how large the picture is.
pub(super) fn draw(sketch: &Sketch) -> (Canvas, Size) {
    let mut canvas = Canvas::new();
    let row = Row::of(sketch);
    let mut extent = Extent::default();
    row.draw_boxes(&mut canvas, &mut extent);
    row.draw_loops(&mut canvas, &mut extent);
    row.draw_near(&mut canvas, &mut extent);
    row.draw_far(&mut canvas, &mut extent);
    strokes::draw_key(&mut canvas, sketch, &mut extent);

    let mut picture = Canvas::new();
    let corner = Pixel { x: MARGIN - extent.left, y: MARGIN - extent.top };
    picture.inset(canvas, corner);
    let width = extent.right - extent.left + 2.0 * MARGIN;
    (picture, Size { width, height: extent.bottom - extent.top + 2.0 * MARGIN })
}

/// Everything in its place; x counts from the left end of the first box and y from the middle of
/// all boxes.
struct Row {
    boxes: Vec<Box>,
    height: f64,
    arcs: Vec<Arc>,
    start: Vec<String>,
}

/// The box of a location.
struct Box {
    name: &'static str,
    lines: Vec<String>,
    is_missed: bool,
    left: f64,
    width: f64,
}

/// A transition between positions in the row.
struct Arc {
    from: usize,
    to: usize,
    label: Label,
    class: String,
}

/// The lines of a label.
struct Label {
    lines: Vec<String>,
    width: f64,
}

impl Label {
    fn of(link: &Link) -> Label {
        let lines: Vec<String> =
            link.short_lines().iter().flat_map(|line| broken(line, LINE_LENGTH)).collect();
        let width = lines.iter().map(|line| text_width(line)).fold(0.0, f64::max);
        Label { lines, width }
    }

    fn height(&self) -> f64 {
        self.lines.len() as f64 * LINE_HEIGHT
    }
}

/// How far the picture reaches.
#[derive(Default)]
struct Extent {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Extent {
    fn include(&mut self, corner: Pixel, size: Size) {
        self.left = self.left.min(corner.x);
        self.top = self.top.min(corner.y);
        self.right = self.right.max(corner.x + size.width);
        self.bottom = self.bottom.max(corner.y + size.height);
    }
}

/// Above or below the boxes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Above,
    Below,
}

impl Side {
    /// The direction away from the boxes.
    fn sign(self) -> f64 {
        match self {
            Side::Above => -1.0,
            Side::Below => 1.0,
        }
    }
}

impl Arc {
    fn is_loop(&self) -> bool {
        self.from == self.to
    }

    fn is_near(&self) -> bool {
        self.from.abs_diff(self.to) == 1
    }

    fn is_far(&self) -> bool {
        self.from.abs_diff(self.to) > 1
    }

    fn side(&self) -> Side {
        if self.from < self.to { Side::Above } else { Side::Below }
    }

    fn first(&self) -> usize {
        self.from.min(self.to)
    }

    /// The gap in which the label stands: that after the location of this position.
    fn gap(&self) -> usize {
        self.first() + (self.from.abs_diff(self.to) - 1) / 2
    }
}

impl Row {
    fn of(sketch: &Sketch) -> Row {
        let mut order: Vec<usize> = (0..sketch.modes.len()).collect();
        order.sort_by_key(|&place| place != sketch.initial);
        let position = |place| order.iter().position(|&one| one == place).unwrap_or_default();
        let arcs: Vec<Arc> = sketch
            .links
            .iter()
            .map(|link| Arc {
                from: position(link.source),
                to: position(link.target),
                label: Label::of(link),
                class: format!("arrow {}", stroke_class(link.urgency, link.is_missed)),
            })
            .collect();
        let boxes = order.iter().map(|&place| Box::of(&sketch.modes[place])).collect();
        let mut row = Row { boxes, height: 0.0, arcs, start: sketch.start.clone() };
        row.set_sizes();
        row
    }

    fn set_sizes(&mut self) {
        let last = self.boxes.len() - 1;
        let lines = self.boxes.iter().map(|one| one.lines.len()).max().unwrap_or(1);
        let near = |side: Side| {
            (0..last).map(|gap| self.near(gap, side).count()).max().unwrap_or_default()
        };
        let ports = 2.0 * (FIRST_PORT + PORT * near(Side::Above).max(near(Side::Below)) as f64);
        let loops: f64 = self.loops(last).map(loop_height).sum();
        self.height = (lines as f64 * LINE_HEIGHT + PADDING).max(ports).max(loops + PADDING);

        let mut left = 0.0;
        for position in 0..=last {
            let mut width = self.boxes[position].width;
            for side in [Side::Above, Side::Below] {
                let far = self.far(side);
                let ports = far.iter().filter(|arc| [arc.from, arc.to].contains(&position)).count();
                let loops: f64 = match (side, position == last) {
                    (Side::Above, false) => self.loops(position).map(loop_width).sum(),
                    _ => 0.0,
                };
                width = width.max(loops + 2.0 * PORT * (ports as f64 + 1.0));
            }
            let labels = self.arcs.iter().filter(|arc| !arc.is_loop() && arc.gap() == position);
            let gap = labels.map(|arc| arc.label.width + 2.0 * AIR).fold(LEAST_GAP, f64::max);
            self.boxes[position].width = width;
            self.boxes[position].left = left;
            left += width + gap;
        }
    }

    /// The loops of the location at `position`.
    fn loops(&self, position: usize) -> impl Iterator<Item = &Arc> {
        self.arcs.iter().filter(move |arc| arc.is_loop() && arc.from == position)
    }

    /// The arcs in the gap after `position`, the innermost first.
    fn near(&self, position: usize, side: Side) -> impl Iterator<Item = &Arc> {
        self.arcs
            .iter()
            .filter(move |arc| arc.is_near() && arc.first() == position && arc.side() == side)
    }

    /// The arcs that pass over locations, the shortest first.
    fn far(&self, side: Side) -> Vec<&Arc> {
        let mut far: Vec<&Arc> =
            self.arcs.iter().filter(|arc| arc.is_far() && arc.side() == side).collect();
        far.sort_by_key(|arc| arc.from.abs_diff(arc.to));
        far
    }

    fn middle_of_gap(&self, position: usize) -> f64 {
        (self.boxes[position].right() + self.boxes[position + 1].left) / 2.0
    }
}

impl Box {
    fn of(place: &crate::diagram::sketch::Mode) -> Box {
        let lines: Vec<String> =
            place.lines().iter().flat_map(|line| broken(line, LINE_LENGTH)).collect();
        let longest = lines.iter().map(|line| text_width(line)).fold(0.0, f64::max);
        let width = (longest + 2.0 * PADDING).max(LEAST_BOX);
        Box { name: place.name, lines, is_missed: place.is_missed, left: 0.0, width }
    }

    fn right(&self) -> f64 {
        self.left + self.width
    }

    fn middle(&self) -> f64 {
        self.left + self.width / 2.0
    }
}

/// How much of the side of a box a loop at its right takes.
fn loop_height(arc: &Arc) -> f64 {
    arc.label.height().max(5.2 * LOOP[1]) + LEADING
}

/// How much of the side of a box a loop on top of it takes.
fn loop_width(arc: &Arc) -> f64 {
    arc.label.width.max(5.2 * LOOP[1]) + LOOP_GAP
}
