//! Polygons from drawings and surveys, put together to one floor.

use super::counted;
use crate::automaton::network::scenario::WorkspaceOutline;
use crate::figures::quantity;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

/// Coordinates farther from 0 are none of a floor plan.
const FARTHEST: f64 = 1e100;

/// The corners of a polygon, not closed twice.
pub type Ring = Vec<[f64; 2]>;

/// A ring with all lengths multiplied.
pub(super) fn scaled(ring: Ring, scale: f64) -> Ring {
    ring.into_iter().map(|[x, y]| [scale * x, scale * y]).collect()
}

/// Twice the area, positive for counter-clockwise rings.
fn double_area(ring: &[[f64; 2]]) -> f64 {
    let sides = ring.iter().zip(ring.iter().cycle().skip(1));
    sides.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum()
}

/// A polygon whose first ring bounds it and whose other rings are holes, each in the direction
/// that says so.
pub(super) fn oriented(polygon: Vec<Ring>) -> Vec<Ring> {
    let turn = |(index, mut ring): (usize, Ring)| {
        if (double_area(&ring) > 0.0) != (index == 0) {
            ring.reverse();
        }
        ring
    };
    polygon.into_iter().enumerate().map(turn).collect()
}

/// The floor that rings bound, without the walls, and what was left out: all but the largest of
/// its pieces.
pub(super) fn floor(
    rings: &[Ring],
    walls: &[Ring],
    rule: FillRule,
) -> Result<(WorkspaceOutline, Vec<String>), String> {
    let mut coordinates = rings.iter().chain(walls).flatten().flatten();
    if let Some(wrong) = coordinates.find(|value| value.is_nan() || value.abs() > FARTHEST) {
        return Err(format!("a coordinate is {wrong:e}: they are numbers up to {FARTHEST:e}"));
    }
    let pieces = rings.to_vec().overlay_as::<i64>(&walls.to_vec(), OverlayRule::Difference, rule);
    let area = |piece: &Vec<Ring>| {
        let areas = piece.iter().map(|ring| double_area(ring).abs() / 2.0);
        areas.enumerate().map(|(index, area)| if index == 0 { area } else { -area }).sum::<f64>()
    };
    let mut pieces: Vec<(f64, Vec<Ring>)> =
        pieces.into_iter().map(|piece| (area(&piece), piece)).collect();
    pieces.sort_by(|one, other| other.0.total_cmp(&one.0));
    let mut pieces = pieces.into_iter();
    let (_, largest) =
        pieces.next().ok_or_else(|| "no floor: the map has no polygon with an area".to_owned())?;
    let left_out: Vec<f64> = pieces.map(|(area, _)| area).collect();
    let notes = match left_out.len() {
        0 => Vec::new(),
        count => vec![format!(
            "left out: {}, {} square units together",
            counted(count, "separate piece of floor", "separate pieces of floor"),
            quantity(left_out.iter().sum())
        )],
    };
    let mut rings = largest.into_iter();
    let boundary = rings.next().unwrap_or_default();
    Ok((WorkspaceOutline { boundary, holes: rings.collect() }, notes))
}
