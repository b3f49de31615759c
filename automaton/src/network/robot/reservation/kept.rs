//! What a robot keeps for those that send to it.

use pleach_discrete::network::NodeId;
use pleach_discrete::network::reservation::{Lease, Spare};

use super::circles::Circles;
use super::{FlowGrant, FlowRequest, RequestNumber, SAME_FLOW, ends, soon_after};

/// What a receiver keeps for a sender.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KeptFlow {
    from: NodeId,
    /// The largest F_ij that the sender may use, and until when.
    lease: Lease<f64>,
    wanted: f64,
    /// The number of the last request, and whether it has been answered.
    asked: RequestNumber,
    is_answered: bool,
}

/// What a robot grants from what its own flows carry.
pub(super) struct Terms<'a> {
    /// The control period.
    pub period: u32,
    /// The last control period up to which its flows carry all that is granted.
    pub until: u32,
    /// The last up to which they carry [parts](KeptFlow::part_besides) of it, if that is later.
    pub longer: Option<u32>,
    /// What they carry beyond what has been granted.
    pub spare: f64,
    /// Whether more may be granted than has been.
    pub may_raise: bool,
    /// The circles of flows that it is part of.
    pub circles: &'a Circles,
}

impl KeptFlow {
    /// The lease of the sender.
    pub(super) const fn lease(&self) -> Lease<f64> {
        self.lease
    }

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
    pub(super) fn part_besides(&self, circles: &Circles) -> f64 {
        let all = self.lease.flow();
        (all - circles.set_aside_from(self.from)).clamp(0.0, all)
    }

    /// Whether its sender has asked for it in this control period, and some of it is about to end.
    fn waits(&self, period: u32) -> bool {
        self.asked.period == period && self.lease.lasting(soon_after(period)) < self.lease.flow()
    }

    /// Grants more as far as there is something to spare for as long, and what has been granted for as long as flows last
    /// that carry it; returns the grant to send, if any.
    fn grant(&mut self, terms: &Terms<'_>, spare: &mut Spare<f64>) -> Option<FlowGrant> {
        let (sent, waits) = (self.lease, self.waits(terms.period));
        let part = terms.longer.map(|longer| (self.part_besides(terms.circles), longer));
        let (before, lease) = (sent.flow(), &mut self.lease);
        let flow = spare.most(before, self.wanted);
        let can_grant =
            flow > before + SAME_FLOW && terms.may_raise && lease.promise(flow, terms.until);
        if can_grant {
            spare.grant(before, flow);
        }
        let answers = can_grant || !std::mem::replace(&mut self.is_answered, true);
        if answers || waits {
            lease.promise(before, terms.until);
            if let Some((flow, longer)) = part {
                lease.promise(flow, longer);
            }
        }
        (answers || *lease != sent).then(|| FlowGrant::of(self.asked, lease))
    }
}

/// What a robot keeps for its senders, in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct KeptFlows(Vec<KeptFlow>);

impl KeptFlows {
    /// Where what is kept for this sender is, or where it belongs.
    fn place_of(&self, sender: NodeId) -> Result<usize, usize> {
        self.0.binary_search_by_key(&sender, |kept| kept.from)
    }

    pub(super) fn all(&self) -> &[KeptFlow] {
        &self.0
    }

    /// Begins this control period: leases end.
    pub(super) fn pass(&mut self, period: u32) {
        self.0.iter_mut().for_each(|kept| kept.pass(period));
        self.0.retain(|kept| kept.lease.until() >= period);
    }

    /// A sender asks for a flow; returns whether it is a new request. That voids what was granted before, beyond what is
    /// in use.
    pub(super) fn receive_request(
        &mut self,
        from: NodeId,
        request: FlowRequest,
        period: u32,
    ) -> bool {
        let FlowRequest { number, held, wanted } = request;
        let known = self.place_of(from);
        if known.is_ok_and(|at| number <= self.0[at].asked) {
            return false;
        }
        let mut lease = known.map_or(Lease::of(0.0, period), |at| self.0[at].lease);
        lease.limit(held.max(0.0));
        let kept = KeptFlow { from, lease, wanted, asked: number, is_answered: false };
        match known {
            Ok(at) => self.0[at] = kept,
            Err(at) => self.0.insert(at, kept),
        }
        true
    }

    /// The robots that may send to this one.
    pub(super) fn senders(&self) -> impl Iterator<Item = NodeId> {
        self.0.iter().filter(|kept| kept.lease.flow() > 0.0).map(|kept| kept.from)
    }

    /// What each sender may use.
    pub(super) fn granted(&self) -> impl Iterator<Item = (NodeId, f64)> {
        self.0.iter().map(|kept| (kept.from, kept.lease.flow()))
    }

    /// What this node may send.
    pub(super) fn granted_to(&self, node: NodeId) -> f64 {
        self.place_of(node).map_or(0.0, |at| self.0[at].lease.flow())
    }

    /// What all may send.
    pub(super) fn granted_in_all(&self) -> f64 {
        self.granted().map(|(_, flow)| flow).sum()
    }

    /// What senders want beyond what they may use.
    pub(super) fn wanted_beyond(&self) -> f64 {
        self.0.iter().map(|kept| (kept.wanted - kept.lease.flow()).max(0.0)).sum()
    }

    /// Whether a request waits for an answer, or a lease to be renewed.
    pub(super) fn have_unmet(&self, period: u32) -> bool {
        self.0.iter().any(|kept| kept.is_unmet() || kept.waits(period))
    }

    /// The control periods after which less is promised if no grant is renewed.
    pub(super) fn ends(&self) -> impl Iterator<Item = u32> {
        self.0.iter().flat_map(|kept| ends(&kept.lease))
    }

    /// What is promised, up to each control period after which that is less if no grant is renewed.
    pub(super) fn promises(&self, period: u32) -> impl Iterator<Item = (u32, f64)> {
        let mut ends: Vec<u32> = self.ends().chain([period]).collect();
        ends.sort_unstable();
        ends.dedup();
        let promised = |end| self.0.iter().map(|kept| kept.lease.lasting(end)).sum();
        ends.into_iter().map(move |end| (end, promised(end)))
    }

    /// Answers requests, and renews what is about to end.
    pub(super) fn grant(&mut self, terms: &Terms<'_>) -> impl Iterator<Item = (NodeId, FlowGrant)> {
        let mut spare = Spare::of(terms.spare);
        self.0.iter_mut().filter_map(move |kept| {
            let grant = kept.grant(terms, &mut spare)?;
            Some((kept.from, grant))
        })
    }
}

#[cfg(test)]
impl KeptFlows {
    /// What is kept for a sender, and the number of its last request.
    pub(super) fn of(&self, sender: NodeId) -> Option<(Lease<f64>, RequestNumber)> {
        self.place_of(sender).ok().map(|at| (self.0[at].lease, self.0[at].asked))
    }

    /// This much is kept for a sender that has asked.
    pub(super) fn set(&mut self, sender: NodeId, lease: Lease<f64>) {
        if let Ok(at) = self.place_of(sender) {
            self.0[at].lease = lease;
        }
    }
}
