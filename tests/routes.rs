//! The routes that robots find themselves, over their own messages, against clarabel: feasible in
//! every control period, and optimal once they have converged.
//!
//! *Tolerances.* A robot leaves out shares below 10⁻⁶, and regards residuals as met up to 10⁻⁹. What it
//! leaves out goes over other links, whose price is the same at the optimum, so that Σ w T² changes in
//! second order only. Σ w T² is strongly convex with modulus 2 w ≥ 2: where it exceeds its least value
//! by ε, no share is off by more than √ε.

use crate::floor_plans::Dice;
use crate::missions::{Filtered, network_over, run_unmonitored, valid};
use pleach::automaton::network::Site;
use pleach::automaton::network::record::{Route, Snapshot};
use pleach::automaton::network::scenario::{
    AccessPoint, Control, LinkRanges, RobotStart, RoutingMethod, Scenario, Task, WorkspaceOutline,
};
use pleach::continuous::Point;
use pleach::continuous::network::rates::Receiver;
use pleach::continuous::network::routing::central::{CentralRouting, solve_central};
use pleach::continuous::network::routing::problem::{DirectedLink, RoutingProblem};
use std::f64::consts::TAU;

/// By how much Σ w T² may exceed what clarabel finds.
const EXCESS: f64 = 1e-6;
/// What robots count as rounding.
const ROUNDING: f64 = 1e-9;
/// Links with less reliability carry nothing, unless they belong to the tree.
const LEAST_USEFUL_RELIABILITY: f64 = 0.3;
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

/// Problem (6) over the links that robots use.
fn problem(scenario: &Scenario) -> RoutingProblem {
    let site = Site::new(scenario).unwrap();
    let robots: Vec<Point> = scenario.robot.iter().map(|robot| robot.position.into()).collect();
    let rates: Vec<f64> = scenario.robot.iter().map(|robot| robot.rate).collect();
    let (aversion, reserve) = (site.settings.slope_aversion, site.settings.routing_reserve);
    let all = &site.access_points;
    let all = RoutingProblem::of_places(&robots, all, &rates, &site.link, aversion, reserve);
    let useful = |link: &&DirectedLink| link.reliability >= LEAST_USEFUL_RELIABILITY;
    let links = all.unwrap().links().iter().filter(useful).copied().collect();
    RoutingProblem::new(links, rates, reserve).unwrap()
}

/// T of each link of the problem.
fn shares(problem: &RoutingProblem, snapshot: &Snapshot) -> Vec<f64> {
    let node = |receiver| match receiver {
        Receiver::Robot(robot) => robot,
        Receiver::AccessPoint(number) => problem.robots() + number,
    };
    let share_of = |link: &DirectedLink| {
        let is_it = |route: &&Route| (route.from, route.to) == (link.sender, node(link.receiver));
        snapshot.routes.iter().find(is_it).map_or(0.0, |route| route.share)
    };
    let shares: Vec<f64> = problem.links().iter().map(share_of).collect();
    let used = shares.iter().filter(|share| **share > 0.0).count();
    assert_eq!(used, snapshot.routes.len(), "robots use links that they should not");
    shares
}

/// Whether rates are carried, and nobody sends for more than all of its time.
fn assert_feasible(problem: &RoutingProblem, shares: &[f64], k: usize, name: &str) {
    for (robot, residual) in problem.residuals(shares).into_iter().enumerate() {
        assert!(
            residual >= -ROUNDING,
            "{name}, k = {k}: robot {robot} has a residual of {residual}"
        );
    }
    for (robot, used) in problem.used_time(shares).into_iter().enumerate() {
        assert!(used <= 1.0, "{name}, k = {k}: robot {robot} sends for {used} of its time");
    }
    assert!(shares.iter().all(|share| *share >= 0.0), "{name}, k = {k}");
}

fn assert_optimal(problem: &RoutingProblem, shares: &[f64], optimum: &CentralRouting, name: &str) {
    let excess = problem.objective(shares) - optimum.objective;
    println!("{name}: {} exceeded by {excess:e}", optimum.objective);
    assert!(excess.abs() <= EXCESS, "{name}: {} exceeded by {excess}", optimum.objective);
    for (share, expected) in shares.iter().zip(&optimum.shares) {
        assert!((share - expected).abs() <= EXCESS.sqrt(), "{name}: {share}, not {expected}");
    }
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
    let robots = places[1..].iter().map(|position| RobotStart { position: *position, rate: 0.02 });
    Scenario {
        name: format!("scattered-{seed}"),
        description: None,
        workspace: WorkspaceOutline {
            boundary: vec![[0.0, 0.0], [2.4, 0.0], [2.4, 1.6], [0.0, 1.6]],
            holes: Vec::new(),
        },
        link: LinkRanges::new(0.3, 0.6),
        control: Control::default(),
        access_point: vec![AccessPoint { position: places[0] }],
        robot: robots.collect(),
        task: vec![Task { position: [0.5, 0.5] }],
    }
}

#[test]
fn robots_find_the_routes_that_clarabel_finds_and_always_carry_their_rates() {
    for method in [RoutingMethod::Dual, RoutingMethod::AcceleratedDual, RoutingMethod::Adal] {
        for seed in 0..SCENARIOS {
            let mut scenario = valid(scattered(seed)).into_scenario();
            scenario.control.routing_method = Some(method);
            scenario.control.routing_iterations = Some(ITERATIONS);
            let problem = problem(&scenario);
            let optimum = solve_central(&problem).unwrap();
            let name = format!("{}, {method:?}", scenario.name);
            let snapshots = routes_of(&scenario);
            for (k, snapshot) in snapshots.iter().enumerate() {
                assert_feasible(&problem, &shares(&problem, snapshot), k, &name);
            }
            let last = shares(&problem, snapshots.last().unwrap());
            assert_optimal(&problem, &last, &optimum, &name);
        }
    }
}
