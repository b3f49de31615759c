//! Hundreds of missions, in one program.

#![allow(clippy::unwrap_used, reason = "a test that panics has failed")]

#[path = "../../generated/mod.rs"]
mod generated;

mod certificates;
mod coverage;
mod determinism;
mod errands;
mod fleets;
mod found_missions;
mod imported;
mod medium;
mod random_missions;
mod rates;
mod saturated;
mod shipped;
mod storms;
mod strategies;
mod stressed;
mod verdicts;
