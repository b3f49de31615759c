//! Paths in the notation of SVG.

use std::fmt::Write as _;

use crate::diagram::svg::canvas::{Pixel, number};

/// A cubic curve by its ends and its inner control points.
pub(super) fn bezier(from: Pixel, leaving: Pixel, arriving: Pixel, to: Pixel) -> String {
    let [a, b, c, d] = [from, leaving, arriving, to].map(pair);
    format!("M {a} C {b} {c} {d}")
}

/// A line through `corners`, which are rounded.
pub(super) fn bent(corners: &[Pixel], radius: f64) -> String {
    let mut path = corners.first().map_or_else(String::new, |first| format!("M {}", pair(*first)));
    for corner in corners.windows(3) {
        let [before, at, after] = [corner[0], corner[1], corner[2]];
        let (enter, leave) = (towards(at, before, radius), towards(at, after, radius));
        // Writing into a string cannot fail.
        let _ = write!(path, " L {} Q {} {}", pair(enter), pair(at), pair(leave));
    }
    if let Some(last) = corners.last() {
        let _ = write!(path, " L {}", pair(*last));
    }
    path
}

/// From `from`, the place `distance` nearer to `to`, or half way if that is less.
fn towards(from: Pixel, to: Pixel, distance: f64) -> Pixel {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let length = dx.hypot(dy);
    let share = if length > 0.0 { (distance / length).min(0.5) } else { 0.0 };
    Pixel { x: from.x + share * dx, y: from.y + share * dy }
}

fn pair(place: Pixel) -> String {
    format!("{} {}", number(place.x), number(place.y))
}
