//! Going back to the flows of the period before, where the new ones do not fit.
//!
//! The flows F_ij of a period stand until the next one, and moves are certified for them: wherever
//! the robots have gone, these flows are carried over the links as they are now, and every residual
//! is what it was. So a robot that the sweeps leave with c_i < −c_min takes its former flows again,
//! and has the robots at the other ends of all flows that have changed do the same. They pass that
//! on. A robot that is not reached shares no changed flow with one that is, so that the flows of all
//! fit together again.

use pleach_discrete::network::NodeId;

use super::super::message::Message;
use super::super::record::MissionEvent;
use super::Robot;
use super::routing::RouteLink;
use crate::node::Outputs;

/// The flows of the period before, in the order of the nodes at their other ends.
#[derive(Clone, Debug, Default)]
pub(super) struct StandingFlows {
    /// Whether there are any, and the residual was at least −c_min.
    fit: bool,
    residual: f64,
    outflows: Vec<(NodeId, f64)>,
    inflows: Vec<(NodeId, f64)>,
}

impl Robot {
    /// Routes are about to be sought anew: those of the period before are kept, if there was one.
    pub(super) fn keep_flows(&mut self) {
        if self.is_new {
            return;
        }
        let fit = !self.is_infeasible();
        let standing = &mut self.standing;
        (standing.fit, standing.residual) = (fit, self.residual);
        standing.outflows.clear();
        let flows = self.links.iter().map(|link| (link.to, link.flow()));
        standing.outflows.extend(flows.filter(|&(_, flow)| flow > 0.0));
        standing.inflows.clone_from(&self.inflows);
    }

    /// The sweeps are over: if they have left c_i < −c_min, the robot goes back to its former flows.
    pub(super) fn settle_routes(&mut self, outputs: &mut Outputs<Message, MissionEvent>) {
        if self.is_infeasible() {
            self.restore_flows(outputs);
        }
    }

    /// A robot with which this one shares a flow that has changed goes back to its former flows.
    pub(super) fn restore_flows(&mut self, outputs: &mut Outputs<Message, MissionEvent>) {
        if !std::mem::take(&mut self.standing.fit) {
            return;
        }
        let standing = std::mem::take(&mut self.standing);
        let flows: Vec<_> = self.routes().map(|link| (link.to, link.flow())).collect();
        let robots = self.site.robots;
        let mut sharers = changed(&standing.outflows, &flows);
        sharers.retain(|&node| node < robots);
        sharers.extend(changed(&standing.inflows, &self.inflows));
        sharers.sort_unstable();
        sharers.dedup();
        self.links.iter_mut().for_each(|link| link.share = 0.0);
        for &(to, flow) in &standing.outflows {
            self.send_again(to, flow);
        }
        self.inflows.clone_from(&standing.inflows);
        self.residual = standing.residual;
        self.standing = standing;
        for node in sharers {
            outputs.send(node, Message::Restore);
        }
    }

    fn send_again(&mut self, to: NodeId, flow: f64) {
        let Some(reliability) = self.neighbour(to).map(|neighbour| neighbour.reliability) else {
            return;
        };
        match self.links.binary_search_by_key(&to, |link| link.to) {
            Ok(at) => self.links[at].share = flow / reliability,
            // It is too weak for a new flow.
            Err(at) => self.links.insert(at, RouteLink::of_flow(to, reliability, flow)),
        }
    }
}

/// The nodes whose flow is not the same in both lists.
fn changed(before: &[(NodeId, f64)], now: &[(NodeId, f64)]) -> Vec<NodeId> {
    let only_in = |one: &[(NodeId, f64)], other: &[(NodeId, f64)]| {
        one.iter().filter(|flow| !other.contains(flow)).map(|&(node, _)| node).collect::<Vec<_>>()
    };
    [only_in(before, now), only_in(now, before)].concat()
}
