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
//! holds from the first period in which it does, whatever becomes of messages: a message that is lost
//! leaves flows as they are. A grant answers one request, and a new request voids the grants before it,
//! so that late messages and copies change nothing.
//!
//! A grant says until when it holds, which is never longer than the flows of the receiver last that carry it:
//! where grants are not renewed, flows end at those who send first.

use pleach_discrete::network::NodeId;
use pleach_discrete::network::reservation::{Spare, holds, renewed};
use serde::{Deserialize, Serialize};

use super::super::message::Message;
use super::super::record::MissionEvent;
use super::Robot;
use super::routing::{RESIDUAL_ROUNDING, RouteLink, link_at};
use crate::node::Outputs;

#[cfg(test)]
mod lemma;

/// Control periods for which a grant holds at the least as long as no message is lost. Every flow is asked for
/// again in each of them.
const LEASE: u32 = 8;
/// How many leases long packets flow to an access point that is not heard. It promises nothing to anyone, so
/// that nothing ends but its service.
const PATIENCE_WITH_ACCESS_POINTS: u32 = 2;
/// Flows that differ by less are the same.
const SAME_FLOW: f64 = 1e-12;
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

/// An answer to a request for a flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlowGrant {
    /// The number of the request.
    pub number: RequestNumber,
    /// The largest F_ij that the sender may use.
    pub flow: f64,
    /// The last control period in which it may.
    pub until: u32,
}

/// What a sender uses of a link, and what it may use.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct HeldFlow {
    /// F_ij as it is in use.
    pub flow: f64,
    /// F_ij as it is planned.
    wanted: f64,
    /// The largest F_ij that the receiver has granted.
    granted: f64,
    /// The number of the last request.
    asked: RequestNumber,
    /// Whether the last request waits for an answer.
    is_open: bool,
    /// Whether a request is to be made.
    is_due: bool,
    /// The last control period in which the grant holds.
    pub until: u32,
}

/// What a receiver keeps for a sender.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reservation {
    from: NodeId,
    /// The largest F_ij that the sender may use.
    pub flow: f64,
    wanted: f64,
    /// The number of the last request, and whether it has been answered.
    asked: RequestNumber,
    is_answered: bool,
    /// The last control period in which the grant holds.
    pub until: u32,
}

type Out = Outputs<Message, MissionEvent>;

impl Reservation {
    /// Whether its request waits for an answer, or for more than has been granted.
    fn is_unmet(&self) -> bool {
        !self.is_answered || self.wanted > self.flow + SAME_FLOW
    }
}

impl HeldFlow {
    /// Whether packets flow, or shall. Other links have nothing to raise, to lower or to keep.
    const fn is_in_use(&self) -> bool {
        self.flow > 0.0 || self.wanted > 0.0
    }

    /// Whether the flow is to be raised or lowered.
    fn is_to_change(&self) -> bool {
        self.allowed() > self.flow + SAME_FLOW || self.wanted < self.flow - SAME_FLOW
    }

    /// What the plan and the receiver's grant allow.
    fn allowed(&self) -> f64 {
        self.wanted.min(self.granted)
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
        self.granted > self.flow + SAME_FLOW && self.wanted <= self.flow + SAME_FLOW
    }
}

/// Raises flows and lowers others by as much, at once, where that takes no more time. A sender that has neither time
/// nor flows to spare could not leave a link that hardly carries anything otherwise. Returns how much is taken over.
fn replace_flows(links: &mut [&mut RouteLink], promised: u32) -> f64 {
    let mut taken_over = 0.0;
    let count = links.len();
    for (more, less) in (0..count).flat_map(|more| (0..count).map(move |less| (more, less))) {
        if !links[more].held.can_rise() || !links[less].held.can_fall() {
            continue;
        }
        let Ok([more, less]) = links.get_disjoint_mut([more, less]) else { continue };
        let lasts = |link: &RouteLink| holds(link.held.until, promised);
        if more.reliability < less.reliability || lasts(less) && !lasts(more) {
            continue;
        }
        let taken = more.held.raise((less.held.flow - less.held.wanted).max(0.0));
        less.held.lower(taken);
        taken_over += taken;
    }
    taken_over
}

impl Robot {
    /// The plan stands: the robot asks for its flows, and stops those whose grants have ended.
    pub(super) fn ask_for_flows(&mut self, outputs: &mut Out) {
        let (period, robots) = (self.period, self.site.robots);
        let patience = PATIENCE_WITH_ACCESS_POINTS * self.lease();
        let knows_load = self.knows_load();
        self.reservations.retain(|kept| holds(kept.until, period));
        for at in 0..self.links.len() {
            let link = &self.links[at];
            let to = link.to;
            // Where flows are not reported, the plan can be none.
            let planned = link.flow().clamp(0.0, link.reliability);
            let can_raise = planned != 0.0 && knows_load && self.knows_place_of(to);
            if to >= robots {
                // An access point takes everything, as long as it is there.
                let heard_in = self.neighbour(to).map_or(0, |known| known.heard_in);
                let held = &mut self.links[at].held;
                (held.granted, held.until) = (f64::INFINITY, heard_in.saturating_add(patience));
            }
            let link = &mut self.links[at];
            let held = &mut link.held;
            if !holds(held.until, period) {
                (held.flow, held.granted) = (0.0, 0.0);
            }
            let most = if can_raise { planned } else { planned.min(held.flow) };
            held.wanted = if link.is_retiring { 0.0 } else { most };
            held.is_due = to < robots && (held.is_in_use() || held.is_open);
        }
        self.settle_flows(outputs);
    }

