//! Problem (6) solved centrally with clarabel: the oracle of the distributed methods, and the
//! answer to whether any routing can carry the rates.

use super::problem::RoutingProblem;
use crate::network::rates::Receiver;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT,
};
use thiserror::Error;

/// The solution of (6) for a whole network.
#[derive(Clone, Debug, PartialEq)]
pub struct CentralRouting {
    /// T of every link, in the order of the problem's links.
    pub shares: Vec<f64>,
    /// λ_i ≥ 0 of every robot.
    pub multipliers: Vec<f64>,
    /// Σ w T².
    pub objective: f64,
}

/// Why there is no central solution.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CentralError {
    /// No routing meets the reserve: the problem has no solution.
    #[error("no routing gives every robot a residual of {reserve}")]
    NoRouting {
        /// η that was asked for.
        reserve: f64,
    },
    /// The solver ended without an answer.
    #[error("the solver ended without an answer: {status}")]
    Undecided {
        /// What it said.
        status: String,
    },
}

/// Solves (6): the one routing with the least Σ w T².
///
/// # Errors
///
/// [`CentralError::NoRouting`] if (6) is infeasible, [`CentralError::Undecided`] if the solver
/// failed.
pub fn solve_central(problem: &RoutingProblem) -> Result<CentralRouting, CentralError> {
    let links = problem.links().len();
    let robots = problem.robots();
    let mut program = Program::of_links(problem, links);
    program.quadratic = problem.links().iter().map(|link| 2.0 * link.weight).collect();
    let solution =
        program.solve()?.ok_or(CentralError::NoRouting { reserve: problem.reserve() })?;
    let shares: Vec<f64> = solution.primal.iter().map(|share| share.max(0.0)).collect();
    Ok(CentralRouting {
        objective: problem.objective(&shares),
        multipliers: solution.dual[..robots].to_vec(),
        shares,
    })
}

/// The largest reserve η for which (6) has a solution: the maximum over all routings of the
/// smallest residual. Rates can be carried if and only if it is at least 0.
///
/// # Errors
///
/// [`CentralError::Undecided`] if the solver failed.
pub fn widest_reserve(problem: &RoutingProblem) -> Result<f64, CentralError> {
    let links = problem.links().len();
    let mut program = Program::of_links(problem, links + 1);
    for robot in 0..problem.robots() {
        program.entry(robot, links, 1.0);
        program.bounds[robot] = -problem.rates()[robot];
    }
    program.quadratic = vec![0.0; links + 1];
    program.linear[links] = -1.0;
    let solution = program
        .solve()?
        .ok_or_else(|| CentralError::Undecided { status: "a feasible program refused".into() })?;
    Ok(solution.primal[links])
}

/// Whether some routing gives every robot at least the reserve of the problem; `tolerance` is the
/// rate that may be missing, and should be above the solver's 1e-8.
///
/// # Errors
///
/// [`CentralError::Undecided`] if the solver failed.
pub fn feasible(problem: &RoutingProblem, tolerance: f64) -> Result<bool, CentralError> {
    Ok(widest_reserve(problem)? >= problem.reserve() - tolerance)
}

/// minimise ½ zᵀ diag(quadratic) z + linearᵀ z subject to `entries`·z ≤ `bounds`.
struct Program {
    quadratic: Vec<f64>,
    linear: Vec<f64>,
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    bounds: Vec<f64>,
}

struct Solution {
    primal: Vec<f64>,
    dual: Vec<f64>,
}

impl Program {
    /// −c_i(T) ≤ −η for each robot, then Σ_j T_ij ≤ 1 for each robot, then −T ≤ 0 for each link.
    fn of_links(problem: &RoutingProblem, variables: usize) -> Self {
        let robots = problem.robots();
        let mut bounds: Vec<f64> =
            problem.rates().iter().map(|rate| -(rate + problem.reserve())).collect();
        bounds.resize(2 * robots, 1.0);
        bounds.resize(2 * robots + problem.links().len(), 0.0);
        let mut program = Self {
            quadratic: Vec::new(),
            linear: vec![0.0; variables],
            rows: Vec::new(),
            columns: Vec::new(),
            values: Vec::new(),
            bounds,
        };
        for (index, link) in problem.links().iter().enumerate() {
            program.entry(link.sender, index, -link.reliability);
            if let Receiver::Robot(receiver) = link.receiver {
                program.entry(receiver, index, link.reliability);
            }
            program.entry(robots + link.sender, index, 1.0);
            program.entry(2 * robots + index, index, -1.0);
        }
        program
    }

    fn entry(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    /// `None` if the constraints contradict each other.
    fn solve(self) -> Result<Option<Solution>, CentralError> {
        let variables = self.linear.len();
        let diagonal: Vec<usize> = (0..variables).collect();
        let quadratic = CscMatrix::new_from_triplets(
            variables,
            variables,
            diagonal.clone(),
            diagonal,
            self.quadratic,
        );
        let constraints = CscMatrix::new_from_triplets(
            self.bounds.len(),
            variables,
            self.rows,
            self.columns,
            self.values,
        );
        let cones: [SupportedConeT<f64>; 1] = [NonnegativeConeT(self.bounds.len())];
        let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
        let mut solver = DefaultSolver::new(
            &quadratic,
            &self.linear,
            &constraints,
            &self.bounds,
            &cones,
            settings,
        )
        .map_err(|error| CentralError::Undecided { status: error.to_string() })?;
        solver.solve();
        match solver.solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => Ok(Some(Solution {
                primal: solver.solution.x.clone(),
                dual: solver.solution.z.clone(),
            })),
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Ok(None),
            status => Err(CentralError::Undecided { status: format!("{status:?}") }),
        }
    }
}
