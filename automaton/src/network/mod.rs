//! The robot network: one robot's automaton, the network composed of them, and their medium.

pub mod access_point;
pub mod automata;
pub mod beacon;
mod composition;
pub mod duty;
pub mod medium;
pub mod observer;
pub mod record;
pub mod robot;
pub mod scenario;
pub mod shared;
pub mod site;

pub use automata::{Automata, mission_automaton};
pub use composition::{KernelTimes, Network, NetworkError, NetworkJump};
pub use medium::{Medium, Radio};
pub use robot::{Robot, duty_automaton};
pub use site::{Site, SiteError};
