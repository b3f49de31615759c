//! Robots that nobody asks for anything stand still and route: their flows against clarabel, which solves
//! the same problem (6) for all of them at once.

use std::ops::ControlFlow;
use std::sync::Arc;

use pleach_automaton::network::record::{End, Snapshot};
use pleach_automaton::network::scenario::{RoutingMethod, Scenario};
use pleach_automaton::network::{Message, Network, Radio, Site};
use pleach_automaton::node::{Delivery, Envelope, Medium};
use pleach_automaton::{Executor, HybridTime, Observer};
use pleach_continuous::Point;
use pleach_continuous::network::rates::Receiver;
use pleach_continuous::network::routing::central::solve_central;
use pleach_continuous::network::routing::problem::{DirectedLink, RoutingProblem};
use serde_json::json;

use super::JUMPS_PER_PERIOD;

/// Links with less reliability carry nothing, unless they belong to the tree.
const LEAST_USEFUL_RELIABILITY: f64 = 0.3;
/// What robots count as rounding.
const ROUNDING: f64 = 1e-9;
/// By how much Σ w T² may exceed its least value: robots leave out shares below 10⁻⁶.
const EXCESS: f64 = 1e-6;

/// A radio over which the user is not heard.
struct WithoutUser(Radio, usize);

impl Medium<Message, Point> for WithoutUser {
    fn update(&mut self, bodies: &[Point]) {
        self.0.update(bodies);
    }

    fn send(&mut self, envelope: Envelope<Message>) {
        if envelope.from != self.1 {
            self.0.send(envelope);
        }
    }

    fn time_to_arrival(&self) -> Option<f64> {
        self.0.time_to_arrival()
    }

    fn flow(&mut self, duration: f64) {
        self.0.flow(duration);
    }

    fn deliver<E>(
        &mut self,
        hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.0.deliver(hand_over)
    }
}

#[derive(Default)]
struct Recorder(Vec<Snapshot>);

impl<M: Medium<Message, Point>> Observer<Network<M>> for Recorder {
    const SEES_JUMPS: bool = false;

    fn flows(&mut self, network: &Network<M>, _: HybridTime, _: f64) -> ControlFlow<End> {
        self.0.push(network.snapshot());
        ControlFlow::Continue(())
    }
}

/// Seven robots around an access point; three of them do not reach it, and its neighbours forward for them
/// over links of different reliabilities.
fn scenario(method: RoutingMethod) -> Scenario {
    let places = [
        [1.20, 0.45],
        [0.90, 0.60],
        [1.45, 0.95],
        [0.95, 1.05],
        [0.60, 0.80],
        [1.75, 0.80],
        [1.20, 1.35],
    ];
    let robots = places.map(|position| json!({"position": position, "rate": 0.04}));
    let mut scenario: Scenario = serde_json::from_value(json!({
        "name": "star",
        "workspace": {"boundary": [[0.0, 0.0], [2.4, 0.0], [2.4, 1.6], [0.0, 1.6]]},
        "link": {"full_range": 0.3, "max_range": 0.6},
        "control": {"routing_iterations": 20},
        "access_point": [{"position": [1.2, 0.8]}],
        "robot": robots,
        "task": [{"position": [0.5, 0.5]}],
    }))
    .expect("it is a scenario");
    scenario.control.routing_method = Some(method);
    scenario
}

fn snapshots(scenario: &Scenario, periods: f64) -> (Vec<Snapshot>, RoutingProblem) {
    let site = Arc::new(Site::new(scenario).expect("its numbers make sense"));
    let user = site.robots + site.access_points.len();
    let medium = WithoutUser(Radio::new(&site), user);
    let mut network =
        Network::with_medium(scenario, Arc::clone(&site), medium).expect("it can begin");
    let executor = Executor::new(periods, JUMPS_PER_PERIOD).expect("there is time");
    let mut recorder = Recorder::default();
    executor.run(&mut network, &mut recorder).expect("robots go on");
    let robots: Vec<Point> = scenario.robot.iter().map(|robot| robot.position.into()).collect();
    let rates: Vec<f64> = scenario.robot.iter().map(|robot| robot.rate).collect();
    let (aversion, reserve) = (site.settings.slope_aversion, site.settings.routing_reserve);
    let access = &site.access_points;
    let all = RoutingProblem::of_places(&robots, access, &rates, &site.link, aversion, reserve);
    let useful = |link: &&DirectedLink| link.reliability >= LEAST_USEFUL_RELIABILITY;
    let links = all.expect("rates are numbers").links().iter().filter(useful).copied().collect();
    (recorder.0, RoutingProblem::new(links, rates, reserve).expect("links are between nodes"))
}

/// T of each link of the problem.
fn shares(problem: &RoutingProblem, snapshot: &Snapshot) -> Vec<f64> {
    let node = |receiver| match receiver {
        Receiver::Robot(robot) => robot,
        Receiver::AccessPoint(number) => problem.robots() + number,
    };
    let share_of = |link: &DirectedLink| {
        let ends = (link.sender, node(link.receiver));
        let route = snapshot.routes.iter().find(|route| (route.from, route.to) == ends);
        route.map_or(0.0, |route| route.share)
    };
    problem.links().iter().map(share_of).collect()
}

fn assert_routes_are_best(method: RoutingMethod, periods: f64) {
    let (snapshots, problem) = snapshots(&scenario(method), periods);
    for snapshot in &snapshots {
        let (k, shares) = (snapshot.step, shares(&problem, snapshot));
        for (robot, (residual, told)) in
            problem.residuals(&shares).into_iter().zip(&snapshot.residuals).enumerate()
        {
            assert!(residual >= -ROUNDING, "k = {k}: c of robot {robot} is {residual}");
            assert!((residual - told).abs() < ROUNDING, "k = {k}: {robot} takes c for {told}");
        }
        assert!(problem.used_time(&shares).iter().all(|load| *load <= 1.0), "k = {k}: overloaded");
    }
    let best = solve_central(&problem).expect("links carry the rates");
    let last = snapshots.last().expect("there is time");
    let found = shares(&problem, last);
    let excess = problem.objective(&found) - best.objective;
    assert!(excess.abs() <= EXCESS, "{method:?}: Σ w T² exceeds its least value by {excess:e}");
    for ((share, expected), link) in found.iter().zip(&best.shares).zip(problem.links()) {
        assert!((share - expected).abs() <= EXCESS.sqrt(), "{link:?}: {share}, not {expected}");
    }
    for (robot, (found, expected)) in last.multipliers.iter().zip(&best.multipliers).enumerate() {
        assert!(
            (found - expected).abs() < 1e-2 * expected.abs().max(1.0),
            "λ of robot {robot} is {found}, not {expected}"
        );
    }
}

#[test]
fn the_dual_iteration_finds_the_best_routes() {
    assert_routes_are_best(RoutingMethod::Dual, 300.0);
}

#[test]
fn the_accelerated_iteration_finds_the_best_routes_in_a_third_of_the_time() {
    assert_routes_are_best(RoutingMethod::AcceleratedDual, 100.0);
}

#[test]
fn adal_finds_the_best_routes() {
    assert_routes_are_best(RoutingMethod::Adal, 150.0);
}
