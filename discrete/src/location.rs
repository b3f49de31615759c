//! The two vocabularies of a discrete graph.

use std::convert::Infallible;
use std::fmt::Debug;

/// The locations of an automaton, usually an enum without fields.
///
/// The order of the type is a total order that nothing but determinism relies on.
pub trait Location: Copy + Eq + Ord + Debug + 'static {
    /// Every location, each once, in the order in which tables and diagrams show them.
    const ALL: &'static [Self];

    /// Whether there are locations beyond `ALL`, made while the program runs: an automaton has those
    /// then that it mentions.
    const IS_OPEN: bool = false;

    /// The name in traces, tables and diagrams: lower-case words, different for each location.
    fn name(self) -> &'static str;

    /// The place in `ALL`, where it is known without looking: it saves a search.
    #[inline]
    fn place(self) -> Option<usize> {
        None
    }
}

/// The events on which an automaton jumps, usually an enum without fields.
pub trait Event: Copy + Eq + Ord + Debug + 'static {
    /// Every event, each once, in the order in which tables and diagrams show them.
    const ALL: &'static [Self];

    /// Whether there are events beyond `ALL`, made while the program runs: an automaton has those
    /// then that it mentions.
    const IS_OPEN: bool = false;

    /// The name in traces, tables and diagrams: lower-case words, different for each event.
    fn name(self) -> &'static str;
}

/// The events of an automaton that never jumps: there are none.
impl Event for Infallible {
    const ALL: &'static [Self] = &[];

    fn name(self) -> &'static str {
        match self {}
    }
}
