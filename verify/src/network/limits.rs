//! What a mission is held against: the scenario's numbers with every default filled in.

use std::fmt;

use pleach_automaton::network::scenario::{Fault, Scenario, Settings};
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
    /// No mission can start from it.
    #[error("no mission can start from the scenario: {}", Listed(.0))]
    Scenario(Vec<Fault>),
    /// The polygons bound no workspace.
    #[error(transparent)]
    Workspace(#[from] WorkspaceError),
}

/// Faults, one behind the other.
struct Listed<'a>(&'a [Fault]);

impl fmt::Display for Listed<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { "; " };
            write!(formatter, "{separator}{fault}")?;
        }
        Ok(())
    }
}

/// The bounds of a mission, valid by construction.
#[derive(Clone, Debug)]
pub struct Limits {
    workspace: Workspace,
    settings: Settings,
    rates: Vec<f64>,
    access_points: Vec<Point>,
    tasks: Vec<Point>,
}

impl Limits {
    /// The bounds that a scenario sets.
    ///
    /// # Errors
    ///
    /// The faults of a scenario from which no mission can start.
    pub fn of(scenario: &Scenario) -> Result<Self, LimitError> {
        scenario.validate().map_err(LimitError::Scenario)?;
        let access_points = scenario.access_point.iter().map(|point| point.position);
        let tasks = scenario.task.iter().map(|task| task.position);
        Ok(Limits {
            workspace: scenario.workspace()?,
            settings: Settings::resolve(scenario),
            rates: scenario.robot.iter().map(|robot| robot.rate).collect(),
            access_points: access_points.map(Point::from).collect(),
            tasks: tasks.map(Point::from).collect(),
        })
    }

    /// Every setting, defaults filled in.
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// 𝒲: where the robots are.
    pub fn workspace(&self) -> &Workspace {
        &self.workspace
    }

    /// ρ: the distance kept from walls.
    pub fn clearance(&self) -> f64 {
        self.settings.clearance
    }

    /// 2ρ: the distance that robots keep from each other.
    pub fn separation(&self) -> f64 {
        2.0 * self.settings.clearance
    }

    /// δ: how close a robot must be to a task or post.
    pub fn service_radius(&self) -> f64 {
        self.settings.service_radius
    }

    /// σ: how far a robot may travel in a period.
    pub fn step_radius(&self) -> f64 {
        self.settings.step_radius
    }

    /// −c_min: the least residual.
    pub fn least_residual(&self) -> f64 {
        -self.settings.residual_tolerance
    }

    /// l: reliability 1 up to here.
    pub fn full_range(&self) -> f64 {
        self.settings.link.full_range
    }

    /// u: reliability 0 from here on.
    pub fn max_range(&self) -> f64 {
        self.settings.link.max_range
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
    fn a_scenario_that_cannot_start_has_no_limits() {
        let mut scenario = sample::scenario();
        scenario.control.clearance = Some(f64::NAN);
        let message = Limits::of(&scenario).unwrap_err().to_string();
        assert!(message.contains("control.clearance: NaN is not a finite number"), "{message}");
    }
}
