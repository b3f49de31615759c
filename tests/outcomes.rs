//! Every mission ends, with an outcome that says what happened.

use missions::{Arrival, Filtered, Mission, run, run_over, shipped, shipped_mission};
use pleach::automaton::network::record::{MissionEvent as Event, Outcome, Route};
use pleach::automaton::network::scenario::{
    AccessPoint, Agenda, Control, LinkModel, LinkRanges, RobotStart, Scenario, Task, Unreachable,
    WorkspaceOutline,
};
use pleach::continuous::Point;
use std::path::Path;
use std::process::{Command, Output};

const CLEARANCE: f64 = 0.01;
const SERVICE_RADIUS: f64 = 0.03;

/// A room of 2 by 1 with a pillar and a narrow wedge at its right end, six robots at its left
/// end and one task.
fn room(task: [f64; 2]) -> Scenario {
    let places = [[0.1, 0.3], [0.3, 0.3], [0.5, 0.3], [0.1, 0.7], [0.3, 0.7], [0.5, 0.7]];
    Scenario {
        name: "room".into(),
        description: None,
        workspace: WorkspaceOutline {
            boundary: vec![[0.0, 0.0], [2.0, 0.0], [2.0, 0.9], [2.4, 1.0], [0.0, 1.0]],
            holes: vec![vec![[1.0, 0.4], [1.2, 0.4], [1.2, 0.6], [1.0, 0.6]]],
        },
        link: LinkRanges::new(0.4, 0.5),
        control: Control {
            clearance: Some(CLEARANCE),
            service_radius: Some(SERVICE_RADIUS),
            ..Control::default()
        },
        mission: Agenda::default(),
        access_point: vec![AccessPoint { position: [0.3, 0.5] }],
        robot: places.map(|position| RobotStart::at(position, 0.075)).into(),
        task: vec![Task::at(task)],
    }
}

/// The mission ended without this task, and says so.
fn assert_unserviced(mission: &Mission, outcome: Outcome, task: usize) {
    assert_eq!(mission.end.outcome, outcome, "{}", mission.end.reason);
    assert_eq!(mission.end.task, Some(task));
    assert!(mission.end.reason.contains(&format!("task {task}")), "{}", mission.end.reason);
    assert_eq!(mission.serviced(), task);
}

// ---- Where a task may be -----------------------------------------------------------------------

/// A task is serviced from the nearest place where a robot may be, dist(q, 𝒲_f) ≤ δ.
#[test]
fn a_task_within_the_service_radius_of_the_free_space_is_serviced() {
    let places = [
        ("in the open", [1.5, 0.5]),
        ("within ρ of the pillar", [0.995, 0.5]),
        ("within ρ of the boundary", [1.5, 0.004]),
        ("on a wall", [1.2, 0.5]),
        ("behind the surface of a wall", [1.5, -0.015]),
        ("in a right corner", [2.0, 0.0]),
        ("at a corner of the pillar", [1.2, 0.6]),
        ("at the access point", [0.3, 0.5]),
        ("where a robot stands", [0.5, 0.7]),
    ];
    for (place, task) in places {
        let mission = run(room(task));
        assert_eq!(mission.end.outcome, Outcome::Serviced, "{place}: {}", mission.end.reason);
        let &(_, robot) = mission.last().serviced.first().unwrap();
        let distance = (mission.last().positions[robot] - Point::from(task)).norm();
        assert!(distance <= SERVICE_RADIUS + 1e-6, "{place}: from {distance}");
    }
}

/// In the tip of a wedge of angle θ robots stay ρ/sin(θ/2) away from it, which is more than δ.
#[test]
fn a_task_farther_from_the_free_space_is_unreachable() {
    let places = [
        ("in the pillar", [1.1, 0.5]),
        ("outside the workspace", [1.5, -0.05]),
        ("far outside", [30.0, -40.0]),
        ("in the tip of a wedge", [2.4, 1.0]),
    ];
    for (place, task) in places {
        let mission = run(room(task));
        println!("{place}");
        assert_unserviced(&mission, Outcome::UnreachableTask, 0);
        let first = &mission.periods[0].snapshot.positions;
        assert_eq!(first, &mission.last().positions, "{place}: no robot moves");
    }
}

#[test]
fn a_task_in_another_component_is_unreachable() {
    assert_unserviced(&shipped_mission("unreachable").0, Outcome::UnreachableTask, 1);
}

/// What was serviced before stays serviced, and what comes after an impossible task is serviced, too.
#[test]
fn an_impossible_task_is_skipped() {
    let mut scenario = room([1.5, 0.5]);
    scenario.task.extend([[1.1, 0.5], [1.5, 0.2]].map(Task::at));
    let mission = run(scenario);
    let end = &mission.end;
    assert_eq!((end.outcome, &end.tasks[..]), (Outcome::UnreachableTask, &[1][..]));
    assert!(end.reason.contains("the service radius of task 1"), "{}", end.reason);
    let serviced: Vec<usize> = mission.last().serviced.iter().map(|&(task, _)| task).collect();
    assert_eq!(serviced, [0, 2]);
}

/// Forty tasks in a building, four of them in walls.
#[test]
fn tasks_in_walls_are_named_and_all_others_serviced() {
    let mission =
        run(pleach::scenario_file::read(Path::new("tests/scenarios/tasks-in-walls.toml"))
            .unwrap()
            .into_scenario());
    assert_eq!(mission.end.outcome, Outcome::UnreachableTask, "{}", mission.end.reason);
    assert_eq!(mission.end.tasks, [8, 11, 14, 24]);
    let is_serviced = |event: &Event| matches!(event, Event::TaskServiced { .. });
    assert_eq!(mission.events().filter(|(_, event)| is_serviced(event)).count(), 36);
}

