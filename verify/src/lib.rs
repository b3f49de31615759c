//! Properties stated once, and monitors over trajectories.
//!
//! Each property is a documented pure function. Monitors, tests, exhaustive exploration and
//! proofs call that function, so that all of them speak of the same thing.
//! [`network`] holds those of the robot network; [`exploration`] visits every state of a
//! discrete system.

#![cfg_attr(test, allow(clippy::unwrap_used, reason = "a test may panic"))]

pub mod exploration;
pub mod network;
