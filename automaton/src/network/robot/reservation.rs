//! Reservation: a robot sends to another only what that one has granted.
//!
//! The routing method and its sweeps say which flows would be best. The flows in use are held from one
//! control period to the next and change on request. A robot asks for the flows of its plan; it raises
//! F_ij to what the receiver has granted, and grants only what its own flows forward. It lowers F_ij
//! where the rest still carries what it has granted and its rate, and tells the receiver; or raises one and lowers
//! another by as much at once. So
//!
//! ```text
//! Σ_j F_ij − Σ_j (granted to j) − r_i ≥ 0
//! ```
//!
//! holds from the first period in which it does, as long as grants are renewed: a message that is lost
//! leaves flows as they are until a lease ends. A request is answered by a grant, which tells all that is kept for the
//! sender, and what is about to end is renewed by further ones. A new request voids the grants before it, so that late
//! messages and copies change nothing.
//!
//! A grant says until when it holds, which is never longer than the flows of the receiver last that carry it:
//! where grants are not renewed, flows end at those who send first. If c_i ≥ 0 now,
//!
//! ```text
//! Σ_j (F_ij that lasts until t) − Σ_j (granted to j until t) − r_i ≥ 0
//! ```
//!
//! holds in every control period t up to the last for which the robot has granted anything. A robot with c_i < 0 grants
//! no more, and renews what it has granted for as long as its flows last.
//!
//! Where robots send to each other in a circle, each grant waits for the next one to be renewed. What goes round is
//! found by probes (`circles`), and the rest granted for longer: it is left when the leases of the circle end.

use pleach_discrete::network::NodeId;
use pleach_discrete::network::reservation::{Lease, Spare};
use serde::{Deserialize, Serialize};

use super::Robot;
use super::circles::Circles;
use super::routing::{RESIDUAL_ROUNDING, RouteLink, link_at};
use crate::network::member::NodeOutputs;
use crate::network::message::Message;

#[cfg(test)]
mod lemma;

/// Control periods for which a grant holds at the least as long as no message is lost. Every flow is asked for
/// again in each of them.
const LEASE: u32 = 8;
/// A lease that will have ended this many control periods from now is about to end, and waits to be renewed.
const ABOUT_TO_END: u32 = LEASE - 2;
/// How many leases long packets flow to an access point that is not heard. It promises nothing to anyone, so
/// that nothing ends but its service.
const PATIENCE_WITH_ACCESS_POINTS: u32 = 2;
/// Flows that differ by less are the same.
pub(super) const SAME_FLOW: f64 = 1e-12;
/// Passes in which some flows are raised and others lowered to make room for them.
const PASSES: usize = 4;

/// The number of a request, by which its grants are known: later ones are greater.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RequestNumber {
    /// The control period in which it is made.
    pub period: u32,
    /// Its number among the sender's requests.
    pub number: u32,
}

/// A request for a flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlowRequest {
    /// Its number.
    pub number: RequestNumber,
    /// F_ij as it is in use.
    pub held: f64,
    /// F_ij as the sender plans it.
    pub wanted: f64,
}

/// An answer to a request for a flow: all that the receiver of the flow keeps for its sender. Of grants that answer the
/// same request later ones tell as much or more, for the control periods that are left.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlowGrant {
    /// The number of the request.
    pub number: RequestNumber,
    /// The F_ij that the sender may use.
    pub flow: f64,
    /// The last control period in which it may use that much.
    pub until: u32,
    /// The part of it that it may use for longer.
    pub part: Option<GrantedPart>,
}

/// The part of a granted flow that may be used for longer than all of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GrantedPart {
    /// The part of F_ij.
    pub flow: f64,
    /// The last control period in which it may be used.
    pub until: u32,
}

/// What a sender uses of a link, and what it may use. It is kept from the first plan with a flow on, as long as there
/// is a link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct HeldFlow {
    /// The receiver.
    pub(super) to: NodeId,
    /// R_ij.
    reliability: f64,
    /// F_ij as it is in use.
    pub flow: f64,
    /// F_ij as it is planned.
    wanted: f64,
    /// The largest F_ij that the receiver has granted, and until when.
    pub lease: Lease<f64>,
    /// The number of the last request.
    asked: RequestNumber,
    /// Whether the last request waits for an answer.
    is_open: bool,
    /// Whether a request is to be made.
    is_due: bool,
}

