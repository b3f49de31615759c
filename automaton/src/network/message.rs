//! The messages that nodes of the network exchange.
//!
//! Messages are data: in memory they share what they carry, and between processes they are written
//! and read in any format of [serde](https://serde.rs). A message that is read is checked. Unknown
//! fields, numbers that are not finite, and elections, agreements, sets and lineages that no node
//! can have sent are refused:
//!
//! ```
//! use pleach_automaton::network::Message;
//!
//! let text = serde_json::to_string(&Message::Demand(0.25))?;
//! assert_eq!(text, r#"{"demand":0.25}"#);
//! assert_eq!(serde_json::from_str::<Message>(&text)?, Message::Demand(0.25));
//! assert!(serde_json::from_str::<Message>(r#"{"demand":null}"#).is_err());
//! # Ok::<(), serde_json::Error>(())
//! ```
//!
//! Whether the nodes and tasks exist that it names, [`Message::is_possible`] tells.

mod bounds;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::network::routing::adal::NeighbourReport;
use pleach_discrete::network::NodeId;
use serde::{Deserialize, Serialize};

use super::beacon::{Beacon, Bulletin};
use super::order::Order;
use super::robot::{FlowGrant, FlowRequest, Probe};
use super::roll::Roll;
use super::wire;

/// A message of the network. All of them go through the same medium.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Message {
    /// The public state of the sender, to all nodes in range.
    Beacon {
        /// The control period in which it is sent. All nodes count their periods alike; one that
        /// begins later takes the number from the first beacon that it receives.
        period: u32,
        /// The newest roll that the sender knows.
        roll: Roll,
        /// The newest control period in which an access point has confirmed the sender's way to it.
        confirmed: Option<u32>,
        /// The public state.
        #[serde(with = "wire")]
        beacon: Arc<Beacon>,
    },
    /// How the sender's equation c_i ≥ η stands, to all nodes in range.
    Multiplier {
        /// λ_i, and what ADAL needs beside it.
        #[serde(with = "wire")]
        report: NeighbourReport,
        /// The parent of the sender in the tree: the node that its demand will go to.
        parent: Option<NodeId>,
    },
    /// F_ij, to the receiver j of the flow; 0 if there is none any more.
    Flow(#[serde(with = "wire")] f64),
    /// By how much the sender's flow to its parent grows in the sweep, to the parent.
    Demand(#[serde(with = "wire")] f64),
    /// The sender cannot pass on what it is sent, to all nodes in range.
    Shortage,
    /// The sender asks the receiver for a flow towards it.
    AskFlow(#[serde(with = "wire")] FlowRequest),
    /// The sender grants the receiver a flow towards itself.
    GrantFlow(#[serde(with = "wire")] FlowGrant),
    /// Follows flows whose leases wait to be renewed, to find a circle of them.
    Probe(#[serde(with = "wire")] Probe),
    /// The move that the sender intends, to all nodes in range.
    Proposal {
        /// The control period.
        period: u32,
        /// From where it is to where it would be.
        #[serde(with = "wire")]
        segment: Segment,
        /// The node that is asked to know of the move, where nobody relies on the sender.
        witness: Option<NodeId>,
    },
    /// The sender cannot accept the move that the receiver intends.
    Objection {
        /// The control period.
        period: u32,
    },
    /// The sender, which relies on the receiver or is its witness, knows and accepts the move that the receiver
    /// intends, and every part of it.
    Consent {
        /// The control period.
        period: u32,
    },
    /// All that a user has asked for so far, to the first access point.
    Request(Order),
    /// The newest notice on the mission, from the first access point to the user.
    News(Bulletin),
}

impl Message {
    /// Whether its receiver may send something at once, and not only at its next tick.
    pub const fn may_be_answered_at_once(&self) -> bool {
        match self {
            Message::Demand(_) | Message::Shortage | Message::Probe(_) | Message::News(_) => true,
            Message::Proposal { witness, .. } => witness.is_some(),
            Message::Beacon { .. }
            | Message::Multiplier { .. }
            | Message::Flow(_)
            | Message::AskFlow(_)
            | Message::GrantFlow(_)
            | Message::Objection { .. }
            | Message::Consent { .. }
            | Message::Request(_) => false,
        }
    }
}
