//! What a mission is held against: the scenario's numbers with every default filled in.

use pleach_automaton::network::scenario::Scenario;
use pleach_continuous::Point;
use pleach_continuous::geometry::{Workspace, WorkspaceError};
use thiserror::Error;

/// How far a measured value may lie beyond its bound: in the scenario's unit of length for
/// distances, and as a share of the radio's rate for residuals, shares and loads.
///
/// It covers rounding and the stopping tolerance of iterative solvers (1e-8 or better), and is
/// a ten-thousandth of the smallest clearance (0.01) in the studies.
pub const SLACK: f64 = 1e-6;

/// Why no mission can be held against a scenario.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LimitError {
    /// A number is not what it must be.
    #[error("{name} is {value}; it must be {requirement}")]
    Number {
        /// The key in the scenario.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What would be right.
        requirement: &'static str,
    },
    /// The polygons bound no workspace.
    #[error(transparent)]
    Workspace(#[from] WorkspaceError),
}

/// The bounds of a mission, valid by construction.
#[derive(Clone, Debug)]
pub struct Limits {
    workspace: Workspace,
    clearance: f64,
    service_radius: f64,
    step_radius: f64,
    residual_tolerance: f64,
    full_range: f64,
    max_range: f64,
    rates: Vec<f64>,
    access_points: Vec<Point>,
    tasks: Vec<Point>,
}

impl Limits {
    /// The bounds that a scenario sets, with the defaults that
    /// [`Control`](pleach_automaton::network::scenario::Control) documents.
    ///
    /// # Errors
    ///
    /// A length or rate that is not finite, negative, or zero where it must be positive, ranges
    /// l ≥ u, or polygons that bound no workspace.
    pub fn of(scenario: &Scenario) -> Result<Self, LimitError> {
        let (link, control) = (&scenario.link, &scenario.control);
        let (full_range, max_range) = (link.full_range, link.max_range);
        positive("link.full_range", full_range)?;
        positive("link.max_range", max_range)?;
        if full_range >= max_range {
            let requirement = "less than link.max_range";
            return Err(error("link.full_range", full_range, requirement));
        }
        let clearance = control.clearance.unwrap_or(full_range / 40.0);
        let service_radius = control.service_radius.unwrap_or(3.0 * clearance);
        let step_radius = control.step_radius.unwrap_or((max_range - full_range) / 10.0);
        let residual_tolerance = control.residual_tolerance.unwrap_or(0.0);
        positive("control.clearance", clearance)?;
        positive("control.service_radius", service_radius)?;
        positive("control.step_radius", step_radius)?;
        not_negative("control.residual_tolerance", residual_tolerance)?;
        for robot in &scenario.robot {
            not_negative("robot.rate", robot.rate)?;
        }
        let outline = &scenario.workspace;
        let polygon =
            |vertices: &Vec<[f64; 2]>| vertices.iter().copied().map(Point::from).collect();
        let holes = outline.holes.iter().map(polygon).collect();
        Ok(Limits {
            workspace: Workspace::new(polygon(&outline.boundary), holes)?,
            clearance,
            service_radius,
            step_radius,
            residual_tolerance,
            full_range,
            max_range,
            rates: scenario.robot.iter().map(|robot| robot.rate).collect(),
            access_points: places(scenario.access_point.iter().map(|point| point.position))?,
            tasks: places(scenario.task.iter().map(|task| task.position))?,
        })
    }

    /// 𝒲: where the robots are.
    pub fn workspace(&self) -> &Workspace {
        &self.workspace
    }

    /// ρ: the distance kept from walls.
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// 2ρ: the distance that robots keep from each other.
    pub fn separation(&self) -> f64 {
        2.0 * self.clearance
    }

    /// δ: how close a robot must be to a task or post.
    pub fn service_radius(&self) -> f64 {
        self.service_radius
    }

    /// σ: how far a robot may travel in a period.
    pub fn step_radius(&self) -> f64 {
        self.step_radius
    }

    /// −c_min: the least residual.
    pub fn least_residual(&self) -> f64 {
        -self.residual_tolerance
    }

    /// l: reliability 1 up to here.
    pub fn full_range(&self) -> f64 {
        self.full_range
    }

    /// u: reliability 0 from here on.
    pub fn max_range(&self) -> f64 {
        self.max_range
    }

    /// r_i of every robot.
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// N: how many robots there are.
    pub fn robots(&self) -> usize {
        self.rates.len()
    }

    /// N + K: how many nodes there are.
    pub fn nodes(&self) -> usize {
        self.rates.len() + self.access_points.len()
    }

    /// Where the access points stand.
    pub fn access_points(&self) -> &[Point] {
        &self.access_points
    }

    /// q_v: where the tasks are.
    pub fn tasks(&self) -> &[Point] {
        &self.tasks
    }
}

fn error(name: &'static str, value: f64, requirement: &'static str) -> LimitError {
    LimitError::Number { name, value, requirement }
}

fn positive(name: &'static str, value: f64) -> Result<(), LimitError> {
    let valid = value.is_finite() && value > 0.0;
    if valid { Ok(()) } else { Err(error(name, value, "a positive number")) }
}

fn not_negative(name: &'static str, value: f64) -> Result<(), LimitError> {
    let valid = value.is_finite() && value >= 0.0;
    if valid { Ok(()) } else { Err(error(name, value, "a number that is not negative")) }
}

fn places(positions: impl Iterator<Item = [f64; 2]>) -> Result<Vec<Point>, LimitError> {
    positions
        .map(|position| match position.into_iter().find(|value| !value.is_finite()) {
            Some(value) => Err(error("position", value, "a finite number")),
            None => Ok(Point::from(position)),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::sample;

    #[test]
    fn defaults_are_those_that_the_scenario_documents() {
        let limits = Limits::of(&sample::scenario()).unwrap();
        assert_eq!(limits.separation(), 0.02);
        assert_eq!(limits.service_radius(), 0.03);
        assert!((limits.step_radius() - 0.01).abs() < 1e-12);
        assert_eq!(limits.least_residual(), 0.0);
    }

    #[test]
    fn ranges_and_lengths_must_make_sense() {
        let mut scenario = sample::scenario();
        scenario.link.full_range = 0.5;
        let message = Limits::of(&scenario).unwrap_err().to_string();
        assert_eq!(message, "link.full_range is 0.5; it must be less than link.max_range");
        let mut scenario = sample::scenario();
        scenario.control.clearance = Some(f64::NAN);
        let message = Limits::of(&scenario).unwrap_err().to_string();
        assert_eq!(message, "control.clearance is NaN; it must be a positive number");
        let mut scenario = sample::scenario();
        scenario.robot[0].rate = -0.1;
        let message = Limits::of(&scenario).unwrap_err().to_string();
        assert_eq!(message, "robot.rate is -0.1; it must be a number that is not negative");
        let mut scenario = sample::scenario();
        scenario.workspace.boundary.truncate(2);
        assert!(matches!(Limits::of(&scenario), Err(LimitError::Workspace(_))));
    }
}
