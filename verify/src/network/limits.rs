//! What a mission is held against: the scenario's numbers with every default filled in.

use std::sync::Arc;

use pleach_automaton::network::Site;
use pleach_automaton::network::scenario::{LinkModel, Settings, ValidScenario};
use pleach_continuous::Point;
use pleach_continuous::geometry::Workspace;
use pleach_continuous::network::LinkReliability;

use super::link;

/// How far a measured value may lie beyond its bound: in the scenario's unit of length for
/// distances, and as a share of the radio's rate for residuals, shares and loads.
///
/// It covers rounding and the stopping tolerance of iterative solvers (1e-8 or better), and is
/// a ten-thousandth of the smallest clearance (0.01) in the studies.
pub const SLACK: f64 = 1e-6;

/// The bounds of a mission, valid by construction.
#[derive(Clone, Debug)]
pub struct Limits {
    site: Arc<Site>,
    rates: Vec<f64>,
    tasks: Vec<Point>,
}

impl Limits {
    /// The bounds that a scenario sets.
    pub fn of(scenario: &ValidScenario) -> Self {
        let tasks = scenario.task.iter().map(|task| task.position);
        Limits {
            site: Arc::clone(scenario.site()),
            rates: scenario.robot.iter().map(|robot| robot.rate).collect(),
            tasks: tasks.map(Point::from).collect(),
        }
    }

    /// Every setting, defaults filled in.
    pub fn settings(&self) -> &Settings {
        &self.site.settings
    }

    /// 𝒲: where the robots are.
    pub fn workspace(&self) -> &Workspace {
        &self.site.workspace
    }

    /// ρ: the distance kept from walls.
    pub fn clearance(&self) -> f64 {
        self.settings().clearance
    }

    /// 2ρ: the distance that robots keep from each other.
    pub fn separation(&self) -> f64 {
        2.0 * self.settings().clearance
    }

    /// δ: how close a robot must be to a task or post.
    pub fn service_radius(&self) -> f64 {
        self.settings().service_radius
    }

    /// σ: how far a robot may travel in a period.
    pub fn step_radius(&self) -> f64 {
        self.settings().step_radius
    }

    /// −c_min: the least residual.
    pub fn least_residual(&self) -> f64 {
        -self.settings().residual_tolerance
    }

    /// R of a link of this length. For links of eq. (27) it is computed here once more, by a
    /// function that shares no code with the robots; for others it is that of their model.
    pub fn reliability(&self, distance: f64) -> f64 {
        let ranges = self.settings().link;
        match (ranges.model, self.site.has_own_link()) {
            (LinkModel::Cubic, false) => {
                link::reliability(distance, ranges.full_range, ranges.max_range)
            }
            _ => self.site.radio.reliability(distance),
        }
    }

    /// R as robots reckon with it whose places are this far apart, as far as they know: that of a link
    /// which is longer by what the two may be off.
    pub(super) fn reckoned_reliability(&self, distance: f64) -> f64 {
        self.reliability(distance + self.settings().link_margin())
    }

    /// u: reliability 0 from here on.
    pub fn max_range(&self) -> f64 {
        self.site.radio.range()
    }

    /// d_build: up to which length links of the tree are made, before and after the team has stretched them.
    pub(super) fn link_to_be_made(&self, stretched: bool) -> f64 {
        self.site.lengths(stretched).build
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
        self.rates.len() + self.site.access_points.len()
    }

    /// Where the access points stand.
    pub fn access_points(&self) -> &[Point] {
        &self.site.access_points
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
        let limits = Limits::of(&sample::scenario());
        assert_eq!(limits.separation(), 0.02);
        assert_eq!(limits.service_radius(), 0.03);
        assert!((limits.step_radius() - 0.01).abs() < 1e-12);
        assert_eq!(limits.least_residual(), 0.0);
    }
}
