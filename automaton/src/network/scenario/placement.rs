//! Whether robots and access points stand where a mission can start.

use super::validation::{ROUNDING, robot_key};
use super::{Fault, Problem, Scenario, Settings};
use nalgebra::{Point2, distance};

/// What is wrong with the workspace and with where robots and access points stand in it.
pub(super) fn faults(scenario: &Scenario) -> Vec<Fault> {
    robots_too_close(scenario)
}

/// Robots closer than 2ρ to each other; each robot is compared with those before it.
fn robots_too_close(scenario: &Scenario) -> Vec<Fault> {
    let least = 2.0 * Settings::resolve(scenario).clearance;
    let robots: Vec<_> = scenario.robot.iter().map(|robot| Point2::from(robot.position)).collect();
    let nearest_before = |index: usize| {
        (robots[..index].iter().enumerate())
            .map(|(other, position)| (other, distance(position, &robots[index])))
            .min_by(|left, right| left.1.total_cmp(&right.1))
    };
    (0..robots.len())
        .filter_map(|index| Some((index, nearest_before(index)?)))
        .filter(|&(_, (_, distance))| distance < least * (1.0 - ROUNDING))
        .map(|(index, (other, distance))| {
            Problem::RobotsTooClose { other, distance, least }.at(robot_key(index).key("position"))
        })
        .collect()
}
