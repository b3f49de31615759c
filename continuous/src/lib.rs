//! The continuous layer: flows, geometry of the workspace, communication and motion.
//!
//! [`flow`] is for all models: exact and integrated solutions, and the events on them. The rest is
//! for the robot network and requires the feature `network`, which is on by default; lengths there
//! are in the scenario's own unit, and times in seconds.

#![warn(unreachable_pub)]
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "a test may panic"))]

pub mod flow;
#[cfg(feature = "network")]
pub mod geometry;
#[cfg(feature = "network")]
pub mod network;

/// The linear algebra of [`Point`], [`Vector`] and of flows, in the version that signatures name.
pub use nalgebra;

/// A place in the plane.
pub type Point = nalgebra::Point2<f64>;
/// A displacement in the plane.
pub type Vector = nalgebra::Vector2<f64>;
