//! Flows in circles: a robot finds out that its leases wait for each other.
//!
//! A grant lasts no longer than the flows of the receiver that carry it (`reservation`). In a circle of robots that send
//! to each other, each lease therefore waits for the next one to be renewed, and all of them end at once. Such a wait is
//! found by the edge chasing of Chandy, Misra and Haas (1983,
//! [doi:10.1145/357360.357365](https://doi.org/10.1145/357360.357365)): a robot one of whose leases has not been renewed
//! sends a [`Probe`] along that flow, and whoever hears it passes it on along a lease of its own that has not been renewed
//! either. A probe that returns to the robot that has sent it has gone round a circle. The least flow on its way is what
//! flows in the circle and gets nowhere: without it, each of these robots would send and be sent as much less.
//!
//! So the sender from which its own probe returns is granted the rest of its flow for longer, by
//! [`part_for_longer`](super::reservation). What flows in the circle ends with its leases, at all of its robots in the same
//! control period. Whatever a probe says, no more is granted for longer than what flows last that long.

use pleach_discrete::network::NodeId;
use serde::{Deserialize, Serialize};

use super::Robot;
use super::reservation::HeldFlow;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;

/// A message that follows flows whose leases have not been renewed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// The least of the flows that it has followed.
    pub flow: f64,
    /// The robots that have passed it on, the one that looks for a circle first.
    pub robots: Vec<NodeId>,
}

/// What a robot knows in a control period of the circles of flows that it is part of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Circle {
    /// The receiver along whose flow it sends and passes on probes: it has not renewed its lease.
    next: Option<NodeId>,
    /// The sender from which the robot's own probe has returned, and the flow that goes round in the circle.
    found: Option<(NodeId, f64)>,
}

impl Circle {
    /// Whether the robot is on a circle.
    pub(super) const fn is_found(self) -> bool {
        self.found.is_some()
    }

    /// What flows in the circle of all that this robot sends.
    pub(super) fn flow_from(self, sender: NodeId) -> f64 {
        self.found.filter(|&(from, _)| from == sender).map_or(0.0, |(_, flow)| flow)
    }
}

impl Robot {
    /// Sends a probe along a flow whose lease has not been renewed since the last control period: a different one in each,
    /// where there are several. A robot to which nobody sends is on no circle, and only passes on none.
    pub(super) fn look_for_circle(&mut self, outputs: &mut NodeOutputs) {
        let waiting = || self.flows.iter().filter(|held| held.waits());
        let next = match waiting().count() {
            0 => None,
            count => waiting().nth(self.period as usize % count).map(HeldFlow::probe_onward),
        };
        self.circle = Circle { next: next.map(|(to, _)| to), found: None };
        if let Some((to, flow)) = next
            && self.senders().next().is_some()
        {
            outputs.send(to, Message::Probe(Probe { flow, robots: vec![self.id] }));
        }
    }

    /// Notes a circle where this is its own probe, and passes on that of another robot, unless it has done so before.
    pub(super) fn hear_probe(&mut self, from: NodeId, probe: &Probe, outputs: &mut NodeOutputs) {
        let Some(granted) = self.granted_to(from) else { return };
        let flow = probe.flow.min(granted);
        match probe.robots.iter().position(|&robot| robot == self.id) {
            Some(0) => {
                self.circle.found = Some((from, flow));
                self.has_flow_news = true;
            }
            Some(_) => {}
            None => self.pass_on(flow, &probe.robots, outputs),
        }
    }

    fn pass_on(&self, flow: f64, robots: &[NodeId], outputs: &mut NodeOutputs) {
        let Some(held) = self.circle.next.and_then(|to| self.flow_to(to)) else { return };
        let (to, own) = held.probe_onward();
        let robots = robots.iter().copied().chain([self.id]).collect();
        outputs.send(to, Message::Probe(Probe { flow: flow.min(own), robots }));
    }
}
