//! Hybrid automata as typed values: the graph, the executor, traces and diagrams.
//!
//! A model is an [`Automaton`]: its locations and events are enums, its discrete behaviour is one
//! [`TransitionTable`](pleach_discrete::TransitionTable), and its guards are
//! [predicates as data](pleach_guards). It can be
//!
//! * **run**: several automata, their states and what they share make a [`System`], which the one
//!   [`Executor`] takes through hybrid time; its [module](executor) states the semantics;
//! * **drawn**: [`diagram`] writes Mermaid, DOT, SVG and tables from the automaton itself, so that
//!   pictures cannot drift from the code.
//!
//! The robot network is one such model, in [`network`]; nothing else here knows of robots.

pub mod automaton;
pub mod builder;
pub mod diagram;
pub mod executor;
pub mod network;
pub mod reset;
pub mod time;
pub mod trajectory;

pub use automaton::{Automaton, GuardError, Jump, Mode, Step, Transition};
pub use builder::{BuildError, Builder};
pub use executor::{Ending, Executor, InvalidLimit, Observer, Reason, Round, System};
pub use reset::{Flow, Reset};
pub use time::HybridTime;
pub use trajectory::{Participants, Trace, TraceEntry};
