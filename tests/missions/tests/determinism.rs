//! The same scenario gives the same bytes, whatever the settings.

use missions::in_storms::mission_in_storm;
use missions::{run, shipped, shipped_names, traced, valid};
use pleach::automaton::network::scenario::{MotionSolver, RoutingMethod, Scenario, ValidScenario};
use pleach::mission;
use pleach::trace::TraceWriter;
use std::thread;

/// Missions in storms that are run with caching and without.
const STORMS: u64 = 20;

/// The trace of a scenario as its file holds it.
fn bytes(scenario: &Scenario) -> Vec<u8> {
    traced(&valid(scenario.clone())).0
}

/// Two traces of one scenario, written at the same time by two threads.
fn assert_same_bytes(scenario: &Scenario) {
    let [first, second] = at_once([(); 2].map(|()| || bytes(scenario)));
    assert_equal(&first, &second, &scenario.name);
}

/// The results of two functions, each of which runs on a thread of its own.
fn at_once<T: Send>(functions: [impl FnOnce() -> T + Send; 2]) -> [T; 2] {
    thread::scope(|scope| {
        functions.map(|function| scope.spawn(function)).map(|thread| thread.join().unwrap())
    })
}

fn assert_equal(first: &[u8], second: &[u8], mission: &str) {
    let differs = (first.split(|&byte| byte == b'\n').zip(second.split(|&byte| byte == b'\n')))
        .position(|(first, second)| first != second);
    assert_eq!(differs, None, "{mission}: the line from which on the traces differ");
    assert_eq!(first.len(), second.len(), "{mission}");
}

/// A scenario with motion solver and routing method chosen.
fn with_methods(name: &str, solver: MotionSolver, method: RoutingMethod) -> Scenario {
    let mut scenario = shipped(name);
    scenario.control.motion_solver = Some(solver);
    scenario.control.routing_method = Some(method);
    scenario
}

#[test]
fn the_same_scenario_gives_the_same_bytes() {
    for name in ["study-1", "study-2", "discs", "two-clusters", "ring"] {
        assert_same_bytes(&shipped(name));
    }
}

#[test]
fn every_motion_solver_and_routing_method_gives_the_same_bytes() {
    for solver in [MotionSolver::Exact, MotionSolver::Conic] {
        for method in [RoutingMethod::Dual, RoutingMethod::Adal] {
            assert_same_bytes(&with_methods("leaf-leader", solver, method));
        }
    }
}

/// What the settings state is what is used.
#[test]
fn the_motion_solvers_differ_beyond_their_names() {
    let [exact, conic] = [MotionSolver::Exact, MotionSolver::Conic]
        .map(|solver| bytes(&with_methods("redundant-node", solver, RoutingMethod::Dual)));
    let steps = |trace: &[u8]| -> Vec<Vec<u8>> {
        trace.split(|&byte| byte == b'\n').skip(1).map(<[u8]>::to_vec).collect()
    };
    assert_ne!(steps(&exact), steps(&conic));
}

#[test]
fn every_motion_solver_and_routing_method_services_the_studies() {
    for name in ["study-1", "study-2"] {
        for solver in [MotionSolver::Exact, MotionSolver::Conic] {
            for method in [RoutingMethod::Dual, RoutingMethod::Adal] {
                run(with_methods(name, solver, method)).assert_serviced();
            }
        }
    }
}

/// Robots that derive everything anew at each tick do what robots do that derive only what has changed.
#[test]
fn caching_changes_no_byte() {
    for name in shipped_names() {
        let cached = valid(shipped(&name));
        let [first, second] =
            at_once([cached.clone(), cached.without_caching()].map(|it| move || traced(&it).0));
        assert_equal(&first, &second, &name);
    }
}

/// The same while messages are lost or late, and nodes stop.
#[test]
fn caching_changes_no_byte_in_storms() {
    for seed in 0..STORMS {
        let (cached, storm) = mission_in_storm(seed);
        let storm = &storm;
        let trace = |scenario: ValidScenario| {
            move || {
                let mut writer = TraceWriter::new(Vec::new(), &scenario).unwrap();
                mission::run_in_storm(&scenario, storm, &mut [&mut writer]).unwrap();
                writer.finish().unwrap()
            }
        };
        let [first, second] = at_once([cached.clone(), cached.without_caching()].map(trace));
        assert_equal(&first, &second, &format!("storm {seed} in {}", cached.name));
    }
}
