//! Exhaustive exploration: every state that a discrete system can reach, in every order of events.
//!
//! This package tests the published packages, and is not published itself: [`network`] explores the
//! protocol of the robots by means of the code that they run.
//!
//! A [`Model`] says where it starts and what may happen next. [`explore`] visits its states
//! breadth first, so that the path to each state that it finds is a shortest one, and checks each
//! state against the given properties. The visited states form a [`StateGraph`], a finite graph, on
//! which [`traps`](StateGraph::traps) decides what must happen on every fair path.
//!
//! ```
//! use pleach_exploration::{Fairness, Model, Property, explore};
//!
//! /// Two processes that take turns in counting to three.
//! struct Turns;
//!
//! impl Model for Turns {
//!     type State = [u8; 2];
//!     type Action = usize;
//!     type Error = std::convert::Infallible;
//!
//!     fn initial(&mut self) -> Result<Vec<[u8; 2]>, Self::Error> {
//!         Ok(vec![[0, 0]])
//!     }
//!
//!     fn successors(&mut self, state: &[u8; 2]) -> Result<Vec<(usize, [u8; 2])>, Self::Error> {
//!         let may = |process: &usize| state[*process] < 3;
//!         let after = |process: usize| {
//!             let mut next = *state;
//!             next[process] += 1;
//!             (process, next)
//!         };
//!         Ok((0..2).filter(may).map(after).collect())
//!     }
//! }
//!
//! let small: Property<Turns> = Property { name: "small", holds: |_, state| state[0] < 4 };
//! let exploration = explore(&mut Turns, &[small], 100)?;
//! assert_eq!(exploration.states().len(), 16);
//! assert!(exploration.violations().is_empty());
//! assert!(exploration.traps(|state| *state == [3, 3], |_| false, Fairness::Weak).is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(test, allow(clippy::unwrap_used, reason = "a test may panic"))]

mod explorer;
mod liveness;
pub mod network;

pub use explorer::{
    ExplorationError, Explored, Model, Property, StateGraph, StateId, Successors, Violation,
    explore,
};
pub use liveness::Fairness;
