//! Which flows a robot plans, asks for, grants and uses (reservation), and how it routes.

use pleach_continuous::network::LinkReliability as _;
use pleach_continuous::network::routing::adal::NeighbourReport;
use pleach_continuous::network::routing::dual::DualState;
use pleach_discrete::network::reservation::Lease;

use super::*;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;
use crate::network::robot::reservation::{FlowGrant, FlowRequest, GrantedPart, RequestNumber};
use crate::network::robot::routing::{RouteLink, RoutingState};
use crate::node::Destination;

const LEASE: u32 = 8;

/// Robot 0 with links to the access point, 1.2 away, and to robot 5, 1.0 away.
pub(in super::super) fn router() -> Robot {
    let mut robot = robot();
    robot.holds(Post { parent: Some(Anchor::Access(0)), ..fixed(20, 0) });
    robot.hears(beacon(5, west(1.0), fixed(13, 14), &[13, 14]));
    robot.hears(access_point(east(1.2)));
    robot.remember_parent();
    robot.survey_links();
    assert_eq!(robot.links.iter().map(|link| link.to).collect::<Vec<_>>(), [5, ROBOTS]);
    robot
}

pub(super) fn sent(outputs: &mut NodeOutputs) -> Vec<(Destination, Message)> {
    outputs.drain_sent().map(|envelope| (envelope.to, envelope.message)).collect()
}

pub(in super::super) fn requests(outputs: &mut NodeOutputs) -> Vec<(Destination, FlowRequest)> {
    let asks = |(to, message)| match message {
        Message::AskFlow(request) => Some((to, request)),
        _ => None,
    };
    sent(outputs).into_iter().filter_map(asks).collect()
}

pub(in super::super) fn grants(outputs: &mut NodeOutputs) -> Vec<(Destination, FlowGrant)> {
    let grants = |(to, message)| match message {
        Message::GrantFlow(grant) => Some((to, grant)),
        _ => None,
    };
    sent(outputs).into_iter().filter_map(grants).collect()
}

/// The router asks robot 5 for a flow of 0.2 R.
fn asking() -> (Robot, FlowRequest) {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    robot.links[0].share = 0.2;
    robot.ask_for_flows(&mut outputs);
    let request = requests(&mut outputs).first().expect("it asks").1;
    (robot, request)
}

/// A link that a step of both ends could break carries nothing unless it belongs to the tree; one with a flow
/// stays until that has ended.
#[test]
fn links_are_those_that_are_reliable_enough_or_of_the_tree() {
    let far = |robot: &Robot| robot.site.link.distance_at(0.3);
    let links = |away: f64, attached: bool, flow: f64| {
        let mut robot = router();
        robot.held_flow(5).flow = flow;
        let held = if attached { fixed(13, 20) } else { fixed(13, 14) };
        let parent = attached.then_some(0);
        robot.hears(Beacon { parent, ..beacon(5, west(away), held, &[13, 14]) });
        robot.survey_links();
        robot.links.iter().find(|link| link.to == 5).map(|link| link.is_retiring)
    };
    let limit = far(&robot());
    assert_eq!(links(limit - 1e-3, false, 0.0), Some(false));
    assert_eq!(links(limit + 1e-3, false, 0.0), None);
    assert_eq!(links(limit + 1e-3, true, 0.0), Some(false), "a link of the tree");
    assert_eq!(links(limit + 1e-3, false, 0.1), Some(true), "its flow has to end first");
    assert_eq!(links(2.0, false, 0.1), None, "no packets get there");
}

#[test]
fn nothing_is_planned_over_a_link_that_is_retiring() {
    let limit = robot().site.link.distance_at(0.3);
    let planned = |away: f64| {
        let mut robot = router();
        robot.held_flow(5).flow = 0.1;
        robot.hears(beacon(5, west(away), fixed(13, 14), &[13, 14]));
        robot.survey_links();
        robot.routing = RoutingState::Dual(DualState::new(1.0));
        robot.primal_step();
        robot.links.iter().find(|link| link.to == 5).map(|link| link.share > 0.0)
    };
    assert_eq!((planned(limit - 1e-3), planned(limit + 1e-3)), (Some(true), Some(false)));
}

