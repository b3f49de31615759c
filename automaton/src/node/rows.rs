//! The nodes of an ensemble in rows, which take their steps of a round at once.

use std::fmt::{self, Debug, Formatter};

use super::{Delivery, Input, Mail, Medium, Node, NodeId, Outputs, Traffic};
use crate::abreast::{abreast, threads};

/// With fewer steps in a round, one thread is as fast as several.
const FEWEST_STEPS_FOR_THREADS: usize = 2_000;
/// The number of rows for each thread. With several, no thread waits long for another.
const ROWS_PER_THREAD: usize = 4;

/// Nodes, with what the ensemble keeps of each.
pub(super) struct Rows<N: Node> {
    pub nodes: Vec<N>,
    pub seats: Vec<Seat>,
    /// How many threads may take steps.
    pub threads: usize,
    /// What is left by the steps of each row; the first also has what single nodes leave, and all reports.
    left: Vec<Leavings<N>>,
}

/// What the ensemble keeps of a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seat {
    pub traffic: Traffic,
    /// The number of the delivery in which it has heard something last; 0 if in none.
    pub heard: usize,
    /// The round at this instant in which it has ticked last; 0 if in none.
    pub ticked: usize,
    /// The round at this instant in which it ticks next, if it hears nothing until then.
    pub ticks: Option<usize>,
}

/// What happens in a round.
pub(super) struct Steps<'a, M> {
    /// What is heard, if anything is, and the number of this delivery.
    pub mail: Option<(&'a Mail<M>, usize)>,
    /// The round of ticks.
    pub round: usize,
}

/// What the nodes of a row leave when they have taken their steps.
struct Leavings<N: Node> {
    outputs: Outputs<N::Message, N::Report>,
    result: Result<(), N::Error>,
}

impl<N: Node> Leavings<N> {
    const fn nothing() -> Self {
        Leavings { outputs: Outputs::of(0), result: Ok(()) }
    }
}

impl<N: Node> Rows<N> {
    /// These nodes, numbered from 0.
    pub fn new(nodes: Vec<N>) -> Self {
        let mut seats = vec![Seat::default(); nodes.len()];
        seats.iter_mut().zip(&nodes).for_each(|(seat, node)| seat.ask(node));
        Rows { nodes, seats, threads: threads(), left: vec![Leavings::nothing()] }
    }

    /// Nodes that have mail hear it, and those that are due in this round then tick.
    ///
    /// # Errors
    ///
    /// That of the first node that cannot go on.
    pub fn take(&mut self, steps: &Steps<'_, N::Message>) -> Result<(), N::Error> {
        let is_short = self.threads == 1 || self.count(steps) < FEWEST_STEPS_FOR_THREADS;
        let (threads, rows) =
            if is_short { (1, 1) } else { (self.threads, self.threads * ROWS_PER_THREAD) };
        let length = self.nodes.len().div_ceil(rows).max(1);
        let Rows { nodes, seats, left, .. } = self;
        left.resize_with(rows.max(left.len()), Leavings::nothing);
        let rows = nodes.chunks_mut(length).zip(seats.chunks_mut(length)).zip(&mut *left);
        abreast(threads, rows.enumerate(), |(row, ((nodes, seats), left))| {
            left.result = steps.take_in_turn(row * length, nodes, seats, &mut left.outputs);
        });
        let [first, others @ ..] = &mut left[..] else { return Ok(()) };
        others.iter_mut().for_each(|row| first.outputs.append_reports(&mut row.outputs));
        left.iter_mut().try_for_each(|row| std::mem::replace(&mut row.result, Ok(())))
    }

    /// Lets time pass.
    ///
    /// # Errors
    ///
    /// That of the first node whose invariant does not hold afterwards.
    pub fn flow(&mut self, duration: f64) -> Result<(), N::Error> {
        self.nodes.iter_mut().zip(&mut self.seats).try_for_each(|(node, seat)| {
            node.flow(duration);
            seat.ticked = 0;
            seat.ask(node);
            node.check_invariant()
        })
    }

    /// About how many steps are taken.
    fn count(&self, steps: &Steps<'_, N::Message>) -> usize {
        match steps.mail {
            Some((mail, _)) => mail.len(),
            None => self.seats.iter().filter(|seat| seat.is_due_in(steps.round)).count(),
        }
    }

