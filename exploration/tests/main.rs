//! The tests of the package, in one program.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod campaigns;
#[path = "../../tests/generated/mod.rs"]
mod generated;
mod protocol;
