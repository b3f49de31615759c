//! The medium: what becomes of messages between their senders and their receivers.

use super::{Destination, Envelope, Inboxes, NodeId};

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

    /// Seconds until the next message arrives: 0 if one arrives now, `None` if none is on its way.
    fn time_to_arrival(&self) -> Option<f64>;

    /// Lets `duration` > 0 seconds pass, at most [`time_to_arrival`](Self::time_to_arrival).
    fn flow(&mut self, duration: f64);

    /// Hands over every message that arrives now, in an order that depends on nothing but what
    /// was sent: receivers ascending, and for each its messages as they were sent.
    ///
    /// # Errors
    ///
    /// The first error of `hand_over`.
    fn deliver<E>(
        &mut self,
        hand_over: impl FnMut(Delivery<'_, M>) -> Result<(), E>,
    ) -> Result<(), E>;
}

/// A medium in which every message arrives at once, at every node that it is for.
#[derive(Clone, Debug, Default)]
pub struct FullMesh<M> {
    inboxes: Inboxes<M>,
}

impl<M> FullMesh<M> {
    /// No message is on its way.
    pub fn new() -> Self {
        FullMesh { inboxes: Inboxes::new() }
    }
}

impl<M, B> Medium<M, B> for FullMesh<M> {
    fn update(&mut self, bodies: &[B]) {
        self.inboxes.resize(bodies.len());
    }

    fn send(&mut self, Envelope { from, to, message }: Envelope<M>) {
        match to {
            Destination::Everyone => {
                let others = (0..self.inboxes.len()).filter(|&node| node != from);
                self.inboxes.put(from, others, message);
            }
            Destination::One(node) => self.inboxes.put(from, [node], message),
        }
    }

    fn time_to_arrival(&self) -> Option<f64> {
        (!self.inboxes.are_empty()).then_some(0.0)
    }

    fn flow(&mut self, _: f64) {}

    fn deliver<E>(
        &mut self,
        hand_over: impl FnMut(Delivery<'_, M>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.inboxes.deliver(hand_over)
    }
}