/// As long as nothing changes, a control period begins with the links of the one before.
#[test]
fn links_are_found_anew_when_something_has_changed() {
    let mut robot = router();
    let found = |robot: &mut Robot| {
        robot.links[0].share += 0.1;
        robot.survey_links();
        let link = robot.links[0];
        (link.to, link.share, robot.links.len(), robot.upstream)
    };
    assert!(robot.links_stand);
    assert_eq!(found(&mut robot), (5, 0.0, 2, Some(ROBOTS)));
    robot.hears(beacon(4, east(1.0), fixed(14, 13), &[13, 14]));
    assert!(!robot.links_stand);
    assert_eq!(found(&mut robot), (4, 0.0, 3, Some(ROBOTS)));
    robot.holds(Post { parent: Some(Anchor::Post(PostId(13))), ..fixed(20, 0) });
    robot.note_change();
    assert_eq!(found(&mut robot), (4, 0.0, 3, Some(5)));
    robot.held_flow(4).flow = 0.1;
    robot.hears(beacon(4, east(robot.site.link.distance_at(0.2)), fixed(14, 13), &[13, 14]));
    robot.survey_links();
    assert!(!robot.links_stand, "one that is retiring goes with its flow");
}

/// F_ij up to what is planned and granted, and for all the time that the sender has.
#[test]
fn a_flow_is_raised_to_what_is_planned_and_granted() {
    let flow = |wanted: f64, granted: f64, busy: f64| {
        let mut robot = router();
        let mut outputs = NodeOutputs::of(0);
        let reliability = robot.links[0].reliability;
        robot.links[0].share = wanted / reliability;
        robot.links[1].share = busy;
        robot.ask_for_flows(&mut outputs);
        let asked = requests(&mut outputs);
        let [(Destination::One(5), request)] = asked[..] else { panic!("{asked:?}") };
        robot.hear_grant(
            5,
            FlowGrant { number: request.number, flow: granted, until: NOW + LEASE, part: None },
        );
        robot.take_in_requests(&mut outputs);
        (robot.held_flow(5).flow, robot.held_flow(ROBOTS).load())
    };
    let close = |(one, two): (f64, f64), (first, second): (f64, f64)| {
        assert!((one - first).abs() < 1e-9 && (two - second).abs() < 1e-9, "{one} and {two}");
    };
    close(flow(0.3, 0.5, 0.2), (0.3, 0.2));
    close(flow(0.5, 0.3, 0.2), (0.3, 0.2));
}

/// While a receiver may have made the move to which the robot has consented, what flows to it is certified, and
/// no more. What flows to others takes time that it may need.
#[test]
fn no_flow_is_raised_while_a_receiver_may_have_moved() {
    let flows = |consents: bool, passed: u32| {
        let mut robot = router();
        let mut outputs = NodeOutputs::of(0);
        let planned = |robot: &mut Robot, share: f64| {
            robot.links.iter_mut().for_each(|link| link.share = share);
        };
        planned(&mut robot, 0.2);
        robot.ask_for_flows(&mut outputs);
        let number = requests(&mut outputs)[0].1.number;
        let flow = robot.links[0].reliability;
        robot.hear_grant(5, FlowGrant { number, flow, until: NOW + LEASE, part: None });
        robot.take_in_requests(&mut outputs);
        sent(&mut outputs);
        if consents {
            robot.consented.push((5, NOW));
        }
        robot.period += passed;
        planned(&mut robot, 0.4);
        robot.ask_for_flows(&mut outputs);
        let wanted = requests(&mut outputs)[0].1.wanted;
        [wanted / robot.links[0].reliability, robot.held_flow(ROBOTS).load()]
            .map(|load| (load * 1e9).round())
    };
    let [kept, raised] = [0.2, 0.4].map(|load: f64| [(load * 1e9).round(); 2]);
    assert_eq!(flows(false, 1), raised, "robot 5 has not moved without a consent");
    assert_eq!(flows(true, 1), kept);
    assert_eq!(flows(true, 0), raised, "it has heard it in this period");
}

