//! `strategy = "eager"`: recruits are called for ahead of a standstill, and the primary team goes on while they
//! come. Each mission is held against every property while it runs.

use missions::floor_plans::Family;
use missions::in_storms::mission_in_storm;
use missions::{Drawn, Mission, files, read, run_by, shipped, strategies, used};
use pleach::automaton::network::record::{MissionEvent as Event, Outcome, Snapshot};
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
    strategies::BOTH.map(|strategy| run_by(strategy, scenario.clone()))
}

/// In how many periods the primary team moves although it is not the active one.
fn moves_on_its_own(mission: &Mission) -> usize {
    let moves = |pair: &&[missions::Period]| {
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
        assert!(used(eager.last()) <= used(paper.last()), "{name}");
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
fn has_idle_node(last: &Snapshot) -> bool {
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
            let [paper, eager] =
                strategies::BOTH.map(|strategy| Drawn::shared(family, seed, strategy));
            let said = format!("{}: {}", eager.name, eager.end.reason);
            assert!(!paper.is_serviced() || eager.is_serviced(), "{said}");
            assert!(!eager.is_serviced() || !has_idle_node(&eager.last), "{said}");
            let ratio = |of: &dyn Fn(&Drawn) -> usize| of(eager) as f64 / of(paper) as f64;
            (ratio(&|it| it.periods), ratio(&|it| used(&it.last)))
        })
        .collect();
    let (times, robots): (Vec<f64>, Vec<f64>) = outcomes.into_iter().unzip();
    let (time, robots) = (median(times), median(robots));
    assert!(time < 0.85, "median of the times: {time}");
    assert!(robots < 1.0, "median of the robots: {robots}");
}

/// Those that failed in the paper's order; the others are eager as they are.
#[test]
fn what_failed_once_does_not_fail_with_recruits_called_for_ahead() {
    let files = files("tests/scenarios/found").into_iter();
    let scenarios = files.map(|file| read(file).into_scenario());
    for scenario in scenarios.filter(|it| it.control.strategy == Some(Strategy::Paper)) {
        run_by(Strategy::Eager, scenario).assert_serviced();
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
