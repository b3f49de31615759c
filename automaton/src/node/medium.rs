//! The medium: what becomes of messages between their senders and their receivers.

use super::{Destination, Envelope, Mail, NodeId};

/// A message that arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Delivery<'a, M> {
    /// The sender.
    pub from: NodeId,
    /// The receiver.
    pub to: NodeId,
    /// The message.
    pub message: &'a M,
}

/// What carries messages `M` between nodes with bodies `B`. It decides on the audience of each
/// message, and whether, when and how often it arrives. Nodes never ask it anything.
pub trait Medium<M, B> {
    /// Where the nodes are now, by number. Called before anything is sent, and again whenever
    /// time has passed.
    fn update(&mut self, bodies: &[B]);

    /// A node sends a message.
    fn send(&mut self, envelope: Envelope<M>);

    /// Nodes send messages, in this order; none is left here. A medium that keeps them can take them all at once.
    fn send_all(&mut self, envelopes: &mut Vec<Envelope<M>>) {
        envelopes.drain(..).for_each(|envelope| self.send(envelope));
    }

    /// Seconds until the next message arrives: 0 if one arrives now, `None` if none is on its way.
    fn time_to_arrival(&self) -> Option<f64>;

    /// Lets `duration` > 0 seconds pass, at most [`time_to_arrival`](Self::time_to_arrival).
    fn flow(&mut self, duration: f64);

    /// Hands over every message that arrives now, in an order that depends on nothing but what
    /// was sent: messages as they were sent, each to its receivers in ascending order.
    ///
    /// # Errors
    ///
    /// The first error of `hand_over`.
    fn deliver<E>(
        &mut self,
        hand_over: impl FnMut(Delivery<'_, M>) -> Result<(), E>,
    ) -> Result<(), E>;

    /// In place of that, all that arrives now, for each node what it would hear in that order; `None` from a medium that
    /// does not sort its messages. What it offers counts as delivered. Where a node may say something before its next
    /// tick, to other nodes or to observers, the mail [says so](Mail::may_be_answered).
    fn mail(&mut self) -> Option<&Mail<M>> {
        None
    }
}

/// A medium in which every message arrives at once, at every node that it is for.
#[derive(Clone, Debug)]
pub struct FullMesh<M> {
    nodes: usize,
    sent: Vec<Envelope<M>>,
}

impl<M> FullMesh<M> {
    /// No message is on its way.
    pub const fn new() -> Self {
        FullMesh { nodes: 0, sent: Vec::new() }
    }
}

impl<M> Default for FullMesh<M> {
    fn default() -> Self {
        FullMesh::new()
    }
}

impl<M, B> Medium<M, B> for FullMesh<M> {
    fn update(&mut self, bodies: &[B]) {
        self.nodes = bodies.len();
    }

    fn send(&mut self, envelope: Envelope<M>) {
        self.sent.push(envelope);
    }

    fn time_to_arrival(&self) -> Option<f64> {
        (!self.sent.is_empty()).then_some(0.0)
    }

    fn flow(&mut self, _: f64) {}

    fn deliver<E>(
        &mut self,
        mut hand_over: impl FnMut(Delivery<'_, M>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.sent.drain(..).try_for_each(|Envelope { from, to, message }| {
            let receivers = match to {
                Destination::Everyone => 0..self.nodes,
                Destination::One(node) => node..node + 1,
            };
            receivers
                .filter(|&to| to != from)
                .try_for_each(|to| hand_over(Delivery { from, to, message: &message }))
        })
    }
}