    /// A node senses something; nothing if there is no such node.
    ///
    /// # Errors
    ///
    /// That of the node.
    pub fn sense(&mut self, id: NodeId, sensed: N::Sense) -> Result<(), N::Error> {
        let Rows { nodes, seats, left, .. } = self;
        let Some((node, seat)) = nodes.get_mut(id).zip(seats.get_mut(id)) else { return Ok(()) };
        seat.step(node, Input::Sensed(sensed), left[0].outputs.now_of(id))?;
        seat.ask(node);
        Ok(())
    }

    /// A node hears a message of this delivery; nothing if there is no such node.
    ///
    /// # Errors
    ///
    /// That of the node.
    pub fn hear(
        &mut self,
        delivery: Delivery<'_, N::Message>,
        number: usize,
    ) -> Result<(), N::Error> {
        let Rows { nodes, seats, left, .. } = self;
        let Delivery { from, to, message } = delivery;
        let Some((node, seat)) = nodes.get_mut(to).zip(seats.get_mut(to)) else { return Ok(()) };
        seat.hear(number, 1);
        seat.step(node, Input::Heard { from, message }, left[0].outputs.now_of(to))?;
        seat.ask(node);
        Ok(())
    }

    /// Gives the medium what the nodes have sent, in their order.
    pub fn send<B>(&mut self, medium: &mut impl Medium<N::Message, B>) {
        self.left.iter_mut().for_each(|left| medium.send_all(left.outputs.sent_mut()));
    }

    /// What the nodes have told observers since the last call, in its order.
    pub fn drain_reports(&mut self) -> std::vec::Drain<'_, (NodeId, N::Report)> {
        self.left[0].outputs.drain_reports()
    }
}

impl<N: Node + Debug> Debug for Rows<N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Rows { nodes, seats, .. } = self;
        f.debug_struct("Rows").field("nodes", nodes).field("seats", seats).finish_non_exhaustive()
    }
}

impl<M> Steps<'_, M> {
    /// The steps of the nodes in a row, of which the first has this number.
    fn take_in_turn<N: Node<Message = M>>(
        &self,
        first: NodeId,
        nodes: &mut [N],
        seats: &mut [Seat],
        outputs: &mut Outputs<M, N::Report>,
    ) -> Result<(), N::Error> {
        for (id, (node, seat)) in (first..).zip(nodes.iter_mut().zip(seats)) {
            let heard = self.mail.map(|(mail, number)| (mail.of(id), number));
            if let Some((mut mail, number)) = heard.filter(|(mail, _)| mail.len() > 0) {
                seat.hear(number, mail.len());
                mail.try_for_each(|Delivery { from, message, .. }| {
                    seat.step(node, Input::Heard { from, message }, outputs.now_of(id))
                })?;
                seat.ask(node);
            }
            if seat.is_due_in(self.round) {
                seat.tick(node, self.round, outputs.now_of(id))?;
            }
        }
        Ok(())
    }
}

impl Seat {
    /// The node takes a step; what it sends is counted.
    #[inline]
    fn step<N: Node>(
        &mut self,
        node: &mut N,
        input: Input<'_, N::Message, N::Sense>,
        outputs: &mut Outputs<N::Message, N::Report>,
    ) -> Result<(), N::Error> {
        let before = outputs.sent().len();
        let result = node.step(input, outputs);
        self.traffic.sent += (outputs.sent().len() - before) as u64;
        result
    }

    /// The node hears this many messages in a delivery.
    const fn hear(&mut self, delivery: usize, messages: usize) {
        self.heard = delivery;
        self.traffic.heard += messages as u64;
    }

    /// The node ticks in this round.
    fn tick<N: Node>(
        &mut self,
        node: &mut N,
        round: usize,
        outputs: &mut Outputs<N::Message, N::Report>,
    ) -> Result<(), N::Error> {
        let passed = round - self.ticked - 1;
        self.ticked = round;
        self.step(node, Input::Tick { passed }, outputs)?;
        self.ask(node);
        Ok(())
    }

    /// The node has changed: asks it when it ticks next.
    pub fn ask<N: Node>(&mut self, node: &N) {
        let is_due = node.time_to_tick().is_some_and(|wait| wait <= 0.0);
        self.ticks = is_due.then(|| self.ticked + 1 + node.rounds_to_pass());
    }

    fn is_due_in(&self, round: usize) -> bool {
        self.ticks.is_some_and(|ticks| ticks <= round)
    }
}
