//! The nodes of an ensemble, which take their steps of a round in chunks, on several threads.

use std::fmt::{self, Debug, Formatter};

use super::{Delivery, Input, Mail, Medium, Node, NodeId, Outputs, Traffic};
use crate::parallel::{for_each, threads};

/// With fewer steps in a round, one thread is as fast as several.
const FEWEST_STEPS_FOR_THREADS: usize = 2_000;
/// The number of chunks for each thread. With several, no thread waits long for another.
const CHUNKS_PER_THREAD: usize = 4;

/// Nodes, with what the ensemble keeps of each.
pub(super) struct Chunks<N: Node> {
    pub nodes: Vec<N>,
    pub slots: Vec<Slot>,
    /// How many threads may take steps.
    pub threads: usize,
    /// What is left by the steps of each chunk; the first also has what single nodes leave, all answers and all reports.
    outcomes: Vec<Outcome<N>>,
}

/// What the ensemble keeps of a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slot {
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
    /// The round of ticks, if nodes tick.
    pub round: Option<usize>,
}

/// What nodes of this kind say.
type Said<N> = Outputs<<N as Node>::Message, <N as Node>::Report>;

/// What the nodes of a chunk leave when they have taken their steps.
struct Outcome<N: Node> {
    /// What nodes say as they tick.
    outputs: Said<N>,
    /// What nodes have said on hearing messages, each with the place of the message among all that were sent.
    answers: Vec<(u32, Said<N>)>,
    result: Result<(), N::Error>,
}

impl<N: Node> Outcome<N> {
    const fn nothing() -> Self {
        Outcome { outputs: Outputs::of(0), answers: Vec::new(), result: Ok(()) }
    }
}

impl<N: Node> Chunks<N> {
    /// These nodes, numbered from 0.
    pub(super) fn new(nodes: Vec<N>) -> Self {
        let mut slots = vec![Slot::default(); nodes.len()];
        slots.iter_mut().zip(&nodes).for_each(|(slot, node)| slot.ask(node));
        Chunks { nodes, slots, threads: threads(), outcomes: vec![Outcome::nothing()] }
    }

    /// Nodes that have mail hear it, and those that are due in this round then tick.
    ///
    /// # Errors
    ///
    /// That of the first node that cannot go on.
    pub(super) fn take(&mut self, steps: &Steps<'_, N::Message>) -> Result<(), N::Error> {
        let is_short = self.threads == 1 || self.count(steps) < FEWEST_STEPS_FOR_THREADS;
        let (threads, chunks) =
            if is_short { (1, 1) } else { (self.threads, self.threads * CHUNKS_PER_THREAD) };
        let length = self.nodes.len().div_ceil(chunks).max(1);
        let Chunks { nodes, slots, outcomes, .. } = self;
        outcomes.resize_with(chunks.max(outcomes.len()), Outcome::nothing);
        let chunks = nodes.chunks_mut(length).zip(slots.chunks_mut(length)).zip(&mut *outcomes);
        for_each(threads, chunks.enumerate(), |(chunk, ((nodes, slots), outcome))| {
            outcome.result = steps.take_in_turn(chunk * length, nodes, slots, outcome);
        });
        // Answers have the order of what they answer, and those to one message that of their senders.
        let mut answers: Vec<_> =
            outcomes.iter_mut().flat_map(|outcome| outcome.answers.drain(..)).collect();
        debug_assert!(steps.round.is_none() || answers.is_empty(), "nobody was expected to answer");
        answers.sort_by_key(|&(place, _)| place);
        let [first, others @ ..] = &mut outcomes[..] else { return Ok(()) };
        answers.iter_mut().for_each(|(_, answer)| first.outputs.append(answer));
        others.iter_mut().for_each(|other| first.outputs.append_reports(&mut other.outputs));
        outcomes.iter_mut().try_for_each(|outcome| std::mem::replace(&mut outcome.result, Ok(())))
    }

    /// Lets time pass.
    ///
    /// # Errors
    ///
    /// That of the first node whose invariant does not hold afterwards.
    pub(super) fn flow(&mut self, duration: f64) -> Result<(), N::Error> {
        self.nodes.iter_mut().zip(&mut self.slots).try_for_each(|(node, slot)| {
            node.flow(duration);
            slot.ticked = 0;
            slot.ask(node);
            node.check_invariant()
        })
    }

    /// About how many steps are taken.
    fn count(&self, steps: &Steps<'_, N::Message>) -> usize {
        match steps.mail {
            Some((mail, _)) => mail.len(),
            None => self.slots.iter().filter(|slot| steps.tick_of(slot).is_some()).count(),
        }
    }

