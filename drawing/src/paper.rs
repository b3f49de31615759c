//! Sheets, strokes and texts.

use svg::Document;
use svg::node::element::{Circle, Group, Line, Polyline, Rectangle, Text};

use crate::style::PAPER;

/// A place on the sheet or a size, across and downwards, in pixels.
pub type Spot = [f64; 2];

/// Writes a coordinate: two decimals at most, and as few as it needs. There is no negative zero.
#[must_use]
pub fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

/// Writes the corners of a polygon or a polyline.
pub fn corners(spots: impl IntoIterator<Item = Spot>) -> String {
    let pairs: Vec<String> =
        spots.into_iter().map(|[x, y]| format!("{},{}", number(x), number(y))).collect();
    pairs.join(" ")
}

/// A white sheet from its upper left `corner`. The class of the white is `paper`.
pub fn sheet([left, top]: Spot, [width, height]: Spot) -> Document {
    let view = [left, top, width, height].map(number);
    Document::new()
        .set("viewBox", view.join(" "))
        .set("width", number(width))
        .set("height", number(height))
        .add(rectangle([left, top], [width, height]).set("class", "paper").set("fill", PAPER))
}

/// A part of a picture; its class names it for style sheets and for readers of the file.
#[must_use]
pub fn layer(class: &str) -> Group {
    Group::new().set("class", class)
}

/// A text whose base line begins at a place.
pub fn text(content: impl Into<String>, [x, y]: Spot) -> Text {
    Text::new(content).set("x", number(x)).set("y", number(y))
}

/// A straight line.
#[must_use]
pub fn line(from: Spot, to: Spot) -> Line {
    let line = Line::new().set("x1", number(from[0])).set("y1", number(from[1]));
    line.set("x2", number(to[0])).set("y2", number(to[1]))
}

/// Straight lines from spot to spot, without a filling.
pub fn polyline(spots: impl IntoIterator<Item = Spot>) -> Polyline {
    Polyline::new().set("points", corners(spots)).set("fill", "none")
}

/// A rectangle from its upper left corner; a size below zero counts as zero.
#[must_use]
pub fn rectangle([x, y]: Spot, [width, height]: Spot) -> Rectangle {
    let rectangle = Rectangle::new().set("x", number(x)).set("y", number(y));
    rectangle.set("width", number(width.max(0.0))).set("height", number(height.max(0.0)))
}

/// A circle.
#[must_use]
pub fn disc([x, y]: Spot, radius: f64) -> Circle {
    Circle::new().set("cx", number(x)).set("cy", number(y)).set("r", number(radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short_and_zero_has_no_sign() {
        let texts = [12.0, 0.125, -3.10, -0.001, 1200.0].map(number);
        assert_eq!(texts, ["12", "0.12", "-3.1", "0", "1200"]);
    }
}
