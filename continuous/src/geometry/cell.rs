//! Convex collision-free cells: where a robot may go within one period (Sec. IV-B).
//!
//! The cell C_i of (18) is the intersection of
//!
//! - the half-planes H_i of (17): the sides of the robot's Voronoi cell (Definition 4.2) that it
//!   shares with others, moved inwards by ρ. They keep robots 2ρ apart for as long as each stays
//!   in its own: the half-planes of two neighbours are disjoint;
//! - a convex part P_i of the free space that contains the way ahead.
//!
//! ```
//! use pleach_continuous::Point;
//! use pleach_continuous::geometry::{FreeSpace, Workspace, convex_region, voronoi_half_planes};
//!
//! let room = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)].map(|(x, y)| Point::new(x, y));
//! let clearance = 0.1;
//! let free_space = FreeSpace::new(&Workspace::new(room.to_vec(), vec![])?, clearance)?;
//!
//! // A robot near the lower wall, on its way to the right, where another one stands 0.6 away.
//! let (robot, other, goal) = (Point::new(1.0, 0.2), Point::new(1.6, 0.2), Point::new(3.0, 0.2));
//! let mut cell = voronoi_half_planes(robot, &[other], clearance);
//! cell.extend(convex_region(&free_space, robot, goal, 0.5));
//! assert_eq!(cell.len(), 2); // the other robot, and the lower wall
//!
//! let admits = |x, y| cell.iter().all(|half_plane| half_plane.contains(Point::new(x, y)));
//! assert!(admits(1.19, 0.2) && !admits(1.21, 0.2)); // half the way, less the clearance
//! assert!(admits(1.1, 0.11) && !admits(1.1, 0.09));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::f64::consts::SQRT_2;

use super::segment::side;
use super::workspace::edges_of;
use super::{FreeSpace, HalfPlane, Segment};
use crate::{Point, Vector};

#[cfg(any(kani, test))]
mod proofs;

/// As a fraction of the tolerance τ of the free space: the distance below which a way touches a
/// wall, and rounding spoils the direction from one to the other. Far below the τ/2 that the sight
/// set keeps beyond the clearance.
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
            Some(own_side(bisector, position, clearance))
        })
        .collect()
}

/// The side of a bisector on which a robot stays: `clearance` from it, or where the robot is.
pub(super) fn own_side(bisector: HalfPlane, position: Point, clearance: f64) -> HalfPlane {
    HalfPlane { offset: bisector.offset - clearance, ..bisector }.widened_to(position)
}

/// Half-planes whose intersection with the disc of `radius` around `position` is a convex subset
/// of `space` that contains `position` and the part of the segment to `waypoint` (a₁ of
/// Definition 4.1) within the disc: the set P_i of (18).
///
/// Each wall, an edge of the sight set within the disc, contributes a half-plane that contains the
/// way ahead and not the wall: the one on the wall's own line if possible. A point of the free
/// space's complement would have a wall between itself and `position`, and is cut off by its
/// half-plane. Then the half-planes retreat by the τ/2 from the sight set to the planning set, as
/// far as the way allows, so that robots stay away from where sight ends.
///
/// Should `position` not see so far towards `waypoint`, the region is grown around `position` alone.
/// Half-planes that do not cut the disc are left out.
///
/// For a `position` outside the free space, within the reach of re-entry, the region is the convex
/// hull of `position` and of the region of its [entry](FreeSpace::entry): it admits the way in, and
/// the straight way to what the entry sees of the way ahead, and [nothing farther
/// out](super::reentry). A robot beyond that reach gets half-planes that it may stay in.
pub fn convex_region(
    space: &FreeSpace,
    position: Point,
    waypoint: Point,
    radius: f64,
) -> Vec<HalfPlane> {
    match space.entry(position) {
        Some(entry) if entry != position => {
            let half_side = radius + (position - entry).norm();
            let way = way_ahead(space, entry, waypoint, half_side);
            let region = free_region(space, &way, half_side * SQRT_2);
            hull(position, &way, half_side, &region)
        }
        _ => free_region(space, &way_ahead(space, position, waypoint, radius), radius),
    }
}