/// Robot 5 asks for a flow of 0.2; this robot sends 0.1 + `spare` to the access point, 0.1 of it its own.
fn granted(spare: f64) -> (Robot, Vec<(Destination, FlowGrant)>) {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    let reliability = robot.links[1].reliability;
    robot.links[1].share = (0.1 + spare) / reliability;
    robot.ask_for_flows(&mut outputs);
    sent(&mut outputs);
    let number = RequestNumber { period: NOW, number: 1 };
    robot.hear_request(5, FlowRequest { number, held: 0.0, wanted: 0.2 });
    robot.take_in_requests(&mut outputs);
    let grants = grants(&mut outputs);
    (robot, grants)
}

/// Σ_j F_ij − Σ_j (granted to j) − r_i ≥ 0.
#[test]
fn no_more_is_granted_than_is_forwarded() {
    for (spare, expected) in [(0.0, 0.0), (0.15, 0.15), (0.3, 0.2)] {
        let (mut robot, grants) = granted(spare);
        let [(Destination::One(5), grant)] = grants[..] else { panic!("it answers: {grants:?}") };
        assert!((grant.flow - expected).abs() < 1e-9, "{} of {spare}", grant.flow);
        robot.adopt_flows();
        assert!((robot.residual - (spare - expected)).abs() < 1e-9, "{}", robot.residual);
        assert_eq!(robot.senders().count(), usize::from(expected > 0.0));
        assert_eq!(robot.inflows.len(), robot.senders().count());
        assert!((robot.inflow - expected).abs() < 1e-9);
    }
}

/// A sender that still wants it asks again; one that has lost its link would not hear of the grant.
#[test]
fn nothing_is_granted_to_a_request_of_an_earlier_control_period() {
    let granted_later = |passed: u32| {
        let (mut robot, _) = granted(0.0);
        let mut outputs = NodeOutputs::of(0);
        robot.period += passed;
        robot.links[1].share += 0.3;
        robot.ask_for_flows(&mut outputs);
        let reserved: f64 = robot.reservations.iter().map(|kept| kept.lease.flow()).sum();
        (grants(&mut outputs).len(), reserved)
    };
    assert_eq!(granted_later(0), (1, 0.2));
    assert_eq!(granted_later(1), (0, 0.0));
}

#[test]
fn a_request_is_answered_once_and_an_older_one_never() {
    let (mut robot, _) = granted(0.3);
    let mut outputs = NodeOutputs::of(0);
    for _ in 0..2 {
        grants(&mut outputs);
        robot.has_flow_news = true;
        robot.take_in_requests(&mut outputs);
    }
    assert!(grants(&mut outputs).is_empty(), "nothing has changed");
    let request = |number, held, wanted| FlowRequest {
        number: RequestNumber { period: NOW, number },
        held,
        wanted,
    };
    robot.hear_request(5, request(1, 0.0, 0.0));
    robot.take_in_requests(&mut outputs);
    assert!(grants(&mut outputs).is_empty(), "it is the same again");
    // A new request voids the grant but for what is in use.
    robot.hear_request(5, request(2, 0.05, 0.05));
    robot.take_in_requests(&mut outputs);
    let answered = grants(&mut outputs);
    assert!(
        matches!(answered[..], [(_, grant)] if (grant.flow - 0.05).abs() < 1e-9),
        "{answered:?}"
    );
}

#[test]
fn grants_end_with_their_lease() {
    let (mut robot, _) = granted(0.3);
    let mut outputs = NodeOutputs::of(0);
    robot.ask_for_flows(&mut outputs);
    let until = robot.reservations[0].lease.until();
    for (period, senders) in [(until, 1), (until + 1, 0)] {
        robot.period = period;
        robot.ask_for_flows(&mut outputs);
        assert_eq!(robot.senders().count(), senders, "in {period} of {until}");
    }
    let (mut sender, FlowRequest { number, wanted: flow, .. }) = asking();
    sender.hear_grant(5, FlowGrant { number, flow, until: NOW + LEASE, part: None });
    sender.take_in_requests(&mut outputs);
    assert!(sender.sends_to(5) && sender.requests_are_answered());
    for (later, sends) in [(LEASE, true), (LEASE + 1, false)] {
        sender.period = NOW + later;
        sender.ask_for_flows(&mut outputs);
        assert_eq!(sender.sends_to(5), sends, "{later} periods later");
    }
}

