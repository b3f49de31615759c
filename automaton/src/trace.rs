//! What remains of a run: its discrete projection, the trace.

use crate::executor::{Observer, System};
use crate::time::HybridTime;

/// The jumps of a run in the order in which they were taken.
///
/// A trace is an [`Observer`]: handed to the executor, it records the run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace<J> {
    entries: Vec<TraceEntry<J>>,
}

/// One jump of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TraceEntry<J> {
    /// When: the jump leads from (t, j) to (t, j + 1).
    pub at: HybridTime,
    /// The components that jump.
    pub by: Participants,
    /// What is done.
    pub jump: J,
}

/// Which components of a system take part in a jump.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Participants {
    /// One component by itself.
    One(usize),
    /// These components together, as one jump, in ascending order.
    Some(Box<[usize]>),
    /// All components together, as one jump.
    All,
}

impl<J> Trace<J> {
    /// The trace in which nothing has happened.
    pub const fn new() -> Self {
        Trace { entries: Vec::new() }
    }

    /// The jumps in their order.
    pub fn entries(&self) -> &[TraceEntry<J>] {
        &self.entries
    }

    /// The jumps that `component` takes part in, those of all components among them.
    pub fn of(&self, component: usize) -> impl Iterator<Item = &TraceEntry<J>> {
        self.entries.iter().filter(move |entry| entry.by.include(component))
    }
}

impl Participants {
    /// Whether `component` takes part.
    pub fn include(&self, component: usize) -> bool {
        match self {
            Participants::One(one) => *one == component,
            Participants::Some(some) => some.contains(&component),
            Participants::All => true,
        }
    }
}

impl<J> Default for Trace<J> {
    fn default() -> Self {
        Trace::new()
    }
}

impl<S: System> Observer<S> for Trace<S::Jump> {
    fn jumped(&mut self, entry: TraceEntry<S::Jump>) {
        self.entries.push(entry);
    }
}
