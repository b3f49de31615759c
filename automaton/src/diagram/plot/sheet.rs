//! The sheet of a plot: curves, texts and areas. The classes are named in one style sheet.

use pleach_drawing::style::{FORMULAS, GRID, INK, PAPER, QUIET};
use pleach_drawing::svg::node::element::{Path, Style, Title};
use pleach_drawing::svg::{Document, Node};
use pleach_drawing::{self as drawing, Spot, rectangle};

/// The width of the picture, in pixels.
pub(super) const WIDTH: f64 = 900.0;
/// The size of the text, in pixels.
const FONT_SIZE: f64 = 13.0;
/// From the middle of a line of text down to its base line, as a share of the size of the font.
const DESCENT: f64 = 0.35;
/// The radius of the dots at both ends of a jump, in pixels.
const DOT: f64 = 3.0;

/// Colours besides those that all pictures share: of panels, jumps and curves.
fn style_sheet() -> String {
    let families = FORMULAS.families;
    format!(
        "\
text {{ font-family: {families}; fill: {INK}; }}
.middle {{ text-anchor: middle; }}
.end {{ text-anchor: end; }}
.title {{ font-weight: bold; font-size: 17px; }}
.name {{ font-weight: bold; }}
.quiet {{ fill: {QUIET}; font-size: 12px; }}
.panel {{ fill: #fbfcfd; stroke: #aeb7c2; stroke-width: 1; }}
.grid {{ stroke: {GRID}; stroke-width: 1; }}
.jump {{ stroke: #8d98a5; stroke-width: 1.1; stroke-dasharray: 4 3; }}
.curve {{ fill: none; stroke: #1f5fa8; stroke-width: 1.8; stroke-linejoin: round; }}
.after {{ fill: #1f5fa8; }}
.before {{ fill: {PAPER}; stroke: #1f5fa8; stroke-width: 1.3; }}
.start {{ fill: {INK}; }}"
    )
}

/// The colours of locations: those of Okabe and Ito (2008), lightened so that a name can stand on
/// them, and darker ones of the same hues for lines.
const COLOURS: [(&str, &str); 8] = [
    ("#bcd9ee", "#0072b2"),
    ("#f7d59a", "#c77a00"),
    ("#b5e0cf", "#009e73"),
    ("#f3c2a4", "#d55e00"),
    ("#e8cadb", "#b0588c"),
    ("#cfe9f9", "#2c8cc0"),
    ("#ece7a3", "#8f8500"),
    ("#d5d8dc", "#5d6773"),
];

/// The colour of areas for the location with this number.
pub(super) fn area_colour(location: usize) -> &'static str {
    COLOURS[location % COLOURS.len()].0
}

/// The colour of lines for the location with this number.
pub(super) fn line_colour(location: usize) -> &'static str {
    COLOURS[location % COLOURS.len()].1
}

/// How wide a line of text is, estimated without its font.
pub(super) fn text_width(text: &str) -> f64 {
    FORMULAS.width(text, FONT_SIZE)
}

/// A plot while it is being drawn.
#[derive(Default)]
pub(super) struct Sheet {
    strokes: Vec<Box<dyn Node>>,
}

impl Sheet {
    pub(super) fn finish(self, height: f64) -> String {
        let sheet = drawing::sheet([0.0; 2], [WIDTH, height]).set("font-size", FONT_SIZE);
        let document = sheet.add(Style::new(style_sheet()));
        format!("{}\n", self.strokes.into_iter().fold(document, Document::add))
    }

    fn add(&mut self, element: impl Into<Box<dyn Node>>) {
        self.strokes.push(element.into());
    }

    /// A line of text whose middle is at the height `y`.
    pub(super) fn text(&mut self, x: f64, y: f64, text: &str, class: &str) {
        self.add(drawing::text(text, [x, y + DESCENT * FONT_SIZE]).set("class", class));
    }

    pub(super) fn line(&mut self, from: Spot, to: Spot, class: &str) {
        self.add(drawing::line(from, to).set("class", class));
    }

    /// A line along a path in the notation of SVG, in a colour of its own if there is one.
    pub(super) fn curve(&mut self, path: &str, colour: Option<&str>) {
        let curve = Path::new().set("class", "curve").set("d", path);
        self.add(match colour {
            Some(colour) => curve.set("style", format!("stroke: {colour}")),
            None => curve,
        });
    }

    pub(super) fn dot(&mut self, spot: Spot, class: &str) {
        self.add(drawing::disc(spot, DOT).set("class", class));
    }

    /// The frame of a panel.
    pub(super) fn panel(&mut self, corner: Spot, size: Spot) {
        self.add(rectangle(corner, size).set("class", "panel"));
    }

    /// A coloured area that says what it is when it is pointed at.
    pub(super) fn area(&mut self, corner: Spot, size: Spot, colour: &str, tooltip: &str) {
        self.add(rectangle(corner, size).set("fill", colour).add(Title::new(tooltip)));
    }
}
