//! Strokes, texts and sheets as figures draw them, and the map from the workspace to the sheet.

use pleach_drawing::style::{INK, QUIET, WORDS};
use pleach_drawing::svg::Document;
use pleach_drawing::svg::node::element::{Line, Rectangle, Text};
use pleach_drawing::{self as drawing, line, number};

use super::palette::{SUBTITLE_SIZE, TITLE_SIZE};

pub(crate) use pleach_drawing::Spot;

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

/// How wide a text is, estimated without its font.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    WORDS.width(text, size)
}

/// A text that starts at a place.
pub(super) fn text(content: impl Into<String>, spot: Spot, size: f64, colour: &str) -> Text {
    drawing::text(content, spot).set("font-size", number(size)).set("fill", colour)
}

/// A straight stroke with round ends.
pub(super) fn stroke(from: Spot, to: Spot, colour: &str, width: f64) -> Line {
    line(from, to)
        .set("stroke", colour)
        .set("stroke-width", number(width))
        .set("stroke-linecap", "round")
}

/// A filled rectangle from a corner, with its size.
pub(super) fn rectangle(corner: Spot, size: Spot, colour: &str) -> Rectangle {
    drawing::rectangle(corner, size).set("fill", colour)
}

/// How much wider bold type is than regular type, in typefaces with wide bold letters.
const BOLD: f64 = 1.15;
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
    let fitting = |content: &str, size: f64, stretch: f64| {
        size.min(size * room / (stretch * text_width(content, size)).max(1.0))
    };
    let title_size = fitting(title, TITLE_SIZE, BOLD);
    framed([0.0, 0.0], [width, height], title)
        .add(text(title, [20.0, 34.0], title_size, INK).set("font-weight", "bold"))
        .add(text(subtitle, [20.0, 56.0], fitting(subtitle, SUBTITLE_SIZE, 1.0), QUIET))
}

fn framed(corner: Spot, size: Spot, title: &str) -> Document {
    drawing::sheet(corner, size)
        .set("font-family", WORDS.families)
        .set("role", "img")
        .set("aria-label", title)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Bold letters of DejaVu Sans, which stands in where none of the families is installed, are 0.61 of the size
    /// wide in such a title.
    #[test]
    fn a_long_title_fits_onto_the_sheet_in_wide_bold_letters() {
        let title =
            "thin-corridor-with-a-very-long-name-that-goes-on-and-on-and-on-for-titles: the start";
        let picture = headed([960.0, 100.0], title, "", false).to_string();
        let words = picture.lines().find(|line| line.contains("font-weight=\"bold\"")).unwrap();
        let size = words.split_once("font-size=\"").unwrap().1.split_once('"').unwrap().0;
        let width = 0.61 * title.chars().count() as f64 * size.parse::<f64>().unwrap();
        assert!(20.0 + width <= 960.0 - 15.0, "{width} px of {size}");
    }
}
