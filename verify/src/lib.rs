//! Properties stated once, and monitors over trajectories.

pub mod network;
