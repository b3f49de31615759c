//! The same scenario gives the same bytes, whatever the settings.

use missions::{run, shipped, traced, valid};
use pleach::automaton::network::scenario::{MotionSolver, RoutingMethod, Scenario};
use std::thread;

/// The trace of a scenario as its file holds it.
fn bytes(scenario: &Scenario) -> Vec<u8> {
    traced(&valid(scenario.clone())).0
}

/// Two traces of one scenario, written at the same time by two threads.
fn assert_same_bytes(scenario: &Scenario) -> Vec<u8> {
    let [first, second] = thread::scope(|scope| {
        let [first, second] = [(); 2].map(|()| scope.spawn(|| bytes(scenario)));
        [first.join().unwrap(), second.join().unwrap()]
    });
    let differs = (first.split(|&byte| byte == b'\n').zip(second.split(|&byte| byte == b'\n')))
        .position(|(first, second)| first != second);
    assert_eq!(differs, None, "{}: the line from which on the traces differ", scenario.name);
    assert_eq!(first.len(), second.len(), "{}", scenario.name);
    first
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
