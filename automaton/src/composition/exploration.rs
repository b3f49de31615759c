//! Exploring a composition in which no time passes: all states that it can reach.
//!
//! A protocol or a logic without clocks is a composition whose flows move nothing. Its runs are
//! sequences of jumps, and what any of them can lead to is found by looking at every state once,
//! breadth first, so that the way to each state is as short as any.
//!
//! From a state every jump can be taken whose guards hold, a label by all its participants
//! together. Where one of them has to be taken (*must* or *at once*), those that only may be have
//! to wait, as in a run. Priorities and the order of components, which settle what a run does
//! first, settle nothing here: each order is explored. Invariants say whether time may pass, and so
//! they say nothing.
//!
//! Two processes that share a resource, and a state in which each waits for the other:
//!
//! ```
//! use pleach_automaton::{from, Automaton, Composition};
//! use pleach_discrete::vocabulary;
//! use pleach_guards::always;
//!
//! vocabulary! {
//!     enum Fork: Location { Free = "free", Taken = "taken" }
//!     enum Diner: Location { Thinking = "thinking", Waiting = "waiting", Eating = "eating" }
//!     enum Act: Event { TakeOne = "take one", TakeOther = "take the other", PutBack = "put back" }
//!     enum Use: Event { First = "taken by 1", Second = "taken by 2", Back1 = "back from 1", Back2 = "back from 2" }
//! }
//!
//! let fork = Automaton::starting_in(Fork::Free)
//!     .initially(())
//!     .transition(from(Fork::Free).on(Use::First).to(Fork::Taken).may(always()))
//!     .transition(from(Fork::Free).on(Use::Second).to(Fork::Taken).may(always()))
//!     .transition(from(Fork::Taken).on(Use::Back1).to(Fork::Free).may(always()))
//!     .transition(from(Fork::Taken).on(Use::Back2).to(Fork::Free).may(always()))
//!     .build()?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
