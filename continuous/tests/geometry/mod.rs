//! The geometry against plain reimplementations that try everything.

mod cells;
mod environments;
mod free_space;
mod geodesics;
mod neighbours;
mod plain;
mod reentry;
mod workspace;