/// A grant is promised for a lease, and no longer than what carries it.
#[test]
fn grants_last_no_longer_than_the_flows_that_carry_them() {
    let until = |end: u32, kept: Option<(f64, u32)>| {
        let (mut robot, _) = granted(0.3);
        let mut outputs = NodeOutputs::of(0);
        robot.held_flow(ROBOTS).lease = Lease::of(f64::INFINITY, end);
        match kept {
            Some((flow, until)) => robot.reservations[0].lease = Lease::of(flow, until),
            None => robot.reservations.clear(),
        }
        let number = RequestNumber { period: NOW, number: 2 };
        robot.hear_request(5, FlowRequest { number, held: 1.0, wanted: 0.2 });
        robot.take_in_requests(&mut outputs);
        let grants = grants(&mut outputs);
        let [(_, grant)] = grants[..] else { panic!("it answers: {grants:?}") };
        ((grant.flow * 100.0).round() / 100.0, grant.until)
    };
    let lease = router().lease();
    assert_eq!(until(NOW + 99, None), (0.2, NOW + lease));
    assert_eq!(until(NOW + 3, None), (0.2, NOW + 3));
    assert_eq!(until(NOW + 3, Some((0.1, NOW + 2))), (0.2, NOW + 3));
    // What has been promised for longer stays, and what is added to it lasts no longer.
    assert_eq!(until(NOW + 3, Some((0.1, NOW + 5))), (0.2, NOW + 3));
    assert_eq!(until(NOW + 5, Some((0.2, NOW + 3))), (0.2, NOW + 5));
}

/// Robot 5 holds 0.1, half of it for longer, and wants 0.2, which is carried for less long than what it holds: that cannot
/// be promised beside what has been. It is answered once with what is kept for it, and robot 6 gets what there is to spare.
#[test]
fn what_cannot_be_promised_is_left_for_others() {
    let (mut robot, _) = granted(0.3);
    let mut outputs = NodeOutputs::of(0);
    robot.held_flow(ROBOTS).lease = Lease::of(f64::INFINITY, NOW + 3);
    let mut kept = Lease::of(0.1, NOW + 5);
    assert!(kept.promise(0.05, NOW + 7));
    robot.reservations[0].lease = kept;
    let number = RequestNumber { period: NOW, number: 2 };
    for (from, held) in [(5, 0.1), (6, 0.0)] {
        robot.hear_request(from, FlowRequest { number, held, wanted: 0.2 });
    }
    robot.take_in_requests(&mut outputs);
    let answers = grants(&mut outputs);
    let [(Destination::One(5), refused), (Destination::One(6), granted)] = answers[..] else {
        panic!("it answers both: {answers:?}")
    };
    let part = Some(GrantedPart { flow: 0.05, until: NOW + 7 });
    assert_eq!(refused, FlowGrant { number, flow: 0.1, until: NOW + 5, part });
    assert!((granted.flow - 0.2).abs() < 1e-9 && granted.until == NOW + 3, "{granted:?}");
}

/// A grant of a part holds when all of it has ended.
#[test]
fn what_is_granted_for_longer_is_left_when_the_rest_ends() {
    let (mut sender, FlowRequest { number, wanted, .. }) = asking();
    let mut outputs = NodeOutputs::of(0);
    let part = wanted / 4.0;
    let for_longer = GrantedPart { flow: part, until: NOW + 4 };
    let grant = FlowGrant { number, flow: wanted, until: NOW + 2, part: Some(for_longer) };
    sender.hear_grant(5, grant);
    sender.take_in_requests(&mut outputs);
    for (later, flow) in [(2, wanted), (3, part), (4, part), (5, 0.0)] {
        sender.period = NOW + later;
        sender.ask_for_flows(&mut outputs);
        assert_eq!(sender.held_flow(5).flow, flow, "{later} periods later");
    }
}

