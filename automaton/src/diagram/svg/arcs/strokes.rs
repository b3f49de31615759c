//! How boxes, loops and arcs are drawn once they have their places.

use pleach_discrete::Urgency;

use super::path::{bent, bezier};
use super::{
    AIR, Arc, Extent, FIRST_PORT, LEADING, LOOP, Label, PORT, Row, Side, loop_height, loop_width,
};
use crate::diagram::sketch::Sketch;
use crate::diagram::svg::canvas::{Canvas, LINE_HEIGHT, Pixel, Size, number, text_width};
use crate::diagram::svg::{label_class, stroke_class};

/// How far the first arc between neighbours bulges, in pixels.
const BULGE: f64 = 14.0;
/// The radius of bends, in pixels.
const BEND: f64 = 12.0;
/// The length of the arrow to the initial location, in pixels.
const ENTRANCE: f64 = 40.0;
/// The length of a stroke in the key, in pixels.
const SAMPLE: f64 = 30.0;

impl Row {
    pub(super) fn draw_boxes(&self, canvas: &mut Canvas, extent: &mut Extent) {
        for one in &self.boxes {
            let corner = Pixel { x: one.left, y: -self.height / 2.0 };
            let size = Size { width: one.width, height: self.height };
            canvas.location(corner, size, one.name, one.is_missed);
            extent.include(corner, size);
            let first = -(one.lines.len() as f64 - 1.0) / 2.0 * LINE_HEIGHT;
            for (at, line) in one.lines.iter().enumerate() {
                let class = if at == 0 { "name middle" } else { "middle" };
                let place = Pixel { x: one.middle(), y: first + at as f64 * LINE_HEIGHT };
                canvas.label(place, line, class);
            }
        }
        self.draw_entrance(canvas, extent);
    }

    /// The arrow to the initial location, with the initial state on it.
    fn draw_entrance(&self, canvas: &mut Canvas, extent: &mut Extent) {
        let width = self.start.iter().map(|line| text_width(line)).fold(0.0, f64::max);
        let length = ENTRANCE.max(width + AIR);
        canvas.dot(Pixel { x: -length, y: 0.0 });
        canvas.arrow(Pixel { x: -length, y: 0.0 }, Pixel { x: 0.0, y: 0.0 }, "must");
        let top = -LEADING - self.start.len() as f64 * LINE_HEIGHT;
        for (at, line) in self.start.iter().enumerate() {
            let y = top + (at as f64 + 0.5) * LINE_HEIGHT;
            canvas.label(Pixel { x: -length, y }, line, "condition");
        }
        let corner = Pixel { x: -length - LEADING, y: top };
        extent.include(corner, Size { width: length, height: -top + LEADING });
    }

    pub(super) fn draw_loops(&self, canvas: &mut Canvas, extent: &mut Extent) {
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
                Pixel { x: right, y: y - spread },
                Pixel { x: right + reach / 0.75, y: y - 2.6 * spread },
                Pixel { x: right + reach / 0.75, y: y + 2.6 * spread },
                Pixel { x: right, y: y + spread },
            );
            self.stroke(canvas, arc, &curve);
            let corner = Pixel { x: right + reach + LEADING, y: y - arc.label.height() / 2.0 };
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
                Pixel { x: x - spread, y: top },
                Pixel { x: x - 2.6 * spread, y: top - reach / 0.75 },
                Pixel { x: x + 2.6 * spread, y: top - reach / 0.75 },
                Pixel { x: x + spread, y: top },
            );
            self.stroke(canvas, arc, &curve);
            let corner = Pixel {
                x: x - arc.label.width / 2.0,
                y: top - reach - LEADING - arc.label.height(),
            };
            arc.label.draw(canvas, x, corner.y, "middle");
            extent.include(corner, Size { width: arc.label.width, height: arc.label.height() });
            left += loop_width(arc);
        }
    }

    pub(super) fn draw_near(&self, canvas: &mut Canvas, extent: &mut Extent) {
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
            let mut ends = [Pixel { x: left, y: sign * port }, Pixel { x: right, y: sign * port }];
            if side == Side::Below {
                ends.reverse();
            }
            let [from, to] = ends;
            let path = if number == 0 {
                let control = sign * (port + (level - port) / 0.75);
                let inwards = (to.x - from.x) / 4.0;
                let (one, other) = (from.x + inwards, to.x - inwards);
                bezier(from, Pixel { x: one, y: control }, Pixel { x: other, y: control }, to)
            } else {
                let inwards = (to.x - from.x).signum() * AIR / 2.0;
                let corners = [
                    from,
                    Pixel { x: from.x + inwards, y: from.y },
                    Pixel { x: from.x + inwards, y: sign * level },
                    Pixel { x: to.x - inwards, y: sign * level },
                    Pixel { x: to.x - inwards, y: to.y },
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
        extent.include(Pixel { x: x - width / 2.0, y: top }, Size { width, height });
        level + height + 2.0 * LEADING
    }

    pub(super) fn draw_far(&self, canvas: &mut Canvas, extent: &mut Extent) {
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
                    Pixel { x: from, y: edge },
                    Pixel { x: from, y: height },
                    Pixel { x: to, y: height },
                    Pixel { x: to, y: edge },
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

impl Label {
    /// Draws the lines from `top` on, at or around `x`.
    fn draw(&self, canvas: &mut Canvas, x: f64, top: f64, alignment: &str) {
        for (at, line) in self.lines.iter().enumerate() {
            let y = top + (at as f64 + 0.5) * LINE_HEIGHT;
            let class = format!("{} {alignment}", label_class(at, line));
            canvas.label(Pixel { x, y }, line, class.trim_end());
        }
    }
}

/// What the strokes of the picture mean, below it.
pub(super) fn draw_key(canvas: &mut Canvas, sketch: &Sketch, extent: &mut Extent) {
    let all = [Urgency::May, Urgency::Must, Urgency::AtOnce];
    let present = |urgency: &&Urgency| sketch.links.iter().any(|link| link.urgency == **urgency);
    let y = extent.bottom + 1.5 * LINE_HEIGHT;
    let mut x = extent.left;
    for urgency in all.iter().filter(present) {
        let class = format!("arrow {}", stroke_class(*urgency, false));
        let end = x + SAMPLE;
        canvas.path(&format!("M {} {} H {}", number(x), number(y), number(end)), &class, true);
        canvas.label(Pixel { x: end + LEADING, y }, urgency.name(), "key");
        x = end + LEADING + text_width(urgency.name()) + AIR;
    }
    if x > extent.left {
        let size = Size { width: x - AIR - extent.left, height: LINE_HEIGHT };
        extent.include(Pixel { x: extent.left, y: y - LINE_HEIGHT / 2.0 }, size);
    }
}