/// What a receiver keeps for a sender.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reservation {
    from: NodeId,
    /// The largest F_ij that the sender may use, and until when.
    pub lease: Lease<f64>,
    wanted: f64,
    /// The number of the last request, and whether it has been answered.
    asked: RequestNumber,
    is_answered: bool,
}

impl FlowGrant {
    /// What is kept as the request with this number is answered.
    fn of(number: RequestNumber, lease: &Lease<f64>) -> Self {
        let part = lease.part().map(|(flow, until)| GrantedPart { flow, until });
        FlowGrant { number, flow: lease.flow(), until: lease.until(), part }
    }

    fn lease(&self) -> Lease<f64> {
        let mut lease = Lease::of(self.flow, self.until);
        if let Some(GrantedPart { flow, until }) = self.part {
            lease.promise(flow, until);
        }
        lease
    }
}

impl Reservation {
    /// Begins this control period. What was asked for in an earlier period and not granted is dropped: a sender that
    /// still wants it asks again, and one whose link is gone would ignore a grant.
    fn pass(&mut self, period: u32) {
        self.lease.pass(period);
        if self.asked.period < period {
            self.wanted = self.wanted.min(self.lease.flow());
        }
    }

    /// Whether its request waits for an answer, or for more than has been granted.
    fn is_unmet(&self) -> bool {
        !self.is_answered || self.wanted > self.lease.flow() + SAME_FLOW
    }

    /// What is left of it when what flows in circles has ended.
    fn part_besides(&self, circles: &Circles) -> f64 {
        let all = self.lease.flow();
        (all - circles.set_aside_from(self.from)).clamp(0.0, all)
    }

    /// Whether its sender has asked for it in this control period, and some of it is about to end.
    fn waits(&self, period: u32) -> bool {
        self.asked.period == period && self.lease.lasting(soon_after(period)) < self.lease.flow()
    }
}

impl HeldFlow {
    /// None yet, to this node.
    fn to(to: NodeId) -> Self {
        HeldFlow { to, ..HeldFlow::default() }
    }

    /// T_ij.
    pub fn load(&self) -> f64 {
        self.flow / self.reliability
    }

    /// Whether packets flow, or shall. Others have nothing to raise, to lower or to keep.
    const fn is_in_use(&self) -> bool {
        self.flow > 0.0 || self.wanted > 0.0
    }

    /// Whether the flow is to be raised or lowered.
    fn is_to_change(&self) -> bool {
        self.allowed() > self.flow + SAME_FLOW || self.wanted < self.flow - SAME_FLOW
    }

    /// What the plan and the receiver's grant allow.
    fn allowed(&self) -> f64 {
        self.wanted.min(self.lease.flow())
    }

    /// What of it is about to end, and waits to be renewed.
    pub(super) fn waiting(&self, period: u32) -> f64 {
        self.flow - self.lasting(soon_after(period))
    }

    /// What will be left of it in a control period ahead if no grant is renewed.
    fn lasting(&self, period: u32) -> f64 {
        self.flow.min(self.lease.lasting(period))
    }

    fn can_rise(&self) -> bool {
        self.allowed() > self.flow
    }

    fn can_fall(&self) -> bool {
        self.wanted < self.flow
    }

    /// Raises the flow to what is allowed, by at most `most`; returns by how much.
    fn raise(&mut self, most: f64) -> f64 {
        self.change_to(self.allowed().min(self.flow + most).max(self.flow))
    }

    /// Lowers the flow to what is planned, by at most `most`; returns by how much.
    fn lower(&mut self, most: f64) -> f64 {
        -self.change_to(self.wanted.max(self.flow - most).min(self.flow))
    }

    /// Returns by how much the flow has grown.
    fn change_to(&mut self, flow: f64) -> f64 {
        let before = self.flow;
        if (flow - before).abs() > SAME_FLOW {
            self.flow = if flow > SAME_FLOW { flow } else { 0.0 };
        }
        self.flow - before
    }

