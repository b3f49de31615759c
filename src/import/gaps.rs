//! Passages of a floor that are too narrow for robots.

use super::outline::Ring;
use crate::automaton::network::scenario::WorkspaceOutline;
use crate::continuous::Point;
use crate::continuous::geometry::Segment;
use std::collections::BTreeMap;

/// A passage between two walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// How far the walls are apart.
    pub width: f64,
    /// The middle of the passage.
    pub at: [f64; 2],
}

/// How many times longer than the passage is wide the walls at either side of it must be: the
/// inner corner of a room is no passage.
const LENGTH_OF_WALLS: f64 = 3.0;
/// By how much a passage may fall short of the width asked for, as a share of it: rounding.
const ROUNDING: f64 = 1e-6;

/// The places where walls are less than `width` apart, the narrowest first; of several within one
/// width of each other only the narrowest.
///
/// Two corners or sides are the ends of a passage if the way from one to the other along the walls
/// is much longer than straight across the floor.
pub fn narrower_than(workspace: &WorkspaceOutline, width: f64) -> Vec<Gap> {
    let sides = Sides::of(workspace, width);
    let mut gaps: Vec<Gap> =
        (0..sides.corners.len()).filter_map(|c| sides.gap_at(c, width)).collect();
    gaps.retain(|gap| gap.width < width * (1.0 - ROUNDING));
    gaps.sort_by(|one, other| {
        one.width.total_cmp(&other.width).then(one.at[0].total_cmp(&other.at[0]))
    });
    let mut kept: Vec<Gap> = Vec::new();
    for gap in gaps {
        let near = |other: &Gap| (Point::from(other.at) - Point::from(gap.at)).norm() < width;
        if !kept.iter().any(near) {
            kept.push(gap);
        }
    }
    kept
}

/// A corner or the start of a side: where it is, on which ring, and how far along it.
struct Corner {
    at: Point,
    next: Point,
    ring: usize,
    along: f64,
}

/// The sides of all rings, in square cells of one width.
struct Sides {
    corners: Vec<Corner>,
    lengths: Vec<f64>,
    cells: BTreeMap<(i64, i64), Vec<usize>>,
    width: f64,
    workspace: Vec<Ring>,
}

impl Sides {
    fn of(workspace: &WorkspaceOutline, width: f64) -> Self {
        let rings: Vec<Ring> =
            std::iter::once(&workspace.boundary).chain(&workspace.holes).cloned().collect();
        let (mut corners, mut lengths) = (Vec::new(), Vec::new());
        for (ring, points) in rings.iter().enumerate() {
            let mut along = 0.0;
            for (from, to) in points.iter().zip(points.iter().cycle().skip(1)) {
                let (at, next) = (Point::from(*from), Point::from(*to));
                corners.push(Corner { at, next, ring, along });
                along += (next - at).norm();
            }
            lengths.push(along);
        }
        let mut sides = Self { corners, lengths, cells: BTreeMap::new(), width, workspace: rings };
        for index in 0..sides.corners.len() {
            let Corner { at, next, .. } = sides.corners[index];
            let steps = ((next - at).norm() / width).ceil().max(1.0) as usize;
            for step in 0..=steps {
                let place = at + (next - at) * (step as f64 / steps as f64);
                let sides_here = sides.cells.entry(sides.cell(place)).or_default();
                if sides_here.last() != Some(&index) {
                    sides_here.push(index);
                }
            }
        }
        sides
    }

    fn cell(&self, place: Point) -> (i64, i64) {
        ((place.x / self.width).floor() as i64, (place.y / self.width).floor() as i64)
    }

    /// The narrowest passage from a corner to the side that faces it.
    fn gap_at(&self, corner: usize, width: f64) -> Option<Gap> {
        let Corner { at, ring, along, .. } = self.corners[corner];
        let (column, row) = self.cell(at);
        let near = (column - 2..=column + 2).flat_map(|x| (row - 2..=row + 2).map(move |y| (x, y)));
        let mut narrowest: Option<Gap> = None;
        for &side in near.filter_map(|cell| self.cells.get(&cell)).flatten() {
            let other = &self.corners[side];
            let facing = Segment::new(other.at, other.next).nearest(at);
            let distance = (facing - at).norm();
            let middle = Point::from((at.coords + facing.coords) / 2.0);
            let is_passage = distance > 0.0
                && distance < width
                && (other.ring != ring || {
                    let way = (other.along + (facing - other.at).norm() - along).abs();
                    way.min(self.lengths[ring] - way) > LENGTH_OF_WALLS * distance
                });
            if is_passage
                && narrowest.is_none_or(|gap| distance < gap.width)
                && self.is_floor(middle)
            {
                narrowest = Some(Gap { width: distance, at: middle.into() });
            }
        }
        narrowest
    }

    fn is_floor(&self, place: Point) -> bool {
        let sides =
            self.workspace.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        let crossed = sides.filter(|(a, b)| {
            (a[1] > place.y) != (b[1] > place.y)
                && place.x < a[0] + (place.y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        crossed.count() % 2 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room(holes: Vec<Ring>) -> WorkspaceOutline {
        WorkspaceOutline { boundary: vec![[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]], holes }
    }

    #[test]
    fn corners_of_a_room_are_no_passages() {
        assert_eq!(narrower_than(&room(vec![]), 0.5), []);
    }

    #[test]
    fn a_door_and_a_slit_are_found() {
        let door = vec![
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 2.0],
            [2.1, 2.0],
            [2.1, 1.1],
            [2.0, 1.1],
            [2.0, 2.0],
            [0.0, 2.0],
        ];
        let pillar = vec![[0.3, 0.1], [0.6, 0.1], [0.6, 0.5], [0.3, 0.5]];
        let plan = WorkspaceOutline { boundary: door, holes: vec![pillar] };
        let gaps = narrower_than(&plan, 1.2);
        let widths: Vec<f64> = gaps.iter().map(|gap| (gap.width * 1e3).round() / 1e3).collect();
        assert!(widths.contains(&0.1), "the slit below the pillar: {gaps:?}");
        assert!(widths.iter().any(|width| (*width - 1.1).abs() < 0.4), "the door: {gaps:?}");
        assert_eq!(narrower_than(&plan, 0.05), []);
    }
}
