//! Flows in circles: robots find out that their leases wait for each other.
//!
//! A grant lasts no longer than the flows of the receiver that carry it (`reservation`). In a circle of robots that send
//! to each other, each lease therefore waits for the next one to be renewed, and all of them end at once, with all that
//! flows there. Such a wait is found by the edge chasing of Chandy, Misra and Haas (1983,
//! [doi:10.1145/357360.357365](https://doi.org/10.1145/357360.357365)). A robot one of whose leases is about to end sends
//! a [`Probe`] along that flow, and a robot that hears it passes it on along such a flow of its own. A probe that returns
//! to its sender has gone round a circle. The least flow on its way is what goes round and reaches no access point: each
//! robot of the circle sets as much aside of what it sends and of what it is sent there, as its own probe tells it. Probes
//! that follow are about what is left, so that circles with a link in common are found one after another, none for more
//! than there is.
//!
//! What is not set aside is granted for longer (by `reservation`). What is set aside ends with the
//! leases of the circle, at all of its robots in the same control period. Whatever probes say, no more is granted for
//! longer than what flows last that long.

use pleach_discrete::network::NodeId;
use serde::{Deserialize, Serialize};

use super::Robot;
use super::reservation::{HeldFlow, SAME_FLOW};
use crate::network::member::NodeOutputs;
use crate::network::message::Message;

/// A message that follows flows whose leases wait to be renewed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Which probe of its sender it is; later ones have greater numbers.
    pub number: u32,
    /// The least of the flows that it has followed, as far as they wait and have not been set aside.
    pub flow: f64,
    /// The robots that have passed it on, the one that has sent it first.
    pub robots: Vec<NodeId>,
}

/// What a robot has found out in a control period about circles of flows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Circles {
    /// The number of its newest probe.
    number: u32,
    /// Whether this has not returned.
    is_out: bool,
    /// The receiver of the flow that probes follow from here for now, and as much of it as waits.
    next: Option<(NodeId, f64)>,
    found: Vec<Circle>,
}

/// A circle of flows that a robot is part of.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Circle {
    /// The robot that sends to this one.
    from: NodeId,
    /// The robot that this one sends to.
    to: NodeId,
    /// What goes round.
    flow: f64,
}

impl Circles {
    /// Whether the robot is part of one.
    const fn are_found(&self) -> bool {
        !self.found.is_empty()
    }

    /// What has been set aside of all that this node sends here.
    pub(super) fn set_aside_from(&self, sender: NodeId) -> f64 {
        self.found.iter().filter(|it| it.from == sender).map(|it| it.flow).sum()
    }

    /// What has been set aside of all that the robot sends to this node.
    fn set_aside_to(&self, receiver: NodeId) -> f64 {
        self.found.iter().filter(|it| it.to == receiver).map(|it| it.flow).sum()
    }

    /// So much goes round a circle, beside what has been found before.
    pub(super) fn find(&mut self, from: NodeId, to: NodeId, flow: f64) {
        self.found.push(Circle { from, to, flow });
    }

    /// A control period begins.
    pub(super) fn forget(&mut self) {
        (self.is_out, self.next) = (false, None);
        self.found.clear();
    }
}

impl Robot {
    /// A control period's reservation begins: what was found in the last one is forgotten.
    pub(super) fn note_waiting_leases(&mut self) {
        if std::mem::take(&mut self.leases_wait) {
            self.circles.forget();
        }
        let waits = self.waiting_flows().next().is_some();
        self.leases_wait = waits;
    }

    /// Chooses the flow that probes follow, and sends one along it. A robot to which nobody sends is part of no circle.
    pub(super) fn look_for_circles(&mut self, outputs: &mut NodeOutputs) {
        if !self.leases_wait {
            return;
        }
        self.circles.next = self.draw_waiting_flow();
        if let Some((to, flow)) = self.circles.next
            && self.senders().next().is_some()
        {
            let number = self.circles.number.wrapping_add(1);
            (self.circles.number, self.circles.is_out) = (number, true);
            outputs.send(to, Message::Probe(Probe { number, flow, robots: vec![self.id] }));
        }
    }

    /// Whether it is part of a circle.
    pub(super) const fn is_on_circle(&self) -> bool {
        self.leases_wait && self.circles.are_found()
    }

    /// The receivers of flows whose leases wait, each with as much as waits and has not been set aside.
    fn waiting_flows(&self) -> impl Iterator<Item = (NodeId, f64)> {
        let period = self.period;
        let waiting = move |held: &HeldFlow| {
            let flow = held.waiting(period);
            let left = if flow > 0.0 { flow - self.circles.set_aside_to(held.to()) } else { flow };
            (left > SAME_FLOW).then_some((held.to(), left))
        };
        self.flows.iter().filter_map(waiting)
    }

    /// Where several leases wait, another one each time: as good as drawn by lot, so that every choice of all robots comes up
    /// in time.
    fn draw_waiting_flow(&self) -> Option<(NodeId, f64)> {
        let count = self.waiting_flows().count();
        let time = u64::from(self.period) << 8 | self.round_count.times_asked_again() as u64;
        let lot = (time ^ (self.id as u64) << 40).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        self.waiting_flows().nth((lot as usize).checked_rem(count)?)
    }

    /// Sets aside what goes round a circle where this is the robot's own probe, and passes on that of another robot, unless
    /// it has done so before.
    pub(super) fn hear_probe(&mut self, from: NodeId, probe: &Probe, outputs: &mut NodeOutputs) {
        match probe.robots.iter().position(|&robot| robot == self.id) {
            Some(0) => self.close_circle(from, probe),
            Some(_) => {}
            None => self.pass_on(probe, outputs),
        }
    }

    fn close_circle(&mut self, from: NodeId, probe: &Probe) {
        let Circles { number, is_out, next, .. } = &mut self.circles;
        if probe.number == *number
            && std::mem::take(is_out)
            && let Some((to, _)) = *next
        {
            self.circles.find(from, to, probe.flow);
            self.has_flow_news = true;
        }
    }

    fn pass_on(&self, probe: &Probe, outputs: &mut NodeOutputs) {
        let Some((to, left)) = self.circles.next else { return };
        let robots = probe.robots.iter().copied().chain([self.id]).collect();
        let flow = probe.flow.min(left);
        outputs.send(to, Message::Probe(Probe { flow, robots, ..*probe }));
    }
}
