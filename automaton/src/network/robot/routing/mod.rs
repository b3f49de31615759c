//! Routing: the dual iteration (13)–(14) or ADAL, then a sweep that makes the routes feasible.
//!
//! In every control period the robot exchanges multipliers and flows with the neighbours that it
//! can send to, a few times ([`iteration`]). Then the [`sweep`] goes up the tree, deepest robots first: each sends
//! what is missing for c_i ≥ η over its tree link, so that the routes are feasible at every t_k
//! whatever the dual iterate is. Both change the shares of its [`links`]; the [`balance`] is what these leave of what
//! flows in.

mod balance;
mod iteration;
mod links;
mod sweep;
#[cfg(test)]
mod tests;

use pleach_continuous::network::routing::adal::NeighbourReport;
use pleach_discrete::network::NodeId;

use super::context::Context;
use super::revision::{Revision, Stamp};
use crate::network::member::NodeOutputs;
use crate::network::scenario::RoutingMethod;
use balance::Balance;
use iteration::Iteration;
use links::Links;
use sweep::Sweep;

pub(super) use links::Receiver;
pub use links::RouteLink;

/// How a robot routes its packets: the links over which it may send, and the plan of a control period.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Routing {
    /// r_i.
    rate: f64,
    links: Links,
    iteration: Iteration,
    sweep: Sweep,
    balance: Balance,
    /// The parent to which it sends its demand in this period.
    parent: Option<NodeId>,
    /// What links and parent were found with.
    found_at: Stamp,
    /// The routes of the period before do not carry the rates.
    falls_short: bool,
}

/// What routes are planned over in a control period.
pub(super) struct Survey {
    /// The parent in the tree.
    pub parent: Option<NodeId>,
    /// The neighbours, ascending.
    pub receivers: Vec<Receiver>,
}

impl Routing {
    /// That of a robot with the rate r_i and without links.
    pub(super) fn new(method: RoutingMethod, rate: f64) -> Self {
        Routing {
            rate,
            links: Links::default(),
            iteration: Iteration::new(method),
            sweep: Sweep::default(),
            balance: Balance::default(),
            parent: None,
            found_at: Stamp::default(),
            falls_short: false,
        }
    }

    /// Whether its links have been found at this revision.
    pub(super) fn has_links_of(&self, revision: Revision) -> bool {
        self.found_at.is_of(revision)
    }

    /// Whether a survey would find the links and the parent that it has.
    pub(super) fn would_find(&self, context: Context<'_>, survey: &Survey) -> bool {
        let found = self.links.to(&survey.receivers, context);
        self.links.are_those_of(&found) && self.parent == survey.parent
    }

    /// Takes over the links of a survey. One that is retiring goes with its flow, and is looked for again.
    pub(super) fn find_links(&mut self, context: Context<'_>, survey: &Survey, revision: Revision) {
        self.links = self.links.to(&survey.receivers, context);
        self.parent = survey.parent;
        self.iteration.set_step_size(self.links.safe_dual_step(context));
        self.found_at.renew(revision);
        if self.links.has_retiring() {
            self.found_at.expire();
        }
    }

    /// A control period's routes begin with what the routing method made of them in the period before.
    pub(super) fn begin_period(&mut self) {
        self.links.begin_period();
        self.iteration.begin_period();
        self.sweep.begin_period();
        self.balance.begin_period();
    }

    /// The flows of the period before are known over the links as they are now.
    pub(super) fn begin(&mut self, context: Context<'_>) {
        let residual = self.balance.residual_now(&self.links, context);
        self.iteration.begin(residual, &self.links, context);
    }

    /// Sends how its equation c_i ≥ η stands: in the first iteration of a period, and when that has changed.
    pub(super) fn send_report(&mut self, outputs: &mut NodeOutputs) {
        self.iteration.send_report(self.parent, outputs);
    }

    /// A neighbour reports how its equation stands, and where its demand will go.
    pub(super) fn receive_report(
        &mut self,
        context: Context<'_>,
        from: NodeId,
        report: NeighbourReport,
        parent: Option<NodeId>,
    ) {
        if self.links.receive_report(from, report) {
            self.iteration.note_new_multiplier();
        }
        if parent == Some(context.id) {
            self.sweep.expect(from);
        }
    }

