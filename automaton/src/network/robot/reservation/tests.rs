//! Which flows are asked for, granted and used, and how circles of flows are found: a reservation alone, with the plans and
//! messages that it receives.

use std::collections::BTreeSet;
use std::sync::Arc;

use pleach_continuous::network::acceptance::Segment;

use super::*;
use crate::network::robot::hearing::Neighbour;
use crate::network::robot::negotiation::Negotiation;
use crate::network::robot::neighbours::Neighbours;
use crate::network::robot::rounds::Rounds;
use crate::network::robot::tests::{
    HERE, NOW, ROBOTS, access_point, beacon, east, fixed, hall, sent, west,
};
use crate::network::site::Site;
use crate::node::Destination;

/// The robot to which robot 0 sends.
pub(super) const NEXT: NodeId = 5;
/// Robots that may send to it.
const BEFORE: NodeId = 3;
const OTHER: NodeId = 4;
/// The control periods until the leases of a circle end.
const LEFT: u32 = 3;
/// R_ij of the link to robot 5, and of the link to the access point.
pub(super) const RELIABILITIES: [f64; 2] = [1.0, 0.9];
pub(super) const RATE: f64 = 0.1;

/// The reservation of robot 0, which has links to robot 5 and to the access point, and what it is given in each step.
#[derive(Clone)]
pub(super) struct Alone {
    pub reservation: Reservation,
    pub period: u32,
    rounds: Rounds,
    id: NodeId,
    site: Arc<Site>,
    neighbours: Neighbours,
    negotiation: Negotiation,
    /// F_ij of the plan, for each receiver with its reliability.
    pub plans: Vec<Plan>,
}

impl Alone {
    pub(super) fn new() -> Self {
        let site = Arc::new(Site::new(&hall()).expect("its numbers make sense"));
        let mut neighbours = Neighbours::default();
        for heard in [beacon(NEXT, west(1.0), fixed(13, 14), &[13, 14]), access_point(east(1.2))] {
            let neighbour = Neighbour::new(&Arc::new(heard), None, NOW, HERE, &site);
            neighbours.insert(neighbours.len(), neighbour);
        }
        let plan = |(to, reliability)| Plan { to, reliability, flow: 0.0 };
        Alone {
            reservation: Reservation::default(),
            period: NOW,
            rounds: Rounds::default(),
            id: 0,
            site,
            neighbours,
            negotiation: Negotiation::default(),
            plans: [NEXT, ROBOTS].into_iter().zip(RELIABILITIES).map(plan).collect(),
        }
    }

