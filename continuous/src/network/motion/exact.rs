//! The motion problem by enumeration: in the plane at most two constraints determine the answer.
//!
//! The projection of the waypoint onto a convex set in the plane is the waypoint itself, its
//! projection onto one constraint, or a point where two boundaries meet. All coordinates are
//! displacements from the robot, which keeps rounding proportional to the step and not to the
//! place in the workspace.

use super::{Motion, MotionOutcome, MotionProblem, USABLE_TOLERANCE};
use crate::Vector;

impl MotionProblem {
    /// Solves (21) exactly, up to rounding, by enumerating 0, 1 or 2 active constraints.
    ///
    /// The robot stays if its own position is infeasible, and with the outcome
    /// [`Undecided`](MotionOutcome::Undecided) if the waypoint is not a finite point. Feasible sets
    /// without interior, segments and points, are no special case.
    pub fn solve_exact(&self) -> Motion {
        if !self.admits(&self.position) {
            return Motion::stay(self, MotionOutcome::Infeasible);
        }
        let goal = self.waypoint - self.position;
        if !goal.iter().all(|component| component.is_finite()) {
            return Motion::stay(self, MotionOutcome::Undecided);
        }
        let constraints = relevant_constraints(self);
        let step = project(goal, &constraints);
        let target = self.shrink_to_feasible(self.position + step);
        Motion { target, outcome: MotionOutcome::Optimal }
    }

    /// Solves (21) for a robot that may be outside of its constraints, because it has measured itself
    /// elsewhere than it was to be: its next place meets all of them, or it stays.
    ///
    /// On the way there it is still outside. That this does no harm is a matter of the constraints, see
    /// [`errors`](crate::geometry::errors).
    pub fn solve_from_outside(&self) -> Motion {
        if self.admits(&self.position) {
            return self.solve_exact();
        }
        let goal = self.waypoint - self.position;
        let constraints = relevant_constraints(self);
        match nearest_feasible(goal, &constraints, f64::INFINITY).map(|step| self.position + step) {
            Some(target) if self.admits(&target) => {
                Motion { target, outcome: MotionOutcome::Optimal }
            }
            _ => Motion::stay(self, MotionOutcome::Infeasible),
        }
    }
}

/// The point nearest to `goal` that meets all constraints; the origin meets them.
pub(super) fn project(goal: Vector, constraints: &[Constraint]) -> Vector {
    nearest_feasible(goal, constraints, goal.norm_squared()).unwrap_or_else(Vector::zeros)
}

/// The point nearest to `goal` that meets all constraints, if one does. Corners count whose squared
/// distance to the goal is less than `limit`.
fn nearest_feasible(goal: Vector, constraints: &[Constraint], limit: f64) -> Option<Vector> {
    let admitted = |step: &Vector| {
        constraints.iter().all(|constraint| constraint.margin(step) >= -USABLE_TOLERANCE)
    };
    if admitted(&goal) {
        return Some(goal);
    }
    let violated = || constraints.iter().enumerate().filter(|(_, c)| c.margin(&goal) < 0.0);
    // Nearest to the goal on one constraint and feasible for all: nothing feasible is nearer.
    for (_, constraint) in violated() {
        let step = constraint.project(goal);
        if admitted(&step) {
            return Some(step);
        }
    }
    // Two active constraints. The goal violates at least one of them: if it met both, it would be
    // its own projection onto their intersection.
    let mut best = None;
    let mut least = limit;
    for (index, constraint) in violated() {
        for (other_index, other) in constraints.iter().enumerate() {
            if other_index == index {
                continue;
            }
            for step in constraint.crossings(other).into_iter().flatten() {
                let distance = (step - goal).norm_squared();
                if distance < least && admitted(&step) {
                    (best, least) = (Some(step), distance);
                }
            }
        }
    }
    best
}

/// A constraint on the displacement.
#[derive(Clone, Copy, Debug)]
pub(super) enum Constraint {
    /// normal·step ≤ margin.
    Line { normal: Vector, margin: f64 },
    /// ‖step − center‖ ≤ radius.
    Circle { center: Vector, radius: f64 },
}

