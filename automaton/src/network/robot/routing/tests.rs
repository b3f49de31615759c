//! Which links a robot may use, how its iteration runs, and what its sweep sends: routing alone.

use std::sync::Arc;

use pleach_continuous::network::LinkReliability as _;

use super::*;
use crate::network::message::Message;
use crate::network::robot::rounds::Rounds;
use crate::network::robot::tests::{NOW, ROBOTS, hall, sent};
use crate::network::site::Site;
use crate::node::Destination;

const RATE: f64 = 0.1;

/// The routing of robot 0, and what it is given in each step.
#[derive(Clone)]
struct Alone {
    routing: Routing,
    site: Arc<Site>,
}

/// A neighbour at this distance, with R_ij of there.
fn receiver(site: &Site, node: NodeId, distance: f64) -> Receiver {
    let reliability = site.link.reliability(distance);
    Receiver { node, distance, reliability, in_tree: false, has_flow: false }
}

impl Alone {
    /// Without links.
    fn new() -> Self {
        let site = Arc::new(Site::new(&hall()).expect("its numbers make sense"));
        Alone { routing: Routing::new(site.settings.routing_method, RATE), site }
    }

    /// With links to the access point, 1.2 away, and to robot 5, 1.0 away.
    fn router() -> Self {
        let mut alone = Self::new();
        let receivers = [(5, 1.0), (ROBOTS, 1.2)];
        let receivers = receivers.map(|(node, away)| receiver(&alone.site, node, away)).to_vec();
        alone.finds(Survey { parent: Some(ROBOTS), receivers });
        alone
    }

    /// Below robot 5, 1.0 away, with two children.
    fn below_another() -> Self {
        let mut alone = Self::new();
        let receivers = [1, 2, 5].map(|node| receiver(&alone.site, node, 1.0)).to_vec();
        alone.finds(Survey { parent: Some(5), receivers });
        alone
    }

    fn finds(&mut self, survey: Survey) {
        self.step(|routing, context, _| routing.find_links(context, &survey, Revision::FIRST));
        self.routing.begin_period();
    }

