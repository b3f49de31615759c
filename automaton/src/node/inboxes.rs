//! Messages that arrive in the same round, sorted by receiver.

use super::{Delivery, NodeId};

/// What synchronous media are made of: messages, each kept once, and for every node those that it
/// is about to hear. The memory is used again from round to round.
#[derive(Clone, Debug, Default)]
pub struct Inboxes<M> {
    messages: Vec<(NodeId, M)>,
    /// For every node, indices of `messages`.
    waiting: Vec<Vec<u32>>,
}

impl<M> Inboxes<M> {
    /// No node, no message.
    pub const fn new() -> Self {
        Inboxes { messages: Vec::new(), waiting: Vec::new() }
    }

    /// Makes room for so many nodes.
    pub fn resize(&mut self, nodes: usize) {
        self.waiting.resize_with(nodes, Vec::new);
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.waiting.len()
    }

    /// Whether there is no node.
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Whether no message waits.
    pub fn are_empty(&self) -> bool {
        self.messages.is_empty()
    }

    /// A message for each of the receivers; numbers that are those of no node are left out.
    pub fn put(
        &mut self,
        from: NodeId,
        receivers: impl IntoIterator<Item = NodeId>,
        message: M,
    ) {
        let at = self.messages.len() as u32;
        let mut is_heard = false;
        for receiver in receivers {
            if let Some(inbox) = self.waiting.get_mut(receiver) {
                inbox.push(at);
                is_heard = true;
            }
        }
        if is_heard {
            self.messages.push((from, message));
        }
    }

    /// Hands over every message: receivers ascending, and for each its messages as they were put.
    ///
    /// # Errors
    ///
    /// The first error of `hand_over`; what is left is dropped.
    pub fn deliver<E>(
        &mut self,
        mut hand_over: impl FnMut(Delivery<'_, M>) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut outcome = Ok(());
        for (to, inbox) in self.waiting.iter_mut().enumerate() {
            for at in inbox.drain(..) {
                let (from, message) = &self.messages[at as usize];
                if outcome.is_ok() {
                    outcome = hand_over(Delivery { from: *from, to, message });
                }
            }
        }
        self.messages.clear();
        outcome
    }
}