    /// Whether the loads of its links are known, as it knows where all are to which packets flow. Where it
    /// does not, a receiver may have made a move to which it has consented: the load is certified for what
    /// flows, and for no more.
    fn knows_load(&self) -> bool {
        let mut receivers = self.links.iter().filter(|link| link.held.flow > 0.0);
        receivers.all(|link| self.knows_place_of(link.to))
    }

    /// Takes in the requests and grants of the round; asks again, every few rounds, where there is no
    /// answer.
    pub(super) fn take_in_requests(&mut self, outputs: &mut Out) {
        let is_late = self.round_count.is_for_asking_again();
        if is_late {
            self.links.iter_mut().for_each(|link| link.held.is_due = link.held.is_open);
        }
        if is_late || self.has_flow_news {
            self.settle_flows(outputs);
        }
    }

    /// Whether every request has been answered.
    pub(super) fn requests_are_answered(&self) -> bool {
        !self.links.iter().any(|link| link.held.is_open)
    }

    /// Whether packets flow to this node.
    pub(super) fn sends_to(&self, node: NodeId) -> bool {
        self.link(node).is_some_and(|link| link.held.flow > 0.0)
    }

    /// Whether it has ever asked this node for a flow over the link that it has to it now.
    pub(super) fn has_asked(&self, node: NodeId) -> bool {
        self.link(node).is_some_and(|link| link.held.asked != RequestNumber::default())
    }

    /// The robots that may send to this one.
    pub(super) fn senders(&self) -> impl Iterator<Item = NodeId> {
        self.reservations.iter().filter(|kept| kept.flow > 0.0).map(|kept| kept.from)
    }

    fn ask(&mut self, at: usize, outputs: &mut Out) {
        let RequestNumber { period, number } = self.last_request;
        let number = if period == self.period { number + 1 } else { 1 };
        self.last_request = RequestNumber { period: self.period, number };
        let RouteLink { to, held, .. } = &mut self.links[at];
        // What was granted before is void, beyond what is in use.
        (held.asked, held.granted, held.is_open) = (self.last_request, held.flow, true);
        let HeldFlow { asked: number, flow, wanted, .. } = *held;
        outputs.send(*to, Message::AskFlow(FlowRequest { number, held: flow, wanted }));
    }

    /// A sender asks for a flow.
    pub(super) fn hear_request(&mut self, from: NodeId, request: FlowRequest) {
        let FlowRequest { number, held, wanted } = request;
        let known = self.reservations.binary_search_by_key(&from, |kept| kept.from);
        if known.is_ok_and(|at| number <= self.reservations[at].asked) {
            return;
        }
        let (flow, until) = known.map_or((0.0, self.period), |at| {
            let kept = &self.reservations[at];
            (kept.flow.min(held).max(0.0), kept.until)
        });
        let kept = Reservation { from, flow, wanted, asked: number, is_answered: false, until };
        match known {
            Ok(at) => self.reservations[at] = kept,
            Err(at) => self.reservations.insert(at, kept),
        }
        self.has_flow_news = true;
    }

    /// A receiver answers a request.
    pub(super) fn hear_grant(&mut self, from: NodeId, grant: FlowGrant) {
        let Some(at) = link_at(&self.links, from) else { return };
        let held = &mut self.links[at].held;
        if held.asked == grant.number {
            (held.is_open, held.until) = (false, renewed(held.until, grant.until));
            held.granted = held.granted.max(grant.flow);
            self.has_flow_news = true;
        }
    }

    /// Raises flows as they are granted and lowers others that are not needed, makes the requests that are
    /// due, gives back what it does not use, and grants what it can forward. Every request gets an answer.
    fn settle_flows(&mut self, outputs: &mut Out) {
        self.has_flow_news = false;
        if self.links_in_use().any(|link| link.held.is_to_change()) {
            self.change_flows();
        }
        for at in 0..self.links.len() {
            let held = &mut self.links[at].held;
            if held.allowed() > held.flow + SAME_FLOW {
                // There is no room for more in this period.
                held.wanted = held.flow;
            }
            let is_due = std::mem::take(&mut held.is_due) || held.can_be_given_back();
            if is_due && self.links[at].to < self.site.robots {
                self.ask(at, outputs);
            }
        }
        if self.reservations.iter().any(Reservation::is_unmet) {
            self.grant_flows(outputs);
        }
    }

