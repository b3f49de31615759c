//! The sweep: demands go up the tree, so that the routes are feasible whatever the dual iterate is.

use pleach_discrete::network::NodeId;

use super::super::context::Context;
use super::Routing;
use super::balance::RESIDUAL_ROUNDING;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;

/// What a robot has received and sent in the sweeps of a control period.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sweep {
    /// The robots that send their demand here, ascending, each with what has been received of it.
    demands: Vec<(NodeId, Option<f64>)>,
    /// How many demands have been passed on in this sweep.
    passed_on: usize,
    /// Whether the robot has met the demands of the first sweep.
    is_first_over: bool,
    /// Whether it does without its reserve, as the tree can carry no more than the rates.
    has_no_reserve: bool,
    /// Whether shortages have changed something since the last sweep.
    has_shortage_news: bool,
}

impl Sweep {
    /// A control period begins.
    pub(super) fn begin_period(&mut self) {
        self.demands.clear();
        (self.has_no_reserve, self.has_shortage_news) = (false, false);
    }

    /// A neighbour will send its demand to this robot.
    pub(super) fn expect(&mut self, child: NodeId) {
        if let Err(at) = self.place_of(child) {
            self.demands.insert(at, (child, None));
        }
    }

    fn receive(&mut self, from: NodeId, more: f64) {
        match self.place_of(from) {
            Ok(at) => self.demands[at].1 = Some(more),
            Err(at) => self.demands.insert(at, (from, Some(more))),
        }
    }

    fn place_of(&self, child: NodeId) -> Result<usize, usize> {
        self.demands.binary_search_by_key(&child, |&(child, _)| child)
    }

    fn has_received_all(&self) -> bool {
        self.demands.iter().all(|(_, received)| received.is_some())
    }

    /// Whether the robot has taken part in the first sweep, and has received nothing since that changes its flows, given
    /// whether its routes are infeasible.
    pub(super) const fn is_over(&self, is_infeasible: bool) -> bool {
        self.is_first_over && !self.has_shortage_news && (self.has_no_reserve || !is_infeasible)
    }
}

impl Routing {
    /// The sweep begins at the robots that no other sends its demand to.
    pub(in super::super) fn begin_sweep(
        &mut self,
        context: Context<'_>,
        outputs: &mut NodeOutputs,
    ) {
        (self.sweep.is_first_over, self.sweep.passed_on) = (false, 0);
        if self.sweep.demands.is_empty() {
            self.pass_demand_on(true, context, outputs);
        }
    }

    /// A child in the tree sends by how much its flow changes. In the first sweep of a period the robot
    /// waits for all of them, so that one message goes over each link; later ones begin where there
    /// is news, and every message is passed on.
    pub(in super::super) fn receive_demand(
        &mut self,
        context: Context<'_>,
        from: NodeId,
        more: f64,
        outputs: &mut NodeOutputs,
    ) {
        if self.sweep.is_first_over {
            self.balance.receive_more(more);
            self.pass_demand_on(false, context, outputs);
            return;
        }
        self.sweep.receive(from, more);
        if self.sweep.has_received_all() {
            self.take_demands();
            self.pass_demand_on(true, context, outputs);
        }
    }

    fn take_demands(&mut self) {
        let received = self.sweep.demands.iter().filter_map(|&(_, more)| more);
        received.for_each(|more| self.balance.receive_more(more));
    }

    /// Passes on what it does not carry itself. In a tree that takes no more messages than there are
    /// robots; where robots on Σ stand in for others, each as it was last received, their demands can go round
    /// in a cycle, and end there.
    fn pass_demand_on(&mut self, is_first: bool, context: Context<'_>, outputs: &mut NodeOutputs) {
        self.sweep.is_first_over = true;
        let more = self.meet_demand(is_first, context);
        if let Some(parent) = self.parent
            && context.is_robot(parent)
            && (is_first || more != 0.0)
            && self.sweep.passed_on < context.site.robots
        {
            self.sweep.passed_on += 1;
            outputs.send(parent, Message::Demand(more));
        }
    }

    /// The first sweep is over: a robot that is still waiting meets the demands that it has received.
    pub(in super::super) fn end_sweep(&mut self, context: Context<'_>) {
        if !std::mem::replace(&mut self.sweep.is_first_over, true) {
            self.take_demands();
            self.meet_demand(true, context);
        }
    }

    /// A further sweep begins where shortages have changed something.
    pub(in super::super) fn sweep_again(
        &mut self,
        context: Context<'_>,
        outputs: &mut NodeOutputs,
    ) {
        self.sweep.passed_on = 0;
        if !self.sweep.has_shortage_news && !self.balance.is_unsettled() {
            return;
        }
        let before = self.balance.inflow();
        self.balance.add_up_inflow();
        let has_shortage_news = std::mem::take(&mut self.sweep.has_shortage_news);
        if has_shortage_news || self.balance.inflow() != before {
            self.pass_demand_on(false, context, outputs);
        }
    }

    /// Sends what c_i = η takes. What is missing goes over the tree link; in the first sweep, what
    /// is too much, because the iteration has not converged, is taken off all links alike, so that
    /// no robot is requested to pass on what is not there. Returns by how much the flow to the parent
    /// has changed.
    fn meet_demand(&mut self, is_first: bool, context: Context<'_>) -> f64 {
        let Some(tree_link) = self.parent.and_then(|parent| self.links.place_of(parent)) else {
            return 0.0;
        };
        let before = self.links.all()[tree_link].flow();
        // Less than nothing seems to flow in where a sender has less to send than before, and what it sent is not known.
        let demand = (self.balance.inflow() + context.rate + self.reserve(context)).max(0.0);
        let outflow = self.links.outflow();
        if outflow > demand && (is_first || self.sweep.has_no_reserve) {
            self.links.scale(demand / outflow);
        } else if demand - outflow > RESIDUAL_ROUNDING {
            self.links.raise_outflow(demand, tree_link);
        } else {
            return 0.0;
        }
        self.links.all()[tree_link].flow() - before
    }

    /// The robot may find that it cannot pass on what it is sent: it does without its reserve,
    /// and reports that once in a period.
    pub(in super::super) fn admit_shortage(
        &mut self,
        context: Context<'_>,
        outputs: &mut NodeOutputs,
    ) {
        if self.is_infeasible(context) {
            self.give_up_reserve(outputs);
        }
    }

    /// A neighbour cannot pass on what it is sent. A robot whose parent it is does without its
    /// reserve from now on, and so must those behind; every other sends it nothing more.
    pub(in super::super) fn receive_shortage(
        &mut self,
        overloaded: NodeId,
        outputs: &mut NodeOutputs,
    ) {
        if self.parent == Some(overloaded) {
            self.give_up_reserve(outputs);
        } else if self.links.relieve(overloaded) {
            self.sweep.has_shortage_news = true;
        }
    }

    fn give_up_reserve(&mut self, outputs: &mut NodeOutputs) {
        if !std::mem::replace(&mut self.sweep.has_no_reserve, true) {
            self.sweep.has_shortage_news = true;
            outputs.broadcast(Message::Shortage);
        }
    }

    /// η, or nothing when the tree can carry no more than the rates.
    fn reserve(&self, context: Context<'_>) -> f64 {
        match self.sweep.has_no_reserve {
            true => 0.0,
            false => context.site.settings.routing_reserve,
        }
    }
}