/// Nor is it tried where the scenario says so.
#[test]
fn an_impossible_task_ends_the_mission_that_says_so() {
    let mut scenario = room([1.5, 0.5]);
    scenario.mission.unreachable = Some(Unreachable::End);
    scenario.task.extend([[1.1, 0.5], [1.5, 0.2]].map(Task::at));
    let mission = run(scenario);
    assert_unserviced(&mission, Outcome::UnreachableTask, 1);
    assert_eq!(mission.last().serviced.len(), 1);
    assert!(!mission.events().any(|(_, event)| *event == Event::TaskAnnounced { task: 2 }));
}

#[test]
fn two_tasks_in_one_place_are_both_serviced() {
    let mut scenario = room([1.5, 0.5]);
    scenario.task.push(scenario.task[0]);
    run(scenario).assert_serviced();
}

#[test]
fn a_mission_without_tasks_is_over() {
    let mut scenario = room([0.0, 0.0]);
    scenario.task.clear();
    let mission = run(scenario);
    mission.assert_serviced();
    assert!(mission.periods.len() < 20);
}

// ---- Robots and time ---------------------------------------------------------------------------

#[test]
fn too_few_robots_are_told_how_many_are_missing() {
    for robots in 1..=3 {
        let mut scenario = room([1.9, 0.2]);
        scenario.robot.truncate(robots);
        let mission = run(scenario);
        assert_unserviced(&mission, Outcome::InsufficientRobots, 0);
        assert!(mission.end.reason.contains("more robot"), "{}", mission.end.reason);
    }
}

/// Each robot more goes farther; as many as it takes service the task.
#[test]
fn enough_robots_are_enough() {
    run(room([1.9, 0.2])).assert_serviced();
}

#[test]
fn a_mission_takes_no_more_control_periods_than_allowed() {
    for limit in [1, 2, 37] {
        let mut scenario = room([1.9, 0.2]);
        scenario.control.max_steps = Some(limit);
        let mission = run(scenario);
        assert_eq!(mission.end.outcome, Outcome::StepLimit);
        assert_eq!(mission.periods.len(), limit);
        assert!(mission.end.reason.contains(&limit.to_string()), "{}", mission.end.reason);
    }
}

// ---- The monitor -------------------------------------------------------------------------------

/// The radio stops for one robot: what others have granted it counts as inflow although it does not
/// send all of it, so that their accounts are not those of the routes.
#[test]
fn the_monitor_stops_a_mission_at_the_first_violation() {
    let (muted, from) = (0, 20);
    let mutes = |Arrival { period, sender, receiver, .. }: Arrival| {
        period >= from && [sender, receiver].contains(&muted)
    };
    let (mission, _) = run_over(room([1.9, 0.2]), |site| Filtered::new(site, mutes));
    assert_eq!(mission.end.outcome, Outcome::InvariantViolated);
    assert_eq!(mission.last().step, from);
    let reason = &mission.end.reason;
    for said in ["accounting", "step 20", "t = 20.000 s", "robot 3"] {
        assert!(reason.contains(said), "{said}: {reason}");
    }
}

// ---- The program -------------------------------------------------------------------------------

fn pleach(scenario: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pleach"))
        .args(["run", "--no-figures", "--quiet"])
        .arg(scenario)
        .output()
        .expect("the program starts")
}

/// Exit status 4 is tested where outcomes become statuses: no scenario violates an invariant.
#[test]
fn the_program_tells_outcomes_by_its_exit_status() {
    let hasty = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hasty.toml");
    let mut scenario = shipped("redundant-node");
    scenario.control.max_steps = Some(3);
    std::fs::write(&hasty, toml::to_string(&scenario).unwrap()).unwrap();
    let expected = [
        (Path::new("scenarios/redundant-node.toml"), 0, "serviced"),
        (Path::new("tests/scenarios/faulty/empty.toml"), 2, ""),
        (
            Path::new("scenarios/too-few.toml"),
            3,
            "insufficient robots: of 3 tasks 1 are serviced; no robot could service tasks 1 and 2",
        ),
        (Path::new("scenarios/unreachable.toml"), 3, "unreachable task: "),
        (&hasty, 3, "step limit: "),
        // Five robots of rate 0.27: one relay cannot carry the traffic of all.
        (
            Path::new("tests/scenarios/saturated.toml"),
            3,
            "blocked: the rates cannot be carried to task 0: the primary team stands still because the links of \
             robot 4 carry no more, and no robot is left that can come; the load is 1.000 at robot",
        ),
    ];
    for (scenario, status, outcome) in expected {
        let output = pleach(scenario);
        assert_eq!(output.status.code(), Some(status), "{}", scenario.display());
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(said.contains(outcome), "{said}");
    }
}

/// The link model is one that the scenario names, for robots and monitor alike.
#[test]
fn a_mission_with_logistic_links_is_serviced() {
    let mut scenario = shipped("too-few");
    scenario.task.truncate(1);
    (scenario.link.model, scenario.link.steepness) = (LinkModel::Logistic, Some(3.0));
    let mission = run(scenario);
    let is_in_transition = |route: &&Route| (0.01..0.99).contains(&route.reliability);
    let periods = mission.periods.iter().flat_map(|period| &period.snapshot.routes);
    assert!(periods.filter(is_in_transition).count() > 10, "links of the tested kind are used");
    mission.assert_serviced();
}
