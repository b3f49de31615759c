//! The robot network: one robot's automaton, the network composed of them, and their medium.

pub mod access_point;
pub mod automata;
pub mod beacon;
mod composition;
pub mod duty;
mod link;
pub mod medium;
pub mod observer;
pub mod record;
pub mod robot;
pub mod scenario;
pub mod shared;
pub mod site;

pub use automata::{mission_automaton, role_automaton};
pub use composition::{KernelTimes, Network, NetworkError, NetworkJump};
pub use link::Link;
pub use medium::{Medium, Radio};
pub use robot::Robot;
pub use site::{Site, SiteError};
