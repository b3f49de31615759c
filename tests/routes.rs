//! The routes that robots find themselves, over their own messages, against clarabel: feasible in
//! every control period, and optimal once they have converged.

use crate::best_routes::BestRoutes;
use missions::floor_plans::Dice;
use missions::{Filtered, network_over, run_unmonitored, valid};
use pleach::automaton::network::Site;
use pleach::automaton::network::record::Snapshot;
use pleach::automaton::network::scenario::{
    AccessPoint, Agenda, Control, LinkRanges, RobotStart, RoutingMethod, Scenario, Task,
    WorkspaceOutline,
};
use std::f64::consts::TAU;

/// The control periods in which routes converge at the number of iterations below.
const PERIODS: usize = 300;
const ITERATIONS: usize = 20;
const SCENARIOS: u64 = 4;
const ROBOTS: usize = 10;

/// A mission whose request never arrives: the robots stand where they start, and route.
fn routes_of(scenario: &Scenario) -> Vec<Snapshot> {
    let user = scenario.robot.len() + scenario.access_point.len();
    let mut network = network_over(scenario, |site: &Site| {
        Filtered::new(site, move |arrival| arrival.sender == user)
    });
    let (periods, end) = run_unmonitored(&mut network, PERIODS);
    assert!(end.is_none(), "{}: nothing is to be done", scenario.name);
    periods.into_iter().map(|period| period.snapshot).collect()
}

/// Robots that are scattered around an access point, each within reach of one before it.
fn scattered(seed: u64) -> Scenario {
    let mut dice = Dice::new(&[seed]);
    let mut places = vec![[1.2, 0.8]];
    while places.len() <= ROBOTS {
        let [x, y] = dice.pick(&places);
        let (angle, away) = (dice.between(0.0, TAU), dice.between(0.2, 0.36));
        let place = [x + away * angle.cos(), y + away * angle.sin()];
        let is_free = |other: &[f64; 2]| (place[0] - other[0]).hypot(place[1] - other[1]) > 0.15;
        let is_inside = (0.1..2.3).contains(&place[0]) && (0.1..1.5).contains(&place[1]);
        if is_inside && places.iter().all(is_free) {
            places.push(place);
        }
    }
    let robots = places[1..].iter().map(|position| RobotStart::at(*position, 0.02));
    Scenario {
        name: format!("scattered-{seed}"),
        description: None,
        workspace: WorkspaceOutline {
            boundary: vec![[0.0, 0.0], [2.4, 0.0], [2.4, 1.6], [0.0, 1.6]],
            holes: Vec::new(),
        },
        link: LinkRanges::new(0.3, 0.6),
        control: Control::default(),
        mission: Agenda::default(),
        access_point: vec![AccessPoint { position: places[0] }],
        robot: robots.collect(),
        task: vec![Task::at([0.5, 0.5])],
    }
}

#[test]
fn robots_find_the_routes_that_clarabel_finds_and_always_carry_their_rates() {
    for method in [RoutingMethod::Dual, RoutingMethod::AcceleratedDual, RoutingMethod::Adal] {
        for seed in 0..SCENARIOS {
            let mut scenario = valid(scattered(seed)).into_scenario();
            scenario.control.routing_method = Some(method);
            scenario.control.routing_iterations = Some(ITERATIONS);
            let best = BestRoutes::of(&scenario, &Site::new(&scenario).unwrap());
            let snapshots = routes_of(&scenario);
            snapshots.iter().for_each(|snapshot| best.assert_feasible(snapshot));
            let last = snapshots.last().unwrap();
            best.assert_optimal(last);
            best.assert_multipliers(last);
        }
    }
}

/// Two robots that need each other but little: one has a little more to send than the other.
fn alike(more: f64) -> Scenario {
    let mut scenario = scattered(0);
    scenario.robot =
        vec![RobotStart::at([1.0, 1.0], 0.02 + more), RobotStart::at([1.4, 1.0], 0.02)];
    scenario
}

/// However little goes over a link, it neither comes and goes nor keeps the others from coming to rest.
#[test]
fn routes_that_have_converged_change_no_more() {
    for more in [1e-6, 1e-5, 2e-5, 3e-5, 1e-4, 1e-3] {
        let snapshots = routes_of(&alike(more));
        let [.., before, last] = &snapshots[..] else { panic!("{PERIODS} control periods") };
        assert_eq!(before.multipliers, last.multipliers, "{more} more to send");
    }
}
