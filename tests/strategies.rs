//! `strategy = "eager"`: recruits are called for ahead of a standstill, and the primary team goes on while they
//! come. Each mission is held against every property while it runs.

use crate::floor_plans::in_storms::mission_in_storm;
use crate::floor_plans::{Family, scenario, strategies};
use crate::missions::{Mission, run_by, shipped};
use pleach::automaton::network::record::{MissionEvent as Event, Outcome};
use pleach::automaton::network::scenario::{Scenario, Strategy, ValidScenario};
use pleach::discrete::network::{Phase, Role};
use pleach::verify::network::storm::judged_run;
use rayon::prelude::*;

/// Missions of each family.
const SEEDS: u64 = 2;
/// Missions in storms.
const STORMS: u64 = 12;
const PERIODS_IN_STORMS: usize = 1_500;

/// The same mission by either strategy: the paper's, and the eager one.
fn both(scenario: &Scenario) -> [Mission; 2] {
    [Strategy::Paper, Strategy::Eager].map(|strategy| run_by(strategy, scenario.clone()))
}

fn robots_used(mission: &Mission) -> usize {
    mission.last().roles.iter().filter(|&&role| role != Role::Redundant).count()
}

/// In how many periods the primary team moves although it is not the active one.
fn moves_on_its_own(mission: &Mission) -> usize {
    let moves = |pair: &&[crate::missions::Period]| {
        let [before, after] = [&pair[0].snapshot, &pair[1].snapshot];
        let is_active = before.phase == Phase::Advance || after.phase == Phase::Advance;
        let moves = |&robot: &usize| before.positions[robot] != after.positions[robot];
        !is_active && before.primary_team.iter().any(moves)
    };
    mission.periods.windows(2).filter(moves).count()
}

fn calls_ahead(mission: &Mission) -> usize {
    mission.events().filter(|(_, event)| matches!(event, Event::RecruitCalled { .. })).count()
}

#[test]
fn the_studies_take_three_quarters_of_the_time_and_no_more_robots() {
    for name in ["study-1", "study-2", "corridor"] {
        let [paper, eager] = both(&shipped(name));
        paper.assert_serviced();
        eager.assert_serviced();
        let periods = [&paper, &eager].map(|mission| mission.periods.len() as f64);
        assert!(periods[1] < 0.75 * periods[0], "{name}: {periods:?}");
        assert!(robots_used(&eager) <= robots_used(&paper), "{name}");
        assert!(calls_ahead(&eager) > 0 && moves_on_its_own(&eager) > 0, "{name}");
        let is_ordered = (calls_ahead(&paper), moves_on_its_own(&paper)) == (0, 0);
        assert!(is_ordered, "{name}: in the paper's order one team moves at a time");
    }
}

/// With too few robots as many tasks are serviced as in the paper's order, and the mission ends with the same reason.
#[test]
fn a_mission_for_which_robots_are_too_few_gets_as_far() {
    let [paper, eager] = both(&shipped("too-few"));
    assert_eq!(eager.end.outcome, Outcome::InsufficientRobots, "{}", eager.end.reason);
    assert_eq!(eager.serviced(), paper.serviced());
    assert_eq!(eager.end.task, paper.end.task);
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Whether a robot is part of the tree although it services nothing and nothing is attached to it.
fn has_idle_node(mission: &Mission) -> bool {
    let last = mission.last();
    let used = |&robot: &usize| last.roles[robot] != Role::Redundant;
    let bears =
        |robot: usize| last.tree.iter().any(|(child, parent)| *parent == robot && used(child));
    (0..last.roles.len()).any(|robot| last.roles[robot] == Role::Node && !bears(robot))
}

/// What is serviced in the paper's order is serviced, sooner in the median, and with fewer robots in most missions.
#[test]
fn random_missions_are_serviced_alike_and_sooner() {
    let families: Vec<Family> = Family::of_every_day().chain(Family::WINDING).collect();
    let missions: Vec<_> =
        families.iter().flat_map(|&family| (1..=SEEDS).map(move |seed| (family, seed))).collect();
    let outcomes: Vec<_> = missions
        .into_par_iter()
        .map(|(family, seed)| {
            let [paper, eager] = both(scenario(family, seed).scenario());
            let said = format!("{}-{seed}: {}", family.name(), eager.end.reason);
            let is_serviced = |mission: &Mission| mission.end.outcome == Outcome::Serviced;
            assert!(!is_serviced(&paper) || is_serviced(&eager), "{said}");
            assert!(!is_serviced(&eager) || !has_idle_node(&eager), "{said}");
            let ratio = |of: &dyn Fn(&Mission) -> usize| of(&eager) as f64 / of(&paper) as f64;
            (ratio(&|it| it.periods.len()), ratio(&robots_used))
        })
        .collect();
    let (times, robots): (Vec<f64>, Vec<f64>) = outcomes.into_iter().unzip();
    let (time, robots) = (median(times), median(robots));
    assert!(time < 0.85, "median of the times: {time}");
    assert!(robots < 1.0, "median of the robots: {robots}");
}

#[test]
fn what_failed_once_does_not_fail_with_recruits_called_for_ahead() {
    for file in crate::found_missions::files("tests/scenarios/found") {
        let scenario = pleach::scenario_file::read(&file).unwrap();
        let eager = run_by(Strategy::Eager, scenario.into_scenario());
        eager.assert_serviced();
    }
}

#[test]
fn storms_break_no_promise_where_recruits_are_called_for_ahead() {
    (0..STORMS).into_par_iter().for_each(|seed| {
        let (scenario, storm) = mission_in_storm(seed);
        let scenario: ValidScenario = strategies::following(Some(Strategy::Eager), scenario);
        let verdict = judged_run(&scenario, &storm, PERIODS_IN_STORMS).expect("nodes go on");
        assert!(verdict.violations.is_empty(), "storm {seed}: {:?}", verdict.violations);
    });
}