/// The segment from `position` towards `waypoint` within `radius`, or `position` alone if it is out
/// of sight.
fn way_ahead(space: &FreeSpace, position: Point, waypoint: Point, radius: f64) -> Segment {
    let ahead = way_within(position, waypoint, radius);
    if space.is_clear(&ahead) { ahead } else { Segment::still(position) }
}

/// The half-planes of the walls within `radius` of the beginning of a clear way.
fn free_region(space: &FreeSpace, way: &Segment, radius: f64) -> Vec<HalfPlane> {
    let position = way.from;
    let tolerance = space.tolerance();
    let touch = TOUCH * tolerance;
    // Edges that rounding puts just outside the disc bound it too.
    let walls = space.walls_near(position, radius + tolerance);
    let separating = walls.filter_map(|wall| {
        own_half_plane(wall, way, touch).or_else(|| half_plane_between(wall, way, touch))
    });
    // Back to the planning set, unless the way itself leaves it.
    let retracted = separating.map(|plane| {
        let offset = plane.offset - tolerance / 2.0;
        HalfPlane { offset, ..plane }.widened_to(way.from).widened_to(way.to)
    });
    retracted.filter(|plane| plane.margin(position) < radius).collect()
}

/// The convex hull of `outside` and of the part of a region in the square around the beginning of
/// the way: the half-planes of the region that contain `outside`, and the two tangents from there.
fn hull(outside: Point, way: &Segment, half_side: f64, region: &[HalfPlane]) -> Vec<HalfPlane> {
    let (kept, broken): (Vec<_>, Vec<_>) =
        region.iter().copied().partition(|plane| plane.contains(outside));
    if broken.is_empty() {
        return kept;
    }
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| way.from + Vector::new(x, y) * half_side);
    let corners = region.iter().fold(square.to_vec(), |ring, plane| clipped(&ring, plane));
    // The way belongs to the region, whatever rounding does to the corners.
    let seen = || corners.iter().chain([&way.from, &way.to]).copied();
    let tangent = |is_outer: fn(f64) -> bool| {
        let outermost = seen()
            .reduce(|best, next| if is_outer(side(outside, best, next)) { next } else { best });
        Segment::new(outside, outermost.unwrap_or(way.from)).left_normal()
    };
    let (left, right) = (tangent(|side| side > 0.0), tangent(|side| side < 0.0));
    let tangents = [left, -right].map(|outward| HalfPlane::through(outside, outward));
    kept.into_iter().chain(tangents.into_iter().flatten()).collect()
}

/// The part of a convex polygon in a half-plane (I. E. Sutherland and G. W. Hodgman,
/// <https://doi.org/10.1145/360767.360802>).
fn clipped(ring: &[Point], plane: &HalfPlane) -> Vec<Point> {
    let mut part = Vec::with_capacity(ring.len() + 1);
    for edge in edges_of(ring) {
        let (from, to) = (plane.margin(edge.from), plane.margin(edge.to));
        if from >= 0.0 {
            part.push(edge.from);
        }
        if (from >= 0.0) != (to >= 0.0) {
            part.push(edge.at(from / (from - to)));
        }
    }
    part
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

/// The half-plane on the free side of the wall's own line, if it contains the way up to `touch`.
fn own_half_plane(wall: &Segment, way: &Segment, touch: f64) -> Option<HalfPlane> {
    let own = HalfPlane::through(wall.from, -wall.left_normal())?;
    (own.margin(way.from).min(own.margin(way.to)) >= -touch).then_some(own)
}

/// A half-plane that contains the way and has the wall on its border or outside: across the
/// shortest line between them, or along the way where the wall ends closer to it than `touch`.
fn half_plane_between(wall: &Segment, way: &Segment, touch: f64) -> Option<HalfPlane> {
    let (here, there) = way.closest(wall);
    if (there - here).norm() > touch {
        return HalfPlane::through(there, there - here);
    }
    // The end of the wall that is farther from the line of the way tells on which side it is.
    let right = HalfPlane::through(way.from, way.left_normal())?;
    let (from, to) = (right.margin(wall.from), right.margin(wall.to));
    let farther = if from.abs() > to.abs() { from } else { to };
    HalfPlane::through(way.from, way.left_normal() * -farther.signum())
}
