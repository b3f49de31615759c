//! Half-planes for robots whose places and moves have errors.
//!
//! Let a robot know its place up to a distance e, the *position error*: the place p that it believes
//! in and the true one x differ by at most e. Let its moves have a *motion error* m: when the share s
//! of a move by v has been done, the robot has been displaced by s v and at most s m more. Then a
//! move that ends at p + v ends truly within e + m of it, and until then the robot is within e + m of
//! the segment that it has announced. After the next measurement it believes to be within
//! [2e + m](Errors::stray) of where the move was to end.
//!
//! # Walls
//!
//! Free space for the [clearance](Errors::planning_clearance) ρ + e + m keeps ρ from walls: a robot
//! goes straight from a point of a convex free region to another one.
//!
//! A robot that has strayed out of that free space has only what it knows of each wall. Let the
//! nearest point of a wall, which is straight, be at the distance D from p, in the direction n. If
//! the true distance is at least ρ, it stays so with
//!
//! ```text
//! n · v ≤ D − (ρ + e + m)         if D ≥ ρ + e,
//! N · v ≤ −m  for all N within θ of n, sin θ = e/D,  otherwise
//! ```
//!
//! or v = 0. *Proof.* Along n, the wall is at least D − e ahead of x. When the share s is done, at
//! least D − e − s (n · v + m) are left, which is affine in s: at s = 0 it is at least ρ by D ≥ ρ + e,
//! at s = 1 by the first condition. Otherwise let N be the direction in which the wall is truly
//! nearest, at the distance X ≥ ρ. Since what leads to the nearest point of a convex set does not
//! change by more than the point from which it is measured, X N and D n differ by at most e, so that
//! the angle between them is at most θ. Along N, at least X − s (N · v + m) ≥ X are left. ∎
//!
//! # Robots
//!
//! Two robots believe to be at p and q, at the distance D; n leads from p to q. With
//! c = ρ + e + m, they keep 2ρ from each other, if they are so far apart when they begin, with
//!
//! ```text
//! n · v ≤ D/2 − c                 if D ≥ 2ρ + 2e,
//! N · v ≤ −m  for all N within θ of n, sin θ = 2e/D,  otherwise
//! ```
//!
//! or v = 0, the other one with −n likewise, whichever of them move, each at its own pace. *Proof.*
//! The true offset W differs from D n by at most 2e. With shares s and t done, along n at least
//! D − 2e − s (n · v + m) − t (−n · w + m) are left, which is affine in s and in t, so that the four
//! corners tell: (0, 0) leaves D − 2e, (1, 1) leaves 2ρ if each is bounded by D/2 − c, and (1, 0)
//! leaves D/2 + ρ − e. All are at least 2ρ if D ≥ 2ρ + 2e. Otherwise let N be the direction of W; along
//! it at least |W| − s (N · v + m) − t (−N · w + m) ≥ |W| are left. ∎
//!
//! So robots that believe to be nearer to each other than allowed may stay, or go apart; they never
//! come nearer by little and little. The conditions for all N within θ hold if they hold for the two
//! outermost and θ is less than a right angle, since a direction between them is a sum of these with
//! nonnegative factors that add up to 1 or more.
//!
//! # Robots that have stopped
//!
//! A robot stands, and truly is within a of q, where it was heard last. One that believes to be at p keeps
//! 2ρ from it, if they are so far apart when it begins, with u = a + 2 (e + m) and
//!
//! ```text
//! n · v ≤ D − (2ρ + u)            if D ≥ 2ρ + u,
//! N · v ≤ −m  for all N within θ of n, cos θ = (D² + W² − u²) / 2DW,  otherwise
//! ```
//!
//! or v = 0, where W² is the greater one of 4ρ² and D² − u². *Proof.* The true offset differs from D n by at
//! most u. Along n, at least D − u − s (n · v + m) are left. Otherwise let N be the direction of the true
//! offset and T its length, at least 2ρ. By the law of cosines the cosine of the angle between N and n is at
//! least (D² + T² − u²) / 2DT, which is least for T² = D² − u² and, where T cannot be as small, for
//! T = 2ρ. Along N, at least T − s (N · v + m) ≥ T are left. ∎ If θ is a right angle or more, the robot may be
//! on any side, and this one stays.

use nalgebra::Unit;

use super::cell::own_side;
use super::{HalfPlane, Workspace};
use crate::{Point, Vector};

/// sin 60°: three directions at 120° from each other leave no way.
const SIN_60: f64 = 0.866_025_403_784_438_6;

/// How far the places and moves of robots may be off; lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// e: a robot is within this distance of where it believes to be.
    pub position: f64,
    /// m: a move strays at most so far; in the midst of it, by the same share of that.
    pub motion: f64,
}

impl Errors {
    /// Whether places and moves are exact.
    pub fn are_none(&self) -> bool {
        self.position == 0.0 && self.motion == 0.0
    }

