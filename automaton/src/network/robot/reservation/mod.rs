//! Reservation: a robot sends to another only what that one has granted.
//!
//! The routing method and its sweeps say which flows would be best. The flows in use are held from one
//! control period to the next and change on request. A robot asks for the flows of its plan; it raises
//! F_ij to what the receiver has granted, and grants only what its own flows forward. It lowers F_ij
//! where the rest still carries what it has granted and its rate, and informs the receiver; or raises one and lowers
//! another by the same amount at once. So
//!
//! ```text
//! Σ_j F_ij − Σ_j (granted to j) − r_i ≥ 0
//! ```
//!
//! holds from the first period in which it does, as long as grants are renewed: a message that is lost
//! leaves flows as they are until a lease ends. A request is answered by a grant, which states all that is kept for the
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
//! found by probes ([`circles`]), and the rest granted for longer: it is left when the leases of the circle end.

mod circles;
mod held;
mod kept;
#[cfg(test)]
mod lemma;
#[cfg(test)]
mod tests;

use pleach_discrete::network::NodeId;
use pleach_discrete::network::reservation::Lease;
use serde::{Deserialize, Serialize};

use super::context::Context;
use super::places::Places;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;
use circles::Circles;
use held::{HeldFlow, HeldFlows};
use kept::{KeptFlow, KeptFlows, Terms};

pub use circles::Probe;

/// Control periods for which a grant holds at the least as long as no message is lost. Every flow is asked for
/// again in each of them.
const LEASE: u32 = 8;
/// A lease that will have ended this many control periods from now is about to end, and waits to be renewed.
const ABOUT_TO_END: u32 = LEASE - 2;
/// How many leases long packets flow to an access point that is not heard. It promises nothing to anyone, so
/// that nothing ends but its service.
const PATIENCE_WITH_ACCESS_POINTS: u32 = 2;
/// Flows that differ by less are the same.
const SAME_FLOW: f64 = 1e-12;

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

/// The plan for a flow in a control period.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// The receiver.
    pub to: NodeId,
    /// R_ij.
    pub reliability: f64,
    /// F_ij.
    pub flow: f64,
}

/// The flows of a robot that are in use: those that it sends, and what it has granted to others.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Reservation {
    held: HeldFlows,
    kept: KeptFlows,
    /// The number of its last request.
    last_request: RequestNumber,
    /// Whether a request or a grant has been received that has not been taken in.
    has_news: bool,
    circles: Circles,
}

impl RequestNumber {
    /// The number of the request that follows, in this control period.
    const fn next_in(self, period: u32) -> Self {
        let number = if self.period == period { self.number + 1 } else { 1 };
        RequestNumber { period, number }
    }
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

/// The control period in which what is about to end has ended.
const fn soon_after(period: u32) -> u32 {
    period.saturating_add(ABOUT_TO_END)
}

/// The control periods after which less of a lease holds.
fn ends(lease: &Lease<f64>) -> [u32; 2] {
    [lease.until(), lease.end()]
}

/// Control periods for which a robot grants flows that last as long, given for how many rounds news may be under way. A
/// robot farther from the access points grants its own for one period less, as it receives a renewal one period later.
pub(super) fn lease_of(longest_wait: usize) -> u32 {
    LEASE.saturating_add(longest_wait as u32)
}

impl Reservation {
    /// What is held of a link ends with it.
    pub(super) fn drop_flows_without_link(&mut self, has_link: impl Fn(NodeId) -> bool) {
        self.held.retain(has_link);
    }

    /// The plan stands: the robot asks for its flows, and stops those whose grants have ended.
    pub(super) fn ask_for_flows(
        &mut self,
        context: Context<'_>,
        plans: impl Iterator<Item = Plan>,
        places: &Places<'_>,
        lease: u32,
        outputs: &mut NodeOutputs,
    ) {
        let period = context.period;
        let knows_load = self.knows_load(places);
        let patience = PATIENCE_WITH_ACCESS_POINTS * lease;
        self.kept.pass(period);
        for mut plan in plans {
            // Where flows are not reported, the plan can be none.
            plan.flow = plan.flow.clamp(0.0, plan.reliability);
            let held = self.held.to(plan.to);
            if plan.flow == 0.0 && held.is_none() {
                continue;
            }
            let sends = held.is_some_and(HeldFlow::is_flowing);
            let may_rise = plan.flow != 0.0 && knows_load && places.are_known_of(plan.to, sends);
            let is_access_point = !context.is_robot(plan.to);
            let until =
                is_access_point.then(|| places.last_heard(plan.to).saturating_add(patience));
            self.held.plan(plan, may_rise, until, period);
        }
        self.note_waiting_leases(context);
        self.settle_flows(context, lease, outputs);
    }

    /// Whether the loads of its links are known, as it knows where all are to which packets flow. Where it
    /// does not, a receiver may have made a move to which it has consented: the load is certified for what
    /// flows, and for no more.
    fn knows_load(&self, places: &Places<'_>) -> bool {
        self.held.receivers().all(|node| places.are_known_of(node, true))
    }

    /// Takes in the requests and grants of the round; asks again, every few rounds, where there is no
    /// answer.
    pub(super) fn take_in_requests(
        &mut self,
        context: Context<'_>,
        lease: u32,
        outputs: &mut NodeOutputs,
    ) {
        let is_late = context.rounds.is_for_asking_again();
        if is_late {
            self.held.ask_again();
        }
        if is_late || self.has_news {
            self.settle_flows(context, lease, outputs);
        }
        if is_late {
            self.look_for_circles(context, outputs);
        }
    }

