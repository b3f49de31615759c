//! The same scenario gives the same bytes, whatever the settings.

use crate::missions::{run, run_over, shipped, valid};
use pleach::automaton::network::Radio;
use pleach::automaton::network::scenario::{MotionSolver, RoutingMethod, Scenario};
use pleach::automaton::node::{Unreliable, Weather};
use pleach::mission;
use pleach::trace::TraceWriter;
use rayon::ThreadPoolBuilder;
use serde_json::json;
use std::thread;

/// The trace of a scenario as its file holds it.
fn bytes(scenario: &Scenario) -> Vec<u8> {
    let mut writer = TraceWriter::new(Vec::new(), scenario).unwrap();
    mission::run(&valid(scenario.clone()), &mut [&mut writer]).unwrap();
    writer.finish().unwrap()
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

/// So many robots that their steps are taken on several threads where there are some, in a hall in which
/// one is sent to a task.
fn crowd() -> Scenario {
    const COLUMNS: usize = 26;
    const SPACING: f64 = 0.24;
    let place =
        |column: usize, row: usize| [(column as f64 + 0.5) * SPACING, (row as f64 + 0.5) * SPACING];
    let robots: Vec<_> = (0..20 * COLUMNS)
        .map(|robot| json!({"position": place(robot % COLUMNS, robot / COLUMNS), "rate": 0.001}))
        .collect();
    let access_points: Vec<_> = (0..8)
        .map(|number| [6 * (number % 4) + 3, 10 * (number / 4) + 5])
        .map(|[column, row]| place(column, row).map(|middle| middle + SPACING / 2.0))
        .map(|position| json!({"position": position}))
        .collect();
    let (width, height) = (COLUMNS as f64 * SPACING + 1.0, 20.0 * SPACING);
    serde_json::from_value(json!({
        "name": "crowd",
        "workspace": {"boundary": [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]},
        "link": {"full_range": 0.4, "max_range": 0.5},
        "control": {"max_steps": 8},
        "access_point": access_points,
        "robot": robots,
        "task": [{"position": [width - 0.5, height / 2.0]}],
    }))
    .unwrap()
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let [one, three] = [1, 3].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bytes(&crowd()))
    });
    assert!(one.split(|&byte| byte == b'\n').count() > 8, "robots have moved");
    assert!(one == three, "on one thread and on three");
}

/// The radio hands all messages of a round out at once; a medium that delivers one after the other leads
/// to the same.
#[test]
fn messages_that_are_heard_side_by_side_lead_to_the_same_mission() {
    for name in ["study-1", "two-clusters"] {
        let calm = |site: &_| Unreliable::new(Radio::new(site), Weather::default(), 0);
        let (in_turn, _) = run_over(shipped(name), calm);
        let abreast = run(shipped(name));
        assert!(abreast.periods == in_turn.periods, "{name}");
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
