//! Flows in circles: robots find out that their leases wait for each other.
//!
//! A grant lasts no longer than the flows of the receiver that carry it (`reservation`). In a circle of robots that send
//! to each other, each lease therefore waits for the next one to be renewed, and all of them end at once, with all that
//! flows there. Such a wait is found by the edge chasing of Chandy, Misra and Haas (1983,
//! [doi:10.1145/357360.357365](https://doi.org/10.1145/357360.357365)). A robot one of whose leases is about to end sends
//! a [`Probe`] along that flow, and a robot that hears it passes it on along such a flow of its own. A probe that returns
//! to its sender has gone round a circle. The least flow on its way is what goes round and reaches no access point: each
//! robot of the circle sets as much aside of what it sends and of what it is sent there, as its own probe tells it.
//! Probes that follow are about what is left, so that circles with a link in common are found one after another, none
//! for more than there is.
//!
//! What is not set aside is granted for longer (by `reservation`). What is set aside ends with the leases of the circle,
//! at all of its robots in the same control period if each of them has heard its own probe. Whatever probes say, a robot
//! grants nothing for longer than its own flows carry it.

use pleach_discrete::network::NodeId;
use serde::{Deserialize, Serialize};

use super::Robot;
use super::reservation::SAME_FLOW;
use crate::chance::mixed;
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
    /// Whether it is still under way.
    is_out: bool,
    /// How many probes of others it has passed on since.
    passed_on: usize,
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
    /// What has been set aside of all that this node sends here.
    pub(super) fn set_aside_from(&self, sender: NodeId) -> f64 {
        self.set_aside(|circle| circle.from == sender)
    }

    /// What has been set aside of all that the robot sends to this node.
    fn set_aside_to(&self, receiver: NodeId) -> f64 {
        self.set_aside(|circle| circle.to == receiver)
    }

    fn set_aside(&self, counts: impl Fn(&Circle) -> bool) -> f64 {
        self.found.iter().filter(|circle| counts(circle)).map(|circle| circle.flow).sum()
    }

    /// So much goes round a circle, beside what has been found before.
    pub(super) fn add(&mut self, from: NodeId, to: NodeId, flow: f64) {
        self.found.push(Circle { from, to, flow });
    }

    /// A control period begins.
    fn forget(&mut self) {
        (self.is_out, self.next) = (false, None);
        self.found.clear();
    }
}

impl Robot {
    /// The reservation of a control period begins: what was found in the last one is forgotten.
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
        let next = self.draw_waiting_flow();
        (self.circles.next, self.circles.is_out, self.circles.passed_on) = (next, false, 0);
        if let Some((to, flow)) = next
            && self.senders().next().is_some()
        {
            let number = self.circles.number.wrapping_add(1);
            (self.circles.number, self.circles.is_out) = (number, true);
            outputs.send(to, Message::Probe(Probe { number, flow, robots: vec![self.id] }));
        }
    }

    /// Whether it knows of a circle that it is part of.
    pub(super) const fn is_on_circle(&self) -> bool {
        !self.circles.found.is_empty()
    }

    /// The robots to which it sends over leases that wait, each with as much as waits and has not been set aside.
    fn waiting_flows(&self) -> impl Iterator<Item = (NodeId, f64)> {
        let (period, robots) = (self.period, self.site.robots);
        let to_robots = self.flows.iter().filter(move |held| held.to < robots);
        let waiting = to_robots.map(move |held| (held.to, held.waiting(period)));
        waiting
            .filter(|&(_, flow)| flow > SAME_FLOW)
            .map(|(to, flow)| (to, flow - self.circles.set_aside_to(to)))
            .filter(|&(_, left)| left > SAME_FLOW)
    }

    /// Where several leases wait, another one each time: drawn by lot, so that every choice of all robots comes up in
    /// time.
    fn draw_waiting_flow(&self) -> Option<(NodeId, f64)> {
        let count = self.waiting_flows().count();
        let look = u64::from(self.period) << 8 | self.round_count.times_asked_again() as u64;
        let drawn = mixed(look ^ (self.id as u64) << 40) as usize;
        self.waiting_flows().nth(drawn.checked_rem(count)?)
    }

    /// Sets aside what goes round a circle where this is the robot's own probe, and passes on that of another robot that
    /// has not come by before.
    pub(super) fn hear_probe(&mut self, from: NodeId, probe: &Probe, outputs: &mut NodeOutputs) {
        match probe.robots.iter().position(|&robot| robot == self.id) {
            Some(0) => self.close_circle(from, probe),
            Some(_) => {}
            None => self.pass_on(probe, outputs),
        }
    }

    fn close_circle(&mut self, from: NodeId, probe: &Probe) {
        let flow = probe.flow.min(self.granted_to(from));
        let Circles { number, is_out, next, .. } = &mut self.circles;
        if probe.number == *number
            && flow > 0.0
            && std::mem::take(is_out)
            && let Some((to, _)) = *next
        {
            self.circles.add(from, to, flow);
            self.has_flow_news = true;
        }
    }

    /// At most as many as there are robots, so that copies do not add up on a long way.
    fn pass_on(&mut self, probe: &Probe, outputs: &mut NodeOutputs) {
        let Some((to, left)) = self.circles.next else { return };
        if self.circles.passed_on < self.site.robots {
            self.circles.passed_on += 1;
            let robots = probe.robots.iter().copied().chain([self.id]).collect();
            let flow = probe.flow.min(left);
            outputs.send(to, Message::Probe(Probe { flow, robots, ..*probe }));
        }
    }
}
