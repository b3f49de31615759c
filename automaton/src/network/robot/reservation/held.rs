//! The flows that a robot sends: what it uses of each link, and what it may use.

use pleach_discrete::network::NodeId;
use pleach_discrete::network::reservation::Lease;

use super::{FlowGrant, FlowRequest, Plan, RequestNumber, SAME_FLOW, ends, soon_after};

/// Passes in which some flows are raised and others lowered to make room for them.
const PASSES: usize = 4;

/// What a sender uses of a link, and what it may use. It is kept from the first plan with a flow on, as long as there
/// is a link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct HeldFlow {
    /// The receiver.
    to: NodeId,
    /// R_ij.
    reliability: f64,
    /// F_ij as it is in use.
    flow: f64,
    /// F_ij as it is planned.
    wanted: f64,
    /// The largest F_ij that the receiver has granted, and until when.
    lease: Lease<f64>,
    /// The number of the last request.
    asked: RequestNumber,
    /// Whether the last request waits for an answer.
    is_open: bool,
    /// Whether a request is to be made.
    is_due: bool,
}

impl HeldFlow {
    /// The receiver.
    pub(super) const fn to(&self) -> NodeId {
        self.to
    }

    /// T_ij.
    fn load(&self) -> f64 {
        self.flow / self.reliability
    }

    /// Whether packets flow.
    pub(super) const fn is_flowing(&self) -> bool {
        self.flow > 0.0
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

    /// Begins a control period with this plan, and stops what the grants do not cover any more. The flow may be raised to
    /// the plan, or only fall; to an access point packets may flow until some control period.
    fn plan(&mut self, plan: Plan, may_rise: bool, until: Option<u32>, period: u32) {
        self.reliability = plan.reliability;
        if let Some(until) = until {
            // An access point takes everything, as long as it is there.
            self.lease = Lease::of(f64::INFINITY, until);
        }
        self.lease.pass(period);
        self.flow = self.flow.min(self.lease.flow());
        self.wanted = if may_rise { plan.flow } else { plan.flow.min(self.flow) };
        self.is_due = until.is_none() && (self.is_in_use() || self.is_open);
    }

    /// Whether a request is to be made now that flows have been changed as far as possible: one that is due, or that gives
    /// back what the receiver keeps in vain.
    fn takes_request(&mut self) -> bool {
        if self.allowed() > self.flow + SAME_FLOW {
            // There is no room for more in this period.
            self.wanted = self.flow;
        }
        let is_due = std::mem::take(&mut self.is_due);
        is_due || self.can_be_given_back()
    }

    /// Whether the receiver keeps more for the sender than it has a use for.
    fn can_be_given_back(&self) -> bool {
        self.lease.flow() > self.flow + SAME_FLOW && self.wanted <= self.flow + SAME_FLOW
    }

    /// The request with this number. What was granted before is void, beyond what is in use.
    pub(super) fn request(&mut self, number: RequestNumber) -> FlowRequest {
        self.lease.limit(self.flow);
        (self.asked, self.is_open) = (number, true);
        FlowRequest { number, held: self.flow, wanted: self.wanted }
    }
}

/// The flows that a robot sends, in the order of their receivers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct HeldFlows(Vec<HeldFlow>);

impl HeldFlows {
    /// Where the flow to `node` is, or where it belongs.
    fn place_of(&self, node: NodeId) -> Result<usize, usize> {
        self.0.binary_search_by_key(&node, |held| held.to)
    }

    pub(super) fn to(&self, node: NodeId) -> Option<&HeldFlow> {
        self.place_of(node).ok().map(|at| &self.0[at])
    }

    pub(super) fn all(&self) -> &[HeldFlow] {
        &self.0
    }

    /// What is held of a link ends with it.
    pub(super) fn retain(&mut self, has_link: impl Fn(NodeId) -> bool) {
        self.0.retain(|held| has_link(held.to));
    }

    /// Begins a control period with this plan for a flow, as [`HeldFlow::plan`].
    pub(super) fn plan(&mut self, plan: Plan, may_rise: bool, until: Option<u32>, period: u32) {
        let at = self.place_of(plan.to).unwrap_or_else(|at| {
            self.0.insert(at, HeldFlow { to: plan.to, ..HeldFlow::default() });
            at
        });
        self.0[at].plan(plan, may_rise, until, period);
    }

