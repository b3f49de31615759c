//! Exhaustive exploration of the coordination protocol.
//!
//! What is explored is the code that robots and access points run: [`Robot`] and [`AccessPoint`]
//! with their tables, guards and resets. Only the continuous side is replaced, by choice: robots
//! stand on the places of a graph, [`PlaceGraph`], and a body may come to the next place on its way,
//! or not yet. A [`Protocol`] composes them with a [`Medium`].
//!
//! [`Robot`]: pleach_automaton::network::Robot
//! [`AccessPoint`]: pleach_automaton::network::access_point::AccessPoint

mod campaign;
mod campaigns;
pub mod election;
mod graphs;
mod medium;
mod node;
mod places;
pub mod properties;
mod protocol;
mod story;

pub use campaign::{Campaign, CampaignError, Counts, ENDS, Failure, Findings, Graphs};
pub use campaigns::{QUICK, THOROUGH};
pub use graphs::{Graph, graphs, numbered_graphs};
pub use medium::{Faults, LONGEST_ECHO, Medium};
pub use node::{BeaconId, Local, LocalId, MessageId, Node, Nodes, Stimulus};
pub use places::{PlaceGraph, PlaceGraphError, PlaceId};
pub use properties::{ALWAYS, has_ended};
pub use protocol::{Action, Configuration, Protocol, ProtocolError, State};
pub use story::{story, tell};