/// What it knew of the grant that is renewed has ended meanwhile, so that there is room for another part; the receiver
/// has begun again, and keeps less for longer.
#[test]
fn a_part_is_renewed_when_the_rest_has_ended() {
    let (mut sender, FlowRequest { number, wanted, .. }) = asking();
    let mut outputs = NodeOutputs::of(0);
    let grant = |share: f64, part_until: u32| FlowGrant {
        number,
        flow: wanted,
        until: NOW + 2,
        part: Some(GrantedPart { flow: share * wanted, until: NOW + part_until }),
    };
    sender.hear_grant(5, grant(0.25, 4));
    sender.take_in_requests(&mut outputs);
    sender.period = NOW + 3;
    sender.hear_grant(5, grant(0.125, 9));
    for (later, share) in [(3, 0.25), (4, 0.25), (5, 0.125), (9, 0.125), (10, 0.0)] {
        sender.period = NOW + later;
        sender.ask_for_flows(&mut outputs);
        assert_eq!(sender.held_flow(5).flow, share * wanted, "{later} periods later");
    }
}

/// No process says so; whatever is granted, a robot sends no more than it plans and than is granted, for as long.
#[test]
fn malformed_grants_are_less_than_they_say() {
    let used = |flow: f64, until: u32, part: Option<(f64, u32)>| {
        let (mut sender, FlowRequest { number, wanted, .. }) = asking();
        let mut outputs = NodeOutputs::of(0);
        let part = part.map(|(flow, until)| GrantedPart { flow, until });
        sender.hear_grant(5, FlowGrant { number, flow, until, part });
        sender.take_in_requests(&mut outputs);
        [NOW, NOW + 4].map(|period| {
            sender.period = period;
            sender.ask_for_flows(&mut outputs);
            sender.held_flow(5).flow / wanted
        })
    };
    assert_eq!(used(f64::NAN, NOW + 9, None), [0.0, 0.0]);
    assert_eq!(used(-0.1, NOW + 9, None), [0.0, 0.0]);
    assert_eq!(used(9.0, NOW + 2, Some((f64::NAN, NOW + 9))), [1.0, 0.0]);
    assert_eq!(used(9.0, NOW + 2, Some((-0.1, NOW + 9))), [1.0, 0.0]);
    assert_eq!(used(9.0, NOW + 2, Some((9.0, NOW + 1))), [1.0, 0.0], "the part ends first");
    assert_eq!(used(9.0, NOW + 2, Some((99.0, NOW + 9))), [1.0, 1.0], "the part is more than all");
    assert_eq!(used(9.0, NOW - 9, None), [0.0, 0.0], "it ended long ago");
}

/// An access point takes everything, as long as it has been heard in two leases.
#[test]
fn packets_flow_to_an_access_point_that_is_not_heard_for_a_while() {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    robot.links[1].share = 0.2;
    robot.ask_for_flows(&mut outputs);
    assert!(robot.sends_to(ROBOTS) && requests(&mut outputs).is_empty());
    let patience = 2 * robot.lease();
    for (later, sends) in [(patience, true), (patience + 1, false)] {
        robot.period = NOW + later;
        robot.ask_for_flows(&mut outputs);
        assert_eq!(robot.sends_to(ROBOTS), sends, "{later}");
    }
}

#[test]
fn an_answer_to_an_older_request_counts_for_nothing() {
    let (mut robot, FlowRequest { number, .. }) = asking();
    let mut outputs = NodeOutputs::of(0);
    let older = RequestNumber { number: number.number - 1, ..number };
    robot.hear_grant(5, FlowGrant { number: older, flow: 0.5, until: NOW + LEASE, part: None });
    robot.take_in_requests(&mut outputs);
    assert!(!robot.sends_to(5) && !robot.requests_are_answered());
    assert!(robot.has_asked(5) && !robot.has_asked(ROBOTS) && !robot.has_asked(4));
}

