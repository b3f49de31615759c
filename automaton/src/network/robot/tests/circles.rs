//! Flows in circles: which probes a robot sends and passes on, and what it makes of its own.

use pleach_discrete::network::reservation::Lease;

use super::flows::{grants, router};
use super::*;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;
use crate::network::robot::Probe;
use crate::network::robot::reservation::{FlowGrant, FlowRequest, RequestNumber};
use crate::node::Destination;

/// Robot 5, to which robot 0 sends, and robots 3 and 4, which send to it.
const NEXT: NodeId = 5;
const BEFORE: NodeId = 3;
const OTHER: NodeId = 4;
/// The control periods until the leases of the circle end.
const LEFT: u32 = 3;

/// Robot 0 sends 0.3 to the access point and 0.1 to robot 5, whose lease is not renewed. It has granted 0.2 to robot 3
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
    robot
}

fn probes(outputs: &mut NodeOutputs) -> Vec<(Destination, Probe)> {
    let probe = |(to, message)| match message {
        Message::Probe(probe) => Some((to, probe)),
        _ => None,
    };
    let sent = outputs.drain_sent().map(|envelope| (envelope.to, envelope.message));
    sent.filter_map(probe).collect()
}

fn probe(flow: f64, robots: &[NodeId]) -> Probe {
    Probe { number: 1, flow, robots: robots.to_vec() }
}

/// What it sends along with its requests in the next control period, and then on hearing a probe.
fn sent_next(robot: &mut Robot, from: NodeId, heard: &Probe) -> [Vec<(Destination, Probe)>; 2] {
    let mut outputs = NodeOutputs::of(0);
    robot.period += 1;
    robot.ask_for_flows(&mut outputs);
    let own = probes(&mut outputs);
    robot.hear_probe(from, heard, &mut outputs);
    [own, probes(&mut outputs)]
}

#[test]
fn a_probe_follows_a_lease_that_is_not_renewed() {
    let to_next = |flow, robots: &[NodeId]| vec![(Destination::One(NEXT), probe(flow, robots))];
    let heard = probe(0.05, &[2, BEFORE]);
    let mut robot = on_a_circle();
    let [own, passed_on] = sent_next(&mut robot, BEFORE, &heard);
    assert_eq!(own, to_next(0.1, &[0]));
    assert_eq!(passed_on, to_next(0.05, &[2, BEFORE, 0]));
    let [_, least] = sent_next(&mut robot, BEFORE, &probe(0.5, &[BEFORE]));
    assert_eq!(least, to_next(0.1, &[BEFORE, 0]), "less flows on from here");

    // Its way leads into a circle of which its sender is no part.
    let [_, again] = sent_next(&mut robot, BEFORE, &probe(0.05, &[2, 0, 1, BEFORE]));
    assert!(again.is_empty() && !robot.circles.are_found());
    // One that has been granted nothing here sends nothing on.
    let [_, strange] = sent_next(&mut on_a_circle(), 2, &probe(0.05, &[2]));
    assert!(strange.is_empty());

    let mut alone = on_a_circle();
    alone.reservations.clear();
    let [own, _] = sent_next(&mut alone, BEFORE, &heard);
    assert!(own.is_empty(), "nobody sends to it");
}

#[test]
fn a_lease_that_is_renewed_waits_for_nothing() {
    let sent = |until: u32| {
        let mut robot = on_a_circle();
        let number = robot.flow_to(NEXT).expect("it sends there").asked();
        robot.hear_grant(NEXT, FlowGrant { number, flow: 0.1, until, part: None });
        sent_next(&mut robot, BEFORE, &probe(0.05, &[2, BEFORE])).map(|sent| sent.len())
    };
    assert_eq!(sent(NOW + LEFT), [1, 1]);
    assert_eq!(sent(NOW + LEFT + 1), [0, 0]);
}

/// Where several wait, another one is followed in each control period, so that each circle is found in time.
#[test]
fn probes_follow_one_lease_after_another() {
    let mut robot = on_a_circle();
    robot.hears(beacon(OTHER, east(1.0), fixed(14, 13), &[13, 14]));
    robot.survey_links();
    robot.links.iter_mut().for_each(|link| link.share = 0.1 / link.reliability);
    let held = robot.held_flow(OTHER);
    (held.flow, held.lease) = (0.1, Lease::of(0.1, NOW + LEFT));
    let heard = probe(0.05, &[2, BEFORE]);
    let mut followed: Vec<_> = (0..2)
        .flat_map(|_| sent_next(&mut robot, BEFORE, &heard))
        .flat_map(|sent| sent.into_iter().map(|(to, _)| to))
        .collect();
    followed.sort_unstable();
    let [four, five] = [OTHER, NEXT].map(Destination::One);
    assert_eq!(followed, [four, four, five, five]);
}

/// What flows in the circle ends with the leases of the circle; the sender that is part of it is granted the rest of its
/// flow for longer, and the other one all of it, at once and without another request.
#[test]
fn what_does_not_flow_in_the_circle_is_granted_for_longer() {
    let told = |returned: Option<(NodeId, f64)>| {
        let mut robot = on_a_circle();
        let mut outputs = NodeOutputs::of(0);
        robot.take_in_requests(&mut outputs);
        grants(&mut outputs);
        if let Some((from, flow)) = returned {
            robot.hear_probe(from, &probe(flow, &[0, NEXT, from]), &mut outputs);
        }
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
