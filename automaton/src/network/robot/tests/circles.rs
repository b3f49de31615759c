//! Flows in circles: which probes a robot sends and passes on, and what it makes of its own.

use std::collections::BTreeSet;

use pleach_discrete::network::reservation::Lease;

use super::flows::{grants, router, sent};
use super::*;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;
use crate::network::robot::Probe;
use crate::network::robot::circles::Circles;
use crate::network::robot::reservation::{FlowRequest, RequestNumber};
use crate::node::Destination;

/// Robot 5, to which robot 0 sends, and robots 3 and 4, which send to it.
const NEXT: NodeId = 5;
const BEFORE: NodeId = 3;
const OTHER: NodeId = 4;
/// The control periods until the leases of the circle end.
const LEFT: u32 = 3;

/// Robot 0 sends 0.3 to the access point and 0.1 to robot 5, whose lease is about to end. It has granted 0.2 to robot 3
/// and 0.1 to robot 4, and its rate is 0.1: neither can be renewed.
fn on_a_circle() -> Robot {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    let number = RequestNumber { period: NOW, number: 1 };
    for (link, flow) in [(0, 0.1), (1, 0.3)] {
        robot.links[link].share = flow / robot.links[link].reliability;
    }
    let held = robot.held_flow(NEXT);
    (held.flow, held.lease) = (0.1, Lease::of(0.1, NOW + LEFT));
    for (from, held) in [(BEFORE, 0.2), (OTHER, 0.1)] {
        robot.hear_request(from, FlowRequest { number, held, wanted: held });
    }
    for (kept, flow) in robot.reservations.iter_mut().zip([0.2, 0.1]) {
        kept.lease = Lease::of(flow, NOW + LEFT);
    }
    robot.ask_for_flows(&mut outputs);
    robot.round_count.restart();
    robot
}

/// The robot looks for circles, `rounds` rounds later; what it sends.
fn looks(robot: &mut Robot, rounds: usize) -> Vec<(Destination, Probe)> {
    let mut outputs = NodeOutputs::of(0);
    robot.round_count.pass(rounds);
    robot.take_in_requests(&mut outputs);
    probes(&mut outputs)
}

fn hears(robot: &mut Robot, from: NodeId, heard: &Probe) -> Vec<(Destination, Probe)> {
    let mut outputs = NodeOutputs::of(0);
    robot.hear_probe(from, heard, &mut outputs);
    probes(&mut outputs)
}

fn probes(outputs: &mut NodeOutputs) -> Vec<(Destination, Probe)> {
    let probe = |(to, message)| match message {
        Message::Probe(probe) => Some((to, probe)),
        _ => None,
    };
    sent(outputs).into_iter().filter_map(probe).collect()
}

fn probe(number: u32, flow: f64, robots: &[NodeId]) -> Probe {
    Probe { number, flow, robots: robots.to_vec() }
}

fn to_next(probe: Probe) -> Vec<(Destination, Probe)> {
    vec![(Destination::One(NEXT), probe)]
}

#[test]
fn probes_follow_a_lease_that_is_about_to_end() {
    let mut robot = on_a_circle();
    assert!(looks(&mut robot, 7).is_empty(), "it looks for circles in every eighth round");
    assert_eq!(looks(&mut robot, 1), to_next(probe(1, 0.1, &[0])));
    let passed_on = hears(&mut robot, BEFORE, &probe(7, 0.05, &[2, BEFORE]));
    assert_eq!(passed_on, to_next(probe(7, 0.05, &[2, BEFORE, 0])));
    let least = hears(&mut robot, BEFORE, &probe(7, 0.5, &[BEFORE]));
    assert_eq!(least, to_next(probe(7, 0.1, &[BEFORE, 0])), "less flows on from here");
    let elsewhere = hears(&mut robot, BEFORE, &probe(7, 0.05, &[2, 0, 1, BEFORE]));
    assert!(elsewhere.is_empty() && !robot.is_on_circle(), "its sender is on no circle");
    assert_eq!(looks(&mut robot, 8), to_next(probe(2, 0.1, &[0])));

    let mut alone = on_a_circle();
    alone.reservations.clear();
    assert!(looks(&mut alone, 8).is_empty(), "nobody sends to it");
}

#[test]
fn copies_of_probes_do_not_add_up() {
    let mut robot = on_a_circle();
    looks(&mut robot, 8);
    let copies =
        (0..3 * ROBOTS).flat_map(|_| hears(&mut robot, BEFORE, &probe(7, 0.05, &[BEFORE])));
    assert_eq!(copies.count(), ROBOTS);
}

#[test]
fn a_lease_that_has_been_renewed_waits_for_nothing() {
    let sent = |until: u32| {
        let mut robot = on_a_circle();
        robot.held_flow(NEXT).lease = Lease::of(0.1, until);
        robot.note_waiting_leases();
        let waits = robot.leases_wait;
        assert_eq!(looks(&mut robot, 8).is_empty(), !waits);
        waits
    };
    assert_eq!([NOW + 5, NOW + 6].map(sent), [true, false]);
    // Of a lease that is about to end for a part of the flow, this part waits.
    let mut robot = on_a_circle();
    assert!(robot.held_flow(NEXT).lease.promise(0.07, NOW + 6));
    let [(_, Probe { flow, .. })] = looks(&mut robot, 8)[..] else { panic!("it sends a probe") };
    assert!((flow - 0.03).abs() < 1e-12, "{flow}");
}