    /// A step of the routing, with what it sends.
    fn step(
        &mut self,
        step: impl FnOnce(&mut Routing, Context<'_>, &mut NodeOutputs),
    ) -> Vec<(Destination, Message)> {
        let (mut outputs, rounds) = (NodeOutputs::of(0), Rounds::default());
        let context = Context { id: 0, site: &self.site, rate: RATE, period: NOW, rounds };
        step(&mut self.routing, context, &mut outputs);
        sent(&mut outputs)
    }

    fn receives_report(&mut self, from: NodeId, multiplier: f64, parent: Option<NodeId>) {
        let report = NeighbourReport { multiplier, mismatch: 0.0, crowding: 1.0 };
        self.step(|routing, context, _| routing.receive_report(context, from, report, parent));
    }

    fn primal_step(&mut self) {
        self.step(|routing, context, _| routing.primal_step(context));
    }

    fn dual_step(&mut self) {
        self.step(|routing, context, _| routing.dual_step(context));
    }

    fn sends_flows(&mut self) -> usize {
        self.step(Routing::send_flows).len()
    }

    fn receives_demand(&mut self, from: NodeId, more: f64) -> Vec<(Destination, Message)> {
        self.step(|routing, context, outputs| {
            routing.receive_demand(context, from, more, outputs);
        })
    }

    fn shares(&self) -> Vec<f64> {
        self.routing.links().iter().map(|link| link.share).collect()
    }

    fn flows(&self) -> Vec<f64> {
        self.routing.links().iter().map(RouteLink::flow).collect()
    }
}

/// The only link of a robot to a neighbour at this distance.
fn link(away: f64, in_tree: bool, has_flow: bool) -> (Alone, Option<RouteLink>) {
    let mut alone = Alone::new();
    let receivers = vec![Receiver { in_tree, has_flow, ..receiver(&alone.site, 5, away) }];
    alone.finds(Survey { parent: None, receivers });
    let link = alone.routing.links().first().copied();
    (alone, link)
}

/// Where a link is just reliable enough.
fn limit() -> f64 {
    Alone::new().site.link.distance_at(0.3)
}

/// A link that a step of both ends could break carries nothing unless it belongs to the tree; one with a flow
/// stays until that has ended.
#[test]
fn links_are_those_that_are_reliable_enough_or_of_the_tree() {
    let limit = limit();
    let is_link = |away, in_tree, has_flow| link(away, in_tree, has_flow).1.is_some();
    assert!(is_link(limit - 1e-3, false, false));
    assert!(!is_link(limit + 1e-3, false, false));
    assert!(is_link(limit + 1e-3, true, false), "a link of the tree");
    assert!(is_link(limit + 1e-3, false, true), "its flow has to end first");
    assert!(!is_link(2.0, false, true), "no packets get there");
}

#[test]
fn nothing_is_planned_over_a_link_that_is_retiring() {
    let planned = |away: f64| {
        let (mut alone, _) = link(away, false, true);
        (0..20).for_each(|_| alone.dual_step());
        alone.primal_step();
        (alone.shares()[0] > 0.0, alone.routing.has_links_of(Revision::FIRST))
    };
    assert_eq!(planned(limit() - 1e-3), (true, true));
    assert_eq!(planned(limit() + 1e-3), (false, false), "it is looked for again");
}

/// A control period begins with the shares that the routing method left, and with the reports received before.
#[test]
fn links_that_are_found_again_are_known() {
    let mut alone = Alone::router();
    alone.receives_report(5, 1.0, None);
    (0..20).for_each(|_| alone.dual_step());
    alone.primal_step();
    let (shares, reports) = (alone.shares(), alone.routing.links.offers());
    assert!(shares.iter().any(|&share| share > 0.0) && reports[0].neighbour_multiplier == 1.0);
    alone.step(|routing, _, _| routing.links.scale(0.5));
    let receivers = [(5, 1.0), (ROBOTS, 1.2)];
    let receivers = receivers.map(|(node, away)| receiver(&alone.site, node, away)).to_vec();
    let survey = Survey { parent: Some(ROBOTS), receivers };
    alone.step(|routing, context, _| assert!(routing.would_find(context, &survey)));
    alone.finds(survey);
    assert_eq!((alone.shares(), alone.routing.links.offers()), (shares, reports));
}

/// λ and what its neighbours report: the accelerated iteration goes where c = η.
#[test]
fn a_multiplier_rises_while_less_leaves_than_comes_in() {
    let mut alone = Alone::router();
    assert_eq!(alone.routing.multiplier(), 0.0);
    alone.dual_step();
    assert!(alone.routing.multiplier() > 0.0, "nothing leaves yet");
    let before = alone.routing.multiplier();
    alone.primal_step();
    assert!(alone.shares()[1] > 0.0, "it sends to the access point, whose multiplier is 0");
    alone.routing.receive_flow(5, 0.3);
    alone.dual_step();
    assert!(alone.routing.multiplier() > before);
    alone.routing.receive_flow(5, 0.2);
    alone.step(|routing, context, _| routing.settle_residual(context));
    let out: f64 = alone.flows().iter().sum();
    assert!((alone.routing.residual() - (out - 0.2 - RATE)).abs() < 1e-12, "c = out − in − r");
}

#[test]
fn flows_are_sent_where_they_have_changed() {
    let mut alone = Alone::router();
    let plans = |alone: &mut Alone, shares: [f64; 2]| alone.routing.links.set_shares(shares);
    plans(&mut alone, [0.2, 0.3]);
    let told = alone.step(Routing::send_flows);
    assert!(matches!(told[..], [(Destination::One(5), Message::Flow(_))]), "{told:?}");
    assert_eq!(alone.sends_flows(), 0);
    plans(&mut alone, [0.2, 0.4]);
    assert_eq!(alone.sends_flows(), 0, "an access point has no use for it");
    plans(&mut alone, [0.1, 0.4]);
    assert_eq!(alone.sends_flows(), 1);
}

/// In the first iteration of a control period every robot sends its multiplier; in others, if that has changed.
#[test]
fn a_multiplier_is_sent_in_each_period_and_where_it_has_changed() {
    let mut alone = Alone::router();
    let told =
        |alone: &mut Alone| alone.step(|routing, _, outputs| routing.send_report(outputs)).len();
    assert_eq!([told(&mut alone), told(&mut alone)], [1, 0]);
    alone.dual_step();
    assert_eq!([told(&mut alone), told(&mut alone)], [1, 0]);
    alone.routing.begin_period();
    assert_eq!(told(&mut alone), 1);
}

/// Once the shares rest, further iterations change nothing until a new multiplier or flow is received.
#[test]
fn iterations_pass_until_something_new_is_received() {
    let mut alone = Alone::router();
    let iterate = |alone: &mut Alone| {
        alone.primal_step();
        alone.sends_flows();
        alone.dual_step();
    };
    alone.receives_report(5, 1.0, None);
    (0..200).for_each(|_| iterate(&mut alone));
    assert!(alone.routing.is_at_rest());
    let at_rest = alone.flows();
    let reserve = alone.site.settings.routing_reserve;
    assert!((at_rest.iter().sum::<f64>() - RATE - reserve).abs() < 1e-8, "c = η");
    iterate(&mut alone);
    alone.receives_report(5, 1.0, None);
    assert!(alone.routing.is_at_rest() && alone.flows() == at_rest);

    let mut informed = alone.clone();
    informed.receives_report(5, 0.0, None);
    assert!(!informed.routing.is_at_rest());
    iterate(&mut informed);
    assert!(informed.flows()[0] > at_rest[0], "robot 5 has become cheaper");

    alone.routing.receive_flow(5, 0.05);
    assert!(!alone.routing.is_at_rest());
}

/// The flow of a sender has not been received, and it has less to send than before.
#[test]
fn less_than_nothing_flows_in_and_nothing_is_sent() {
    for share in [0.1, 0.0] {
        let mut alone = Alone::router();
        alone.routing.links.set_shares([share; 2]);
        alone.receives_report(1, 0.0, Some(0));
        alone.step(|routing, context, outputs| routing.begin_sweep(context, outputs));
        alone.receives_demand(1, -1.0);
        assert_eq!(alone.shares(), [0.0; 2]);
    }
}

/// Demands go up the tree once all children have sent theirs.
#[test]
fn a_robot_passes_on_the_demand_that_it_does_not_meet() {
    let mut alone = Alone::below_another();
    for (from, parent) in [(1, Some(0)), (2, Some(0)), (5, Some(4))] {
        alone.receives_report(from, 0.0, parent);
    }
    let begun = alone.step(|routing, context, outputs| routing.begin_sweep(context, outputs));
    assert!(begun.is_empty(), "it waits for its children, and no others");
    assert!(alone.receives_demand(1, 0.1).is_empty(), "it waits for the other one");
    let passed_on = alone.receives_demand(2, 0.2);
    let [(Destination::One(5), Message::Demand(more))] = passed_on[..] else {
        panic!("{passed_on:?}")
    };
    // Its own rate, what flows in, and the reserve.
    let needed = RATE + 0.3 + alone.site.settings.routing_reserve;
    assert!((more - needed).abs() < 1e-9, "{more} of {needed}");
    let passed_on = alone.receives_demand(1, 0.05);
    let [(_, Message::Demand(more))] = passed_on[..] else { panic!("{passed_on:?}") };
    assert!((more - 0.05).abs() < 1e-9, "{more}");
}

/// Demands that go round in a cycle end.
#[test]
fn no_more_demands_are_passed_on_in_a_sweep_than_there_are_robots() {
    let mut alone = Alone::below_another();
    let mut demands = alone.step(|routing, context, outputs| routing.begin_sweep(context, outputs));
    (0..2 * ROBOTS).for_each(|_| demands.extend(alone.receives_demand(1, 0.01)));
    let demands = demands.iter().filter(|(_, message)| matches!(message, Message::Demand(_)));
    assert_eq!(demands.count(), ROBOTS);
}

/// A robot below the one that is overloaded does without its reserve, and reports that; any other sends it nothing more.
#[test]
fn a_shortage_relieves_the_robot_that_has_it() {
    let shortages = |sent: &[(Destination, Message)]| {
        sent.iter().filter(|(_, message)| matches!(message, Message::Shortage)).count()
    };
    let mut alone = Alone::below_another();
    alone.routing.links.set_shares([0.2; 3]);
    let relieved = alone.step(|routing, _, outputs| routing.receive_shortage(2, outputs));
    assert_eq!((shortages(&relieved), alone.shares()[1]), (0, 0.0));
    for expected in [1, 0] {
        let told = alone.step(|routing, _, outputs| routing.receive_shortage(5, outputs));
        assert_eq!(shortages(&told), expected, "it is reported once in a period");
    }
}

/// The routes of a period are the flows in use, and what they leave of what others may send.
#[test]
fn routes_are_adopted_and_fall_short_once() {
    let mut alone = Alone::router();
    let mut adopts = |outflow: f64| {
        let mut falls_short = false;
        alone.step(|routing, context, _| {
            let in_use = [(ROBOTS, 0.25)].into_iter();
            let granted = [(3, 0.0), (4, 0.2)].into_iter();
            falls_short = routing.adopt(context, in_use, outflow, granted);
        });
        (falls_short, (alone.routing.residual() * 1e9).round() / 1e9, alone.shares())
    };
    let shares = || vec![0.0, 0.25];
    assert_eq!(adopts(0.3), (false, 0.0, shares()));
    assert_eq!(adopts(0.1), (true, -0.2, shares()));
    assert_eq!(adopts(0.1), (false, -0.2, shares()), "it has been reported");
}
