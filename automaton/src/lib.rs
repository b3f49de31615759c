//! Hybrid automata as typed values: the graph, the executor, traces and diagrams.
//!
//! A model is an [`Automaton`]: its locations and events are enums, its discrete behaviour is one
//! [`TransitionTable`](pleach_discrete::TransitionTable), and its guards are
//! [predicates as data](pleach_guards). It can be
//!
//! * **run**: several automata, their states and what they share make a [`System`], which the one
//!   [`Executor`] takes through hybrid time; its [module](executor) states the semantics;
//! * **drawn**: [`diagram`] writes Mermaid, DOT, SVG and tables from the automaton itself, so that
//!   pictures cannot drift from the code;
//! * **checked**: [`decision`] finds a state in which guards and invariants hold together, or proves
//!   that there is none.
//!
//! The robot network is one such model, in [`network`]; nothing else here knows of robots.

pub mod automaton;
pub mod builder;
pub mod check;
pub mod composition;
pub mod coordinates;
pub mod decision;
pub mod diagram;
pub mod edge;
pub mod executor;
pub mod flow;
pub mod network;
pub mod reset;
pub mod time;
pub mod trace;
pub mod trajectory;
pub mod zeno;

pub use automaton::{Automaton, Jump, Mode, Step, Transition, TransitionError};
pub use builder::{BuildError, Builder};
pub use check::{Finding, Report};
pub use composition::{
    Composition, CompositionBuilder, CompositionError, Failure, Policy, Settings, Simulation,
    SimulationError,
};
pub use coordinates::{Coordinate, Coordinates, Vector};
pub use edge::{Edge, from};
pub use executor::{Ending, Executor, InvalidLimit, Observer, Reason, Round, System};
pub use flow::{Flow, Rate};
pub use reset::{Assignment, Reset};
pub use time::HybridTime;

pub use trace::{Participants, Trace, TraceEntry};
pub use trajectory::Trajectory;
pub use zeno::Zeno;

// For the macros.
#[doc(hidden)]
pub use {pleach_discrete as discrete, pleach_guards as guards};