/// The constraints that reach into the smallest disc. The others hold wherever that disc holds.
pub(super) fn relevant_constraints(problem: &MotionProblem) -> Vec<Constraint> {
    let mut constraints = Vec::with_capacity(problem.half_planes.len() + problem.discs.len());
    let discs = || problem.discs.iter().enumerate();
    let smallest = discs().min_by(|(_, a), (_, b)| a.radius.total_cmp(&b.radius));
    for (index, disc) in discs() {
        let redundant = smallest.is_some_and(|(smallest_index, smallest)| {
            index != smallest_index
                && (disc.center - smallest.center).norm() + smallest.radius <= disc.radius
        });
        if !redundant {
            let center = disc.center - problem.position;
            constraints.push(Constraint::Circle { center, radius: disc.radius });
        }
    }
    for line in &problem.half_planes {
        let redundant = smallest.is_some_and(|(_, disc)| line.margin(disc.center) >= disc.radius);
        if !redundant {
            let margin = line.margin(problem.position);
            constraints.push(Constraint::Line { normal: line.normal.into_inner(), margin });
        }
    }
    constraints
}

impl Constraint {
    /// Signed distance to the boundary, positive inside.
    fn margin(&self, step: &Vector) -> f64 {
        match self {
            Self::Line { normal, margin } => margin - normal.dot(step),
            Self::Circle { center, radius } => radius - (step - center).norm(),
        }
    }

    /// The nearest point on the boundary to a point outside.
    fn project(&self, goal: Vector) -> Vector {
        match self {
            Self::Line { normal, .. } => goal + normal * self.margin(&goal),
            Self::Circle { center, radius } => {
                let from_center = goal - center;
                center + from_center * (radius / from_center.norm())
            }
        }
    }

    /// Where two boundaries meet: at most two points.
    fn crossings(&self, other: &Self) -> [Option<Vector>; 2] {
        match (self, other) {
            (Self::Line { normal: a, margin: p }, Self::Line { normal: b, margin: q }) => {
                [lines_meet(a, *p, b, *q), None]
            }
            (Self::Line { normal, margin }, Self::Circle { center, radius })
            | (Self::Circle { center, radius }, Self::Line { normal, margin }) => {
                line_meets_circle(normal, *margin, center, *radius)
            }
            (Self::Circle { center: a, radius: p }, Self::Circle { center: b, radius: q }) => {
                circles_meet(a, *p, b, *q)
            }
        }
    }
}

/// Cramer's rule for a·z = p, b·z = q; `None` for parallel lines.
fn lines_meet(a: &Vector, p: f64, b: &Vector, q: f64) -> Option<Vector> {
    let determinant = a.perp(b);
    let point = Vector::new(p * b.y - q * a.y, a.x * q - b.x * p) / determinant;
    (determinant != 0.0 && point.iter().all(|component| component.is_finite())).then_some(point)
}

/// The two points of a line on a circle; both the foot of the center if the line only touches.
fn line_meets_circle(
    normal: &Vector,
    margin: f64,
    center: &Vector,
    radius: f64,
) -> [Option<Vector>; 2] {
    let distance = margin - normal.dot(center);
    if distance.abs() > radius + USABLE_TOLERANCE {
        return [None, None];
    }
    let foot = center + normal * distance;
    either_side(foot, normal, radius * radius - distance * distance)
}

/// The two points of two circles; both on the line of the centers if they only touch.
fn circles_meet(a: &Vector, p: f64, b: &Vector, q: f64) -> [Option<Vector>; 2] {
    let between = b - a;
    let distance = between.norm();
    let apart = distance > p + q + USABLE_TOLERANCE;
    let nested = distance < (p - q).abs() - USABLE_TOLERANCE;
    if distance == 0.0 || apart || nested {
        return [None, None];
    }
    let direction = between / distance;
    let along = 0.5 * (distance + (p - q) * (p + q) / distance);
    either_side(a + direction * along, &direction, p * p - along * along)
}

/// The two points beside `foot` at right angles to `direction`, at the root of `squared`.
fn either_side(foot: Vector, direction: &Vector, squared: f64) -> [Option<Vector>; 2] {
    let offset = Vector::new(-direction.y, direction.x) * squared.max(0.0).sqrt();
    [Some(foot + offset), Some(foot - offset)]
}
