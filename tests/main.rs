//! The tests of the whole, in one program: linking is most of what it takes to build tests.

#![allow(clippy::unwrap_used)] // a test that panics has failed

#[path = "../automaton/tests/missions/best_routes.rs"]
mod best_routes;
mod common;
mod floor_plans;
mod fuzz;
mod fuzzing;
mod generated;
mod missions;
mod oracle;
mod sources;
mod uses;

mod absurd_numbers;
mod book;
mod browser;
mod certificates;
mod command_line;
mod coverage;
mod determinism;
mod documents;
mod errands;
mod faulty_traces;
mod fleets;
mod found_missions;
mod harnesses;
mod import;
mod layering;
mod medium;
mod outcomes;
mod pages;
mod proofs;
mod proven;
mod public_api;
mod random_missions;
mod rates;
mod records;
mod routes;
mod scenario_faults;
mod spaceex;
mod storms;
mod story;
mod strategies;
mod streams;
mod stressed;
mod studies;
mod summary;
mod trace;