    /// Requests that wait for an answer are to be made again.
    pub(super) fn ask_again(&mut self) {
        self.0.iter_mut().for_each(|held| held.is_due = held.is_open);
    }

    /// The flows for which a request is to be made now.
    pub(super) fn take_requests(&mut self) -> impl Iterator<Item = &mut HeldFlow> {
        self.0.iter_mut().filter_map(|held| held.takes_request().then_some(held))
    }

    /// The receiver of a flow answers a request; returns whether it was the last one.
    pub(super) fn receive_grant(&mut self, from: NodeId, grant: FlowGrant, period: u32) -> bool {
        let Ok(at) = self.place_of(from) else { return false };
        let held = &mut self.0[at];
        if held.asked != grant.number {
            return false;
        }
        held.is_open = false;
        let mut kept = grant.lease();
        // It may have ended on its way, and what it renews as well.
        kept.pass(period);
        held.lease.pass(period);
        held.lease.hear(kept);
        true
    }

    /// Whether every request has been answered.
    pub(super) fn are_answered(&self) -> bool {
        !self.0.iter().any(|held| held.is_open)
    }

    /// Whether packets flow to this node.
    pub(super) fn flows_to(&self, node: NodeId) -> bool {
        self.to(node).is_some_and(HeldFlow::is_flowing)
    }

    /// Whether this node has been asked for a flow over the link that there is now.
    pub(super) fn has_asked(&self, node: NodeId) -> bool {
        self.to(node).is_some_and(|held| held.asked != RequestNumber::default())
    }

    /// The nodes to which packets flow.
    pub(super) fn receivers(&self) -> impl Iterator<Item = NodeId> {
        self.0.iter().filter(|held| held.is_flowing()).map(|held| held.to)
    }

    /// T_ij of each flow.
    pub(super) fn loads(&self) -> impl Iterator<Item = (NodeId, f64)> {
        self.0.iter().map(|held| (held.to, held.load()))
    }

    fn in_use(&self) -> impl Iterator<Item = &HeldFlow> {
        self.0.iter().filter(|held| held.is_in_use())
    }

    /// Σ_j F_ij.
    pub(super) fn outflow(&self) -> f64 {
        self.in_use().map(|held| held.flow).sum()
    }

    /// What is left of the flows in a control period ahead if no grant is renewed.
    pub(super) fn lasting(&self, period: u32) -> f64 {
        self.in_use().map(|held| held.lasting(period)).sum()
    }

    /// The control periods after which less flows if no grant is renewed.
    pub(super) fn ends(&self) -> impl Iterator<Item = u32> {
        self.in_use().filter(|held| held.is_flowing()).flat_map(|held| ends(&held.lease))
    }

    /// The last control period up to which flows last that carry this much.
    pub(super) fn last_until(&self, carried: f64) -> Option<u32> {
        self.ends().filter(|&end| self.lasting(end) >= carried - SAME_FLOW).max()
    }

    /// Whether a flow is to be raised or lowered.
    pub(super) fn are_to_change(&self) -> bool {
        self.in_use().any(HeldFlow::is_to_change)
    }

    /// Raises flows as far as they are granted and there is time to send, lowers others as far as the rest
    /// carries these needs, each up to its control period, and replaces one by another.
    pub(super) fn change(&mut self, needs: &[(u32, f64)], period: u32) {
        let promised = needs.last().map_or(period, |&(period, _)| period);
        let mut in_use: Vec<&mut HeldFlow> = Vec::with_capacity(self.0.len());
        in_use.extend(self.0.iter_mut().filter(|held| held.is_in_use()));
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

#[cfg(test)]
impl HeldFlow {
    /// F_ij, the lease, and the number of the last request.
    pub(super) const fn parts(&self) -> (f64, Lease<f64>, RequestNumber) {
        (self.flow, self.lease, self.asked)
    }
}

#[cfg(test)]
impl HeldFlows {
    /// This much flows to a node, by this lease.
    pub(super) fn set(&mut self, to: NodeId, flow: f64, lease: Lease<f64>) {
        let plan = Plan { to, reliability: 1.0, flow: 0.0 };
        if self.to(to).is_none() {
            self.plan(plan, false, None, 0);
        }
        let Ok(at) = self.place_of(to) else { return };
        (self.0[at].flow, self.0[at].lease) = (flow, lease);
    }
}
