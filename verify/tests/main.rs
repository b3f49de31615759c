//! The tests of the package, in one program.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod reach;
mod temporal;
