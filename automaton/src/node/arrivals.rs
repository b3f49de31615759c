//! The messages that arrive in one round, receiver by receiver.

use std::ops::Range;

use super::{Delivery, Envelope, NodeId};

/// The messages that arrive in one round. They are added in the order of a delivery, each with its
/// receivers in ascending order, and heard receiver by receiver: each receiver hears them in that order,
/// and no step of another one lies between.
#[derive(Clone, Debug)]
pub struct Arrivals<M> {
    envelopes: Vec<Envelope<M>>,
    /// The receivers of the messages, one message after the other.
    receivers: Vec<u32>,
    /// Where the receivers of each message begin.
    begins: Vec<u32>,
    /// The deliveries in the order of their receivers: the message of each, and its place in the order
    /// of the delivery.
    inboxes: Vec<Entry>,
    /// Where the inbox of each node ends.
    ends: Vec<u32>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    message: u32,
    place: u32,
}

impl<M> Arrivals<M> {
    /// Nothing arrives.
    pub const fn new() -> Self {
        Arrivals {
            envelopes: Vec::new(),
            receivers: Vec::new(),
            begins: Vec::new(),
            inboxes: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// These messages arrive, in their order, each at the nodes that `receivers` tells, in ascending order.
    /// They are taken out of `sent`.
    pub fn add<'a>(
        &mut self,
        sent: &mut Vec<Envelope<M>>,
        receivers: impl Fn(&Envelope<M>) -> &'a [NodeId],
    ) {
        for envelope in sent.iter() {
            self.begins.push(self.receivers.len() as u32);
            self.receivers.extend(receivers(envelope).iter().map(|&to| to as u32));
        }
        if self.envelopes.is_empty() {
            std::mem::swap(&mut self.envelopes, sent);
        } else {
            self.envelopes.append(sent);
        }
    }

    /// How many messages arrive, counted for each receiver.
    pub fn deliveries(&self) -> usize {
        self.receivers.len()
    }

    /// All of it has been heard.
    pub(super) fn clear(&mut self) {
        self.envelopes.clear();
        self.receivers.clear();
        self.begins.clear();
    }

    /// Sorts by receivers what arrives at the first `nodes` nodes.
    pub(super) fn sort(&mut self, nodes: usize) {
        let Arrivals { receivers, begins, inboxes, ends, .. } = self;
        ends.clear();
        ends.resize(nodes, 0);
        let known = |&to: &u32| (to as usize) < nodes;
        receivers.iter().filter(|to| known(to)).for_each(|&to| ends[to as usize] += 1);
        let mut total = 0;
        for end in ends.iter_mut() {
            // For now where it begins: it grows to its end as it is filled.
            total += std::mem::replace(end, total);
        }
        inboxes.clear();
        inboxes.resize(total as usize, Entry::default());
        for (message, &begin) in begins.iter().enumerate() {
            let end = begins.get(message + 1).map_or(receivers.len(), |&next| next as usize);
            for place in begin as usize..end {
                let to = receivers[place] as usize;
                if let Some(next) = ends.get_mut(to) {
                    let (message, place) = (message as u32, place as u32);
                    inboxes[*next as usize] = Entry { message, place };
                    *next += 1;
                }
            }
        }
    }

    /// Whether anything arrives at a node.
    pub(super) fn has(&self, to: NodeId) -> bool {
        !self.range(to).is_empty()
    }

    fn range(&self, to: NodeId) -> Range<usize> {
        let begin = to.checked_sub(1).map_or(0, |before| self.ends[before]);
        begin as usize..self.ends[to] as usize
    }

    /// What one node hears once all is sorted, each with its place in the order of the delivery.
    pub(super) fn inbox(
        &self,
        to: NodeId,
    ) -> impl ExactSizeIterator<Item = (u32, Delivery<'_, M>)> {
        self.inboxes[self.range(to)].iter().map(move |&Entry { message, place }| {
            let Envelope { from, message, .. } = &self.envelopes[message as usize];
            (place, Delivery { from: *from, to, message })
        })
    }
}

impl<M> Default for Arrivals<M> {
    fn default() -> Self {
        Arrivals::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::node::Destination;

    #[test]
    fn every_receiver_hears_in_the_order_of_the_delivery() {
        let mut arrivals = Arrivals::new();
        let sent = |from, message| Envelope { from, to: Destination::Everyone, message };
        let audiences: [&[NodeId]; 3] = [&[1, 2], &[1], &[0, 1, 7]];
        let receivers = |envelope: &Envelope<char>| audiences[envelope.from];
        arrivals.add(&mut vec![sent(2, 'a'), sent(0, 'b')], receivers);
        arrivals.add(&mut vec![sent(1, 'c')], receivers);
        assert_eq!(arrivals.deliveries(), 6);
        arrivals.sort(3);
        let heard = |to: NodeId| -> Vec<(u32, NodeId, char)> {
            let inbox = arrivals.inbox(to);
            inbox.map(|(place, delivery)| (place, delivery.from, *delivery.message)).collect()
        };
        assert_eq!(heard(0), [(0, 2, 'a')]);
        assert_eq!(heard(1), [(1, 2, 'a'), (3, 0, 'b'), (5, 1, 'c')]);
        assert_eq!(heard(2), [(4, 0, 'b')]);
    }
}
