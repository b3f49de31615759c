//! Missions for tests: random floor plans and storms, how a mission is run and what is seen of it, and a second
//! opinion on its trace.
//!
//! The tests of this package run hundreds of missions: `cargo test -p missions`.

#![allow(clippy::unwrap_used, reason = "a test that panics has failed")]

mod acts;
pub mod arguments;
pub mod arrangements;
mod drawn;
pub mod floor_plans;
pub mod in_storms;
mod medium;
mod mission;
pub mod oracle;
mod scenarios;
pub mod strategies;
pub mod verdicts;

pub use acts::{Acts, counted};
pub use drawn::{Drawn, redundant, used};
pub use medium::{Arrival, AskedTwice, Filtered, Passage, Through, Written};
pub use mission::{
    Mission, Period, network_over, run, run_by, run_over, run_unmonitored, shipped_mission,
    trace_of, traced,
};
pub use scenarios::{files, read, shipped, shipped_names, valid};
