//! Flows in circles: robots find out that their leases wait for each other.
//!
//! A grant lasts no longer than the flows of the receiver that carry it ([`reservation`](super)). In a circle of robots
//! that send to each other, each lease therefore waits for the next one to be renewed, and all of them end at once, with
//! all that flows there. Such a wait is found by the edge chasing of Chandy, Misra and Haas (1983,
//! [doi:10.1145/357360.357365](https://doi.org/10.1145/357360.357365)). A robot one of whose leases is about to end sends
//! a [`Probe`] along that flow, and a robot that receives it passes it on along such a flow of its own. A probe that
//! returns to its sender has gone round a circle. The least flow on its way is what goes round and reaches no access
//! point: when its own probe returns, each robot of the circle sets that amount aside, of what it sends and of what it is
//! sent there. Probes that follow are about what is left, so that circles with a link in common are found one after
//! another, none for more than there is.
//!
//! What is not set aside is granted for longer (by [`reservation`](super)). What is set aside ends with the leases of the
//! circle, at all of its robots in the same control period if each of them has received its own probe. Whatever probes
//! report, a robot grants nothing for longer than its own flows carry it.

use pleach_discrete::network::NodeId;
use serde::{Deserialize, Serialize};

use super::super::context::Context;
use super::held::HeldFlows;
use super::{Reservation, SAME_FLOW};
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
    /// Leases of its flows were about to end when the reservation of this period began.
    leases_wait: bool,
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

    /// Whether a circle is known that the robot is part of.
    pub(super) const fn are_known(&self) -> bool {
        !self.found.is_empty()
    }

    /// Whether circles are looked for in this control period.
    pub(super) const fn are_looked_for(&self) -> bool {
        self.leases_wait
    }

    /// A control period begins: what was found in the last one is dropped.
    fn begin_period(&mut self, leases_wait: impl FnOnce(&Self) -> bool) {
        if std::mem::take(&mut self.leases_wait) {
            (self.is_out, self.next) = (false, None);
            self.found.clear();
        }
        self.leases_wait = leases_wait(self);
    }

    /// Chooses the flow that probes follow; returns the number of a probe to send along it, if one is to be sent.
    fn follow(&mut self, next: Option<(NodeId, f64)>, may_be_on_circle: bool) -> Option<u32> {
        (self.next, self.is_out, self.passed_on) = (next, false, 0);
        if next.is_none() || !may_be_on_circle {
            return None;
        }
        (self.number, self.is_out) = (self.number.wrapping_add(1), true);
        Some(self.number)
    }

    /// A probe of the robot has returned from a node, along which this much may flow to the robot; returns whether it has
    /// found a circle.
    fn close(&mut self, from: NodeId, number: u32, flow: f64) -> bool {
        if number == self.number
            && flow > 0.0
            && std::mem::take(&mut self.is_out)
            && let Some((to, _)) = self.next
        {
            self.found.push(Circle { from, to, flow });
            return true;
        }
        false
    }

    /// The flow along which a probe of another robot is passed on. At most as many are as there are robots, so that copies
    /// do not add up on a long way.
    fn pass_on(&mut self, robots: usize) -> Option<(NodeId, f64)> {
        let next = self.next.filter(|_| self.passed_on < robots)?;
        self.passed_on += 1;
        Some(next)
    }
}

impl Reservation {
    /// The reservation of a control period begins.
    pub(super) fn note_waiting_leases(&mut self, context: Context<'_>) {
        let held = &self.held;
        self.circles.begin_period(|circles| waiting_flows(held, circles, context).next().is_some());
    }

    /// Chooses the flow that probes follow, and sends one along it. A robot to which nobody sends is part of no circle.
    pub(super) fn look_for_circles(&mut self, context: Context<'_>, outputs: &mut NodeOutputs) {
        if !self.circles.leases_wait {
            return;
        }
        let next = self.draw_waiting_flow(context);
        let has_senders = self.senders().next().is_some();
        if let Some(number) = self.circles.follow(next, has_senders)
            && let Some((to, flow)) = next
        {
            outputs.send(to, Message::Probe(Probe { number, flow, robots: vec![context.id] }));
        }
    }

    /// Where several leases wait, another one each time: drawn by lot, so that every choice of all robots comes up in
    /// time.
    fn draw_waiting_flow(&self, context: Context<'_>) -> Option<(NodeId, f64)> {
        let waiting = || waiting_flows(&self.held, &self.circles, context);
        let look = u64::from(context.period) << 8 | context.rounds.times_asked_again() as u64;
        let drawn = mixed(look ^ (context.id as u64) << 40) as usize;
        waiting().nth(drawn.checked_rem(waiting().count())?)
    }

    /// Sets aside what goes round a circle where this is the robot's own probe, and passes on that of another robot that
    /// has not come by before.
    pub(crate) fn receive_probe(
        &mut self,
        context: Context<'_>,
        from: NodeId,
        probe: &Probe,
        outputs: &mut NodeOutputs,
    ) {
        match probe.robots.iter().position(|&robot| robot == context.id) {
            Some(0) => {
                let flow = probe.flow.min(self.kept.granted_to(from));
                self.has_news |= self.circles.close(from, probe.number, flow);
            }
            Some(_) => {}
            None => {
                let Some((to, left)) = self.circles.pass_on(context.site.robots) else { return };
                let robots = probe.robots.iter().copied().chain([context.id]).collect();
                let flow = probe.flow.min(left);
                outputs.send(to, Message::Probe(Probe { flow, robots, ..*probe }));
            }
        }
    }
}

/// The robots to which flows lead over leases that wait, each with as much as waits and has not been set aside.
fn waiting_flows(
    held: &HeldFlows,
    circles: &Circles,
    context: Context<'_>,
) -> impl Iterator<Item = (NodeId, f64)> {
    let to_robots = held.all().iter().filter(move |held| context.is_robot(held.to()));
    let waiting = to_robots.map(move |held| (held.to(), held.waiting(context.period)));
    waiting
        .filter(|&(_, flow)| flow > SAME_FLOW)
        .map(|(to, flow)| (to, flow - circles.set_aside_to(to)))
        .filter(|&(_, left)| left > SAME_FLOW)
}

#[cfg(test)]
impl Circles {
    /// So much has been found to go round a circle.
    pub(super) fn add(&mut self, from: NodeId, to: NodeId, flow: f64) {
        self.leases_wait = true;
        self.found.push(Circle { from, to, flow });
    }
}
