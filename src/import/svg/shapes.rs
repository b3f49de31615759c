//! Shapes and their outlines.

use super::elements::Element;
use crate::import::finite;
use kurbo::{Affine, BezPath, Circle, Ellipse, Line, Rect, RoundedRect, Shape};

/// Circles become curves; those are as exact as can be before chords replace them.
const EXACT: f64 = 1e-6;

/// The outline of a shape, or a line; none for other elements.
pub(super) fn outline(element: &Element) -> Result<Option<BezPath>, String> {
    let path = match element.name.as_str() {
        "path" => {
            let data = element.attribute("d").unwrap_or_default();
            BezPath::from_svg(data).map_err(|error| format!("path: {error}"))?
        }
        "rect" => rectangle(element)?,
        "circle" => {
            let radius = element.length("r")?;
            Circle::new(element.point(["cx", "cy"])?, radius).to_path(EXACT * radius)
        }
        "ellipse" => {
            let [rx, ry] = [element.length("rx")?, element.length("ry")?];
            let center = element.point(["cx", "cy"])?;
            Ellipse::new(center, (rx, ry), 0.0).to_path(EXACT * rx.max(ry))
        }
        "polygon" => polyline(element, true)?,
        "polyline" => polyline(element, false)?,
        "line" => {
            let [from, to] = [element.point(["x1", "y1"])?, element.point(["x2", "y2"])?];
            Line::new(from, to).to_path(EXACT)
        }
        _ => return Ok(None),
    };
    Ok(Some(path))
}

/// A rectangle, whose corners may be rounded by quarters of ellipses.
fn rectangle(element: &Element) -> Result<BezPath, String> {
    let [width, height] = [element.length("width")?, element.length("height")?];
    let rect = Rect::from_origin_size(element.point(["x", "y"])?, (width, height));
    // A radius that is not stated is as the other one.
    let [rx, ry] = [element.stated_length("rx")?, element.stated_length("ry")?];
    let [rx, ry] = [rx.or(ry), ry.or(rx)].map(Option::unwrap_or_default);
    let [rx, ry] = [rx.min(width / 2.0), ry.min(height / 2.0)];
    if rx == 0.0 || ry == 0.0 {
        return Ok(rect.to_path(EXACT));
    }
    // In lengths of the radii the corners are quarters of the unit circle.
    let in_radii = Rect::new(rect.x0 / rx, rect.y0 / ry, rect.x1 / rx, rect.y1 / ry);
    let rounded = RoundedRect::from_rect(in_radii, 1.0).to_path(EXACT);
    Ok(Affine::scale_non_uniform(rx, ry) * rounded)
}

fn polyline(element: &Element, is_closed: bool) -> Result<BezPath, String> {
    let text = element.attribute("points").unwrap_or_default();
    let words = text.split([' ', ',', '\t', '\n', '\r']).filter(|word| !word.is_empty());
    let number = |word: &str| {
        finite(word).ok_or_else(|| format!("points of {}: {word:?} is no number", element.name))
    };
    let numbers = words.map(number).collect::<Result<Vec<f64>, _>>()?;
    let mut path = BezPath::new();
    for (index, corner) in numbers.chunks_exact(2).enumerate() {
        let corner = (corner[0], corner[1]);
        if index == 0 { path.move_to(corner) } else { path.line_to(corner) }
    }
    if is_closed {
        path.close_path();
    }
    Ok(path)
}
