//! Small strokes that every figure is made of: numbers, texts, lines, and the map to the paper.

use svg::Document;
use svg::node::element::{Group, Line, Rectangle, Text};

use super::palette::{CHARACTER_WIDTH, FONT, INK, PAPER, QUIET, SUBTITLE_SIZE, TITLE_SIZE};

/// A place on the paper, y downwards.
pub(crate) type Spot = [f64; 2];

/// Writes a coordinate with two decimals and without a negative zero, so that equal pictures
/// have equal bytes.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

/// Writes a quantity for people: with four decimals or four significant digits at most, and as few
/// as it needs.
#[must_use]
pub fn quantity(value: f64) -> String {
    let exponent = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    let decimals = (3.0 - exponent).clamp(4.0, 300.0) as usize;
    let text = format!("{value:.decimals$}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

/// Writes the corners of a polygon or polyline.
pub(super) fn corners(spots: impl IntoIterator<Item = Spot>) -> String {
    let pairs: Vec<String> =
        spots.into_iter().map(|[x, y]| format!("{},{}", number(x), number(y))).collect();
    pairs.join(" ")
}

/// How wide a text is, estimated without its font.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * CHARACTER_WIDTH
}

/// A text that starts at a place on the paper.
pub(super) fn text(content: impl Into<String>, [x, y]: Spot, size: f64, colour: &str) -> Text {
    Text::new(content)
        .set("x", number(x))
        .set("y", number(y))
        .set("font-size", number(size))
        .set("fill", colour)
}

/// A straight stroke.
pub(super) fn stroke(from: Spot, to: Spot, colour: &str, width: f64) -> Line {
    Line::new()
        .set("x1", number(from[0]))
        .set("y1", number(from[1]))
        .set("x2", number(to[0]))
        .set("y2", number(to[1]))
        .set("stroke", colour)
        .set("stroke-width", number(width))
        .set("stroke-linecap", "round")
}

/// Above the drawings of figures with a heading, for title and subtitle.
const HEAD: f64 = 62.0;

/// An empty sheet; readers of the screen say its title.
pub(super) fn sheet(size: [f64; 2], title: &str) -> Document {
    framed([0.0, 0.0], size, title)
}

/// A sheet with title and subtitle above the drawing; `plain` figures, for papers with captions of
/// their own, go without and begin where the drawing does.
pub(super) fn headed(
    [width, height]: [f64; 2],
    title: &str,
    subtitle: &str,
    plain: bool,
) -> Document {
    if plain {
        return framed([0.0, HEAD], [width, height - HEAD], title);
    }
    let room = width - 40.0;
    let fitting =
        |content: &str, size: f64| size.min(size * room / text_width(content, size).max(1.0));
    framed([0.0, 0.0], [width, height], title)
        .add(text(title, [20.0, 34.0], fitting(title, TITLE_SIZE), INK).set("font-weight", "bold"))
        .add(text(subtitle, [20.0, 56.0], fitting(subtitle, SUBTITLE_SIZE), QUIET))
}

fn framed([left, top]: Spot, [width, height]: [f64; 2], title: &str) -> Document {
    let corners = [left, top, width, height].map(number);
    Document::new()
        .set("viewBox", corners.join(" "))
        .set("width", number(width))
        .set("height", number(height))
        .set("font-family", FONT)
        .set("role", "img")
        .set("aria-label", title)
        .add(rectangle([left, top], [width, height], PAPER))
}

/// A filled rectangle from a corner, with its size.
pub(super) fn rectangle([x, y]: Spot, [width, height]: [f64; 2], colour: &str) -> Rectangle {
    Rectangle::new()
        .set("x", number(x))
        .set("y", number(y))
        .set("width", number(width.max(0.0)))
        .set("height", number(height.max(0.0)))
        .set("fill", colour)
}

/// A layer of a picture; its class names it for readers of the file.
pub(super) fn layer(class: &str) -> Group {
    Group::new().set("class", class)
}

/// The map from the workspace to the paper: same scale in x and y, y turned over.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    scale: f64,
    left: f64,
    bottom: f64,
    origin: Spot,
    size: [f64; 2],
}

impl View {
    /// Fits the bounding box of `points` into a box of the paper, from its upper left `corner`.
    pub(super) fn fit(points: &[[f64; 2]], corner: Spot, room: [f64; 2]) -> View {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for point in points {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let extent = [0, 1].map(|axis| {
            let extent: f64 = high[axis] - low[axis];
            if extent.is_finite() && extent > 0.0 { extent } else { 1.0 }
        });
        let low = low.map(|value: f64| if value.is_finite() { value } else { 0.0 });
        let scale = (room[0] / extent[0]).min(room[1] / extent[1]);
        let size = extent.map(|length| length * scale);
        let origin = [corner[0], corner[1] + size[1]];
        View { scale, left: low[0], bottom: low[1], origin, size }
    }

    /// Where a point of the workspace lies on the paper.
    pub(super) fn spot(&self, point: [f64; 2]) -> Spot {
        [
            self.origin[0] + (point[0] - self.left) * self.scale,
            self.origin[1] - (point[1] - self.bottom) * self.scale,
        ]
    }

    /// A length of the workspace on the paper.
    pub(super) fn length(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// Upper left corner of the drawing and its size.
    pub(super) fn frame(&self) -> (Spot, [f64; 2]) {
        ([self.origin[0], self.origin[1] - self.size[1]], self.size)
    }
}
