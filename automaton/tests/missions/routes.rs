//! Robots that nobody asks for anything stand still and route, and find the best routes by each method.

use std::ops::ControlFlow;
use std::sync::Arc;

use pleach_automaton::network::record::{End, Snapshot};
use pleach_automaton::network::scenario::{RoutingMethod, Scenario};
use pleach_automaton::network::{Message, Network, Radio, Site};
use pleach_automaton::node::{Delivery, Envelope, Medium};
use pleach_automaton::{Executor, HybridTime, Observer};
use pleach_continuous::Point;
use serde_json::json;

use super::JUMPS_PER_PERIOD;
use super::best_routes::BestRoutes;

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

/// The routes of all control periods, and the best ones.
fn routes(scenario: &Scenario, periods: f64) -> (Vec<Snapshot>, BestRoutes) {
    let site = Arc::new(Site::new(scenario).expect("its numbers make sense"));
    let medium = WithoutUser(Radio::new(&site), site.nodes());
    let mut network =
        Network::with_medium(scenario, Arc::clone(&site), medium).expect("it can begin");
    let executor = Executor::new(periods, JUMPS_PER_PERIOD).expect("there is time");
    let mut recorder = Recorder::default();
    executor.run(&mut network, &mut recorder).expect("robots go on");
    (recorder.0, BestRoutes::of(scenario, &site))
}

fn assert_routes_are_best(method: RoutingMethod, periods: f64) {
    let (snapshots, best) = routes(&scenario(method), periods);
    snapshots.iter().for_each(|snapshot| best.assert_feasible(snapshot));
    let last = snapshots.last().expect("there is time");
    best.assert_optimal(last);
    best.assert_multipliers(last);
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