    /// A node senses something; nothing if there is no such node.
    ///
    /// # Errors
    ///
    /// That of the node.
    pub(super) fn sense(&mut self, id: NodeId, sensed: N::Sense) -> Result<(), N::Error> {
        let Chunks { nodes, slots, outcomes, .. } = self;
        let Some((node, slot)) = nodes.get_mut(id).zip(slots.get_mut(id)) else { return Ok(()) };
        slot.step(node, Input::Sensed(sensed), outcomes[0].outputs.now_of(id))?;
        slot.ask(node);
        Ok(())
    }

    /// A node hears a message of this delivery; nothing if there is no such node.
    ///
    /// # Errors
    ///
    /// That of the node.
    pub(super) fn hear(
        &mut self,
        delivery: Delivery<'_, N::Message>,
        number: usize,
    ) -> Result<(), N::Error> {
        let Chunks { nodes, slots, outcomes, .. } = self;
        let Delivery { from, to, message } = delivery;
        let Some((node, slot)) = nodes.get_mut(to).zip(slots.get_mut(to)) else { return Ok(()) };
        slot.hear(number, 1);
        slot.step(node, Input::Heard { from, message }, outcomes[0].outputs.now_of(to))?;
        slot.ask(node);
        Ok(())
    }

    /// Gives the medium what the nodes have sent: answers in the order of what they answer, all else in that of the nodes.
    pub(super) fn send<B>(&mut self, medium: &mut impl Medium<N::Message, B>) {
        self.outcomes.iter_mut().for_each(|outcome| medium.send_all(outcome.outputs.sent_mut()));
    }

    /// What the nodes have told observers since the last call, in its order.
    pub(super) fn drain_reports(&mut self) -> std::vec::Drain<'_, (NodeId, N::Report)> {
        self.outcomes[0].outputs.drain_reports()
    }
}

impl<N: Node + Debug> Debug for Chunks<N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Chunks { nodes, slots, .. } = self;
        f.debug_struct("Chunks").field("nodes", nodes).field("slots", slots).finish_non_exhaustive()
    }
}

impl<M> Steps<'_, M> {
    /// The steps of the nodes in a chunk, of which the first has this number.
    fn take_in_turn<N: Node<Message = M>>(
        &self,
        first: NodeId,
        nodes: &mut [N],
        slots: &mut [Slot],
        outcome: &mut Outcome<N>,
    ) -> Result<(), N::Error> {
        let Outcome { outputs, answers, .. } = outcome;
        for (id, (node, slot)) in (first..).zip(nodes.iter_mut().zip(slots)) {
            let outputs = outputs.now_of(id);
            if let Some((mail, number)) = self.mail {
                slot.hear_all(node, mail.of(id), number, outputs, answers)?;
            }
            if let Some(round) = self.tick_of(slot) {
                slot.tick(node, round, outputs)?;
            }
        }
        Ok(())
    }

    /// The round in which the node of this slot ticks, if it does.
    fn tick_of(&self, slot: &Slot) -> Option<usize> {
        self.round.filter(|&round| slot.is_due_in(round))
    }
}

impl Slot {
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

    /// The node hears the messages of a delivery, one after another. What it says on hearing one is kept with the place
    /// of that one.
    fn hear_all<'m, N: Node<Message: 'm>>(
        &mut self,
        node: &mut N,
        mail: impl ExactSizeIterator<Item = (u32, Delivery<'m, N::Message>)>,
        delivery: usize,
        outputs: &mut Said<N>,
        answers: &mut Vec<(u32, Said<N>)>,
    ) -> Result<(), N::Error> {
        if mail.len() == 0 {
            return Ok(());
        }
        self.hear(delivery, mail.len());
        for (place, Delivery { from, message, .. }) in mail {
            let before = outputs.counts();
            let result = node.step(Input::Heard { from, message }, outputs);
            if outputs.counts() != before {
                let answer = outputs.split_off(before);
                self.traffic.sent += answer.sent().len() as u64;
                answers.push((place, answer));
            }
            result?;
        }
        self.ask(node);
        Ok(())
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
    fn ask<N: Node>(&mut self, node: &N) {
        let is_due = node.time_to_tick().is_some_and(|wait| wait <= 0.0);
        self.ticks = is_due.then(|| self.ticked + 1 + node.rounds_to_pass());
    }

    fn is_due_in(&self, round: usize) -> bool {
        self.ticks.is_some_and(|ticks| ticks <= round)
    }
}
