//! A small sound mission that the tests spoil in one place each.
//!
//! One access point (node 4) at the origin; robots 0 to 3 in a corridor 3 long. Robot 0
//! services task 0 and holds a junction; robot 1 is the leader, alone in the primary team.
//! Robot 2 is redundant; robot 3, a node, is on its way.

use nalgebra::point;
use pleach_automaton::network::record::{PostView, Route, Snapshot};
use pleach_automaton::network::scenario::{
    AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Task, ValidScenario,
    WorkspaceOutline,
};
use pleach_discrete::network::{Phase, Role};

use super::link::{NodePositions, reliability, residuals};

pub(super) const RATE: f64 = 0.075;

pub(super) fn scenario() -> ValidScenario {
    valid(stated())
}

/// A scenario that tests have changed.
pub(super) fn valid(scenario: Scenario) -> ValidScenario {
    ValidScenario::new(scenario).unwrap_or_else(|error| panic!("{error}"))
}

/// The scenario, to be changed.
pub(super) fn stated() -> Scenario {
    let robots = [[0.3, 0.0], [0.6, 0.0], [0.1, 0.2], [0.2, -0.2]];
    Scenario {
        name: "sample".to_owned(),
        description: None,
        workspace: WorkspaceOutline {
            boundary: vec![[-1.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-1.0, 1.0]],
            holes: Vec::new(),
        },
        link: LinkRanges::new(0.4, 0.5),
        control: Control::default(),
        mission: Agenda::default(),
        access_point: vec![AccessPoint { position: [0.0, 0.0] }],
        robot: robots.into_iter().map(|position| RobotStart::at(position, RATE)).collect(),
        task: vec![Task::at([0.3, 0.02]), Task::at([1.5, 0.0])],
    }
}

/// Every transition but those out of a leaf other than to leader, and back to recruit.
pub(super) fn role_table(from: Role, to: Role) -> bool {
    match from {
        Role::Leaf => to == Role::Leader,
        Role::Leader => to == Role::Leaf,
        Role::Redundant => to != Role::Redundant,
        _ => to != Role::Recruit,
    }
}

/// The sound snapshot of step k: robot 1 moves right by 0.01 a step, robot 3 up.
pub(super) fn snapshot(step: usize) -> Snapshot {
    let advance = 0.01 * step as f64;
    let positions = vec![
        point![0.3, 0.0],
        point![0.6 + advance, 0.0],
        point![0.1, 0.2],
        point![0.2, -0.2 + advance],
    ];
    let mut snapshot = Snapshot {
        step,
        time: step as f64,
        positions,
        roles: vec![Role::Leaf, Role::Leader, Role::Redundant, Role::Node],
        phase: Phase::Advance,
        active: vec![1, 3],
        active_team: vec![1],
        primary_team: vec![1],
        path: Vec::new(),
        residuals: Vec::new(),
        multipliers: vec![0.0; 4],
        routes: Vec::new(),
        tree: vec![(0, 4), (1, 0), (2, 4), (3, 4)],
        task: Some(1),
        serviced: vec![(0, 0)],
        closed: Vec::new(),
        posts: vec![
            PostView { reference: point![0.3, 0.01], holder: 0, task: Some(0), junction: true },
            PostView { reference: point![0.2, 0.2], holder: 3, task: None, junction: false },
        ],
        robots: Vec::new(),
        absent: Vec::new(),
        fleets: Vec::new(),
    };
    route(&mut snapshot, &[(0, 4, 0.3), (1, 0, 0.15), (2, 4, 0.1), (3, 4, 0.1)]);
    snapshot
}

/// Replaces the routes (from, to, share), with reliabilities and residuals that agree.
pub(super) fn route(snapshot: &mut Snapshot, shares: &[(usize, usize, f64)]) {
    let access_points = [point![0.0, 0.0]];
    let places = NodePositions { robots: &snapshot.positions, access_points: &access_points };
    let routes = shares.iter().map(|&(from, to, share)| {
        let reliability = reliability(places.distance(from, to), 0.4, 0.5);
        Route { from, to, share, reliability }
    });
    let routes: Vec<_> = routes.collect();
    snapshot.residuals = residuals(&routes, &[RATE; 4]);
    snapshot.routes = routes;
}
