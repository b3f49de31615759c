//! Convex collision-free cells: where a robot may go within one period (Sec. IV-B).
//!
//! The cell C_i of (18) is the intersection of
//!
//! - the half-planes H_i of (17): the sides of the robot's Voronoi cell (Definition 4.2) that it
//!   shares with others, moved inwards by ρ. They keep robots 2ρ apart for as long as each stays
//!   in its own: the half-planes of two neighbours are disjoint;
//! - a convex part P_i of the free space that contains the way ahead.

use super::{FreeSpace, HalfPlane, Segment};
use crate::Point;

/// As a fraction of the tolerance τ of the free space: how far the border of a half-plane may be
/// moved beyond the edge that it stems from. Below one half, where the sight set ends.
const EDGE_SLACK: f64 = 0.25;

/// As a fraction of τ: the distance below which a way touches an edge, and rounding spoils the
/// direction from one to the other.
const TOUCH: f64 = 1e-3;

/// Half-planes that keep `clearance` (ρ, a length) from the bisectors between `position` and each
/// of `neighbours` (17): a robot in its half-planes and its neighbours in theirs are 2ρ apart.
///
/// The sign of ρ_e in (17) depends on the direction of the normal; here normals point at the
/// neighbour and the half-plane shrinks. A robot may always stay: towards a neighbour that is
/// already closer than 2ρ the border runs through the robot. A neighbour at the very same place
/// has no bisector and is left out.
pub fn voronoi_half_planes(
    position: Point,
    neighbours: &[Point],
    clearance: f64,
) -> Vec<HalfPlane> {
    neighbours
        .iter()
        .filter_map(|&neighbour| {
            let middle = nalgebra::center(&position, &neighbour);
            let bisector = HalfPlane::through(middle, neighbour - position)?;
            let shrunk = HalfPlane { offset: bisector.offset - clearance, ..bisector };
            Some(shrunk.widened_to(position))
        })
        .collect()
}

/// Half-planes whose intersection with the disc of `radius` around `position` is a convex subset
/// of `space` that contains `position` and the part of the segment to `waypoint` (a₁ of
/// Definition 4.1) within the disc: the set P_i of (18).
///
/// Expects `position` in the free space and `waypoint` in its sight. Half-planes that do not cut
/// the disc are left out.
pub fn convex_region(
    space: &FreeSpace,
    position: Point,
    waypoint: Point,
    radius: f64,
) -> Vec<HalfPlane> {
    let way = way_within(position, waypoint, radius);
    let mut region = Vec::new();
    // Edges that rounding puts just outside the disc bound it too.
    space.for_each_edge_near(position, radius + space.tolerance(), |edge| {
        let separating = own_half_plane(edge, &way, EDGE_SLACK * space.tolerance())
            .or_else(|| half_plane_between(edge, &way, TOUCH * space.tolerance()));
        let cuts = |plane: &HalfPlane| plane.margin(position) < radius;
        region.extend(separating.filter(cuts));
    });
    region
}

/// The part of the segment from `position` to `waypoint` that is not farther than `radius`.
fn way_within(position: Point, waypoint: Point, radius: f64) -> Segment {
    let towards = waypoint - position;
    let distance = towards.norm();
    if distance <= radius {
        Segment::new(position, waypoint)
    } else {
        Segment::new(position, position + towards * (radius / distance))
    }
}

/// The half-plane on the free side of the edge's own line, if it contains the way or does so when
/// its border moves by no more than `slack`.
fn own_half_plane(edge: &Segment, way: &Segment, slack: f64) -> Option<HalfPlane> {
    let own = HalfPlane::through(edge.from, -edge.left_normal())?;
    let deepest = own.margin(way.from).min(own.margin(way.to));
    (deepest >= -slack).then(|| widened_to_way(own, way))
}

/// A half-plane that contains the way and has the edge on its border or outside: across the
/// shortest line between them, or along the way if they are closer than `touch`.
///
/// In that last case the edge ends where the way passes, or the way cuts off a corner of the
/// planning set by less than half the tolerance; the end of the edge that is farther from the line
/// of the way tells on which side the wall is.
fn half_plane_between(edge: &Segment, way: &Segment, touch: f64) -> Option<HalfPlane> {
    let (here, there) = way.closest(edge);
    let between = there - here;
    let plane = if between.norm() > touch && (here == way.from || here == way.to) {
        HalfPlane::through(there, between)?
    } else {
        let left = HalfPlane::through(way.from, way.left_normal())?;
        let depth = |plane: &HalfPlane, point: Point| -plane.margin(point);
        let (one, other) = (depth(&left, edge.from), depth(&left, edge.to));
        let farther = if one.abs() > other.abs() { one } else { other };
        let plane = HalfPlane::through(way.from, way.left_normal() * farther.signum())?;
        let nearer_end = depth(&plane, edge.from).min(depth(&plane, edge.to));
        HalfPlane { offset: plane.offset + nearer_end.max(0.0), ..plane }
    };
    Some(widened_to_way(plane, way))
}

fn widened_to_way(plane: HalfPlane, way: &Segment) -> HalfPlane {
    plane.widened_to(way.from).widened_to(way.to)
}
