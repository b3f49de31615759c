//! The tests of the whole, in one program: linking is most of what it takes to build tests.

#![allow(clippy::unwrap_used)] // a test that panics has failed

#[path = "../automaton/tests/missions/best_routes.rs"]
mod best_routes;
mod common;
mod fuzz;
mod fuzzing;
mod generated;
mod sources;
mod uses;

mod absurd_numbers;
mod book;
mod browser;
mod command_line;
mod documents;
mod faulty_traces;
mod harnesses;
mod import;
mod language;
mod layering;
mod outcomes;
mod pages;
mod proofs;
mod proven;
mod records;
mod reference;
mod routes;
mod scenario_faults;
mod spaceex;
mod story;
mod streams;
mod studies;
mod summary;
mod trace;
