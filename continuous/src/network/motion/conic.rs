//! The motion problem as the second-order cone program that it is, solved by clarabel.

use super::exact::{project, relevant_constraints};
use super::{Motion, MotionOutcome, MotionProblem};
use crate::Vector;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus,
    SupportedConeT,
};

/// How far outside the constraints the solver's answer may lie, as a share of the smallest disc.
///
/// An interior-point method with the default tolerances ends up to 1e-8 outside of feasible sets
/// that are segments or narrow corners. An answer farther out than this is no solution.
const SOLVER_TOLERANCE: f64 = 1e-6;

impl MotionProblem {
    /// Solves (21) with an interior-point method.
    ///
    /// The answer is as accurate as the solver, about 1e-5 of the trust region and at worst 1e-3,
    /// but it is feasible: what the solver leaves outside is projected onto the constraints. Merely
    /// shortening the step would not do, since a robot that touches a constraint would be frozen by
    /// an excess of 1e-11.
    ///
    /// The robot stays with the outcome [`Undecided`](MotionOutcome::Undecided) if the solver ends
    /// with anything but a solution; since the robot's own position is feasible, even "infeasible"
    /// means only that the solver could not tell.
    pub fn solve_conic(&self) -> Motion {
        if !self.admits(&self.position) {
            return Motion::stay(self, MotionOutcome::Infeasible);
        }
        let goal = self.waypoint - self.position;
        if !goal.iter().all(|component| component.is_finite()) {
            return Motion::stay(self, MotionOutcome::Undecided);
        }
        let unit = unit_of_length(self);
        let Some(answer) = cone_program(self, goal, unit) else {
            return Motion::stay(self, MotionOutcome::Undecided);
        };
        if self.smallest_margin(&(self.position + answer)) < -SOLVER_TOLERANCE * unit {
            return Motion::stay(self, MotionOutcome::Undecided);
        }
        let inside = project(answer, &relevant_constraints(self));
        let target = self.shrink_to_feasible(self.position + inside);
        Motion { target, outcome: MotionOutcome::Optimal }
    }
}

/// The radius of the smallest disc, so that the solver's absolute tolerances fit; 1 without discs.
fn unit_of_length(problem: &MotionProblem) -> f64 {
    let radii = problem.discs.iter().map(|disc| disc.radius).filter(|radius| *radius > 0.0);
    let smallest = radii.fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { smallest } else { 1.0 }
}

/// The step that clarabel finds, in displacements from the robot: with the origin there its
/// answers are about four times as accurate as in the coordinates of the workspace.
fn cone_program(problem: &MotionProblem, goal: Vector, unit: f64) -> Option<Vector> {
    let goal = goal / unit;

    let (mut entries, mut bounds, mut cones) = (Entries::default(), Vec::new(), Vec::new());
    for line in &problem.half_planes {
        // margin − normal·z ≥ 0.
        entries.push(bounds.len(), 0, line.normal.x);
        entries.push(bounds.len(), 1, line.normal.y);
        bounds.push(line.margin(problem.position) / unit);
    }
    if !bounds.is_empty() {
        cones.push(NonnegativeConeT(bounds.len()));
    }
    for disc in &problem.discs {
        // (radius, z − center) lies in the second-order cone.
        let center = (disc.center - problem.position) / unit;
        entries.push(bounds.len() + 1, 0, -1.0);
        entries.push(bounds.len() + 2, 1, -1.0);
        bounds.extend([disc.radius / unit, -center.x, -center.y]);
        cones.push(SecondOrderConeT(3));
    }
    solve(goal, entries, &bounds, &cones).map(|step| step * unit)
}

/// A sparse matrix in the making.
#[derive(Default)]
struct Entries {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Entries {
    fn push(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }
}

/// minimise ‖z − goal‖² subject to bounds − entries·z in the cones.
fn solve(
    goal: Vector,
    entries: Entries,
    bounds: &[f64],
    cones: &[SupportedConeT<f64>],
) -> Option<Vector> {
    let Entries { rows, columns, values } = entries;
    let constraints = CscMatrix::new_from_triplets(bounds.len(), 2, rows, columns, values);
    let quadratic = CscMatrix::from(&[[2.0, 0.0], [0.0, 2.0]]);
    let linear = [-2.0 * goal.x, -2.0 * goal.y];
    let settings =
        DefaultSettings { verbose: false, presolve_enable: false, ..DefaultSettings::default() };
    let mut solver =
        DefaultSolver::new(&quadratic, &linear, &constraints, bounds, cones, settings).ok()?;
    solver.solve();
    let solution = &solver.solution;
    let solved = matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
    let step = Vector::new(solution.x[0], solution.x[1]);
    (solved && step.iter().all(|component| component.is_finite())).then_some(step)
}
