//! Missions in which the certified acceptance has work to do: rates near what links carry, long
//! steps, links of the tree that may be weak. With the settings of the shipped scenarios loads stay
//! far below 1, and hardly a robot ever objects to a move.

use missions::{read, run, shipped};
use pleach::automaton::network::record::Outcome;
use pleach::automaton::network::scenario::Scenario;

/// Settings under which robots object: r, the least reliability of tree links, κ and σ.
struct Stress {
    rate: f64,
    tree_reliability: f64,
    slope_aversion: f64,
    step_radius: f64,
}

const STRESSES: [Stress; 3] = [
    Stress { rate: 0.0767, tree_reliability: 0.5, slope_aversion: 0.0, step_radius: 0.12 },
    Stress { rate: 0.075, tree_reliability: 0.3, slope_aversion: 10.0, step_radius: 0.06 },
    Stress { rate: 0.0767, tree_reliability: 0.3, slope_aversion: 0.0, step_radius: 0.06 },
];

/// Missions under stress, for tests that count what acts in them.
pub fn stressed_scenarios() -> impl Iterator<Item = Scenario> {
    STRESSES.iter().map(|stress| stressed("leaf-leader", stress))
}

fn stressed(name: &str, stress: &Stress) -> Scenario {
    // More robots than those of leaf-leader bring more traffic to the access point.
    let share = if name == "leaf-leader" { 1.0 } else { 0.9 };
    let mut scenario = shipped(name);
    scenario.robot.iter_mut().for_each(|robot| robot.rate = share * stress.rate);
    scenario.control.build_reliability = Some(stress.tree_reliability);
    scenario.control.tree_reliability = Some(stress.tree_reliability);
    scenario.control.slope_aversion = Some(stress.slope_aversion);
    scenario.control.step_radius = Some(stress.step_radius);
    scenario
}

/// Tasks are serviced, and loads come close to all the time of a sender.
#[test]
fn missions_under_stress_keep_what_is_promised() {
    let mut largest: f64 = 0.0;
    for name in ["leaf-leader", "study-1", "corridor", "two-clusters", "ring"] {
        for stress in &STRESSES {
            let mission = run(stressed(name, stress));
            mission.assert_serviced();
            largest = largest.max(mission.extremes.load.as_ref().unwrap().value);
        }
    }
    assert!(largest > 0.99, "the largest load is only {largest}");
}

/// At rates that links can hardly carry, the tree changes to one that cannot. The former flows stand
/// then, so that no residual becomes negative, and the mission ends by naming the loads.
#[test]
fn rates_that_links_cannot_carry_end_the_mission_and_break_nothing() {
    let saturated = read("tests/scenarios/saturated.toml").into_scenario();
    let cases = [0.27, 0.28, 0.29, 0.3]
        .map(|rate| (saturated.clone(), rate))
        .into_iter()
        .chain([0.15, 0.17].map(|rate| (shipped("study-1"), rate)));
    for (mut scenario, rate) in cases {
        scenario.robot.iter_mut().for_each(|robot| robot.rate = rate);
        let end = run(scenario).end;
        assert_eq!(end.outcome, Outcome::Blocked, "with rates of {rate}");
        assert!(end.reason.contains("carry no more"), "{}", end.reason);
    }
}
