//! Everything that nodes of the network tell each other.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::network::routing::adal::NeighbourReport;
use pleach_discrete::network::{Bulletin, NodeId};

use super::beacon::{Beacon, Notice};
use super::shared::Shared;

/// A message of the network. All of them go through the same medium.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// The public state of the sender, to everyone who hears it.
    Beacon(Arc<Beacon>),
    /// How the sender's equation c_i ≥ η stands, to everyone.
    Multiplier {
        /// λ_i, and what ADAL needs beside it.
        report: NeighbourReport,
        /// The parent of the sender in the tree: the node that its demand will go to.
        parent: Option<NodeId>,
    },
    /// F_ij, to the receiver j of the flow; 0 if there is none any more.
    Flow(f64),
    /// By how much the sender's flow to its parent grows in the sweep, to the parent.
    Demand(f64),
    /// The sender cannot pass on what it is sent, to everyone.
    Shortage,
    /// The move that the sender intends, to everyone.
    Proposal(Segment),
    /// The sender cannot accept the move that the receiver intends.
    Objection,
    /// The tasks of a user in their order, to the first access point.
    Request(Arc<[Point]>),
    /// The newest notice on the mission, from the first access point to the user.
    News(Shared<Bulletin<Notice>>),
}
