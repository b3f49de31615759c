//! The tests of the package, in one program.

mod common;

mod analysis;
mod depth;
mod enclosures;
mod functions;
mod margins;
mod printing;
mod programs;
mod reading;
mod serialization;
mod sides;