    /// Whether the receiver keeps more for the sender than it has a use for.
    fn can_be_given_back(&self) -> bool {
        self.lease.flow() > self.flow + SAME_FLOW && self.wanted <= self.flow + SAME_FLOW
    }
}

/// Shifts flow, in equal amounts, from links that are to carry less to links that are to carry more; returns how much.
/// The link that takes over is at least as reliable, and its lease lasts at least as long as that of the other, or as
/// anything that is promised. Without this a sender with neither time nor flow to spare could not leave a link that
/// hardly carries anything.
fn replace_flows(flows: &mut [&mut HeldFlow], promised: u32) -> f64 {
    let mut taken_over = 0.0;
    let count = flows.len();
    for (more, less) in (0..count).flat_map(|more| (0..count).map(move |less| (more, less))) {
        if !flows[more].can_rise() || !flows[less].can_fall() {
            continue;
        }
        let Ok([more, less]) = flows.get_disjoint_mut([more, less]) else { continue };
        let needed_until = less.lease.end().min(promised);
        if more.reliability < less.reliability || more.lease.until() < needed_until {
            continue;
        }
        let taken = more.raise((less.flow - less.wanted).max(0.0));
        less.lower(taken);
        taken_over += taken;
    }
    taken_over
}

/// The control period in which what is about to end has ended.
const fn soon_after(period: u32) -> u32 {
    period.saturating_add(ABOUT_TO_END)
}

/// Where the flow to `node` is among flows, which are in the order of their receivers; or where it belongs.
fn place_of(flows: &[HeldFlow], node: NodeId) -> Result<usize, usize> {
    flows.binary_search_by_key(&node, |held| held.to)
}

/// The control periods after which less of a lease holds.
fn ends(lease: &Lease<f64>) -> [u32; 2] {
    [lease.until(), lease.end()]
}

impl Robot {
    /// The plan stands: the robot asks for its flows, and stops those whose grants have ended.
    pub(super) fn ask_for_flows(&mut self, outputs: &mut NodeOutputs) {
        let (period, robots) = (self.period, self.site.robots);
        let patience = PATIENCE_WITH_ACCESS_POINTS * self.lease();
        let knows_load = self.knows_load();
        self.reservations.iter_mut().for_each(|kept| kept.pass(period));
        self.reservations.retain(|kept| kept.lease.until() >= period);
        for at in 0..self.links.len() {
            let RouteLink { to, reliability, is_retiring, .. } = self.links[at];
            // Where flows are not reported, the plan can be none.
            let planned = self.links[at].flow().clamp(0.0, reliability);
            if planned == 0.0 && self.flow_to(to).is_none() {
                continue;
            }
            let can_raise = planned != 0.0 && knows_load && self.knows_place_of(to);
            let heard_in =
                (to >= robots).then(|| self.neighbour(to).map_or(0, |known| known.heard_in));
            let held = self.held_flow(to);
            held.reliability = reliability;
            if let Some(heard_in) = heard_in {
                // An access point takes everything, as long as it is there.
                held.lease = Lease::of(f64::INFINITY, heard_in.saturating_add(patience));
            }
            held.lease.pass(period);
            held.flow = held.flow.min(held.lease.flow());
            let most = if can_raise { planned } else { planned.min(held.flow) };
            held.wanted = if is_retiring { 0.0 } else { most };
            held.is_due = to < robots && (held.is_in_use() || held.is_open);
        }
        self.note_waiting_leases();
        self.settle_flows(outputs);
    }

    /// Whether the loads of its links are known, as it knows where all are to which packets flow. Where it
    /// does not, a receiver may have made a move to which it has consented: the load is certified for what
    /// flows, and for no more.
    fn knows_load(&self) -> bool {
        let mut flowing = self.flows.iter().filter(|held| held.flow > 0.0);
        flowing.all(|held| self.knows_place_of(held.to))
    }

    /// Takes in the requests and grants of the round; asks again, every few rounds, where there is no
    /// answer.
    pub(super) fn take_in_requests(&mut self, outputs: &mut NodeOutputs) {
        let is_late = self.round_count.is_for_asking_again();
        if is_late {
            self.flows.iter_mut().for_each(|held| held.is_due = held.is_open);
        }
        if is_late || self.has_flow_news {
            self.settle_flows(outputs);
        }
        if is_late {
            self.look_for_circles(outputs);
        }
    }