    /// Raises flows as far as they are granted and there is time to send, lowers others as far as the rest
    /// carries what it has granted, for as long, and replaces one by another.
    fn change_flows(&mut self) {
        let (needed, promised) = (self.needed_outflow(), self.promised_until());
        let mut in_use: Vec<&mut RouteLink> = Vec::with_capacity(self.links.len());
        in_use.extend(self.links.iter_mut().filter(|link| link.held.is_in_use()));
        for _ in 0..PASSES {
            let mut change = 0.0;
            let mut room = 1.0 - in_use.iter().map(|link| link.load()).sum::<f64>();
            for link in &mut in_use {
                let more = link.held.raise(room.max(0.0) * link.reliability);
                room -= more / link.reliability;
                change += more;
            }
            let lasting = in_use.iter().filter(|link| holds(link.held.until, promised));
            let mut spare = lasting.map(|link| link.held.flow).sum::<f64>() - needed;
            for link in &mut in_use {
                let less = link.held.lower(spare.max(0.0));
                spare -= less;
                change += less;
            }
            change += replace_flows(&mut in_use, promised);
            if change == 0.0 {
                break;
            }
        }
    }

    /// Answers requests: grants more as far as its own flows carry that for as long, and all that it has
    /// granted for as long as these last.
    fn grant_flows(&mut self, outputs: &mut Out) {
        let (needed, promised) = (self.needed_outflow(), self.promised_until());
        let wanted = self.reservations.iter().map(|kept| (kept.wanted - kept.flow).max(0.0));
        let carried = (needed + wanted.sum::<f64>()).min(self.held_outflow());
        let until = self.lasts_until(carried).min(self.period.saturating_add(self.lease()));
        let mut spare = Spare::of(self.lasting_outflow(until.max(promised)) - needed);
        let may_grant = self.round_count.is_for_grants();
        for kept in &mut self.reservations {
            let flow = spare.most(kept.flow, kept.wanted);
            let can_grant = flow > kept.flow + SAME_FLOW && may_grant;
            if can_grant {
                spare.grant(kept.flow, flow);
                kept.flow = flow;
            }
            if can_grant || !std::mem::replace(&mut kept.is_answered, true) {
                kept.until = renewed(kept.until, until);
                let grant = FlowGrant { number: kept.asked, flow: kept.flow, until: kept.until };
                outputs.send(kept.from, Message::GrantFlow(grant));
            }
        }
    }

    /// Control periods for which it grants flows that last as long. A robot farther from the access points
    /// grants its own for one period less, as it hears of a renewal one period later.
    pub(super) fn lease(&self) -> u32 {
        LEASE.saturating_add(self.longest_wait() as u32)
    }

    fn links_in_use(&self) -> impl Iterator<Item = &RouteLink> {
        self.links.iter().filter(|link| link.held.is_in_use())
    }

    /// What its own flows have to carry: its rate and what others may send.
    fn needed_outflow(&self) -> f64 {
        self.granted_to_others() + self.rate
    }

    fn held_outflow(&self) -> f64 {
        self.links_in_use().map(|link| link.held.flow).sum()
    }

    /// The flows that last up to this control period, even if no grant is renewed.
    fn lasting_outflow(&self, period: u32) -> f64 {
        let lasting = self.links_in_use().filter(|link| holds(link.held.until, period));
        lasting.map(|link| link.held.flow).sum()
    }

    /// The last control period up to which flows last that carry this much.
    fn lasts_until(&self, carried: f64) -> u32 {
        let flows = self.links_in_use().filter(|link| link.held.flow > 0.0);
        let lasts = |&end: &u32| self.lasting_outflow(end) >= carried - SAME_FLOW;
        flows.map(|link| link.held.until).filter(lasts).max().unwrap_or(self.period)
    }

    /// The last control period for which it has granted a flow; what it grants more may be used as long.
    fn promised_until(&self) -> u32 {
        self.reservations.iter().map(|kept| kept.until).max().unwrap_or(self.period)
    }

    /// What others may send to this robot.
    fn granted_to_others(&self) -> f64 {
        self.reservations.iter().map(|kept| kept.flow).sum()
    }

    /// The flows of this period are those in use, and c_i of eq. (5) is what they leave of what others
    /// may send, whether or not they do.
    pub(super) fn adopt_flows(&mut self) {
        for link in &mut self.links {
            link.share = link.load();
        }
        let kept = self.reservations.iter().filter(|kept| kept.flow > 0.0);
        self.inflows.clear();
        self.inflows.extend(kept.map(|kept| (kept.from, kept.flow)));
        self.inflow = self.granted_to_others();
        self.residual = self.held_outflow() - self.inflow - self.rate;
        if self.residual.abs() < RESIDUAL_ROUNDING {
            self.residual = 0.0;
        }
    }
}
