//! Boxes in a row, joined by arcs: the picture that textbooks show of small automata.
//!
//! The initial location stands at the left. Arcs to the right run above the boxes and arcs to the
//! left below them, so that every label has a place of its own:
//!
//! * between neighbours an arc stays in their gap, and its label lies on its outer side;
//! * an arc that passes over a location runs on a level of its own beyond all that, and its label
//!   stands on the level, over a gap, where no other arc comes down;
//! * loops stand on top of their location, and those of the last one at its right.

use std::fmt::Write as _;

use pleach_discrete::Urgency;

use super::canvas::{Canvas, LINE_HEIGHT, MARGIN, Place, Size, number, text_width};
use super::{broken, label_class, stroke_class};
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
/// How far the first arc between neighbours bulges, in pixels.
const BULGE: f64 = 14.0;
/// How far a loop reaches out of its box, and half of how far it spreads along it, in pixels.
const LOOP: [f64; 2] = [34.0, 9.0];
/// The radius of bends, in pixels.
const BEND: f64 = 12.0;
/// The length of the arrow to the initial location, in pixels.
const ENTRANCE: f64 = 40.0;
/// Between two labels of loops on one side of a box, in pixels.
const LOOP_GAP: f64 = 14.0;
/// The length of a stroke in the key, in pixels.
const SAMPLE: f64 = 30.0;

/// Whether the picture does not become a tangle.
pub(super) fn suit(sketch: &Sketch) -> bool {
    (1..=MOST_PLACES).contains(&sketch.places.len()) && sketch.links.len() <= MOST_LINKS
}

