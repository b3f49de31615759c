//! The picture of a composition: its components side by side in frames, above them a line for each
//! label, with a dot over every participant, and below them an arrow for each connection,
//! from what is read to who reads it.

use super::canvas::{Canvas, LINE_HEIGHT, MARGIN, Pixel, Size, number, text_width};
use super::draw;
use crate::composition::Composition;

/// Between frames, in pixels.
const GAP: f64 = 28.0;
/// Between a frame and the picture in it, in pixels.
const PADDING: f64 = 6.0;
/// From the line of a label to the next, and likewise of connections, in pixels.
const STEP: f64 = 30.0;

/// The composition as an SVG document.
pub fn composition_svg(composition: &Composition) -> String {
    let labels: Vec<(&str, Vec<usize>)> = composition.labels().collect();
    let connections = composition.connections();
    let top =
        MARGIN + labels.len() as f64 * STEP + if labels.is_empty() { 0.0 } else { STEP / 2.0 };

    let mut canvas = Canvas::new();
    canvas.enrich();
    let mut frames = Vec::new();
    let mut left = MARGIN;
    for (name, sketch) in composition.sketches() {
        let (picture, size) = draw(&sketch);
        let width = (size.width + 2.0 * PADDING).max(text_width(name) + 2.0 * MARGIN);
        let picture = Some((picture, size));
        frames.push(Frame { name: name.to_owned(), left, width, picture });
        left += width + GAP;
    }
    let tallest = frames.iter().filter_map(|frame| frame.picture.as_ref());
    let tallest = tallest.map(|(_, size)| size.height).fold(0.0, f64::max);
    let height = tallest + LINE_HEIGHT + 2.0 * PADDING;
    let bottom = top + height;
    for frame in &mut frames {
        frame.draw(&mut canvas, top, height);
    }
    for (number, (label, participants)) in labels.iter().enumerate() {
        let y = MARGIN + (number as f64 + 0.5) * STEP;
        let places: Vec<f64> = participants
            .iter()
            .map(|&component| {
                let known = labels.iter().filter(|(_, who)| who.contains(&component));
                let (before, all) =
                    (known.clone().position(|(one, _)| one == label), known.count());
                frames[component].port(before.unwrap_or(0), all)
            })
            .collect();
        draw_label(&mut canvas, &places, label, [y, top]);
    }
    let ends = |component: usize| {
        let all = connections.iter().flat_map(|one| [one.output, one.input]);
        all.filter(move |one| *one == component).count()
    };
    let mut ports = vec![0; frames.len()];
    for (number, connection) in connections.iter().enumerate() {
        let y = bottom + (number as f64 + 1.0) * STEP;
        let mut port = |component: usize| {
            ports[component] += 1;
            frames[component].port(ports[component] - 1, ends(component))
        };
        let ways = [port(connection.output), port(connection.input)];
        draw_connection(&mut canvas, ways, &connection.label(), [y, bottom]);
    }
    let below = connections.len() as f64 * STEP + if connections.is_empty() { 0.0 } else { STEP };
    canvas.finish(Size { width: left - GAP + MARGIN, height: bottom + below + MARGIN })
}

/// A component with its automaton.
struct Frame {
    name: String,
    left: f64,
    width: f64,
    picture: Option<(Canvas, Size)>,
}

impl Frame {
    /// Where number `which` of `all` ways reaches the frame.
    fn port(&self, which: usize, all: usize) -> f64 {
        self.left + self.width * (which as f64 + 1.0) / (all as f64 + 1.0)
    }

    fn draw(&mut self, canvas: &mut Canvas, top: f64, height: f64) {
        let corner = Pixel { x: self.left, y: top };
        canvas.frame(corner, Size { width: self.width, height });
        let y = top + PADDING + LINE_HEIGHT / 2.0;
        canvas.label(Pixel { x: self.left + 2.0 * PADDING, y }, &self.name, "name");
        if let Some((picture, size)) = self.picture.take() {
            let x = self.left + (self.width - size.width) / 2.0;
            canvas.inset(picture, Pixel { x, y: top + PADDING + LINE_HEIGHT });
        }
    }
}

/// A line over all participants, with a way down to each.
fn draw_label(canvas: &mut Canvas, places: &[f64], label: &str, [y, top]: [f64; 2]) {
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return };
    if first < last {
        let (from, to) = (number(*first), number(*last));
        canvas.path(&format!("M {from} {} H {to}", number(y)), "wire", false);
    }
    for &x in places {
        let (x_text, from, to) = (number(x), number(y), number(top));
        canvas.path(&format!("M {x_text} {from} V {to}"), "wire", false);
        canvas.dot_of(Pixel { x, y: top }, "wire-dot");
    }
    let place = Pixel { x: first + PADDING, y: y - LINE_HEIGHT / 2.0 };
    canvas.label(place, label, "wire-text");
}

/// From the frame at x = `from` down to `y`, across, and up into the other frame.
fn draw_connection(canvas: &mut Canvas, [from, to]: [f64; 2], label: &str, [y, bottom]: [f64; 2]) {
    canvas.dot_of(Pixel { x: from, y: bottom }, "pipe-dot");
    let [x, across, down, up] = [from, to, y, bottom].map(number);
    canvas.path(&format!("M {x} {up} V {down} H {across} V {up}"), "pipe", true);
    let place = Pixel { x: from.min(to) + PADDING, y: y - LINE_HEIGHT / 2.0 };
    canvas.label(place, label, "pipe-text");
}