    /// Whether every request has been answered.
    pub(super) fn requests_are_answered(&self) -> bool {
        !self.flows.iter().any(|held| held.is_open)
    }

    /// Whether packets flow to this node.
    pub(super) fn sends_to(&self, node: NodeId) -> bool {
        self.flow_to(node).is_some_and(|held| held.flow > 0.0)
    }

    /// Whether it has ever asked this node for a flow over the link that it has to it now.
    pub(super) fn has_asked(&self, node: NodeId) -> bool {
        self.flow_to(node).is_some_and(|held| held.asked != RequestNumber::default())
    }

    fn flow_to(&self, node: NodeId) -> Option<&HeldFlow> {
        place_of(&self.flows, node).ok().map(|at| &self.flows[at])
    }

    /// The flow to a node to which there is a link.
    pub(super) fn held_flow(&mut self, node: NodeId) -> &mut HeldFlow {
        let at = place_of(&self.flows, node).unwrap_or_else(|at| {
            self.flows.insert(at, HeldFlow::to(node));
            at
        });
        &mut self.flows[at]
    }

    /// What is held of a link ends with it.
    pub(super) fn drop_flows_without_link(&mut self) {
        self.flows.retain(|held| link_at(&self.links, held.to).is_some());
    }

    /// The robots that may send to this one.
    pub(super) fn senders(&self) -> impl Iterator<Item = NodeId> {
        self.reservations.iter().filter(|kept| kept.lease.flow() > 0.0).map(|kept| kept.from)
    }

    /// Where the reservation for this sender is, or where it belongs.
    fn reservation_of(&self, sender: NodeId) -> Result<usize, usize> {
        self.reservations.binary_search_by_key(&sender, |kept| kept.from)
    }

    /// What this node may send to this one.
    pub(super) fn granted_to(&self, node: NodeId) -> f64 {
        self.reservation_of(node).map_or(0.0, |at| self.reservations[at].lease.flow())
    }

    fn ask(&mut self, at: usize, outputs: &mut NodeOutputs) {
        let RequestNumber { period, number } = self.last_request;
        let number = if period == self.period { number + 1 } else { 1 };
        self.last_request = RequestNumber { period: self.period, number };
        let held = &mut self.flows[at];
        // What was granted before is void, beyond what is in use.
        held.lease.limit(held.flow);
        (held.asked, held.is_open) = (self.last_request, true);
        let HeldFlow { to, asked: number, flow, wanted, .. } = *held;
        outputs.send(to, Message::AskFlow(FlowRequest { number, held: flow, wanted }));
    }

    /// A sender asks for a flow.
    pub(super) fn hear_request(&mut self, from: NodeId, request: FlowRequest) {
        let FlowRequest { number, held, wanted } = request;
        let known = self.reservation_of(from);
        if known.is_ok_and(|at| number <= self.reservations[at].asked) {
            return;
        }
        let mut lease = known.map_or(Lease::of(0.0, self.period), |at| self.reservations[at].lease);
        lease.limit(held.max(0.0));
        let kept = Reservation { from, lease, wanted, asked: number, is_answered: false };
        match known {
            Ok(at) => self.reservations[at] = kept,
            Err(at) => self.reservations.insert(at, kept),
        }
        self.has_flow_news = true;
    }

    /// A receiver answers a request.
    pub(super) fn hear_grant(&mut self, from: NodeId, grant: FlowGrant) {
        let Ok(at) = place_of(&self.flows, from) else { return };
        let held = &mut self.flows[at];
        if held.asked == grant.number {
            held.is_open = false;
            let mut kept = grant.lease();
            // It may have ended on its way, and what it renews as well.
            kept.pass(self.period);
            held.lease.pass(self.period);
            held.lease.hear(kept);
            self.has_flow_news = true;
        }
    }

