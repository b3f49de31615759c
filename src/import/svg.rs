//! Floor plans drawn as SVG: closed paths, rectangles, polygons and circles.

mod drawing;
mod elements;
mod shapes;

use super::outline::{Ring, floor, scaled};
use super::{MapPlaces, Plan, Reading, counted};
use crate::figures::quantity;
use i_overlay::core::fill_rule::FillRule;
use kurbo::{BezPath, PathEl, Shape};

/// Chords of curves deviate by this share of the extent where no tolerance is asked for.
const RELATIVE_TOLERANCE: f64 = 1e-3;
/// The least share of the extent that can be asked for: coordinates are rounded to as much.
const LEAST_TOLERANCE: f64 = 1e-6;

const NO_FLOOR: &str = "no floor: the drawing has no closed shape with an area";

/// Reads all shapes, filled by the even-odd rule: what lies within an odd number of outlines is
/// floor. The vertical axis is turned, so that it points up.
pub(super) fn read(text: &str, reading: &Reading) -> Result<Plan, String> {
    let (paths, more) = drawing::shapes(text)?;
    let bounds = paths.iter().map(Shape::bounding_box).reduce(|one, other| one.union(other));
    let bounds = bounds.ok_or(NO_FLOOR)?;
    let extent = bounds.width().max(bounds.height());
    if extent == 0.0 {
        return Err(NO_FLOOR.into());
    }
    let tolerance =
        reading.tolerance.map_or(RELATIVE_TOLERANCE * extent, |length| length / reading.scale);
    if tolerance.is_nan() || tolerance < LEAST_TOLERANCE * extent {
        let [given, least] = [tolerance, LEAST_TOLERANCE * extent].map(|t| t * reading.scale);
        return Err(format!("the tolerance of curves is {given}: at least {}", quantity(least)));
    }
    let has_curves = paths
        .iter()
        .flat_map(BezPath::iter)
        .any(|element| matches!(element, PathEl::QuadTo(..) | PathEl::CurveTo(..)));
    let upright =
        |ring: Ring| ring.into_iter().map(|[x, y]| [x - bounds.x0, bounds.y1 - y]).collect();
    let (closed, open): (Vec<Line>, Vec<Line>) =
        paths.iter().flat_map(|path| lines(path, tolerance)).partition(|line| line.is_closed);
    let rings = closed.into_iter().map(|line| scaled(upright(line.corners), reading.scale));
    let rings: Vec<Ring> = rings.filter(|ring: &Ring| ring.len() > 2).collect();
    let (workspace, left_out) = floor(&rings, &[], FillRule::EvenOdd)?;
    let mut notes = Vec::new();
    if has_curves {
        notes.push(format!(
            "chords of curves are at most {} away from them: choose a clearance larger by that",
            quantity(tolerance * reading.scale)
        ));
    }
    if !open.is_empty() {
        let lines = counted(open.len(), "line that is", "lines that are");
        notes.push(format!("left out: {lines} not closed, and bound no floor"));
    }
    notes.extend(more);
    notes.extend(left_out);
    Ok(Plan { workspace, places: MapPlaces::default(), notes })
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
