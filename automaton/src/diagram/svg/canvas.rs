//! What `layout-rs` draws on. Its own canvas sets text in a serif font along the curves of the
//! edges and misjudges the height of the page, so this is another one: plain, with a style sheet.

use std::fmt::Write;

use layout::core::format::{ClipHandle, RenderBackend};
use layout::core::geometry::Point;
use layout::core::style::StyleAttr;

use super::LINE_HEIGHT;

/// White around the drawing, in pixels.
const MARGIN: f64 = 12.0;

const STYLE: &str = "\
text { font-family: 'DejaVu Sans', 'Segoe UI', Helvetica, Arial, sans-serif; \
text-anchor: middle; fill: #1b1f24; }
.name { font-weight: bold; }
.location { fill: #eef3fa; stroke: #34527a; stroke-width: 1.5; }
.transition { fill: #ffffff; stroke: #c5ccd6; stroke-width: 0.8; }
.initial { fill: #1b1f24; }
path { fill: none; stroke: #1b1f24; stroke-width: 1.2; }
.may { stroke-dasharray: 5 4; }
.at-once { stroke-width: 2.2; }
.head { fill: #1b1f24; stroke: none; }
";

/// The triangle at the end of an arrow; its tip lies where the line ends.
const MARKER: &str = "<defs><marker id=\"head\" viewBox=\"0 0 10 8\" refX=\"10\" refY=\"4\" \
markerWidth=\"10\" markerHeight=\"8\" markerUnits=\"userSpaceOnUse\" \
orient=\"auto-start-reverse\"><path class=\"head\" d=\"M 0 0 L 10 4 L 0 8 z\"/></marker></defs>\n";

/// An SVG document while it is being drawn. The properties of shapes are their classes.
pub(super) struct Canvas {
    content: String,
    low: Point,
    high: Point,
}

impl Canvas {
    pub fn new() -> Self {
        let (low, high) = (Point::splat(f64::INFINITY), Point::splat(f64::NEG_INFINITY));
        Canvas { content: String::new(), low, high }
    }

    pub fn finish(self) -> String {
        let (x, y) = (self.low.x - MARGIN, self.low.y - MARGIN);
        let (width, height) = (self.high.x + MARGIN - x, self.high.y + MARGIN - y);
        let content = self.content;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"{x:.1} {y:.1} {width:.1} {height:.1}\">\n<style>\n{STYLE}</style>\n{MARKER}\
             <rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             fill=\"#ffffff\"/>\n{content}</svg>\n"
        )
    }

    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing into a string cannot fail.
        let _ = self.content.write_fmt(line);
        self.content.push('\n');
    }

    fn include(&mut self, point: Point) {
        self.low = Point::new(self.low.x.min(point.x), self.low.y.min(point.y));
        self.high = Point::new(self.high.x.max(point.x), self.high.y.max(point.y));
    }
}

impl RenderBackend for Canvas {
    fn draw_rect(
        &mut self,
        corner: Point,
        size: Point,
        _look: &StyleAttr,
        class: Option<String>,
        _clip: Option<ClipHandle>,
    ) {
        self.include(corner);
        self.include(corner.add(size));
        let (class, Point { x, y }) = (class.unwrap_or_default(), corner);
        let (width, height) = (size.x, size.y);
        self.line(format_args!(
            "<rect class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" \
             height=\"{height:.1}\" rx=\"8\"/>"
        ));
    }

    fn draw_line(&mut self, from: Point, to: Point, look: &StyleAttr, class: Option<String>) {
        self.draw_arrow(&[(from, from), (to, to)], false, (false, false), look, class, "");
    }

    fn draw_circle(
        &mut self,
        centre: Point,
        size: Point,
        _look: &StyleAttr,
        class: Option<String>,
    ) {
        let radius = size.scale(0.5);
        self.include(centre.sub(radius));
        self.include(centre.add(radius));
        let class = class.unwrap_or_default();
        self.line(format_args!(
            "<ellipse class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" rx=\"{:.1}\" ry=\"{:.1}\"/>",
            centre.x, centre.y, radius.x, radius.y
        ));
    }

    /// Lines of text around `centre`, the first of them bold.
    fn draw_text(&mut self, centre: Point, text: &str, look: &StyleAttr) {
        let font = look.font_size as f64;
        let spacing = font * LINE_HEIGHT;
        /// From the middle of a line down to its base line, as a share of the size of the font.
        const DESCENT: f64 = 0.35;
        let above = (text.lines().count() as f64 - 1.0) / 2.0;
        let first = centre.y - above * spacing + DESCENT * font;
        for (number, line) in text.lines().enumerate() {
            let (x, y) = (centre.x, first + number as f64 * spacing);
            let class = if number == 0 { " class=\"name\"" } else { "" };
            let line = escaped(line);
            self.line(format_args!(
                "<text{class} x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{font}\">{line}</text>"
            ));
        }
    }

    /// A smooth curve: the first pair holds its start and a control point, each further pair a
    /// control point and where the curve passes.
    fn draw_arrow(
        &mut self,
        path: &[(Point, Point)],
        _dashed: bool,
        (at_start, at_end): (bool, bool),
        _look: &StyleAttr,
        class: Option<String>,
        _text: &str,
    ) {
        let [(start, control), rest @ ..] = path else { return };
        let mut curve = format!("M {:.1} {:.1}", start.x, start.y);
        self.include(*start);
        for (number, (before, end)) in rest.iter().enumerate() {
            let command = match number {
                0 => format!(" C {:.1} {:.1},", control.x, control.y),
                _ => " S".to_owned(),
            };
            self.include(*end);
            let _ = write!(
                curve,
                "{command} {:.1} {:.1}, {:.1} {:.1}",
                before.x, before.y, end.x, end.y
            );
        }
        let class = class.unwrap_or_default();
        let head = if at_start { " marker-start=\"url(#head)\"" } else { "" };
        let tail = if at_end { " marker-end=\"url(#head)\"" } else { "" };
        self.line(format_args!("<path class=\"{class}\" d=\"{curve}\"{head}{tail}/>"));
    }

    /// Nothing here is clipped.
    fn create_clip(&mut self, _corner: Point, _size: Point, _rounded: usize) -> ClipHandle {
        0
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