    /// A step of the reservation, with what it sends.
    fn step(
        &mut self,
        step: impl FnOnce(&mut Reservation, Context<'_>, &mut NodeOutputs),
    ) -> Vec<(Destination, Message)> {
        let Alone { reservation, site, id, period, rounds, .. } = self;
        let context = Context { id: *id, site, rate: RATE, period: *period, rounds: *rounds };
        let mut outputs = NodeOutputs::of(*id);
        step(reservation, context, &mut outputs);
        sent(&mut outputs)
    }

    /// The plan, F_ij for each receiver, and what is sent once it stands.
    pub(super) fn plans(&mut self, flows: &[f64]) -> Vec<(Destination, Message)> {
        self.plans.iter_mut().zip(flows).for_each(|(plan, &flow)| plan.flow = flow);
        self.asks()
    }

    /// What is sent once the plan stands.
    pub(super) fn asks(&mut self) -> Vec<(Destination, Message)> {
        let Alone { neighbours, negotiation, .. } = self.clone();
        let plans = self.plans.clone().into_iter();
        self.step(|reservation, context, outputs| {
            let (neighbours, negotiation) = (&neighbours, &negotiation);
            let places = Places { context, neighbours, negotiation, has_heard_all: false };
            reservation.ask_for_flows(context, plans, &places, lease_of(0), outputs);
        })
    }

    /// What is sent in a round of the reservation.
    pub(super) fn settles(&mut self) -> Vec<(Destination, Message)> {
        self.step(|reservation, context, outputs| {
            reservation.take_in_requests(context, lease_of(0), outputs);
        })
    }

    pub(super) fn receives_request(&mut self, from: NodeId, request: FlowRequest) {
        self.step(|reservation, context, _| reservation.receive_request(context, from, request));
    }

    pub(super) fn receives_grant(&mut self, from: NodeId, grant: FlowGrant) {
        self.step(|reservation, context, _| reservation.receive_grant(context, from, grant));
    }

    fn receives_probe(&mut self, from: NodeId, probe: &Probe) -> Vec<(Destination, Probe)> {
        probes(self.step(|reservation, context, outputs| {
            reservation.receive_probe(context, from, probe, outputs);
        }))
    }

    /// Access points and robots are received all the time.
    pub(super) fn receives_all(&mut self) {
        self.neighbours.iter_mut().for_each(|it| it.heard_in = self.period);
    }

    fn flow_to(&self, node: NodeId) -> f64 {
        self.reservation.held.to(node).map_or(0.0, |held| held.parts().0)
    }

    /// T_ij.
    fn load_to(&self, node: NodeId) -> f64 {
        let mut loads = self.reservation.loads();
        loads.find(|&(to, _)| to == node).map_or(0.0, |(_, load)| load)
    }

    fn sends_flow(&mut self, to: NodeId, flow: f64, until: u32) {
        self.reservation.held.set(to, flow, Lease::of(flow, until));
    }
}

pub(super) fn requests(sent: Vec<(Destination, Message)>) -> Vec<(Destination, FlowRequest)> {
    let asks = |(to, message)| match message {
        Message::AskFlow(request) => Some((to, request)),
        _ => None,
    };
    sent.into_iter().filter_map(asks).collect()
}

pub(super) fn grants(sent: Vec<(Destination, Message)>) -> Vec<(Destination, FlowGrant)> {
    let grants = |(to, message)| match message {
        Message::GrantFlow(grant) => Some((to, grant)),
        _ => None,
    };
    sent.into_iter().filter_map(grants).collect()
}

fn probes(sent: Vec<(Destination, Message)>) -> Vec<(Destination, Probe)> {
    let probes = |(to, message)| match message {
        Message::Probe(probe) => Some((to, probe)),
        _ => None,
    };
    sent.into_iter().filter_map(probes).collect()
}

/// Robot 0 asks robot 5 for a flow of 0.2.
fn asking() -> (Alone, FlowRequest) {
    let mut alone = Alone::new();
    let request = requests(alone.plans(&[0.2, 0.0])).first().expect("it asks").1;
    (alone, request)
}

/// A grant of all for which a request asks.
fn whole(request: FlowRequest, until: u32) -> FlowGrant {
    FlowGrant { number: request.number, flow: request.wanted, until, part: None }
}

fn assert_close(one: f64, other: f64) {
    assert!((one - other).abs() < 1e-9, "{one} is not {other}");
}

/// F_ij up to what is planned and granted, and for all the time that the sender has.
#[test]
fn a_flow_is_raised_to_what_is_planned_and_granted() {
    for (planned, granted, raised) in [(0.3, 0.5, 0.3), (0.5, 0.3, 0.3)] {
        let mut alone = Alone::new();
        let asked = requests(alone.plans(&[planned, 0.2 * RELIABILITIES[1]]));
        let [(Destination::One(NEXT), request)] = asked[..] else { panic!("{asked:?}") };
        assert_eq!((request.wanted, request.held), (planned, 0.0));
        alone.receives_grant(NEXT, FlowGrant { flow: granted, ..whole(request, NOW + LEASE) });
        alone.settles();
        assert_close(alone.flow_to(NEXT), raised);
        assert_close(alone.load_to(ROBOTS), 0.2);
    }
}

/// While a receiver may have made the move to which the robot has consented, what flows to it is certified, and
/// no more. What flows to others takes time that it may need.
#[test]
fn no_flow_is_raised_while_a_receiver_may_have_moved() {
    let flows = |consents: bool, passed: u32| {
        let mut alone = Alone::new();
        let request = requests(alone.plans(&[0.2, 0.2]))[0].1;
        alone.receives_grant(NEXT, FlowGrant { flow: 1.0, ..whole(request, NOW + LEASE) });
        alone.settles();
        if consents {
            let stays = Segment::still(west(1.0));
            alone.negotiation.receive_proposal(NEXT, stays, true);
            alone.negotiation.consent(NOW, &mut NodeOutputs::of(0));
        }
        alone.period += passed;
        let wanted = requests(alone.plans(&[0.4, 0.4]))[0].1.wanted;
        [wanted, alone.flow_to(ROBOTS)]
    };
    assert_eq!(flows(false, 1), [0.4; 2], "robot 5 has not moved without a consent");
    assert_eq!(flows(true, 1), [0.2; 2]);
    assert_eq!(flows(true, 0), [0.4; 2], "it has been received in this period");
}

/// Robot 5 asks for a flow of 0.2; this robot sends 0.1 + `spare` to the access point, 0.1 of it its own.
fn granted(spare: f64) -> (Alone, Vec<(Destination, FlowGrant)>) {
    let mut alone = Alone::new();
    alone.plans(&[0.0, RATE + spare]);
    let number = RequestNumber { period: NOW, number: 1 };
    alone.receives_request(NEXT, FlowRequest { number, held: 0.0, wanted: 0.2 });
    let grants = grants(alone.settles());
    (alone, grants)
}

/// Σ_j F_ij − Σ_j (granted to j) − r_i ≥ 0.
#[test]
fn no_more_is_granted_than_is_forwarded() {
    for (spare, expected) in [(0.0, 0.0), (0.15, 0.15), (0.3, 0.2)] {
        let (alone, grants) = granted(spare);
        let [(Destination::One(NEXT), grant)] = grants[..] else { panic!("{grants:?}") };
        assert_close(grant.flow, expected);
        let reservation = &alone.reservation;
        let inflow: f64 = reservation.granted().map(|(_, flow)| flow).sum();
        assert_close(reservation.outflow() - inflow - RATE, spare - expected);
        assert_eq!(reservation.senders().count(), usize::from(expected > 0.0));
    }
}

/// A sender that still wants it asks again; one that has lost its link would not receive the grant.
#[test]
fn nothing_is_granted_to_a_request_of_an_earlier_control_period() {
    let granted_later = |passed: u32| {
        let (mut alone, _) = granted(0.0);
        alone.period += passed;
        let granted = grants(alone.plans(&[0.0, RATE + 0.3])).len();
        (granted, alone.reservation.granted().map(|(_, flow)| flow).sum::<f64>())
    };
    assert_eq!(granted_later(0), (1, 0.2));
    assert_eq!(granted_later(1), (0, 0.0));
}

#[test]
fn a_request_is_answered_once_and_an_older_one_never() {
    let (mut alone, _) = granted(0.3);
    for answers in [1, 0] {
        alone.reservation.has_news = true;
        assert_eq!(grants(alone.settles()).len(), answers, "a grant counts as an answer once");
    }
    let request = |number, held, wanted| FlowRequest {
        number: RequestNumber { period: NOW, number },
        held,
        wanted,
    };
    alone.receives_request(NEXT, request(1, 0.0, 0.0));
    assert!(grants(alone.settles()).is_empty(), "it is the same again");
    // A new request voids the grant but for what is in use.
    alone.receives_request(NEXT, request(2, 0.05, 0.05));
    let answered = grants(alone.settles());
    let [(_, grant)] = answered[..] else { panic!("{answered:?}") };
    assert_close(grant.flow, 0.05);
}

#[test]
fn grants_end_with_their_lease() {
    let (mut alone, granted) = granted(0.3);
    alone.asks();
    let until = granted[0].1.until;
    for (period, senders) in [(until, 1), (until + 1, 0)] {
        alone.period = period;
        alone.asks();
        assert_eq!(alone.reservation.senders().count(), senders, "in {period} of {until}");
    }
    let (mut sender, request) = asking();
    sender.receives_grant(NEXT, whole(request, NOW + LEASE));
    sender.settles();
    assert!(sender.reservation.sends_to(NEXT) && !sender.reservation.asks_again());
    for (later, sends) in [(LEASE, true), (LEASE + 1, false)] {
        sender.period = NOW + later;
        sender.asks();
        assert_eq!(sender.reservation.sends_to(NEXT), sends, "{later} periods later");
    }
}

/// A grant is promised for a lease, and no longer than what carries it.
#[test]
fn grants_last_no_longer_than_the_flows_that_carry_them() {
    let until = |end: u32, kept: Option<(f64, u32)>| {
        let (mut alone, _) = granted(0.3);
        let flow = alone.flow_to(ROBOTS);
        alone.reservation.held.set(ROBOTS, flow, Lease::of(f64::INFINITY, end));
        match kept {
            Some((flow, until)) => alone.reservation.kept.set(NEXT, Lease::of(flow, until)),
            None => alone.reservation.kept = KeptFlows::default(),
        }
        let number = RequestNumber { period: NOW, number: 2 };
        alone.receives_request(NEXT, FlowRequest { number, held: 1.0, wanted: 0.2 });
        let grants = grants(alone.settles());
        let [(_, grant)] = grants[..] else { panic!("it answers: {grants:?}") };
        ((grant.flow * 100.0).round() / 100.0, grant.until)
    };
    assert_eq!(until(NOW + 99, None), (0.2, NOW + LEASE));
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
    let (mut alone, _) = granted(0.3);
    let flow = alone.flow_to(ROBOTS);
    alone.reservation.held.set(ROBOTS, flow, Lease::of(f64::INFINITY, NOW + 3));
    let mut kept = Lease::of(0.1, NOW + 5);
    assert!(kept.promise(0.05, NOW + 7));
    alone.reservation.kept.set(NEXT, kept);
    let number = RequestNumber { period: NOW, number: 2 };
    for (from, held) in [(NEXT, 0.1), (6, 0.0)] {
        alone.receives_request(from, FlowRequest { number, held, wanted: 0.2 });
    }
    let answers = grants(alone.settles());
    let [(Destination::One(NEXT), refused), (Destination::One(6), granted)] = answers[..] else {
        panic!("it answers both: {answers:?}")
    };
    let part = Some(GrantedPart { flow: 0.05, until: NOW + 7 });
    assert_eq!(refused, FlowGrant { number, flow: 0.1, until: NOW + 5, part });
    assert!((granted.flow - 0.2).abs() < 1e-9 && granted.until == NOW + 3, "{granted:?}");
}

/// A grant of a part holds when all of it has ended.
#[test]
fn what_is_granted_for_longer_is_left_when_the_rest_ends() {
    let (mut sender, request) = asking();
    let (wanted, part) = (request.wanted, request.wanted / 4.0);
    let for_longer = GrantedPart { flow: part, until: NOW + 4 };
    sender.receives_grant(NEXT, FlowGrant { part: Some(for_longer), ..whole(request, NOW + 2) });
    sender.settles();
    for (later, flow) in [(2, wanted), (3, part), (4, part), (5, 0.0)] {
        sender.period = NOW + later;
        sender.asks();
        assert_eq!(sender.flow_to(NEXT), flow, "{later} periods later");
    }
}

/// What it knew of the grant that is renewed has ended meanwhile, so that there is room for another part; the receiver
/// has begun again, and keeps less for longer.
#[test]
fn a_part_is_renewed_when_the_rest_has_ended() {
    let (mut sender, request) = asking();
    let wanted = request.wanted;
    let grant = |share: f64, part_until: u32| FlowGrant {
        part: Some(GrantedPart { flow: share * wanted, until: NOW + part_until }),
        ..whole(request, NOW + 2)
    };
    sender.receives_grant(NEXT, grant(0.25, 4));
    sender.settles();
    sender.period = NOW + 3;
    sender.receives_grant(NEXT, grant(0.125, 9));
    for (later, share) in [(3, 0.25), (4, 0.25), (5, 0.125), (9, 0.125), (10, 0.0)] {
        sender.period = NOW + later;
        sender.asks();
        assert_eq!(sender.flow_to(NEXT), share * wanted, "{later} periods later");
    }
}

/// No process says so; whatever is granted, a robot sends no more than it plans and than is granted, for as long.
#[test]
fn malformed_grants_are_less_than_they_say() {
    let used = |flow: f64, until: u32, part: Option<(f64, u32)>| {
        let (mut sender, request) = asking();
        let part = part.map(|(flow, until)| GrantedPart { flow, until });
        sender.receives_grant(NEXT, FlowGrant { flow, part, ..whole(request, until) });
        sender.settles();
        [NOW, NOW + 4].map(|period| {
            sender.period = period;
            sender.asks();
            sender.flow_to(NEXT) / request.wanted
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

/// An access point takes everything, as long as it has been received in two leases.
#[test]
fn packets_flow_to_an_access_point_that_is_not_received_for_a_while() {
    let mut alone = Alone::new();
    assert!(requests(alone.plans(&[0.0, 0.2])).is_empty());
    assert!(alone.reservation.sends_to(ROBOTS));
    let patience = 2 * LEASE;
    for (later, sends) in [(patience, true), (patience + 1, false)] {
        alone.period = NOW + later;
        alone.asks();
        assert_eq!(alone.reservation.sends_to(ROBOTS), sends, "{later}");
    }
}

#[test]
fn an_answer_to_an_older_request_counts_for_nothing() {
    let (mut alone, request) = asking();
    let number = RequestNumber { number: request.number.number - 1, ..request.number };
    alone.receives_grant(NEXT, FlowGrant { number, ..whole(request, NOW + LEASE) });
    alone.settles();
    let reservation = &alone.reservation;
    assert!(!reservation.sends_to(NEXT) && reservation.asks_again());
    let has_asked = [NEXT, ROBOTS, OTHER].map(|node| reservation.has_asked(node));
    assert_eq!(has_asked, [true, false, false]);
}

/// After eight rounds without an answer it asks again, with another number.
#[test]
fn a_request_without_an_answer_is_made_again() {
    let (mut alone, FlowRequest { number: first, .. }) = asking();
    let mut again = Vec::new();
    for round in 1..=16 {
        alone.rounds.pass(1);
        let asked = requests(alone.settles());
        again.extend(asked.into_iter().map(|(_, request)| (round, request.number)));
    }
    let number = |more| RequestNumber { number: first.number + more, ..first };
    assert_eq!(again, [(8, number(1)), (16, number(2))]);
    alone.period += 1;
    let next = requests(alone.asks())[0].1.number;
    assert_eq!(next, RequestNumber { period: NOW + 1, number: 1 });
}

/// A plan that becomes smaller lowers a flow as far as the rest still carries rate and grants.
#[test]
fn a_flow_is_lowered_where_the_rest_carries_what_is_needed() {
    let mut alone = Alone::new();
    for (planned, held) in [(0.4, 0.4), (0.25, 0.25), (0.05, RATE)] {
        alone.plans(&[0.0, planned]);
        assert_close(alone.flow_to(ROBOTS), held);
    }
}

#[test]
fn what_is_held_of_a_link_ends_with_it() {
    let mut alone = Alone::new();
    alone.plans(&[0.0, 0.2]);
    alone.reservation.drop_flows_without_link(|node| node == ROBOTS);
    assert!(alone.reservation.sends_to(ROBOTS));
    alone.reservation.drop_flows_without_link(|node| node == NEXT);
    assert!(!alone.reservation.sends_to(ROBOTS));
}

/// Two flows that are granted share the time of their sender.
#[test]
fn flows_take_no_more_than_all_the_time_of_a_sender() {
    let [one, two] = RELIABILITIES;
    let mut alone = Alone::new();
    let request = requests(alone.plans(&[0.7 * one, 0.7 * two]))[0].1;
    alone.receives_grant(NEXT, whole(request, NOW + LEASE));
    alone.settles();
    assert_close(alone.load_to(NEXT) + alone.load_to(ROBOTS), 1.0);
    // What the first gives up the other one takes.
    alone.plans(&[0.1 * one, 0.7 * two]);
    assert_close(alone.load_to(NEXT), 0.1);
    assert_close(alone.load_to(ROBOTS), 0.7);
}

/// What is raised first leaves less room for the next.
#[test]
fn flows_that_are_raised_together_share_the_time_that_is_left() {
    let [one, two] = RELIABILITIES;
    let mut alone = Alone::new();
    let request = requests(alone.plans(&[0.6 * one, 0.0]))[0].1;
    alone.receives_grant(NEXT, whole(request, NOW + LEASE));
    alone.plans(&[0.6 * one, 0.8 * two]);
    assert_close(alone.load_to(NEXT), 0.6);
    assert_close(alone.load_to(ROBOTS), 0.4);
}

/// A sender whose time is used up, and that has no flow to spare, goes over to a better link all the same.
#[test]
fn a_flow_takes_the_place_of_another_without_time_or_flow_to_spare() {
    let flows = |old: f64, new: f64, lasts: u32| {
        let mut alone = Alone::new();
        (alone.plans[0].reliability, alone.plans[1].reliability) = (new, old);
        alone.plans(&[0.0, RATE]);
        let request = requests(alone.plans(&[RATE, 0.0]))[0].1;
        // It has promised another robot something for a while, so that its own flows have to last.
        let number = RequestNumber { period: NOW, number: 1 };
        alone.receives_request(6, FlowRequest { number, held: 0.0, wanted: 0.0 });
        alone.reservation.kept.set(6, Lease::of(0.0, NOW + LEASE));
        alone.receives_grant(NEXT, whole(request, NOW + lasts));
        alone.settles();
        [NEXT, ROBOTS].map(|to| alone.flow_to(to) / RATE)
    };
    assert_eq!(flows(RATE, 1.0, LEASE), [1.0, 0.0]);
    assert_eq!(flows(RATE, RATE, LEASE), [1.0, 0.0]);
    assert_eq!(flows(RATE, 0.9 * RATE, LEASE), [0.0, 1.0], "it is less reliable");
    assert_eq!(flows(RATE, 1.0, LEASE - 1), [0.0, 1.0], "its lease is shorter");
}

/// Robot 0 sends 0.3 to the access point and 0.1 to robot 5, whose lease is about to end. It has granted 0.2 to robot 3
/// and 0.1 to robot 4, and its rate is 0.1: neither can be renewed.
fn on_a_circle() -> Alone {
    let mut alone = Alone::new();
    alone.sends_flow(NEXT, 0.1, NOW + LEFT);
    let number = RequestNumber { period: NOW, number: 1 };
    for (from, held) in [(BEFORE, 0.2), (OTHER, 0.1)] {
        alone.receives_request(from, FlowRequest { number, held, wanted: held });
        alone.reservation.kept.set(from, Lease::of(held, NOW + LEFT));
    }
    alone.plans(&[0.1, 0.3]);
    alone
}

/// Robot 0 looks for circles, `rounds` rounds later; what it sends.
fn looks(alone: &mut Alone, rounds: usize) -> Vec<(Destination, Probe)> {
    alone.rounds.pass(rounds);
    probes(alone.settles())
}

fn probe(number: u32, flow: f64, robots: &[NodeId]) -> Probe {
    Probe { number, flow, robots: robots.to_vec() }
}

fn to_next(probe: Probe) -> Vec<(Destination, Probe)> {
    vec![(Destination::One(NEXT), probe)]
}

fn is_on_circle(alone: &Alone) -> bool {
    alone.reservation.circles.are_known()
}

#[test]
fn probes_follow_a_lease_that_is_about_to_end() {
    let mut alone = on_a_circle();
    assert!(looks(&mut alone, 7).is_empty(), "it looks for circles in every eighth round");
    assert_eq!(looks(&mut alone, 1), to_next(probe(1, 0.1, &[0])));
    let passed_on = alone.receives_probe(BEFORE, &probe(7, 0.05, &[2, BEFORE]));
    assert_eq!(passed_on, to_next(probe(7, 0.05, &[2, BEFORE, 0])));
    let least = alone.receives_probe(BEFORE, &probe(7, 0.5, &[BEFORE]));
    assert_eq!(least, to_next(probe(7, 0.1, &[BEFORE, 0])), "less flows on from here");
    let elsewhere = alone.receives_probe(BEFORE, &probe(7, 0.05, &[2, 0, 1, BEFORE]));
    assert!(elsewhere.is_empty() && !is_on_circle(&alone), "its sender is on no circle");
    assert_eq!(looks(&mut alone, 8), to_next(probe(2, 0.1, &[0])));

    let mut without_senders = on_a_circle();
    without_senders.reservation.kept = KeptFlows::default();
    assert!(looks(&mut without_senders, 8).is_empty());
}

#[test]
fn copies_of_probes_do_not_add_up() {
    let mut alone = on_a_circle();
    looks(&mut alone, 8);
    let copy = probe(7, 0.05, &[BEFORE]);
    let copies = (0..3 * ROBOTS).flat_map(|_| alone.receives_probe(BEFORE, &copy));
    assert_eq!(copies.count(), ROBOTS);
}

#[test]
fn a_lease_that_has_been_renewed_waits_for_nothing() {
    let waits = |lease: Lease<f64>| {
        let mut alone = on_a_circle();
        alone.reservation.held.set(NEXT, 0.1, lease);
        alone.step(|reservation, context, _| reservation.note_waiting_leases(context));
        let waits = alone.reservation.circles.are_looked_for();
        let sent = looks(&mut alone, 8);
        assert_eq!(sent.is_empty(), !waits);
        sent.first().map(|(_, probe)| probe.flow)
    };
    assert_eq!([NOW + 5, NOW + 6].map(|until| waits(Lease::of(0.1, until))), [Some(0.1), None]);
    // Of a lease that is about to end for a part of the flow, this part waits.
    let mut lease = Lease::of(0.1, NOW + LEFT);
    assert!(lease.promise(0.07, NOW + 6));
    assert_close(waits(lease).expect("it sends a probe"), 0.03);
}

/// As [`on_a_circle`], and another lease is about to end: that of a flow to robot 4.
fn on_two_circles() -> Alone {
    let mut alone = on_a_circle();
    alone.sends_flow(OTHER, 0.1, NOW + LEFT);
    alone.plans.insert(0, Plan { to: OTHER, reliability: 1.0, flow: 0.0 });
    alone.plans(&[0.1; 3]);
    alone
}

/// Two robots that choose between two flows each, in sixty looks: whichever way a circle takes, probes follow it in some.
#[test]
fn every_choice_of_two_robots_comes_up() {
    let choices = |id: NodeId| {
        let mut alone = on_two_circles();
        alone.id = id;
        let looks = (0..60).map(move |look| {
            alone.period = NOW + look / 10;
            alone.rounds.restart();
            looks(&mut alone, 8 * (look as usize % 10 + 1))
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
    let mut alone = on_a_circle();
    let set_aside = |alone: &Alone| alone.reservation.circles.set_aside_from(BEFORE);
    looks(&mut alone, 8);
    let returned = probe(1, 0.06, &[0, NEXT, BEFORE]);
    alone.receives_probe(BEFORE, &probe(0, 0.06, &[0, NEXT, BEFORE]));
    assert!(!is_on_circle(&alone), "it has sent another one since");
    alone.receives_probe(2, &probe(1, 0.06, &[0, NEXT, 2]));
    assert!(!is_on_circle(&alone), "nothing has been granted to that one");
    alone.receives_probe(BEFORE, &returned);
    assert_eq!(set_aside(&alone), 0.06);
    alone.receives_probe(BEFORE, &returned);
    assert_eq!(set_aside(&alone), 0.06, "a copy");
    let [(_, Probe { number: 2, flow, .. })] = looks(&mut alone, 8)[..] else {
        panic!("it sends another probe")
    };
    assert_close(flow, 0.04);
    alone.receives_probe(BEFORE, &probe(2, flow, &[0, NEXT, BEFORE]));
    assert_close(set_aside(&alone), 0.1);
    assert!(looks(&mut alone, 8).is_empty(), "nothing is left");
    let late = probe(2, 0.1, &[0, NEXT, BEFORE]);
    alone.period += 1;
    alone.asks();
    assert!(!is_on_circle(&alone) && alone.reservation.circles.are_looked_for());
    alone.receives_probe(BEFORE, &late);
    assert!(!is_on_circle(&alone), "it is of the period before");
}

/// What flows in the circle ends with the leases of the circle; the sender that is part of it is granted the rest of its
/// flow for longer, and the other one all of it, at once and without another request.
#[test]
fn what_does_not_flow_in_the_circle_is_granted_for_longer() {
    let granted = |returned: Option<(NodeId, f64)>| {
        let mut alone = on_a_circle();
        looks(&mut alone, 8);
        if let Some((from, flow)) = returned {
            alone.receives_probe(from, &probe(1, flow, &[0, NEXT, from]));
        }
        alone.rounds.pass(1);
        let rounded = |flow: f64| (flow * 100.0).round() / 100.0;
        let grants = grants(alone.settles()).into_iter().map(|(to, grant)| {
            let part = grant.part.map(|part| (rounded(part.flow), part.until - NOW));
            (to, rounded(grant.flow), grant.until - NOW, part)
        });
        grants.collect::<Vec<_>>()
    };
    let [three, four] = [BEFORE, OTHER].map(Destination::One);
    let part = Some((0.1, LEASE));
    assert!(granted(None).is_empty());
    assert_eq!(
        granted(Some((BEFORE, 0.1))),
        [(three, 0.2, LEFT, part), (four, 0.1, LEASE, None)],
        "0.3 is sent to the access point"
    );
    assert_eq!(granted(Some((OTHER, 0.1))), [(three, 0.2, LEASE, None)]);
    assert!(granted(Some((BEFORE, 0.05))).is_empty(), "what is left does not last either");
    assert!(granted(Some((2, 0.1))).is_empty(), "it has been granted nothing");
}