    /// ρ + e + m: what robots that keep the clearance ρ keep by what they know.
    pub fn planning_clearance(&self, clearance: f64) -> f64 {
        clearance + self.position + self.motion
    }

    /// 2e + m: how far from the end of its move a robot may measure itself.
    pub fn stray(&self) -> f64 {
        2.0 * self.position + self.motion
    }

    /// As [`voronoi_half_planes`](super::voronoi_half_planes), for robots with errors; see the module.
    /// `kept` is `clearance`, or somewhat more so that rounding has no effect.
    ///
    /// Without errors the robot may always stay. With errors it may stay as well, but its place does
    /// not belong to the half-planes of a robot that is nearer than allowed: these lead away.
    pub fn voronoi_half_planes(
        &self,
        position: Point,
        neighbours: &[Point],
        clearance: f64,
        kept: f64,
    ) -> Vec<HalfPlane> {
        let mut half_planes = Vec::with_capacity(neighbours.len());
        for &neighbour in neighbours {
            let middle = nalgebra::center(&position, &neighbour);
            let towards = neighbour - position;
            let Some(bisector) = HalfPlane::through(middle, towards) else { continue };
            let (distance, uncertainty) = (towards.norm(), 2.0 * self.position);
            let own = own_side(bisector, position, self.planning_clearance(kept));
            if distance < 2.0 * clearance + uncertainty {
                let cosine = cosine_of(uncertainty / distance);
                half_planes.extend(self.away(position, bisector.normal, cosine));
            } else {
                let missing = self.planning_clearance(clearance) - distance / 2.0;
                half_planes.push(HalfPlane { offset: own.offset - missing.max(0.0), ..own });
            }
        }
        half_planes
    }

    /// Half-planes in which a robot that has strayed out of free space keeps `clearance` from the
    /// walls that are in reach of a move of length `radius`; see the module. Its place does not belong
    /// to those of walls that are nearer than allowed.
    pub fn wall_half_planes(
        &self,
        workspace: &Workspace,
        position: Point,
        radius: f64,
        clearance: f64,
    ) -> Vec<HalfPlane> {
        let kept = self.planning_clearance(clearance);
        let mut half_planes = Vec::new();
        workspace.for_each_edge_near(position, kept + radius, |_, wall| {
            let towards = wall.nearest(position) - position;
            let Some(border) = HalfPlane::through(position, towards) else { return };
            let distance = towards.norm();
            if distance < clearance + self.position {
                let cosine = cosine_of(self.position / distance);
                half_planes.extend(self.away(position, border.normal, cosine));
            } else {
                half_planes.push(HalfPlane { offset: border.offset + distance - kept, ..border });
            }
        });
        half_planes
    }

    /// Half-planes in which a robot keeps 2ρ from one that stands within `astray` of `place`; see the module.
    /// Without errors its own place belongs to them. `kept` is `clearance`, or somewhat more so that rounding
    /// has no effect.
    pub fn half_planes_beside(
        &self,
        position: Point,
        (place, astray): (Point, f64),
        clearance: f64,
        kept: f64,
    ) -> Vec<HalfPlane> {
        let Some(border) = HalfPlane::through(position, place - position) else {
            return self.away(position, Vector::x_axis(), 0.0).collect();
        };
        let distance = (place - position).norm();
        let uncertainty = astray + 2.0 * (self.position + self.motion);
        if distance >= 2.0 * clearance + uncertainty {
            let room = distance - 2.0 * self.planning_clearance(kept) - astray;
            return vec![HalfPlane { offset: border.offset + room.max(0.0), ..border }];
        }
        let square = distance * distance - uncertainty * uncertainty;
        let apart = (2.0 * clearance).max(square.max(0.0).sqrt());
        let cosine = (square + apart * apart) / (2.0 * distance * apart);
        self.away(position, border.normal, cosine).collect()
    }

    /// The places at which the robot is away by m from what lies `towards` or, up to an angle of this
    /// cosine, beside.
    fn away(
        &self,
        position: Point,
        towards: Unit<Vector>,
        cosine: f64,
    ) -> impl Iterator<Item = HalfPlane> {
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let directions = match cosine {
            ..=0.0 => vec![(1.0, 0.0), (-0.5, SIN_60), (-0.5, -SIN_60)],
            _ if sine == 0.0 => vec![(1.0, 0.0)],
            _ => vec![(cosine, sine), (cosine, -sine)],
        };
        let (ahead, aside) = (towards.into_inner(), Vector::new(-towards.y, towards.x));
        directions.into_iter().map(move |(along, across)| {
            let normal = Unit::new_unchecked(ahead * along + aside * across);
            let border = HalfPlane { normal, offset: f64::NEG_INFINITY }.widened_to(position);
            HalfPlane { offset: border.offset - self.motion, ..border }
        })
    }
}

/// The cosine of an acute angle of this sine; of a right one if there is none.
fn cosine_of(sine: f64) -> f64 {
    (1.0 - sine * sine).max(0.0).sqrt()
}
