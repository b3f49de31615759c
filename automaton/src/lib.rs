//! Hybrid automata as typed values: the graph, the executor, traces and diagrams.
//!
//! A model is an [`Automaton`]: its locations and events are enums, its discrete behaviour is one
//! [`TransitionTable`](pleach_discrete::TransitionTable), and its guards are
//! [predicates as data](pleach_guards). It can be
//!
//! * **run**: an automaton over [coordinates](Coordinates), or a [`composition`] of several,
//!   runs as it is and yields a [`Trajectory`]; any other [`System`] runs on the same [`Executor`].
//!   The [executor's page](executor) and `docs/semantics.md` define what a run is;
//! * **drawn**: [`diagram`] writes Mermaid, DOT, SVG, LaTeX and tables from the automaton itself,
//!   so that pictures cannot drift from the code, and plots its trajectories;
//! * **covered**: [`coverage`] counts what a set of runs has exercised, and what it has not;
//! * **checked**: [`check`] reports guards that overlap, states without a way out and resets that
//!   break invariants; [`decision`] finds a state in which guards and invariants hold together, or
//!   proves that there is none.
//!
//! The robot network is one such model, in [`network`]; nothing else here knows of robots. It is
//! behind the feature `network`, which is on by default; without it the framework needs neither
//! geometry nor a solver.

#![warn(unreachable_pub)]

mod automaton;
mod builder;
mod chance;
pub mod check;
pub mod composition;
mod coordinates;
pub mod coverage;
pub mod decision;
pub mod diagram;
mod edge;
pub mod executor;
mod flow;
pub mod law;
mod lists;
pub mod located;
pub mod moment;
pub mod named;
#[cfg(feature = "network")]
pub mod network;
pub mod node;
mod observed;
mod outline;
mod parallel;
mod reset;
mod signals;
pub mod sliding;
mod sweep;
mod time;
mod trace;
pub mod trajectory;
pub mod zeno;

pub use automaton::{
    Automaton, InvariantError, Jump, Mode, ParameterError, Step, Transition, TransitionError,
};
pub use builder::{BuildError, Builder};
pub use check::{Finding, Report};
pub use composition::{
    Accumulation, Composition, CompositionBuilder, CompositionError, Exploration, ExplorationError,
    Failure, Halt, Policy, ReplayError, Settings, Simulation, SimulationError,
};
pub use coordinates::{Coordinate, Coordinates, Vector};
pub use coverage::{Coverage, CoverageError};
pub use edge::{Arrow, Departure, Edge, Trigger, from, from_any};
pub use executor::{
    Ending, Executor, InvalidLimit, LastJump, Limit, Observer, Reason, Round, Sliding, System,
};
pub use flow::{Flow, InvalidMatrix, Rate};
pub use located::{Current, DataOf, Holds, Place, Transfer};
pub use moment::Moment;
pub use named::{Name, Record, RepeatedName};
pub use observed::Observed;
pub use reset::{Assignment, NewValue, Reset};
pub use sliding::Filippov;
pub use sweep::sweep;
pub use time::HybridTime;

pub use trace::{Participants, Trace, TraceEntry};
pub use trajectory::{Doubt, NoValue, Trajectory, Why};
pub use zeno::Zeno;

/// What signatures name: matrices of linear flows and vectors as states, the
/// [graph](Automaton::graph) of an automaton.
pub use {nalgebra, petgraph};

// For the macros.
#[doc(hidden)]
pub use {pleach_discrete as discrete, pleach_guards as guards};
