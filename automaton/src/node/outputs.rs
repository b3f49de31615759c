//! What a node leaves when it takes a step.

use super::NodeId;

/// The destination of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Destination {
    /// Every node that hears the sender.
    Everyone,
    /// One node.
    One(NodeId),
}

/// A message with its sender and destination.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Envelope<M> {
    /// The sender.
    pub from: NodeId,
    /// Its destination.
    pub to: Destination,
    /// The message.
    pub message: M,
}

/// The outputs of the steps of one node, or of several in turn: messages, and reports for
/// observers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outputs<M, R> {
    node: NodeId,
    sent: Vec<Envelope<M>>,
    reports: Vec<(NodeId, R)>,
}

impl<M, R> Outputs<M, R> {
    /// Nothing yet, of the node with this number.
    pub const fn of(node: NodeId) -> Self {
        Outputs { node, sent: Vec::new(), reports: Vec::new() }
    }

    /// What follows comes from another node.
    pub(super) const fn now_of(&mut self, node: NodeId) -> &mut Self {
        self.node = node;
        self
    }

    /// How many messages and reports there are.
    pub(super) const fn counts(&self) -> [usize; 2] {
        [self.sent.len(), self.reports.len()]
    }

    /// Keeps the first `sent` messages and `reports` reports, and returns the rest.
    pub(super) fn split_off(&mut self, [sent, reports]: [usize; 2]) -> Self {
        Outputs {
            node: self.node,
            sent: self.sent.split_off(sent),
            reports: self.reports.split_off(reports),
        }
    }

    /// Appends later messages and reports, of any node.
    pub(super) fn append(&mut self, later: &mut Self) {
        self.sent.append(&mut later.sent);
        self.append_reports(later);
    }

    /// Takes over the reports that other nodes make after these.
    pub(super) fn append_reports(&mut self, later: &mut Self) {
        self.reports.append(&mut later.reports);
    }

    /// Sends a message to every node that hears this one.
    pub fn broadcast(&mut self, message: M) {
        self.sent.push(Envelope { from: self.node, to: Destination::Everyone, message });
    }

    /// Sends a message to one node.
    pub fn send(&mut self, to: NodeId, message: M) {
        self.sent.push(Envelope { from: self.node, to: Destination::One(to), message });
    }

    /// Tells observers.
    pub fn report(&mut self, report: R) {
        self.reports.push((self.node, report));
    }

    /// The messages, in the order in which they were sent.
    pub fn sent(&self) -> &[Envelope<M>] {
        &self.sent
    }

    /// Takes the messages, in the order in which they were sent.
    pub fn drain_sent(&mut self) -> std::vec::Drain<'_, Envelope<M>> {
        self.sent.drain(..)
    }

    /// The messages, in the order in which they were sent, for a medium to take.
    pub(super) const fn sent_mut(&mut self) -> &mut Vec<Envelope<M>> {
        &mut self.sent
    }

    /// Takes the reports with the nodes that made them, in their order.
    pub fn drain_reports(&mut self) -> std::vec::Drain<'_, (NodeId, R)> {
        self.reports.drain(..)
    }
}