/// As [`on_a_circle`], and another lease is about to end: that of a flow to robot 4.
fn on_two_circles() -> Robot {
    let mut robot = on_a_circle();
    robot.hears(beacon(OTHER, east(1.0), fixed(14, 13), &[13, 14]));
    robot.survey_links();
    robot.links.iter_mut().for_each(|link| link.share = 0.1 / link.reliability);
    let held = robot.held_flow(OTHER);
    (held.flow, held.lease) = (0.1, Lease::of(0.1, NOW + LEFT));
    robot.ask_for_flows(&mut NodeOutputs::of(0));
    robot.round_count.restart();
    robot
}

/// Two robots that choose between two flows each, in sixty looks: whichever way a circle takes, probes follow it in some.
#[test]
fn every_choice_of_two_robots_comes_up() {
    let choices = |id: NodeId| {
        let mut robot = on_two_circles();
        robot.id = id;
        let looks = (0..60).map(move |look| {
            (robot.period, robot.circles) = (NOW + look / 10, Circles::default());
            robot.round_count.restart();
            looks(&mut robot, 8 * (look as usize % 10 + 1))
        });
        looks.map(|sent| sent[0].0).collect::<Vec<_>>()
    };
    let [first, second] = [choices(0), choices(2)];
    let both: BTreeSet<_> = first.iter().zip(&second).collect();
    assert_eq!(both.len(), 4);
}

/// What has been found to go round a circle is set aside, once, and further probes are about the rest.
#[test]
fn circles_with_a_link_in_common_share_what_flows_there() {
    let mut robot = on_a_circle();
    let set_aside = |robot: &Robot| robot.circles.set_aside_from(BEFORE);
    looks(&mut robot, 8);
    let returned = probe(1, 0.06, &[0, NEXT, BEFORE]);
    hears(&mut robot, BEFORE, &probe(0, 0.06, &[0, NEXT, BEFORE]));
    assert!(!robot.is_on_circle(), "it has sent another one since");
    hears(&mut robot, 2, &probe(1, 0.06, &[0, NEXT, 2]));
    assert!(!robot.is_on_circle(), "nothing has been granted to that one");
    hears(&mut robot, BEFORE, &returned);
    assert_eq!(set_aside(&robot), 0.06);
    hears(&mut robot, BEFORE, &returned);
    assert_eq!(set_aside(&robot), 0.06, "a copy");
    let [(_, Probe { number: 2, flow, .. })] = looks(&mut robot, 8)[..] else {
        panic!("it sends another probe")
    };
    assert!((flow - 0.04).abs() < 1e-12, "{flow}");
    hears(&mut robot, BEFORE, &probe(2, flow, &[0, NEXT, BEFORE]));
    assert!((set_aside(&robot) - 0.1).abs() < 1e-12);
    assert!(looks(&mut robot, 8).is_empty(), "nothing is left");
    let late = probe(2, 0.1, &[0, NEXT, BEFORE]);
    let mut outputs = NodeOutputs::of(0);
    robot.period += 1;
    robot.ask_for_flows(&mut outputs);
    assert!(!robot.is_on_circle() && robot.leases_wait, "all of it is looked for again");
    hears(&mut robot, BEFORE, &late);
    assert!(!robot.is_on_circle(), "it is of the period before");
}

/// What flows in the circle ends with the leases of the circle; the sender that is part of it is granted the rest of its
/// flow for longer, and the other one all of it, at once and without another request.
#[test]
fn what_does_not_flow_in_the_circle_is_granted_for_longer() {
    let told = |returned: Option<(NodeId, f64)>| {
        let mut robot = on_a_circle();
        let mut outputs = NodeOutputs::of(0);
        looks(&mut robot, 8);
        if let Some((from, flow)) = returned {
            robot.hear_probe(from, &probe(1, flow, &[0, NEXT, from]), &mut outputs);
        }
        robot.round_count.pass(1);
        robot.take_in_requests(&mut outputs);
        let rounded = |flow: f64| (flow * 100.0).round() / 100.0;
        let grants = grants(&mut outputs).into_iter().map(|(to, grant)| {
            let part = grant.part.map(|part| (rounded(part.flow), part.until - NOW));
            (to, rounded(grant.flow), grant.until - NOW, part)
        });
        grants.collect::<Vec<_>>()
    };
    let lease = router().lease();
    let [three, four] = [BEFORE, OTHER].map(Destination::One);
    let part = Some((0.1, lease));
    assert!(told(None).is_empty());
    assert_eq!(
        told(Some((BEFORE, 0.1))),
        [(three, 0.2, LEFT, part), (four, 0.1, lease, None)],
        "0.3 is sent to the access point"
    );
    assert_eq!(told(Some((OTHER, 0.1))), [(three, 0.2, lease, None)]);
    assert!(told(Some((BEFORE, 0.05))).is_empty(), "what is left does not last either");
    assert!(told(Some((2, 0.1))).is_empty(), "it has been granted nothing");
}
