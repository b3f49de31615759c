//! Exhaustive exploration: every state that a discrete system can reach, in every order of events.
//!
//! A [`Model`] says where it starts and what may happen next. [`explore`] visits its states
//! breadth first, so that the way to a state that it finds is a shortest one, and checks each
//! with the properties given. What it has visited is an [`Exploration`]: a finite graph, on which
//! [`traps`](Exploration::traps) decides what must happen on every fair path.
//!
//! ```
//! use pleach_verify::exploration::{Fairness, Model, Property, explore};
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
//! assert!(exploration.traps(|state| *state == [3, 3], Fairness::Weak).is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod explorer;
mod liveness;

pub use explorer::{
    Exploration, ExplorationError, Explored, Model, Property, StateId, Successors, Violation,
    explore,
};
pub use liveness::Fairness;