/// After eight rounds without an answer it asks again, with another number.
#[test]
fn a_request_without_an_answer_is_made_again() {
    let (mut robot, FlowRequest { number: first, .. }) = asking();
    let mut outputs = NodeOutputs::of(0);
    robot.round_count.restart();
    let mut again = Vec::new();
    for round in 1..=16 {
        robot.round_count.pass(1);
        robot.take_in_requests(&mut outputs);
        again
            .extend(requests(&mut outputs).into_iter().map(|(_, request)| (round, request.number)));
    }
    let number = |more| RequestNumber { number: first.number + more, ..first };
    assert_eq!(again, [(8, number(1)), (16, number(2))]);
    robot.period += 1;
    robot.ask_for_flows(&mut outputs);
    assert_eq!(requests(&mut outputs)[0].1.number, RequestNumber { period: NOW + 1, number: 1 });
}

/// A plan that becomes smaller lowers a flow as far as the rest still carries rate and grants.
#[test]
fn a_flow_is_lowered_where_the_rest_carries_what_is_needed() {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    let reliability = robot.links[1].reliability;
    robot.links[1].share = 0.4 / reliability;
    robot.ask_for_flows(&mut outputs);
    assert!((robot.held_flow(ROBOTS).flow - 0.4).abs() < 1e-9);
    for (planned, held) in [(0.25, 0.25), (0.05, 0.1)] {
        robot.links[1].share = planned / reliability;
        robot.ask_for_flows(&mut outputs);
        assert!((robot.held_flow(ROBOTS).flow - held).abs() < 1e-9, "its rate of 0.1 is carried");
    }
}

/// λ and what its neighbours report: the accelerated iteration goes where c = η.
#[test]
fn a_multiplier_rises_while_less_leaves_than_comes_in() {
    let mut robot = router();
    assert_eq!(robot.multiplier(), 0.0);
    robot.dual_step();
    assert!(robot.multiplier() > 0.0, "nothing leaves yet");
    let before = robot.multiplier();
    robot.primal_step();
    assert!(robot.links[1].share > 0.0, "it sends to the access point, whose multiplier is 0");
    robot.hear_flow(5, 0.3);
    robot.dual_step();
    assert!(robot.multiplier() > before);
    assert!((robot.inflow - 0.3).abs() < 1e-12);
    robot.hear_flow(5, 0.0);
    robot.settle_residual();
    let out: f64 = robot.links.iter().map(|link| link.flow()).sum();
    assert!((robot.residual - (out - 0.1)).abs() < 1e-12, "c = out − in − r");
}

#[test]
fn flows_are_told_where_they_have_changed() {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    robot.links[0].share = 0.2;
    robot.links[1].share = 0.3;
    robot.tell_flows(&mut outputs);
    let told = sent(&mut outputs);
    assert!(matches!(told[..], [(Destination::One(5), Message::Flow(_))]), "{told:?}");
    robot.has_untold_flows = true;
    robot.tell_flows(&mut outputs);
    assert!(sent(&mut outputs).is_empty());
    robot.links[0].share = 0.1;
    robot.tell_flows(&mut outputs);
    assert!(sent(&mut outputs).is_empty(), "nothing has happened that could change it");
    robot.has_untold_flows = true;
    robot.tell_flows(&mut outputs);
    assert_eq!(sent(&mut outputs).len(), 1);
}

/// In the first iteration of a control period every robot tells its multiplier; in others, if that has changed.
#[test]
fn a_multiplier_is_told_in_each_period_and_where_it_has_changed() {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    let mut told = |robot: &mut Robot| {
        robot.tell_multiplier(&mut outputs);
        sent(&mut outputs).len()
    };
    assert_eq!([told(&mut robot), told(&mut robot)], [1, 0]);
    robot.dual_step();
    assert_eq!([told(&mut robot), told(&mut robot)], [1, 0]);
    robot.survey_links();
    assert_eq!(told(&mut robot), 1);
}

