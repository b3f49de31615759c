//! The continuous layer: geometry of the workspace, communication and motion.
//!
//! Lengths are in the scenario's own unit, times in seconds.

#![cfg_attr(test, allow(clippy::unwrap_used, reason = "a test may panic"))]

pub mod flow;
pub mod geometry;
pub mod network;

/// A place in the plane.
pub type Point = nalgebra::Point2<f64>;
/// A displacement in the plane.
pub type Vector = nalgebra::Vector2<f64>;
