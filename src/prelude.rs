//! Everything that a model usually needs: `use pleach::prelude::*;`.

pub use crate::MainError;
pub use pleach_automaton::composition::Channel;
pub use pleach_automaton::composition::stream::CsvLog;
pub use pleach_automaton::{
    Automaton, BuildError, Composition, CompositionError, Coordinates, Flow, Policy, Reason, Reset,
    Settings, Trajectory, coordinates, diagram, from, from_any,
};
pub use pleach_discrete::{Event, Location, Superstate, Urgency, vocabulary};
pub use pleach_guards::{
    Expression, Guard, Predicate, Table, Valuation, always, constant, never, norm, not, variable,
};
