//! The parts of an automaton without their types.

use std::ops::RangeInclusive;
use std::sync::Arc;

use pleach_discrete::Row;
use pleach_guards::{Guard, Predicate};

use crate::composition::Sampling;
use crate::flow::Rate;
use crate::law::Command;
use crate::reset::Assignment;
use crate::signals::Signal;

/// Locations, events, flows and resets are numbers here; the builder has what they stand for.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub(super) initial: usize,
    pub(super) rows: Vec<Row<usize, usize>>,
    /// By name the locations that drawings show together.
    pub(super) superstates: Vec<(&'static str, Vec<usize>)>,
    /// For all rows of an event.
    pub(super) conditions: Vec<(usize, Given)>,
    /// For the rows with these numbers.
    pub(super) edges: Vec<(usize, Given)>,
    /// For the rows from a location on an event to a location.
    pub(super) transfers: Vec<([usize; 3], Given)>,
    /// By location. The number of a flow is its place here; without rates it is a function.
    pub(super) flows: Vec<(usize, Option<Arc<[Rate]>>)>,
    pub(super) invariants: Vec<(usize, Predicate)>,
    /// What is chosen at samples.
    pub(super) commands: Vec<(usize, Command)>,
    /// What changes alike in all locations.
    pub(super) throughout: Vec<Rate>,
    pub(super) ranges: Vec<(String, RangeInclusive<f64>)>,
    /// Names that stand for numbers, with these.
    pub(super) parameters: Vec<(String, f64)>,
    /// Names that stand for formulas, with these.
    pub(super) signals: Vec<Signal>,
    /// The events that are taken at samples.
    pub(super) samplings: Vec<(usize, Sampling)>,
    /// The names of all variables, where the type of the state has them.
    pub(super) known: Option<Vec<&'static str>>,
    /// The names of all variables and propositions, where the state is not its coordinates.
    pub(super) observed: Option<Names>,
}

/// When rows may be taken, and what they do.
#[derive(Clone, Debug)]
pub(super) struct Given {
    pub(super) guard: Guard,
    /// Those of the reset; none if it is a function.
    pub(super) assignments: Arc<[Assignment]>,
    /// The number of the reset.
    pub(super) reset: usize,
}

/// The names of variables and of propositions.
pub(super) type Names = (&'static [&'static str], &'static [&'static str]);

impl Parts {
    pub(super) fn starting_in(initial: usize) -> Self {
        Parts { initial, ..Parts::default() }
    }

    /// The locations that rows lead from and to.
    pub(super) fn connected(&self) -> impl Iterator<Item = usize> {
        self.rows.iter().flat_map(|row| [row.source, row.target])
    }

    /// The locations that have flows.
    pub(super) fn described(&self) -> impl Iterator<Item = usize> {
        self.flows.iter().map(|(location, _)| *location)
    }

    /// Guard, assignments and reset of each row.
    pub(super) fn given_mut(&mut self) -> impl Iterator<Item = &mut Given> {
        let conditions = self.conditions.iter_mut().map(|(_, given)| given);
        let edges = self.edges.iter_mut().map(|(_, given)| given);
        conditions.chain(edges).chain(self.transfers.iter_mut().map(|(_, given)| given))
    }

    /// The locations that have invariants.
    pub(super) fn restricted(&self) -> impl Iterator<Item = usize> {
        self.invariants.iter().map(|(location, _)| *location)
    }
}
