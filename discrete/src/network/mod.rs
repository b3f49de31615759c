//! The discrete layer of the robot network.

pub mod role;

pub use role::{Phase, Role};