    /// Raises flows as they are granted and lowers others that are not needed, makes the requests that are
    /// due, gives back what it does not use, and grants what it can forward. Every request gets an answer.
    fn settle_flows(&mut self, outputs: &mut NodeOutputs) {
        self.has_flow_news = false;
        if self.flows_in_use().any(HeldFlow::is_to_change) {
            self.change_flows();
        }
        for at in 0..self.flows.len() {
            let held = &mut self.flows[at];
            if held.allowed() > held.flow + SAME_FLOW {
                // There is no room for more in this period.
                held.wanted = held.flow;
            }
            if held.is_due || held.can_be_given_back() {
                held.is_due = false;
                if held.to < self.site.robots {
                    self.ask(at, outputs);
                }
            }
        }
        let period = self.period;
        if self.reservations.iter().any(|kept| kept.is_unmet() || kept.waits(period)) {
            self.grant_flows(outputs);
        }
    }

    /// Raises flows as far as they are granted and there is time to send, lowers others as far as the rest
    /// carries what it has granted, for as long, and replaces one by another.
    fn change_flows(&mut self) {
        let needs = self.needs();
        let promised = needs.last().map_or(self.period, |&(period, _)| period);
        let mut in_use: Vec<&mut HeldFlow> = Vec::with_capacity(self.flows.len());
        in_use.extend(self.flows.iter_mut().filter(|held| held.is_in_use()));
        for _ in 0..PASSES {
            let mut change = 0.0;
            let mut room = 1.0 - in_use.iter().map(|held| held.load()).sum::<f64>();
            for held in &mut in_use {
                let more = held.raise(room.max(0.0) * held.reliability);
                room -= more / held.reliability;
                change += more;
            }
            let lasting = |period| in_use.iter().map(|held| held.lasting(period)).sum::<f64>();
            let spares = needs.iter().map(|&(period, needed)| lasting(period) - needed);
            let mut spare = spares.fold(f64::INFINITY, f64::min);
            for held in &mut in_use {
                let less = held.lower(spare.max(0.0));
                spare -= less;
                change += less;
            }
            change += replace_flows(&mut in_use, promised);
            if change == 0.0 {
                break;
            }
        }
    }

    /// Answers requests: grants more as far as its own flows carry that for as long, and all that it has granted for as
    /// long as these last; [a part](Reservation::part_besides) for longer where a circle of flows has been found. What is
    /// about to end is renewed without another request, so that all leases of a circle are renewed in the same control
    /// period.
    fn grant_flows(&mut self, outputs: &mut NodeOutputs) {
        let needed = self.needed_outflow();
        let wanted =
            self.reservations.iter().map(|kept| (kept.wanted - kept.lease.flow()).max(0.0));
        let carried = (needed + wanted.sum::<f64>()).min(self.held_outflow());
        let until = self.lasts_until(carried).min(self.last_to_grant());
        let longer = self.parts_last_until(until);
        let (period, circles) = (self.period, &self.circles);
        let mut spare = Spare::of(self.lasting_outflow(until) - needed);
        let may_grant = self.round_count.is_for_grants();
        for kept in &mut self.reservations {
            let (told, waits) = (kept.lease, kept.waits(period));
            let part = longer.map(|longer| (kept.part_besides(circles), longer));
            let (before, lease) = (told.flow(), &mut kept.lease);
            let flow = spare.most(before, kept.wanted);
            let can_grant = flow > before + SAME_FLOW && may_grant && lease.promise(flow, until);
            if can_grant {
                spare.grant(before, flow);
            }
            let is_told = can_grant || !std::mem::replace(&mut kept.is_answered, true);
            if is_told || waits {
                lease.promise(before, until);
                if let Some((flow, longer)) = part {
                    lease.promise(flow, longer);
                }
            }
            if is_told || *lease != told {
                let grant = FlowGrant::of(kept.asked, lease);
                outputs.send(kept.from, Message::GrantFlow(grant));
            }
        }
    }

    /// The last control period for which it may grant something now.
    fn last_to_grant(&self) -> u32 {
        self.period.saturating_add(self.lease())
    }

