//! The geometry against plain reimplementations that try everything.

mod cells;
mod environments;
mod errors;
mod free_space;
mod geodesics;
mod limits;
mod neighbours;
mod parry;
mod plain;
mod reentry;
mod repair;
mod shapes;
mod taut;
mod workspace;