/// Once the shares rest, further iterations change nothing until a new multiplier or flow is heard.
#[test]
fn iterations_pass_until_something_new_is_heard() {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    let report = |multiplier| NeighbourReport { multiplier, mismatch: 0.0, crowding: 1.0 };
    let iterate = |robot: &mut Robot, outputs: &mut NodeOutputs| {
        robot.primal_step();
        robot.tell_flows(outputs);
        robot.dual_step();
    };
    robot.hear_multiplier(5, report(1.0), None);
    for _ in 0..200 {
        iterate(&mut robot, &mut outputs);
    }
    assert!(robot.shares_rest());
    let planned = |robot: &Robot| robot.links.iter().map(RouteLink::flow).collect::<Vec<_>>();
    let at_rest = planned(&robot);
    let reserve = robot.site.settings.routing_reserve;
    assert!((at_rest.iter().sum::<f64>() - 0.1 - reserve).abs() < 1e-8, "c = η");
    iterate(&mut robot, &mut outputs);
    robot.hear_multiplier(5, report(1.0), None);
    assert!(robot.shares_rest() && planned(&robot) == at_rest);

    let mut informed = robot.clone();
    informed.hear_multiplier(5, report(0.0), None);
    assert!(!informed.shares_rest());
    iterate(&mut informed, &mut outputs);
    assert!(planned(&informed)[0] > at_rest[0], "robot 5 has become cheaper");

    robot.hear_flow(5, 0.05);
    assert!(!robot.shares_rest());
}

/// The flow of a sender has not been heard, and it has less to send than before.
#[test]
fn less_than_nothing_flows_in_and_nothing_is_sent() {
    let mut robot = router();
    for share in [0.1, 0.0] {
        robot.links.iter_mut().for_each(|link| link.share = share);
        (robot.has_swept, robot.inflow) = (false, 0.0);
        robot.hear_demand(1, -1.0, &mut NodeOutputs::of(0));
        let shares: Vec<f64> = robot.links.iter().map(|link| link.share).collect();
        assert_eq!(shares, [0.0; 2]);
    }
}

/// Demands go up the tree once all children have told theirs.
#[test]
fn a_robot_passes_on_the_demand_that_it_does_not_meet() {
    let mut robot = robot();
    robot.holds(fixed(20, 13));
    robot.hears(beacon(5, west(1.0), fixed(13, 14), &[13, 14]));
    robot.hears(Beacon { parent: Some(0), ..beacon(1, east(1.0), fixed(11, 20), &[]) });
    robot.hears(Beacon { parent: Some(0), ..beacon(2, north(1.0), fixed(12, 20), &[]) });
    robot.remember_parent();
    robot.survey_links();
    let report = pleach_continuous::network::routing::adal::NeighbourReport {
        multiplier: 0.0,
        mismatch: 0.0,
        crowding: 1.0,
    };
    for (from, parent) in [(1, Some(0)), (2, Some(0)), (5, Some(4))] {
        robot.hear_multiplier(from, report, parent);
    }
    assert_eq!(robot.demands.iter().map(|(child, _)| *child).collect::<Vec<_>>(), [1, 2]);
    let mut outputs = NodeOutputs::of(0);
    robot.begin_sweep(&mut outputs);
    robot.hear_demand(1, 0.1, &mut outputs);
    assert!(sent(&mut outputs).is_empty(), "it waits for the other one");
    robot.hear_demand(2, 0.2, &mut outputs);
    let told = sent(&mut outputs);
    let [(Destination::One(5), Message::Demand(more))] = told[..] else { panic!("{told:?}") };
    // Its own rate, what flows in, and the reserve.
    let needed = 0.1 + 0.3 + robot.site.settings.routing_reserve;
    assert!((more - needed).abs() < 1e-9, "{more} of {needed}");
    robot.hear_demand(1, 0.05, &mut outputs);
    let told = sent(&mut outputs);
    assert!(
        matches!(told[..], [(_, Message::Demand(more))] if (more - 0.05).abs() < 1e-9),
        "{told:?}"
    );
}

/// Two flows that are granted share the time of their sender.
#[test]
fn flows_take_no_more_than_all_the_time_of_a_sender() {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    let [one, two] = [0, 1].map(|at| robot.links[at].reliability);
    (robot.links[0].share, robot.links[1].share) = (0.7, 0.7);
    robot.ask_for_flows(&mut outputs);
    let number = requests(&mut outputs)[0].1.number;
    robot.hear_grant(5, FlowGrant { number, flow: 0.7 * one, until: NOW + LEASE, part: None });
    robot.take_in_requests(&mut outputs);
    let flows = [robot.held_flow(5).flow, robot.held_flow(ROBOTS).flow];
    assert!((flows[0] / one + flows[1] / two - 1.0).abs() < 1e-9, "{flows:?}");
    // What the first gives up the other one takes.
    (robot.links[0].share, robot.links[1].share) = (0.1, 0.7);
    robot.ask_for_flows(&mut outputs);
    let flows = [robot.held_flow(5).flow, robot.held_flow(ROBOTS).flow];
    assert!(
        (flows[0] - 0.1 * one).abs() < 1e-9 && (flows[1] - 0.7 * two).abs() < 1e-9,
        "{flows:?}"
    );
}

