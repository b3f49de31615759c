//! Passages of a floor that are too narrow for robots.

use crate::continuous::Point;
use crate::continuous::geometry::{Segment, Workspace};

/// A passage between two walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gap {
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
/// Walls that are nearer to each other than this share of the width asked for touch but for noise.
const TOUCHING: f64 = 1e-3;

/// The places where walls are less than `width` apart, the narrowest first; of several within one
/// width of each other only the narrowest.
///
/// Two corners or sides are the ends of a passage if the way from one to the other along the walls
/// is much longer than straight across the floor.
pub(super) fn narrower_than(workspace: &Workspace, width: f64) -> Vec<Gap> {
    let sides = Side::all(workspace);
    let mut gaps: Vec<Gap> =
        sides.iter().filter_map(|side| narrowest_at(side, &sides, workspace, width)).collect();
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

/// A side of a ring, from the corner where it starts.
struct Side {
    line: Segment,
    ring: usize,
    /// How far along the ring the corner is.
    along: f64,
    /// The length of the whole ring.
    around: f64,
}

impl Side {
    /// The sides of all rings, in the order of [`Workspace::edges`].
    fn all(workspace: &Workspace) -> Vec<Side> {
        let mut edges = workspace.edges();
        let mut sides = Vec::new();
        for (ring, corners) in workspace.polygons().iter().enumerate() {
            let lines: Vec<Segment> = edges.by_ref().take(corners.len()).collect();
            let around = lines.iter().map(Segment::length).sum();
            let mut along = 0.0;
            for line in lines {
                sides.push(Side { line, ring, along, around });
                along += line.length();
            }
        }
        sides
    }

    /// How long the shorter way along the walls is from its corner to a point of another side;
    /// infinite from one ring to another.
    fn way_to(&self, other: &Side, point: Point) -> f64 {
        if self.ring != other.ring {
            return f64::INFINITY;
        }
        let way = (other.along + (point - other.line.from).norm() - self.along).abs();
        way.min(self.around - way)
    }
}

/// The narrowest passage from the corner of a side to a side that faces it.
fn narrowest_at(side: &Side, sides: &[Side], workspace: &Workspace, width: f64) -> Option<Gap> {
    let corner = side.line.from;
    let mut narrowest: Option<Gap> = None;
    workspace.for_each_edge_near(corner, width, |index, edge| {
        let facing = edge.nearest(corner);
        let distance = (facing - corner).norm();
        let middle = nalgebra::center(&corner, &facing);
        let is_passage = distance > TOUCHING * width
            && distance < width
            && side.way_to(&sides[index], facing) > LENGTH_OF_WALLS * distance;
        if is_passage
            && narrowest.is_none_or(|gap| distance < gap.width)
            && workspace.contains(middle)
        {
            narrowest = Some(Gap { width: distance, at: middle.into() });
        }
    });
    narrowest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn floor<const N: usize>(boundary: [[f64; 2]; N], holes: &[&[[f64; 2]]]) -> Workspace {
        let ring = |corners: &[[f64; 2]]| corners.iter().map(|&corner| corner.into()).collect();
        let holes = holes.iter().map(|hole| ring(hole)).collect();
        Workspace::new(ring(&boundary), holes).expect("the rings are simple")
    }

    const ROOM: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]];

    #[test]
    fn corners_of_a_room_are_no_passages() {
        assert_eq!(narrower_than(&floor(ROOM, &[]), 0.5), []);
    }

    #[test]
    fn a_door_and_a_slit_are_found() {
        let door = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 2.0],
            [2.1, 2.0],
            [2.1, 1.1],
            [2.0, 1.1],
            [2.0, 2.0],
            [0.0, 2.0],
        ];
        let pillar = [[0.3, 0.1], [0.6, 0.1], [0.6, 0.5], [0.3, 0.5]];
        let plan = floor(door, &[&pillar]);
        let gaps = narrower_than(&plan, 1.2);
        let widths: Vec<f64> = gaps.iter().map(|gap| (gap.width * 1e3).round() / 1e3).collect();
        assert!(widths.contains(&0.1), "the slit below the pillar: {gaps:?}");
        assert!(widths.iter().any(|width| (*width - 1.1).abs() < 0.4), "the door: {gaps:?}");
        assert_eq!(narrower_than(&plan, 0.05), []);
    }

    #[test]
    fn a_width_of_nearly_nothing_takes_no_longer() {
        assert_eq!(narrower_than(&floor(ROOM, &[]), 1e-300), []);
    }
}
