//! Floor plans drawn as SVG: closed paths, rectangles, polygons and circles, and lines that are walls.

mod drawing;
mod elements;
mod shapes;

use super::outline::{Ring, Sketch, scaled};
use super::stroke::Stroke;
use super::{MapPlaces, Plan, Reading, counted};
use crate::figures::quantity;
use drawing::Drawn;
use i_overlay::core::fill_rule::FillRule;
use kurbo::{BezPath, PathEl, Shape};

/// Chords of curves deviate by this share of the extent where no tolerance is asked for.
const RELATIVE_TOLERANCE: f64 = 1e-3;
/// The least share of the extent that can be asked for: coordinates are rounded to as much.
const LEAST_TOLERANCE: f64 = 1e-6;

/// Reads all shapes. Closed ones are filled by the even-odd rule: what lies within an odd number of outlines is floor.
/// Lines that are not closed are walls as wide as they are drawn, or as asked for. The vertical axis is turned, so that
/// it points up.
pub(super) fn read(text: &str, reading: &Reading) -> Result<Plan, String> {
    let (shapes, more) = drawing::shapes(text)?;
    let bounds = shapes.iter().map(|shape| shape.outline.bounding_box());
    let bounds = bounds.reduce(|one, other| one.union(other)).unwrap_or_default();
    let extent = bounds.width().max(bounds.height());
    if extent == 0.0 {
        return Err("no floor: the drawing has no closed shape with an area, and no walls".into());
    }
    let tolerance =
        reading.tolerance.map_or(RELATIVE_TOLERANCE * extent, |length| length / reading.scale);
    if tolerance.is_nan() || tolerance < LEAST_TOLERANCE * extent {
        let [given, least] = [tolerance, LEAST_TOLERANCE * extent].map(|t| t * reading.scale);
        return Err(format!("the tolerance of curves is {given}: at least {}", quantity(least)));
    }
    let place = |ring: Ring| {
        let upright = ring.into_iter().map(|[x, y]| [x - bounds.x0, bounds.y1 - y]).collect();
        scaled(upright, reading.scale)
    };
    let mut sketch = Sketch { rule: FillRule::EvenOdd, ..Sketch::default() };
    let (mut left_out, mut has_curves) = (0, false);
    for Drawn { outline, stroke } in &shapes {
        has_curves |=
            outline.iter().any(|it| matches!(it, PathEl::QuadTo(..) | PathEl::CurveTo(..)));
        for Line { corners, is_closed } in lines(outline, tolerance) {
            let width = reading.wall_width.or(stroke.map(|width| width * reading.scale));
            match (is_closed && corners.len() > 2, width) {
                (true, _) => sketch.floors.push(place(corners)),
                (false, Some(width)) if width > 0.0 => {
                    sketch.lines.push(Stroke::along(place(corners), width))
                }
                (false, _) => left_out += 1,
            }
        }
    }
    let (workspace, account) = sketch.floor()?;
    let account = account.accepted(reading.accepted_loss)?;
    let mut notes = vec![account.to_string()];
    if has_curves {
        notes.push(format!(
            "chords of curves are at most {} away from them: choose a clearance larger by that",
            quantity(tolerance * reading.scale)
        ));
    }
    if !sketch.lines.is_empty() {
        let lines = counted(
            sketch.lines.len(),
            "line that is not closed is a wall",
            "lines that are not closed are walls",
        );
        let width = match reading.wall_width {
            Some(width) => format!("{} wide", quantity(width)),
            None => "as wide as drawn (--wall-width)".into(),
        };
        notes.push(format!("{lines}, {width}"));
    }
    if left_out > 0 {
        let lines = counted(left_out, "line that is", "lines that are");
        notes.push(format!(
            "left out: {lines} not closed and not drawn: --wall-width takes them as walls"
        ));
    }
    notes.extend(more);
    let (places, lines) = (MapPlaces::default(), sketch.drawn());
    Ok(Plan { workspace, places, account, picture: None, lines, notes })
}

/// A line of a path, curves as chords.
struct Line {
    corners: Ring,
    /// Whether it ends where it starts.
    is_closed: bool,
}

/// The lines of a path: each ends where it starts, or is open.
fn lines(path: &BezPath, tolerance: f64) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    kurbo::flatten(path.iter(), tolerance, |element| match (element, lines.last_mut()) {
        (PathEl::MoveTo(start), _) => {
            lines.push(Line { corners: vec![[start.x, start.y]], is_closed: false });
        }
        (PathEl::LineTo(corner), Some(line)) => line.corners.push([corner.x, corner.y]),
        (PathEl::ClosePath, Some(line)) => line.is_closed = true,
        _ => {}
    });
    for Line { corners, is_closed } in &mut lines {
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
            *is_closed = true;
        }
    }
    lines.retain(|line| line.corners.len() > 1);
    lines
}
