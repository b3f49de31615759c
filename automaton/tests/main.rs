//! The tests of the package, in one program.

mod common;

mod adversity;
mod bouncing_ball;
mod building;
mod clocks;
mod compile_fail;
mod coverage;
mod decisions;
mod diagrams;
mod encounters;
mod endings;
mod error_messages;
mod faulty_models;
mod first_roots;
mod flights;
mod guarantees;
mod kinks;
mod lines_and_curves;
mod literature;
mod loops;
mod machines;
mod magnitudes;
mod many_components;
mod messages;
#[cfg(feature = "network")]
mod missions;
mod models;
#[cfg(feature = "network")]
mod network_checks;
mod pictures;
mod products;
mod profiles;
mod records;
mod sampled_rooms;
mod semantics;
mod sets;
mod signals;
mod sliding;
mod solver;
mod steps;
mod streams;
mod superstates;
mod two_forms;
