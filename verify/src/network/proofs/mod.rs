//! Steps that take several crates together, for all small networks.
//!
//! The harnesses call the functions that robots run and the properties that the monitor checks.
//! `docs/proofs.md` says what each assumes, and which engine has checked it.

mod duty;
mod election;
mod role;
mod service;
mod team;
mod tree;

/// Any number below a bound.
fn below(bound: usize) -> usize {
    usize::from(kani::any_where(|number: &u8| usize::from(*number) < bound))
}
