//! The robot network: one robot's automaton, the network composed of them, and their medium.

pub mod access_point;
mod act;
mod automata;
mod ballot;
pub mod beacon;
pub mod certificate;
mod composition;
pub mod control;
pub mod duty;
pub mod faulty_node;
pub mod fleets;
mod guards;
mod link;
mod medium;
mod member;
mod membership;
pub mod merging;
pub mod message;
pub mod mission;
mod notices;
pub mod observer;
pub mod order;
mod outbox;
pub mod phrase;
pub mod record;
mod renumbering;
pub mod robot;
pub mod roll;
pub mod scenario;
mod service;
pub mod shared;
mod site;
pub mod user;
mod wire;

pub use access_point::{AccessPoint, attendance_automaton, round_automaton, service_automaton};
pub use automata::{Automata, NamedRow};
pub use composition::{KernelTimes, LONGEST_SETTLING, Network, NetworkError, RobotNode};
pub use faulty_node::{Crash, FaultyNode, NodeFaults};
pub use fleets::Fleets;
pub use link::Link;
pub use medium::Radio;
pub use member::{Member, MemberView, Sense};
pub use message::Message;
pub use renumbering::Renumbering;
pub use robot::{
    Robot, RobotView, SATURATED, attachment_automaton, control_automaton, duty_automaton,
    exchange_automaton, mission_automaton,
};
#[cfg(feature = "abstraction")]
pub use site::Measure;
pub use site::{Site, SiteError};
pub use user::{User, request_automaton};