    /// Whether a request or a grant has been received that has not been taken in.
    pub(super) const fn has_news(&self) -> bool {
        self.has_news
    }

    /// Whether it asks again, or looks for circles, if it receives nothing.
    pub(super) fn asks_again(&self) -> bool {
        !self.held.are_answered() || self.circles.are_looked_for()
    }

    /// Whether packets flow to this node.
    pub(super) fn sends_to(&self, node: NodeId) -> bool {
        self.held.flows_to(node)
    }

    /// Whether it has ever asked this node for a flow over the link that it has to it now.
    pub(super) fn has_asked(&self, node: NodeId) -> bool {
        self.held.has_asked(node)
    }

    /// The robots that may send to this one.
    pub(super) fn senders(&self) -> impl Iterator<Item = NodeId> {
        self.kept.senders()
    }

    /// T_ij of the flows in use, ascending.
    pub(super) fn loads(&self) -> impl Iterator<Item = (NodeId, f64)> {
        self.held.loads()
    }

    /// Σ_j F_ij of the flows in use.
    pub(super) fn outflow(&self) -> f64 {
        self.held.outflow()
    }

    /// What others may send, ascending.
    pub(super) fn granted(&self) -> impl Iterator<Item = (NodeId, f64)> {
        self.kept.granted()
    }

    /// A sender asks for a flow.
    pub(super) fn receive_request(
        &mut self,
        context: Context<'_>,
        from: NodeId,
        request: FlowRequest,
    ) {
        self.has_news |= self.kept.receive_request(from, request, context.period);
    }

    /// A receiver answers a request.
    pub(super) fn receive_grant(&mut self, context: Context<'_>, from: NodeId, grant: FlowGrant) {
        self.has_news |= self.held.receive_grant(from, grant, context.period);
    }

    /// Raises flows as they are granted and lowers others that are not needed, makes the requests that are
    /// due, gives back what it does not use, and grants what it can forward. Every request gets an answer.
    fn settle_flows(&mut self, context: Context<'_>, lease: u32, outputs: &mut NodeOutputs) {
        self.has_news = false;
        if self.held.are_to_change() {
            self.held.change(&self.needs(context), context.period);
        }
        for held in self.held.take_requests().filter(|held| context.is_robot(held.to())) {
            let number = self.last_request.next_in(context.period);
            self.last_request = number;
            outputs.send(held.to(), Message::AskFlow(held.request(number)));
        }
        if self.kept.have_unmet(context.period) {
            self.grant_flows(context, lease, outputs);
        }
    }

    /// Answers requests: grants more as far as its own flows carry that for as long, and all that it has granted for as
    /// long as these last; [a part](KeptFlow::part_besides) for longer where a circle of flows has been found. What is
    /// about to end is renewed without another request, so that all leases of a circle are renewed in the same control
    /// period.
    fn grant_flows(&mut self, context: Context<'_>, lease: u32, outputs: &mut NodeOutputs) {
        let period = context.period;
        let last = period.saturating_add(lease);
        let needed = self.kept.granted_in_all() + context.rate;
        let carried = (needed + self.kept.wanted_beyond()).min(self.held.outflow());
        let until = self.held.last_until(carried).unwrap_or(period).min(last);
        let terms = Terms {
            period,
            until,
            longer: self.parts_last_until(until, last, context.rate),
            spare: self.held.lasting(until) - needed,
            may_raise: context.rounds.is_for_grants(),
            circles: &self.circles,
        };
        for (sender, grant) in self.kept.grant(&terms) {
            outputs.send(sender, Message::GrantFlow(grant));
        }
    }

    /// Until when its flows carry [parts](KeptFlow::part_besides) of what it has granted, where that is longer than
    /// until the period up to which they carry all of it; `last` at the latest.
    fn parts_last_until(&self, until: u32, last: u32, rate: f64) -> Option<u32> {
        let circles = &self.circles;
        if !circles.are_known() {
            return None;
        }
        // What has been promised already holds in any case.
        let part =
            |kept: &KeptFlow, period| kept.part_besides(circles).max(kept.lease().lasting(period));
        let is_carried = |period: u32| {
            let parts = self.kept.all().iter().map(|kept| part(kept, period)).sum::<f64>();
            self.held.lasting(period) >= rate + parts - SAME_FLOW
        };
        let promised = self.kept.ends().filter(|&end| end > until);
        let short = promised.filter(|&end| !is_carried(end)).min();
        let ends = self.held.ends().map(|end| end.min(last));
        let carries =
            |&end: &u32| end > until && short.is_none_or(|it| end < it) && is_carried(end);
        ends.filter(carries).max()
    }

    /// What its own flows have to carry, up to each control period after which that is less: its rate, and what others
    /// may send if no grant is renewed.
    fn needs(&self, context: Context<'_>) -> Vec<(u32, f64)> {
        let promises = self.kept.promises(context.period);
        promises.map(|(end, promised)| (end, promised + context.rate)).collect()
    }
}

#[cfg(test)]
impl Reservation {
    /// So much flows to this node, over a lease that lasts.
    pub(super) fn sends(&mut self, to: NodeId, flow: f64) {
        self.held.set(to, flow, Lease::of(f64::INFINITY, u32::MAX));
    }
}
