//! The motion problem as the second-order cone program that it is, solved by clarabel.

use super::{Motion, MotionOutcome, MotionProblem};
use crate::{Point, Vector};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus,
    SupportedConeT,
};

/// Sweeps of [`MotionProblem::pull_inside`] over the constraints; each shrinks what is violated by a
/// constant factor.
const SWEEPS: usize = 20;

impl MotionProblem {
    /// Solves (21) with an interior-point method.
    ///
    /// The answer is as accurate as the solver, about 1e-5 of the trust region and at worst 1e-3,
    /// but it is feasible: it is checked against every constraint and brought back inside. The
    /// robot stays with the outcome [`Undecided`](MotionOutcome::Undecided) if the solver ends
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
        match cone_program(self, goal) {
            Some(step) => {
                let inside = self.pull_inside(self.position + step);
                let target = self.shrink_to_feasible(inside);
                Motion { target, outcome: MotionOutcome::Optimal }
            }
            None => Motion::stay(self, MotionOutcome::Undecided),
        }
    }

    /// Moves a point onto every constraint that it breaks, one after the other, a few times over.
    ///
    /// An interior-point method ends up to 1e-8 outside of feasible sets without interior. This
    /// brings its answer back where merely shrinking the step would freeze the robot.
    fn pull_inside(&self, point: Point) -> Point {
        let mut point = point;
        for _ in 0..SWEEPS {
            if self.admits(&point) {
                break;
            }
            for line in &self.half_planes {
                let margin = line.margin(point);
                if margin < 0.0 {
                    point += line.normal.into_inner() * margin;
                }
            }
            for disc in &self.discs {
                let from_center = point - disc.center;
                let distance = from_center.norm();
                if distance > disc.radius {
                    point = disc.center + from_center * (disc.radius / distance);
                }
            }
        }
        point
    }
}

/// The step that clarabel finds, in displacements from the robot: with the origin there its
/// answers are about four times as accurate as in the coordinates of the workspace.
fn cone_program(problem: &MotionProblem, goal: Vector) -> Option<Vector> {
    // Lengths are in units of the smallest disc, so that the solver's absolute tolerances fit.
    let unit = problem
        .discs
        .iter()
        .map(|disc| disc.radius)
        .filter(|radius| *radius > 0.0)
        .fold(f64::INFINITY, f64::min);
    let unit = if unit.is_finite() { unit } else { 1.0 };
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
