//! The strokes that a picture of an automaton is made of. Colours and lines are up to one style
//! sheet, in which the classes of the strokes are named.

pub(super) use pleach_drawing::number;
use pleach_drawing::svg::node::element::{
    Definitions, Group, Line, Marker, Path, Rectangle, Style,
};
use pleach_drawing::svg::{Document, Node};
use pleach_drawing::{self as drawing, disc, sheet, style};

/// The size of the text, in pixels.
const FONT_SIZE: f64 = 13.0;
/// From one line of text to the next, in pixels.
pub(super) const LINE_HEIGHT: f64 = 17.0;
/// White around the picture, in pixels.
pub(super) const MARGIN: f64 = 16.0;
/// From the middle of a line of text down to its base line, as a share of the size of the font.
const DESCENT: f64 = 0.35;
/// The radius of the dot where an arrow begins, in pixels.
const DOT: f64 = 4.5;
/// How far a loop reaches up and to the right, in pixels.
const LOOP: [f64; 2] = [26.0, 15.0];

/// Colours besides those that all pictures share: of conditions, keys and locations.
fn style_sheet() -> String {
    let (families, ink, band) = (style::FORMULAS.families, style::INK, style::BAND);
    format!(
        "\
text {{ font-family: {families}; fill: {ink}; }}
.middle {{ text-anchor: middle; }}
.name {{ font-weight: bold; }}
.condition {{ fill: #3b4554; }}
.key {{ fill: #6a7482; font-style: italic; }}
.stripe {{ fill: {band}; }}
.location {{ fill: #dfe9f6; stroke: #34527a; stroke-width: 1.5; }}
.column {{ stroke: #a9b8cc; stroke-width: 1; }}
.dot {{ fill: {ink}; }}
.arrow {{ fill: none; stroke: {ink}; stroke-width: 1.2; }}
.may {{ stroke-dasharray: 5 4; }}
.at-once {{ stroke-width: 2.2; }}
.head {{ fill: {ink}; }}"
    )
}

/// What else there is in pictures of runs and of compositions; the others do without.
const MORE_STYLE: &str = "
.missed { stroke: #c0392b; }
.missed-text { fill: #c0392b; font-weight: bold; }
.missed-dot { fill: #c0392b; }
.location.missed { fill: #fbeae8; stroke-dasharray: 6 4; }
.arrow.missed { stroke-dasharray: 7 4; }
.frame { fill: none; stroke: #7d8894; stroke-width: 1.2; }
.wire { fill: none; stroke: #2f6f4f; stroke-width: 1.4; stroke-dasharray: 2 3; }
.wire-dot { fill: #2f6f4f; }
.wire-text { fill: #2f6f4f; font-weight: bold; }
.pipe { fill: none; stroke: #8a5a12; stroke-width: 2; }
.pipe-dot { fill: #8a5a12; }
.pipe-text { fill: #8a5a12; }";

/// A place in the picture, in pixels; y grows downwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixel {
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
    style::FORMULAS.width(text, FONT_SIZE)
}

/// A picture while it is being drawn.
#[derive(Default)]
pub(super) struct Canvas {
    strokes: Vec<Box<dyn Node>>,
    /// Whether runs or a composition are in the picture, too.
    is_rich: bool,
}

impl Canvas {
    pub(super) fn new() -> Self {
        Canvas::default()
    }

    /// The strokes as an SVG document.
    pub(super) fn finish(self, Size { width, height }: Size) -> String {
        let (mut style, mut definitions) =
            (style_sheet(), Definitions::new().add(head("head", "head")));
        if self.is_rich {
            style.push_str(MORE_STYLE);
            definitions = definitions
                .add(head("missed-head", "missed-dot"))
                .add(head("pipe-head", "pipe-dot"));
        }
        let sheet = sheet([0.0; 2], [width, height]).set("font-size", FONT_SIZE);
        let document = sheet.add(Style::new(style)).add(definitions);
        format!("{}\n", self.strokes.into_iter().fold(document, Document::add))
    }

    /// Puts another picture here, with its upper left corner at `corner`.
    pub(super) fn inset(&mut self, picture: Canvas, corner: Pixel) {
        let shift = format!("translate({} {})", number(corner.x), number(corner.y));
        self.is_rich |= picture.is_rich;
        let group = picture.strokes.into_iter().fold(Group::new(), Group::add);
        self.add(group.set("transform", shift));
    }

    /// Classes for runs and compositions are used from now on.
    pub(super) fn enrich(&mut self) {
        self.is_rich = true;
    }

    fn add(&mut self, element: impl Into<Box<dyn Node>>) {
        self.strokes.push(element.into());
    }

    /// A line of text whose middle is at the height of `place`.
    pub(super) fn label(&mut self, place: Pixel, text: &str, class: &str) {
        let base = place.y + DESCENT * FONT_SIZE;
        self.add(drawing::text(text, [place.x, base]).set("class", class));
    }

    /// The box of a location. Its attribute `data-location` is the name, for scripts that show
    /// which location is active.
    pub(super) fn location(&mut self, corner: Pixel, size: Size, name: &str, is_missed: bool) {
        self.is_rich |= is_missed;
        let class = if is_missed { "location missed" } else { "location" };
        let place = rectangle(corner, size).set("class", class).set("data-location", name);
        self.add(place.set("rx", 8));
    }

    /// The frame of a component.
    pub(super) fn frame(&mut self, corner: Pixel, size: Size) {
        self.add(rectangle(corner, size).set("class", "frame").set("rx", 4));
    }

    /// The ground of a row.
    pub(super) fn stripe(&mut self, corner: Pixel, size: Size) {
        self.add(rectangle(corner, size).set("class", "stripe"));
    }

    /// The line below a location.
    pub(super) fn column_line(&mut self, x: f64, top: f64, bottom: f64) {
        let line = line(Pixel { x, y: top }, Pixel { x, y: bottom });
        self.add(line.set("class", "column"));
    }

    /// The ground of a text that stands on an arrow.
    pub(super) fn ground(&mut self, at: Pixel, radius: f64) {
        self.add(disc([at.x, at.y], radius).set("fill", style::PAPER));
    }

    /// Where a transition begins.
    pub(super) fn dot(&mut self, at: Pixel) {
        self.dot_of(at, "dot");
    }

    /// A dot of another colour.
    pub(super) fn dot_of(&mut self, at: Pixel, class: &str) {
        self.add(disc([at.x, at.y], DOT).set("class", class));
    }

    /// An arrow with its head at `to`.
    pub(super) fn arrow(&mut self, from: Pixel, to: Pixel, class: &str) {
        let line = line(from, to).set("class", format!("arrow {class}"));
        self.add(line.set("marker-end", head_of(class)));
    }

    /// A line or an arrow along a path in the notation of SVG.
    pub(super) fn path(&mut self, path: &str, class: &str, has_head: bool) {
        let stroke = Path::new().set("class", class).set("d", path);
        self.add(if has_head { stroke.set("marker-end", head_of(class)) } else { stroke });
    }

    /// From a dot above `at` round to `at`.
    pub(super) fn returning_arrow(&mut self, at: Pixel, class: &str) {
        let [reach, height] = LOOP;
        let above = at.y - height;
        self.dot(Pixel { x: at.x, y: above });
        let curve = format!(
            "M {x} {above} C {far} {above} {far} {y} {x} {y}",
            x = number(at.x),
            far = number(at.x + reach),
            above = number(above),
            y = number(at.y),
        );
        let path = Path::new().set("class", format!("arrow {class}")).set("d", curve);
        self.add(path.set("marker-end", head_of(class)));
    }

    /// The arrow from nowhere to the initial location, whose box is `length` below.
    pub(super) fn initial_arrow(&mut self, from: Pixel, length: f64) {
        let start = Pixel { y: from.y + DOT, ..from };
        self.dot(start);
        self.arrow(start, Pixel { y: from.y + length, ..from }, "must");
    }
}

/// The head of an arrow; `class` gives its colour.
fn head(name: &str, class: &str) -> Marker {
    let triangle = Path::new().set("class", class).set("d", "M 0 0 L 10 4 L 0 8 z");
    Marker::new()
        .set("id", name)
        .set("viewBox", "0 0 10 8")
        .set("refX", 10)
        .set("refY", 4)
        .set("markerWidth", 11)
        .set("markerHeight", 9)
        .set("markerUnits", "userSpaceOnUse")
        .set("orient", "auto")
        .add(triangle)
}

fn head_of(class: &str) -> &'static str {
    match class {
        _ if class.contains("missed") => "url(#missed-head)",
        _ if class.contains("pipe") => "url(#pipe-head)",
        _ => "url(#head)",
    }
}

fn rectangle(corner: Pixel, size: Size) -> Rectangle {
    drawing::rectangle([corner.x, corner.y], [size.width, size.height])
}

fn line(from: Pixel, to: Pixel) -> Line {
    drawing::line([from.x, from.y], [to.x, to.y])
}
