//! The robot network: one robot's automaton, the network composed of them, and their medium.

pub mod record;
pub mod scenario;
