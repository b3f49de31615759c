//! Properties stated once, monitors over trajectories, and reachability.
//!
//! Each property is a documented pure function. Monitors, tests, exhaustive exploration and
//! proofs call that function, so that all of them speak of the same thing.
//! [`temporal`] judges trajectories of any system by formulas over time; [`reach`] encloses all runs
//! of an automaton; [`network`] holds the properties of the robot network, with the feature of that name, which is on by
//! default.

#![warn(unreachable_pub)]
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "a test may panic"))]

mod draws;
#[cfg(feature = "network")]
pub mod network;
pub mod reach;
pub mod temporal;
