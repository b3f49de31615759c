//! A mission that only pretends: two robots and a leader's tale, for those who watch missions.

#![allow(dead_code)] // not every test needs everything

use pleach::automaton::network::record::{
    End, MissionEvent, Outcome, PostView, RobotSnapshot, Route, Snapshot,
};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::discrete::network::{Activity, ExchangeStage, Phase, Role};
use pleach::mission::Watcher;
use std::path::Path;

/// What a control period shows.
pub struct Report {
    pub events: Vec<MissionEvent>,
    pub snapshot: Snapshot,
}

/// Shows the pretended mission, in which robot 1 walks by robot 0 and services the task.
pub fn show(watcher: &mut dyn Watcher) {
    for Report { events, snapshot } in reports() {
        watcher.observe(&snapshot, &events).expect("a watcher that can write");
    }
    watcher.end(&end()).expect("a watcher that can write");
}

/// How the pretended mission ends.
pub fn end() -> End {
    End::new(Outcome::Serviced, String::new(), None)
}

/// The scenario that the pretended mission belongs to.
pub fn room() -> ValidScenario {
    pleach::scenario_file::read(Path::new("tests/scenarios/room.toml")).expect("a valid scenario")
}

/// Everything that the pretended mission reports.
pub fn reports() -> Vec<Report> {
    let places = [[0.6, 0.5], [0.4, 0.4], [0.1 + 0.2, 1.0 / 3.0]];
    let events = [
        vec![
            MissionEvent::TaskAnnounced { task: 0 },
            MissionEvent::LeaderElected { task: 0, robot: 1, conflict: false },
            MissionEvent::RoleChanged { robot: 1, from: Role::Redundant, to: Role::Leader },
        ],
        vec![
            MissionEvent::Stationary { robot: 1, team: vec![1] },
            MissionEvent::RecruitElected { robot: 0, path: vec![0, 1], break_points: vec![0] },
        ],
        vec![MissionEvent::TaskServiced { task: 0, robot: 1 }],
    ];
    (places.into_iter().zip(events).enumerate())
        .map(|(step, (place, events))| Report { events, snapshot: snapshot(step, place) })
        .collect()
}

fn snapshot(step: usize, place: [f64; 2]) -> Snapshot {
    Snapshot {
        step,
        time: step as f64,
        positions: vec![[0.4, 0.5].into(), place.into()],
        roles: vec![Role::Redundant, Role::Leader],
        phase: Phase::Advance,
        active: vec![1],
        active_team: vec![1],
        primary_team: vec![1],
        path: vec![],
        residuals: vec![0.02, 0.02 - 0.001 * step as f64],
        multipliers: vec![0.0, 1e-7],
        routes: vec![Route { from: 1, to: 0, share: 0.095, reliability: 1.0 }],
        tree: vec![(0, 2), (1, 0)],
        task: Some(0),
        serviced: if step == 2 { vec![(0, 1)] } else { vec![] },
        closed: Vec::new(),
        posts: vec![PostView {
            reference: [0.4, 0.5].into(),
            holder: 0,
            task: None,
            junction: false,
        }],
        robots: vec![
            RobotSnapshot {
                activity: Activity::Relay,
                exchange: ExchangeStage::Free,
                phase: Phase::Advance,
                target: None,
                sent: 12,
                heard: 9,
            },
            RobotSnapshot {
                activity: Activity::Leading,
                exchange: ExchangeStage::Offering,
                phase: Phase::Advance,
                target: Some([0.9, 0.25].into()),
                sent: 14,
                heard: 8,
            },
        ],
        absent: vec![],
        fleets: vec![],
    }
}

/// One event of each kind.
pub fn every_event() -> Vec<MissionEvent> {
    let mut events = vec![
        MissionEvent::TaskAnnounced { task: 0 },
        MissionEvent::LeaderElected { task: 0, robot: 5, conflict: false },
        MissionEvent::LeaderElected { task: 0, robot: 5, conflict: true },
        MissionEvent::Stationary { robot: 4, team: vec![4, 5] },
        MissionEvent::RecruitCalled { robot: 4 },
        MissionEvent::CalledInVain { robot: 4 },
        MissionEvent::LinksStretched { robot: 4 },
        MissionEvent::RecruitElected { robot: 1, path: vec![1, 2, 3], break_points: vec![1, 3] },
        MissionEvent::SubgroupStarted { subgroup: 0, robots: vec![1, 2] },
        MissionEvent::SubgroupArrived { subgroup: 0, robots: vec![1, 2] },
        MissionEvent::JoinedPrimary { robot: 3, team: vec![3, 4, 5] },
        MissionEvent::Released { robot: 5 },
        MissionEvent::TaskServiced { task: 0, robot: 5 },
        MissionEvent::RouteInfeasible { robot: 2 },
        MissionEvent::DutiesExchanged { mover: 1, parked: 2 },
        MissionEvent::Reattached { robot: 3, parent: 7 },
        MissionEvent::ElectionRepeated { task: 0 },
        MissionEvent::TaskReannounced { task: 0, gone: vec![2, 3], joined: vec![] },
        MissionEvent::TaskReannounced { task: 0, gone: vec![], joined: vec![1] },
        MissionEvent::TaskEnded { task: 0 },
        MissionEvent::TaskWithdrawn { task: 1 },
        MissionEvent::TaskGivenUp {
            task: 1,
            outcome: Outcome::Blocked,
            reason: "robot 3 is in the way".to_owned(),
            certificate: None,
        },
    ];
    events.extend(
        (Role::ALL.into_iter().zip(Role::ALL.into_iter().skip(1)))
            .map(|(from, to)| MissionEvent::RoleChanged { robot: 0, from, to }),
    );
    events
}
