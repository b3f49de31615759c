//! The motion problem (21): the next position of a robot.
//!
//! ```text
//! minimise    ‖y − a₁‖²
//! subject to  y in every half-plane  (the cell C_i of (18), the linearised c̃_i ≥ 0 of (22))
//!             y in every disc        (the trust region ‖y − x‖ ≤ σ, limits of links).
//! ```
//!
//! That is the projection of the waypoint a₁ onto a convex set in the plane.
//! [`MotionProblem::solve_exact`] finds it by enumerating which constraints are active;
//! [`MotionProblem::solve_conic`] solves it as the second-order cone program that it is. Both return a point that has been checked against every constraint, or the robot's
//! own position with the reason.

mod conic;
mod exact;
#[cfg(any(kani, test))]
mod proofs;

use crate::geometry::{Disc, HalfPlane};
use crate::{Point, Vector};

/// How far outside a constraint a point may lie and still count as inside, in the scenario's unit.
///
/// A robot that slides along a wall of its cell lies on the boundary up to rounding, which is
/// below 1e-13 for coordinates below 1000. Accepted points are never farther outside than this,
/// however many periods follow each other, since walls do not move with the robot.
pub const FEASIBILITY_TOLERANCE: f64 = 1e-12;

/// Halvings after which [`MotionProblem::shrink_to_feasible`] gives a move up: the closed form
/// before them is off by rounding only.
const HALVINGS: usize = 8;

/// Problem (21) of one robot.
///
/// ```
/// use pleach_continuous::{Point, Vector};
/// use pleach_continuous::geometry::{Disc, HalfPlane};
/// use pleach_continuous::network::motion::{MotionOutcome, MotionProblem};
///
/// let position = Point::new(0.0, 0.0);
/// let problem = MotionProblem {
///     position,
///     waypoint: Point::new(3.0, 4.0),
///     half_planes: vec![HalfPlane::new(Vector::new(1.0, 0.0), 0.3)],
///     discs: vec![Disc { center: position, radius: 0.5 }],
/// };
/// let motion = problem.solve_exact();
/// assert_eq!(motion.outcome, MotionOutcome::Optimal);
/// assert!((motion.target - Point::new(0.3, 0.4)).norm() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MotionProblem {
    /// x_i(t_k): where the robot is.
    pub position: Point,
    /// a₁: the first waypoint of its geodesic.
    pub waypoint: Point,
    /// The half-planes it must stay in.
    pub half_planes: Vec<HalfPlane>,
    /// The discs it must stay in; the trust region is one of them.
    pub discs: Vec<Disc>,
}

/// The answer to a [`MotionProblem`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// x_i(t_{k+1}): feasible up to [`FEASIBILITY_TOLERANCE`] if the position is.
    pub target: Point,
    /// How it came about.
    pub outcome: MotionOutcome,
}

/// How a motion came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionOutcome {
    /// The target solves (21).
    Optimal,
    /// The position itself breaks a constraint, for example because its routes are infeasible: the
    /// robot stays (Algorithm 5, line 10).
    Infeasible,
    /// The solver did not reach an answer: the robot stays.
    Undecided,
}

impl Motion {
    fn stay(problem: &MotionProblem, outcome: MotionOutcome) -> Self {
        Self { target: problem.position, outcome }
    }
}

impl MotionProblem {
    /// Whether a point meets every constraint up to [`FEASIBILITY_TOLERANCE`].
    pub fn admits(&self, point: &Point) -> bool {
        is_admitted(self.smallest_margin(point))
    }

    /// The smallest margin of a point over all constraints; infinite if there are none.
    pub fn smallest_margin(&self, point: &Point) -> f64 {
        let lines = self.half_planes.iter().map(|half_plane| half_plane.margin(*point));
        let circles = self.discs.iter().map(|disc| disc.margin(*point));
        smallest(lines.chain(circles))
    }

    /// Adds c̃_i ≥ `floor` of eq. (22) as a half-plane, from the residual c_i at the position and
    /// its gradient ∇_{x_i} c_i ([`residual_gradient`](super::rates::residual_gradient)), in rate per unit of length.
    ///
    /// A residual that does not change with the position and is below the floor makes the problem
    /// infeasible; one that is above adds nothing.
    pub fn keep_residual(&mut self, residual: f64, gradient: Vector, floor: f64) {
        if gradient.norm() > 0.0 {
            let offset = residual - floor - gradient.dot(&self.position.coords);
            self.half_planes.push(HalfPlane::new(-gradient, offset));
        } else if residual < floor {
            // No place is good enough: a half-plane that contains no point.
            self.half_planes.push(HalfPlane::new(Vector::x(), f64::NEG_INFINITY));
        }
    }

    /// The point nearest to `target` on the segment from the position that this problem
    /// [`admits`](Self::admits); the position if there is none.
    ///
    /// The admitted part of the segment is an interval that starts at the position. Where it ends
    /// follows from the constraints in closed form; a few halvings then remove what rounding
    /// leaves outside.
    pub(super) fn shrink_to_feasible(&self, target: Point) -> Point {
        if self.admits(&target) {
            return target;
        }
        let displacement = target - self.position;
        let lines =
            self.half_planes.iter().map(|line| line_reach(line, &self.position, &displacement));
        let circles = self.discs.iter().map(|disc| disc_reach(disc, &self.position, &displacement));
        let mut share = lines.chain(circles).fold(1.0, f64::min);
        for _ in 0..HALVINGS {
            let point = self.position + displacement * share;
            if self.admits(&point) {
                return point;
            }
            share *= 0.5;
        }
        self.position
    }
}

/// Whether a margin is that of a point inside, up to [`FEASIBILITY_TOLERANCE`].
pub(super) fn is_admitted(margin: f64) -> bool {
    margin >= -FEASIBILITY_TOLERANCE
}

/// The smallest of some margins; infinite if there are none. One that is not a number counts as
/// broken, which `f64::min` would hide: then the answer is not a number either.
pub(super) fn smallest(margins: impl IntoIterator<Item = f64>) -> f64 {
    margins.into_iter().fold(f64::INFINITY, |least, margin| {
        if margin < least || margin.is_nan() { margin } else { least }
    })
}

/// The part of the tolerance that closed forms may use; the rest is for the rounding after them.
const USABLE_TOLERANCE: f64 = 0.5 * FEASIBILITY_TOLERANCE;

/// The share of a displacement that stays within a half-plane up to the tolerance.
fn line_reach(line: &HalfPlane, start: &Point, displacement: &Vector) -> f64 {
    let approach = line.normal.dot(displacement);
    let room = line.margin(*start) + USABLE_TOLERANCE;
    if approach > 0.0 { (room / approach).clamp(0.0, 1.0) } else { 1.0 }
}

/// The share of a displacement that stays within a disc up to the tolerance.
fn disc_reach(disc: &Disc, start: &Point, displacement: &Vector) -> f64 {
    let from_center = start - disc.center;
    let squared = displacement.norm_squared();
    if squared == 0.0 {
        return 1.0;
    }
    // ‖from_center + s·displacement‖ = radius, the larger root.
    let half = from_center.dot(displacement) / squared;
    let radius = disc.radius + USABLE_TOLERANCE;
    let constant = (from_center.norm_squared() - radius * radius) / squared;
    let root = (half * half - constant).max(0.0).sqrt() - half;
    root.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests;