    /// Until when its flows carry [parts](Reservation::part_besides) of what it has granted, where that is longer than
    /// until the period up to which they carry all of it.
    fn parts_last_until(&self, until: u32) -> Option<u32> {
        if !self.is_on_circle() {
            return None;
        }
        let circles = &self.circles;
        // What has been promised already holds in any case.
        let part =
            |kept: &Reservation, period| kept.part_besides(circles).max(kept.lease.lasting(period));
        let is_carried = |period: u32| {
            let parts = self.reservations.iter().map(|kept| part(kept, period)).sum::<f64>();
            self.lasting_outflow(period) >= self.rate + parts - SAME_FLOW
        };
        let promised = self.ends_of_promises().filter(|&end| end > until);
        let short = promised.filter(|&end| !is_carried(end)).min();
        let ends = self.ends_of_flows().map(|end| end.min(self.last_to_grant()));
        let carries =
            |&end: &u32| end > until && short.is_none_or(|it| end < it) && is_carried(end);
        ends.filter(carries).max()
    }

    /// Control periods for which it grants flows that last as long. A robot farther from the access points
    /// grants its own for one period less, as it hears of a renewal one period later.
    pub(super) fn lease(&self) -> u32 {
        LEASE.saturating_add(self.longest_wait() as u32)
    }

    fn flows_in_use(&self) -> impl Iterator<Item = &HeldFlow> {
        self.flows.iter().filter(|held| held.is_in_use())
    }

    /// What its own flows have to carry: its rate and what others may send.
    fn needed_outflow(&self) -> f64 {
        self.granted_to_others() + self.rate
    }

    fn held_outflow(&self) -> f64 {
        self.flows_in_use().map(|held| held.flow).sum()
    }

    /// What is left of the flows in a control period ahead if no grant is renewed.
    fn lasting_outflow(&self, period: u32) -> f64 {
        self.flows_in_use().map(|held| held.lasting(period)).sum()
    }

    /// The last control period up to which flows last that carry this much.
    fn lasts_until(&self, carried: f64) -> u32 {
        let lasts = |&end: &u32| self.lasting_outflow(end) >= carried - SAME_FLOW;
        self.ends_of_flows().filter(lasts).max().unwrap_or(self.period)
    }

    /// The control periods after which less flows if no grant is renewed.
    fn ends_of_flows(&self) -> impl Iterator<Item = u32> {
        let flowing = self.flows_in_use().filter(|held| held.flow > 0.0);
        flowing.flat_map(|held| ends(&held.lease))
    }

    /// The control periods after which less is promised if no grant is renewed.
    fn ends_of_promises(&self) -> impl Iterator<Item = u32> {
        self.reservations.iter().flat_map(|kept| ends(&kept.lease))
    }

    /// What its own flows have to carry, up to each control period after which that is less: its rate, and what others
    /// may send if no grant is renewed.
    fn needs(&self) -> Vec<(u32, f64)> {
        let mut ends: Vec<u32> = self.ends_of_promises().chain([self.period]).collect();
        ends.sort_unstable();
        ends.dedup();
        let kept = || self.reservations.iter();
        let promised = |period| kept().map(|kept| kept.lease.lasting(period)).sum::<f64>();
        ends.into_iter().map(|end| (end, promised(end) + self.rate)).collect()
    }

    /// What others may send to this robot.
    fn granted_to_others(&self) -> f64 {
        self.reservations.iter().map(|kept| kept.lease.flow()).sum()
    }

    /// The flows of this period are those in use, and c_i of eq. (5) is what they leave of what others
    /// may send, whether or not they do.
    pub(super) fn adopt_flows(&mut self) {
        let mut flows = self.flows.iter().peekable();
        for link in &mut self.links {
            let share = flows.next_if(|held| held.to == link.to).map_or(0.0, HeldFlow::load);
            if link.share != share {
                link.share = share;
            }
        }
        let granted = self.reservations.iter().map(|kept| (kept.from, kept.lease.flow()));
        self.inflows.clear();
        self.inflows.extend(granted.filter(|&(_, flow)| flow > 0.0));
        self.inflow = self.granted_to_others();
        self.residual = self.held_outflow() - self.inflow - self.rate;
        if self.residual.abs() < RESIDUAL_ROUNDING {
            self.residual = 0.0;
        }
    }
}
