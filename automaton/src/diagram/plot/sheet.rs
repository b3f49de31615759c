//! The paper of a plot: strokes, texts and colours. The classes are named in one style sheet.

use svg::node::element::{Circle, Line, Path, Rectangle, Style, Text, Title};
use svg::{Document, Node};

/// The width of the picture, in pixels.
pub(super) const WIDTH: f64 = 900.0;
/// The size of the text, in pixels.
const FONT_SIZE: f64 = 13.0;
/// The mean width of a character of a sans-serif font, as a share of its size.
const CHARACTER_WIDTH: f64 = 0.56;
/// From the middle of a line of text down to its base line, as a share of the size of the font.
const DESCENT: f64 = 0.35;
/// The radius of the dots at both ends of a jump, in pixels.
const DOT: f64 = 3.0;

const STYLE: &str = "\
text { font-family: 'DejaVu Sans', 'Segoe UI', Helvetica, Arial, sans-serif; fill: #1b1f24; }
.middle { text-anchor: middle; }
.end { text-anchor: end; }
.title { font-weight: bold; font-size: 17px; }
.name { font-weight: bold; }
.quiet { fill: #5d6773; font-size: 12px; }
.paper { fill: #ffffff; }
.panel { fill: #fbfcfd; stroke: #aeb7c2; stroke-width: 1; }
.grid { stroke: #e3e7ec; stroke-width: 1; }
.jump { stroke: #8d98a5; stroke-width: 1.1; stroke-dasharray: 4 3; }
.curve { fill: none; stroke: #1f5fa8; stroke-width: 1.8; stroke-linejoin: round; }
.after { fill: #1f5fa8; }
.before { fill: #ffffff; stroke: #1f5fa8; stroke-width: 1.3; }
.start { fill: #1b1f24; }";

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
    text.chars().count() as f64 * FONT_SIZE * CHARACTER_WIDTH
}

/// A plot while it is being drawn; y grows downwards.
pub(super) struct Sheet {
    document: Document,
}

impl Sheet {
    pub fn new() -> Sheet {
        let paper =
            Rectangle::new().set("class", "paper").set("width", "100%").set("height", "100%");
        let document =
            Document::new().set("font-size", FONT_SIZE).add(Style::new(STYLE)).add(paper);
        Sheet { document }
    }

    pub fn finish(self, height: f64) -> String {
        let (width, height) = (number(WIDTH), number(height));
        let view = format!("0 0 {width} {height}");
        let document = self.document.set("width", width).set("height", height).set("viewBox", view);
        format!("{document}\n")
    }

    fn add(&mut self, element: impl Into<Box<dyn Node>>) {
        Node::append(&mut self.document, element.into());
    }

    /// A line of text whose middle is at the height `y`.
    pub fn text(&mut self, x: f64, y: f64, text: &str, class: &str) {
        let text = Text::new(text).set("class", class).set("x", number(x));
        self.add(text.set("y", number(y + DESCENT * FONT_SIZE)));
    }

    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], class: &str) {
        let line = Line::new().set("class", class);
        let line = line.set("x1", number(from[0])).set("y1", number(from[1]));
        self.add(line.set("x2", number(to[0])).set("y2", number(to[1])));
    }

    /// A line along a path in the notation of SVG, in a colour of its own if there is one.
    pub fn curve(&mut self, path: &str, colour: Option<&str>) {
        let curve = Path::new().set("class", "curve").set("d", path);
        self.add(match colour {
            Some(colour) => curve.set("style", format!("stroke: {colour}")),
            None => curve,
        });
    }

    pub fn dot(&mut self, [x, y]: [f64; 2], class: &str) {
        let dot = Circle::new().set("class", class).set("r", DOT);
        self.add(dot.set("cx", number(x)).set("cy", number(y)));
    }

    /// The frame of a panel.
    pub fn panel(&mut self, corner: [f64; 2], size: [f64; 2]) {
        self.add(rectangle(corner, size).set("class", "panel"));
    }

    /// A coloured area that says what it is when it is pointed at.
    pub fn area(&mut self, corner: [f64; 2], size: [f64; 2], colour: &str, tooltip: &str) {
        self.add(rectangle(corner, size).set("fill", colour).add(Title::new(tooltip)));
    }
}

fn rectangle([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Rectangle {
    let rectangle = Rectangle::new().set("x", number(x)).set("y", number(y));
    rectangle.set("width", number(width)).set("height", number(height))
}

/// A hundredth of a pixel is fine enough.
pub(super) fn number(value: f64) -> String {
    format!("{value:.2}")
}
