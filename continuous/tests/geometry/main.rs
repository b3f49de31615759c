//! The geometry against plain reimplementations that try everything.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod cells;
mod environments;
mod free_space;
mod geodesics;
mod neighbours;
mod plain;
mod reentry;
mod workspace;