/// What is raised first leaves less room for the next.
#[test]
fn flows_that_are_raised_together_share_the_time_that_is_left() {
    let mut robot = router();
    let mut outputs = NodeOutputs::of(0);
    let [one, two] = [0, 1].map(|at| robot.links[at].reliability);
    (robot.links[0].share, robot.links[1].share) = (0.6, 0.0);
    robot.ask_for_flows(&mut outputs);
    let number = requests(&mut outputs)[0].1.number;
    robot.hear_grant(5, FlowGrant { number, flow: 0.6 * one, until: NOW + LEASE, part: None });
    robot.links[1].share = 0.8;
    robot.ask_for_flows(&mut outputs);
    let flows = [robot.held_flow(5).flow, robot.held_flow(ROBOTS).flow];
    assert!(
        (flows[0] - 0.6 * one).abs() < 1e-9 && (flows[1] - 0.4 * two).abs() < 1e-9,
        "{flows:?}"
    );
}

/// A sender whose time is used up, and that has no flow to spare, goes over to a better link all the same.
#[test]
fn a_flow_takes_the_place_of_another_without_time_or_flow_to_spare() {
    let flows = |old: f64, new: f64, lasts: u32| {
        let mut robot = router();
        let mut outputs = NodeOutputs::of(0);
        (robot.links[0].reliability, robot.links[1].reliability) = (new, old);
        robot.links[1].share = robot.rate / old;
        robot.ask_for_flows(&mut outputs);
        (robot.links[0].share, robot.links[1].share) = (robot.rate / new, 0.0);
        robot.ask_for_flows(&mut outputs);
        let number = requests(&mut outputs)[0].1.number;
        // It has promised another robot something for a while, so that its own flows have to last.
        let number_of_other = RequestNumber { period: NOW, number: 1 };
        robot.hear_request(6, FlowRequest { number: number_of_other, held: 0.0, wanted: 0.0 });
        robot.reservations[0].lease = Lease::of(0.0, NOW + LEASE);
        robot.hear_grant(5, FlowGrant { number, flow: robot.rate, until: NOW + lasts, part: None });
        robot.take_in_requests(&mut outputs);
        [5, ROBOTS].map(|to| robot.held_flow(to).flow / robot.rate).to_vec()
    };
    let rate = router().rate;
    let close = |flows: Vec<f64>, wanted: [f64; 2]| {
        assert!(flows.iter().zip(wanted).all(|(flow, it)| (flow - it).abs() < 1e-9), "{flows:?}");
    };
    close(flows(rate, 1.0, LEASE), [1.0, 0.0]);
    close(flows(rate, rate, LEASE), [1.0, 0.0]);
    close(flows(rate, 0.9 * rate, LEASE), [0.0, 1.0]);
    close(flows(rate, 1.0, LEASE - 1), [0.0, 1.0]);
}

/// Demands that go round in a cycle end.
#[test]
fn no_more_demands_are_passed_on_in_a_sweep_than_there_are_robots() {
    let mut robot = robot();
    robot.holds(fixed(20, 13));
    robot.hears(beacon(5, west(1.0), fixed(13, 14), &[13, 14]));
    robot.remember_parent();
    robot.survey_links();
    let mut outputs = NodeOutputs::of(0);
    robot.begin_sweep(&mut outputs);
    (0..2 * ROBOTS).for_each(|_| robot.hear_demand(1, 0.01, &mut outputs));
    let demands = sent(&mut outputs).into_iter();
    let demands = demands.filter(|(_, message)| matches!(message, Message::Demand(_)));
    assert_eq!(demands.count(), ROBOTS);
}
