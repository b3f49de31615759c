//! Mail: the messages that arrive in one round, sorted by the nodes that hear them.

use super::{Delivery, Envelope, NodeId};

/// Messages sorted by the nodes that hear them. Each node has its own together, in the order in which they were sent,
/// so that its state is touched once a round.
#[derive(Clone, Debug)]
pub struct Mail<M> {
    sent: Vec<Envelope<M>>,
    /// The places of the messages among those sent.
    places: Vec<u32>,
    /// Where those of each node end.
    ends: Vec<usize>,
    /// Whether a node may say something when it hears one of them, and not only at its next tick.
    may_be_answered: bool,
}

impl<M> Mail<M> {
    /// Nothing arrives.
    pub const fn new() -> Self {
        Mail { sent: Vec::new(), places: Vec::new(), ends: Vec::new(), may_be_answered: false }
    }

    /// Replaces what it holds by these messages, sorted by receiver. `receivers_of` gives the nodes that hear a message,
    /// numbered below `nodes`; whether nodes may answer any of them before their next tick is for the medium to say.
    pub fn sort<'a>(
        &mut self,
        messages: &mut Vec<Envelope<M>>,
        nodes: usize,
        receivers_of: impl Fn(&Envelope<M>) -> &'a [NodeId],
        may_be_answered: bool,
    ) {
        self.may_be_answered = may_be_answered;
        let Mail { sent, places, ends, .. } = self;
        sent.clear();
        std::mem::swap(sent, messages);
        ends.clear();
        ends.resize(nodes, 0);
        let receivers: Vec<&[NodeId]> = sent.iter().map(receivers_of).collect();
        receivers.iter().copied().flatten().for_each(|&to| ends[to] += 1);
        let mut count = 0;
        for end in ends.iter_mut() {
            // Until its messages are entered, each node's end is where they begin.
            count += std::mem::replace(end, count);
        }
        places.resize(count, 0);
        for (place, receivers) in (0..).zip(receivers) {
            for &to in receivers {
                places[ends[to]] = place;
                ends[to] += 1;
            }
        }
    }

    /// Whether nodes may answer what they hear before their next tick. If so, they tick only after these answers have
    /// been heard.
    pub const fn may_be_answered(&self) -> bool {
        self.may_be_answered
    }

    /// How many messages arrive, counted for each node that hears them.
    pub const fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether nothing arrives.
    pub const fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// What a node hears, each message with its place among all that have been sent.
    pub fn of(&self, to: NodeId) -> impl ExactSizeIterator<Item = (u32, Delivery<'_, M>)> {
        let end = |node: NodeId| self.ends.get(node).copied().unwrap_or(self.places.len());
        let begin = to.checked_sub(1).map_or(0, end);
        self.places[begin..end(to)].iter().map(move |&place| {
            let Envelope { from, message, .. } = &self.sent[place as usize];
            (place, Delivery { from: *from, to, message })
        })
    }
}

impl<M> Default for Mail<M> {
    fn default() -> Self {
        Mail::new()
    }
}
