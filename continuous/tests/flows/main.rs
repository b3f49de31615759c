//! Flows against closed forms and against the exponential of nalgebra.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod events;
mod exact;
mod integration;
mod stiff;
mod support;