    /// The primal iteration (13), or that of ADAL.
    pub(super) fn primal_step(&mut self, context: Context<'_>) {
        self.iteration.primal_step(&mut self.links, context);
    }

    /// Sends its flows to their receivers, where they have changed.
    pub(super) fn send_flows(&mut self, context: Context<'_>, outputs: &mut NodeOutputs) {
        if self.links.send_flows(context, outputs) {
            self.balance.note_new_outflow();
        }
    }

    /// A neighbour reports the flow that it sends to this robot.
    pub(super) fn receive_flow(&mut self, from: NodeId, flow: f64) {
        self.balance.receive_flow(from, flow);
        self.iteration.note_new_flow();
    }

    /// The dual iteration (14), or that of ADAL.
    pub(super) fn dual_step(&mut self, context: Context<'_>) {
        let residual = self.balance.residual_now(&self.links, context);
        self.iteration.dual_step(residual, &self.links, context);
    }

    /// Whether further iterations change nothing, as long as nothing new is received.
    pub(super) const fn is_at_rest(&self) -> bool {
        self.iteration.is_at_rest() && !self.links.has_unsent()
    }

    /// All flows are known: eq. (5).
    pub(super) fn settle_residual(&mut self, context: Context<'_>) {
        self.balance.settle(&self.links, context);
    }

    /// Whether further sweeps change nothing, as long as nothing new is received.
    pub(super) fn routes_stand(&self, context: Context<'_>) -> bool {
        let has_news = self.links.has_unsent() || self.balance.is_unsettled();
        !has_news && self.sweep.is_over(self.is_infeasible(context))
    }

    /// The routes of the period are the flows in use, each with its share, ascending, and c_i is what they leave of what
    /// others may send, whether or not they do. Returns whether they carry the rates no more.
    pub(super) fn adopt(
        &mut self,
        context: Context<'_>,
        in_use: impl Iterator<Item = (NodeId, f64)>,
        outflow: f64,
        granted: impl Iterator<Item = (NodeId, f64)>,
    ) -> bool {
        self.links.adopt(in_use);
        self.balance.adopt(context, outflow, granted);
        let falls_short = self.is_infeasible(context);
        let fell_short = std::mem::replace(&mut self.falls_short, falls_short);
        falls_short && !fell_short
    }

    /// The links over which it may send, ascending.
    pub(super) fn links(&self) -> &[RouteLink] {
        self.links.all()
    }

    /// Whether it has a link to this node.
    pub(super) fn has_link_to(&self, node: NodeId) -> bool {
        self.links.place_of(node).is_some()
    }

    /// The links in use.
    pub(super) fn routes(&self) -> impl Iterator<Item = &RouteLink> {
        self.links().iter().filter(|link| link.share > 0.0)
    }

    /// h_i = Σ_j T_ij: the share of its time for which it sends.
    pub(super) fn load(&self) -> f64 {
        self.routes().map(|link| link.share).sum()
    }

    /// r_i.
    pub(super) const fn rate(&self) -> f64 {
        self.rate
    }

    /// λ_i.
    pub(super) fn multiplier(&self) -> f64 {
        self.iteration.multiplier()
    }

    /// c_i of eq. (5) at the last sample.
    pub(super) const fn residual(&self) -> f64 {
        self.balance.residual()
    }

    /// Whether the routes cannot carry the rates: c_i < −c_min.
    pub(super) fn is_infeasible(&self, context: Context<'_>) -> bool {
        self.balance.is_infeasible(context)
    }
}

#[cfg(test)]
impl Routing {
    /// The shares of its links are these.
    pub(super) fn plans(&mut self, shares: &[f64]) {
        let receivers: Vec<NodeId> = self.links().iter().map(|link| link.to).collect();
        self.links.adopt(receivers.into_iter().zip(shares.iter().copied()));
    }

    /// It has this residual.
    pub(super) fn leaves(&mut self, residual: f64) {
        self.balance.leave(residual);
    }
}