/// Draws boxes and arcs; also says how large the picture is.
pub(super) fn draw(sketch: &Sketch) -> (Canvas, Size) {
    let mut canvas = Canvas::new();
    let row = Row::of(sketch);
    let mut extent = Extent::default();
    row.draw_boxes(&mut canvas, sketch, &mut extent);
    row.draw_loops(&mut canvas, &mut extent);
    row.draw_near(&mut canvas, &mut extent);
    row.draw_far(&mut canvas, &mut extent);
    draw_key(&mut canvas, sketch, &mut extent);

    let mut picture = Canvas::new();
    let corner = Place { x: MARGIN - extent.left, y: MARGIN - extent.top };
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

    /// Draws the lines from `top` on, at or around `x`.
    fn draw(&self, canvas: &mut Canvas, x: f64, top: f64, alignment: &str) {
        for (at, line) in self.lines.iter().enumerate() {
            let y = top + (at as f64 + 0.5) * LINE_HEIGHT;
            let class = format!("{} {alignment}", label_class(at, line));
            canvas.label(Place { x, y }, line, class.trim_end());
        }
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
    fn include(&mut self, corner: Place, size: Size) {
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
        let mut order: Vec<usize> = (0..sketch.places.len()).collect();
        order.sort_by_key(|&place| Some(place) != sketch.initial);
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
        let boxes = order.iter().map(|&place| Box::of(&sketch.places[place])).collect();
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

    fn draw_boxes(&self, canvas: &mut Canvas, sketch: &Sketch, extent: &mut Extent) {
        for one in &self.boxes {
            let corner = Place { x: one.left, y: -self.height / 2.0 };
            let size = Size { width: one.width, height: self.height };
            if one.is_missed {
                canvas.enrich();
            }
            canvas.location(
                corner,
                size,
                if one.is_missed { "location missed" } else { "location" },
            );
            extent.include(corner, size);
            let first = -(one.lines.len() as f64 - 1.0) / 2.0 * LINE_HEIGHT;
            for (at, line) in one.lines.iter().enumerate() {
                let class = if at == 0 { "name middle" } else { "middle" };
                let place = Place { x: one.middle(), y: first + at as f64 * LINE_HEIGHT };
                canvas.label(place, line, class);
            }
        }
        if sketch.initial.is_some() {
            self.draw_entrance(canvas, extent);
        }
    }

    /// The arrow to the initial location, with the initial state on it.
    fn draw_entrance(&self, canvas: &mut Canvas, extent: &mut Extent) {
        let width = self.start.iter().map(|line| text_width(line)).fold(0.0, f64::max);
        let length = ENTRANCE.max(width + AIR);
        canvas.dot(Place { x: -length, y: 0.0 });
        canvas.arrow(Place { x: -length, y: 0.0 }, Place { x: 0.0, y: 0.0 }, "must");
        let top = -LEADING - self.start.len() as f64 * LINE_HEIGHT;
        for (at, line) in self.start.iter().enumerate() {
            let y = top + (at as f64 + 0.5) * LINE_HEIGHT;
            canvas.label(Place { x: -length, y }, line, "condition");
        }
        let corner = Place { x: -length - LEADING, y: top };
        extent.include(corner, Size { width: length, height: -top + LEADING });
    }

    fn draw_loops(&self, canvas: &mut Canvas, extent: &mut Extent) {
        let last = self.boxes.len() - 1;
        for position in 0..last {
            self.draw_loops_above(canvas, extent, position);
        }
        let [reach, spread] = LOOP;
        let right = self.boxes[last].right();
        let mut top = -self.loops(last).map(loop_height).sum::<f64>() / 2.0;
        for arc in self.loops(last) {
            let y = top + loop_height(arc) / 2.0;
            let curve = bezier(
                Place { x: right, y: y - spread },
                Place { x: right + reach / 0.75, y: y - 2.6 * spread },
                Place { x: right + reach / 0.75, y: y + 2.6 * spread },
                Place { x: right, y: y + spread },
            );
            self.stroke(canvas, arc, &curve);
            let corner = Place { x: right + reach + LEADING, y: y - arc.label.height() / 2.0 };
            arc.label.draw(canvas, corner.x, corner.y, "");
            extent.include(corner, Size { width: arc.label.width, height: arc.label.height() });
            top += loop_height(arc);
        }
    }

    fn draw_loops_above(&self, canvas: &mut Canvas, extent: &mut Extent, position: usize) {
        let [reach, spread] = LOOP;
        let one = &self.boxes[position];
        let top = -self.height / 2.0;
        let mut left = one.middle() - self.loops(position).map(loop_width).sum::<f64>() / 2.0;
        for arc in self.loops(position) {
            let x = left + loop_width(arc) / 2.0;
            let curve = bezier(
                Place { x: x - spread, y: top },
                Place { x: x - 2.6 * spread, y: top - reach / 0.75 },
                Place { x: x + 2.6 * spread, y: top - reach / 0.75 },
                Place { x: x + spread, y: top },
            );
            self.stroke(canvas, arc, &curve);
            let corner = Place {
                x: x - arc.label.width / 2.0,
                y: top - reach - LEADING - arc.label.height(),
            };
            arc.label.draw(canvas, x, corner.y, "middle");
            extent.include(corner, Size { width: arc.label.width, height: arc.label.height() });
            left += loop_width(arc);
        }
    }

    fn draw_near(&self, canvas: &mut Canvas, extent: &mut Extent) {
        for gap in 0..self.boxes.len() - 1 {
            for side in [Side::Above, Side::Below] {
                self.draw_gap(canvas, extent, gap, side);
            }
        }
    }

    fn draw_gap(&self, canvas: &mut Canvas, extent: &mut Extent, gap: usize, side: Side) {
        let (left, right) = (self.boxes[gap].right(), self.boxes[gap + 1].left);
        let sign = side.sign();
        let mut level = FIRST_PORT + BULGE;
        for (number, arc) in self.near(gap, side).enumerate() {
            let port = FIRST_PORT + PORT * number as f64;
            let mut ends = [Place { x: left, y: sign * port }, Place { x: right, y: sign * port }];
            if side == Side::Below {
                ends.reverse();
            }
            let [from, to] = ends;
            let path = if number == 0 {
                let control = sign * (port + (level - port) / 0.75);
                let inwards = (to.x - from.x) / 4.0;
                let (one, other) = (from.x + inwards, to.x - inwards);
                bezier(from, Place { x: one, y: control }, Place { x: other, y: control }, to)
            } else {
                let inwards = (to.x - from.x).signum() * AIR / 2.0;
                let corners = [
                    from,
                    Place { x: from.x + inwards, y: from.y },
                    Place { x: from.x + inwards, y: sign * level },
                    Place { x: to.x - inwards, y: sign * level },
                    Place { x: to.x - inwards, y: to.y },
                    to,
                ];
                bent(&corners, BEND / 2.0)
            };
            self.stroke(canvas, arc, &path);
            level = self.draw_label(canvas, extent, arc, self.middle_of_gap(gap), level);
        }
    }

    /// Draws the label on the outer side of `level`; returns the next level.
    fn draw_label(
        &self,
        canvas: &mut Canvas,
        extent: &mut Extent,
        arc: &Arc,
        x: f64,
        level: f64,
    ) -> f64 {
        let height = arc.label.height();
        let top = match arc.side() {
            Side::Above => -(level + LEADING + height),
            Side::Below => level + LEADING,
        };
        arc.label.draw(canvas, x, top, "middle");
        let width = arc.label.width;
        extent.include(Place { x: x - width / 2.0, y: top }, Size { width, height });
        level + height + 2.0 * LEADING
    }

    fn draw_far(&self, canvas: &mut Canvas, extent: &mut Extent) {
        for side in [Side::Above, Side::Below] {
            let reached = match side {
                Side::Above => -extent.top,
                Side::Below => extent.bottom,
            };
            let mut level = reached + BEND + LEADING;
            let mut ports = vec![[0_u32; 2]; self.boxes.len()];
            for arc in self.far(side) {
                let mut port = |position: usize, is_rightwards: bool| {
                    let one = &self.boxes[position];
                    let taken = &mut ports[position][usize::from(is_rightwards)];
                    *taken += 1;
                    let inwards = PORT * f64::from(*taken);
                    if is_rightwards { one.right() - inwards } else { one.left + inwards }
                };
                let rightwards = arc.from < arc.to;
                let from = port(arc.from, rightwards);
                let to = port(arc.to, !rightwards);
                let (edge, height) = (side.sign() * self.height / 2.0, side.sign() * level);
                let corners = [
                    Place { x: from, y: edge },
                    Place { x: from, y: height },
                    Place { x: to, y: height },
                    Place { x: to, y: edge },
                ];
                self.stroke(canvas, arc, &bent(&corners, BEND));
                level = self.draw_label(canvas, extent, arc, self.middle_of_gap(arc.gap()), level);
            }
        }
    }

    fn stroke(&self, canvas: &mut Canvas, arc: &Arc, path: &str) {
        if arc.class.contains("missed") {
            canvas.enrich();
        }
        canvas.path(path, &arc.class, true);
    }
}

impl Box {
    fn of(place: &crate::diagram::sketch::Place) -> Box {
        let lines: Vec<String> =
            place.lines().iter().flat_map(|line| broken(line, LINE_LENGTH)).collect();
        let longest = lines.iter().map(|line| text_width(line)).fold(0.0, f64::max);
        let width = (longest + 2.0 * PADDING).max(LEAST_BOX);
        Box { lines, is_missed: place.is_missed, left: 0.0, width }
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

/// What the strokes of the picture mean, below it.
fn draw_key(canvas: &mut Canvas, sketch: &Sketch, extent: &mut Extent) {
    let all = [Urgency::May, Urgency::Must, Urgency::AtOnce];
    let present = |urgency: &&Urgency| sketch.links.iter().any(|link| link.urgency == **urgency);
    let y = extent.bottom + 1.5 * LINE_HEIGHT;
    let mut x = extent.left;
    for urgency in all.iter().filter(present) {
        let class = format!("arrow {}", stroke_class(*urgency, false));
        let end = x + SAMPLE;
        canvas.path(&format!("M {} {} H {}", number(x), number(y), number(end)), &class, true);
        canvas.label(Place { x: end + LEADING, y }, urgency.name(), "key");
        x = end + LEADING + text_width(urgency.name()) + AIR;
    }
    if x > extent.left {
        let size = Size { width: x - AIR - extent.left, height: LINE_HEIGHT };
        extent.include(Place { x: extent.left, y: y - LINE_HEIGHT / 2.0 }, size);
    }
}

fn bezier(from: Place, leaving: Place, arriving: Place, to: Place) -> String {
    let [a, b, c, d] = [from, leaving, arriving, to].map(pair);
    format!("M {a} C {b} {c} {d}")
}

/// A line through `corners`, which are rounded.
fn bent(corners: &[Place], radius: f64) -> String {
    let mut path = corners.first().map_or_else(String::new, |first| format!("M {}", pair(*first)));
    for corner in corners.windows(3) {
        let [before, at, after] = [corner[0], corner[1], corner[2]];
        let (enter, leave) = (towards(at, before, radius), towards(at, after, radius));
        // Writing into a string cannot fail.
        let _ = write!(path, " L {} Q {} {}", pair(enter), pair(at), pair(leave));
    }
    if let Some(last) = corners.last() {
        let _ = write!(path, " L {}", pair(*last));
    }
    path
}

/// From `from`, the place `distance` nearer to `to`, or half way if that is less.
fn towards(from: Place, to: Place, distance: f64) -> Place {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let length = dx.hypot(dy);
    let share = if length > 0.0 { (distance / length).min(0.5) } else { 0.0 };
    Place { x: from.x + share * dx, y: from.y + share * dy }
}

fn pair(place: Place) -> String {
    format!("{} {}", number(place.x), number(place.y))
}
