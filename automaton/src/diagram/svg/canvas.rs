//! The strokes that a picture of an automaton is made of. Colours and lines are up to one style
//! sheet, in which the classes of the strokes are named.

use svg::Document;
use svg::node::element::{Circle, Definitions, Line, Marker, Path, Rectangle, Style, Text};

/// The size of the text, in pixels.
const FONT_SIZE: f64 = 13.0;
/// From one line of text to the next, in pixels.
pub(super) const LINE_HEIGHT: f64 = 17.0;
/// The mean width of a character of a sans-serif font, as a share of its size, on the safe side.
const CHARACTER_WIDTH: f64 = 0.6;
/// From the middle of a line of text down to its base line, as a share of the size of the font.
const DESCENT: f64 = 0.35;
/// The radius of the dot where an arrow begins, in pixels.
const DOT: f64 = 4.5;
/// How far a loop reaches up and to the right, in pixels.
const LOOP: [f64; 2] = [26.0, 15.0];

const STYLE: &str = "\
text { font-family: 'DejaVu Sans', 'Segoe UI', Helvetica, Arial, sans-serif; fill: #1b1f24; }
.middle { text-anchor: middle; }
.name { font-weight: bold; }
.condition { fill: #3b4554; }
.key { fill: #6a7482; font-style: italic; }
.paper { fill: #ffffff; }
.stripe { fill: #f4f6f9; }
.location { fill: #dfe9f6; stroke: #34527a; stroke-width: 1.5; }
.column { stroke: #a9b8cc; stroke-width: 1; }
.dot { fill: #1b1f24; }
.arrow { fill: none; stroke: #1b1f24; stroke-width: 1.2; }
.may { stroke-dasharray: 5 4; }
.at-once { stroke-width: 2.2; }
.head { fill: #1b1f24; }";

/// A place in the picture, in pixels; y grows downwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub x: f64,
    pub y: f64,
}

/// The size of a rectangle, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub width: f64,
    pub height: f64,
}

/// How wide a line of text is, estimated without its font.
pub(super) fn text_width(text: &str) -> f64 {
    text.chars().count() as f64 * FONT_SIZE * CHARACTER_WIDTH
}

/// An SVG document while it is being drawn.
pub(super) struct Canvas {
    document: Document,
}

impl Canvas {
    pub fn new() -> Self {
        let triangle = Path::new().set("class", "head").set("d", "M 0 0 L 10 4 L 0 8 z");
        let head = Marker::new()
            .set("id", "head")
            .set("viewBox", "0 0 10 8")
            .set("refX", 10)
            .set("refY", 4)
            .set("markerWidth", 11)
            .set("markerHeight", 9)
            .set("markerUnits", "userSpaceOnUse")
            .set("orient", "auto")
            .add(triangle);
        let paper =
            Rectangle::new().set("class", "paper").set("width", "100%").set("height", "100%");
        let document = Document::new()
            .set("font-size", FONT_SIZE)
            .add(Style::new(STYLE))
            .add(Definitions::new().add(head))
            .add(paper);
        Canvas { document }
    }

    pub fn finish(self, Size { width, height }: Size) -> String {
        let (width, height) = (number(width), number(height));
        let view = format!("0 0 {width} {height}");
        let document = self.document.set("width", width).set("height", height).set("viewBox", view);
        format!("{document}\n")
    }

    fn add(&mut self, element: impl Into<Box<dyn svg::Node>>) {
        svg::Node::append(&mut self.document, element.into());
    }

    /// A line of text whose middle is at the height of `place`.
    pub fn label(&mut self, place: Place, text: &str, class: &str) {
        let base = place.y + DESCENT * FONT_SIZE;
        let text = Text::new(text).set("class", class);
        self.add(text.set("x", number(place.x)).set("y", number(base)));
    }

    /// The box of a location.
    pub fn location(&mut self, corner: Place, size: Size) {
        self.add(rectangle(corner, size).set("class", "location").set("rx", 8));
    }

    /// The ground of a row.
    pub fn stripe(&mut self, corner: Place, size: Size) {
        self.add(rectangle(corner, size).set("class", "stripe"));
    }

    /// The line below a location.
    pub fn column_line(&mut self, x: f64, top: f64, bottom: f64) {
        let line = line(Place { x, y: top }, Place { x, y: bottom });
        self.add(line.set("class", "column"));
    }

    /// Where a transition begins.
    pub fn dot(&mut self, at: Place) {
        let circle = Circle::new().set("class", "dot").set("r", DOT);
        self.add(circle.set("cx", number(at.x)).set("cy", number(at.y)));
    }

    /// An arrow with its head at `to`.
    pub fn arrow(&mut self, from: Place, to: Place, class: &str) {
        let line = line(from, to).set("class", format!("arrow {class}"));
        self.add(line.set("marker-end", "url(#head)"));
    }

    /// From a dot above `at` round to `at`.
    pub fn returning_arrow(&mut self, at: Place, class: &str) {
        let [reach, height] = LOOP;
        let above = at.y - height;
        self.dot(Place { x: at.x, y: above });
        let curve = format!(
            "M {x} {above} C {far} {above} {far} {y} {x} {y}",
            x = number(at.x),
            far = number(at.x + reach),
            above = number(above),
            y = number(at.y),
        );
        let path = Path::new().set("class", format!("arrow {class}")).set("d", curve);
        self.add(path.set("marker-end", "url(#head)"));
    }

    /// The arrow from nowhere to the initial location, whose box is `length` below.
    pub fn initial_arrow(&mut self, from: Place, length: f64) {
        let start = Place { y: from.y + DOT, ..from };
        self.dot(start);
        self.arrow(start, Place { y: from.y + length, ..from }, "must");
    }
}

fn rectangle(corner: Place, size: Size) -> Rectangle {
    Rectangle::new()
        .set("x", number(corner.x))
        .set("y", number(corner.y))
        .set("width", number(size.width))
        .set("height", number(size.height))
}

fn line(from: Place, to: Place) -> Line {
    Line::new()
        .set("x1", number(from.x))
        .set("y1", number(from.y))
        .set("x2", number(to.x))
        .set("y2", number(to.y))
}

/// A tenth of a pixel is fine enough.
fn number(value: f64) -> String {
    format!("{value:.1}")
}
