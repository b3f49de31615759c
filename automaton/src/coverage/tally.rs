//! How often the rows of a table are taken, where no trajectory records it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use pleach_discrete::{Event, Location, Row};
use pleach_guards::Valuation;

use crate::automaton::Automaton;

/// How often each transition of an automaton has been taken, by the number of its row.
///
/// Any number of components may count at once, and the sums do not depend on their order.
#[derive(Clone, Debug)]
pub(crate) struct Tally(Arc<[AtomicU64]>);

impl Tally {
    pub(crate) fn count(&self, row: usize) {
        if let Some(count) = self.0.get(row) {
            count.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl<L: Location, E: Event, S: Valuation> Automaton<L, E, S> {
    /// The same automaton, which from now on counts how often each of its transitions is
    /// [taken](crate::automaton::Step::fire). Its clones count in the same place.
    ///
    /// The coverage of compositions is read off their [trajectories](super::Coverage). Systems that
    /// step their automata themselves leave none, and count instead.
    ///
    /// ```
    /// use pleach_automaton::{Automaton, Reset};
    /// use pleach_discrete::{Row, TransitionTable, Urgency, vocabulary};
    /// use pleach_guards::{Guard, Valuation, variable};
    ///
    /// vocabulary! {
    ///     enum Door: Location { Open = "open", Shut = "shut" }
    ///     enum Hand: Event { Push = "push", Pull = "pull" }
    /// }
    /// struct Force(f64);
    /// # impl Valuation for Force {
    /// #     fn value(&self, variable: &str) -> Option<f64> { (variable == "f").then_some(self.0) }
    /// # }
    /// const fn row(source: Door, event: Hand, target: Door) -> Row<Door, Hand> {
    ///     Row { source, event, target, urgency: Urgency::AtOnce, priority: 0 }
    /// }
    /// const DOOR: TransitionTable<Door, Hand> = TransitionTable::new(&[
    ///     row(Door::Open, Hand::Push, Door::Shut),
    ///     row(Door::Shut, Hand::Pull, Door::Open),
    /// ]);
    ///
    /// let door = Automaton::builder(DOOR, Door::Open)
    ///     .on(Hand::Push, Guard::new("push", variable("f").at_least(1.0)), Reset::identity())
    ///     .on(Hand::Pull, Guard::new("pull", variable("f").at_most(-1.0)), Reset::identity())
    ///     .build()?
    ///     .counted();
    /// door.step(&mut door.initial(), &mut Force(2.0))?;
    /// let counts: Vec<u64> = door.taken().map(|(_, count)| count).collect();
    /// assert_eq!(counts, [1, 0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn counted(mut self) -> Self {
        self.tally = Some(Tally(self.rows.iter().map(|_| AtomicU64::new(0)).collect()));
        self
    }

    /// The rows of the table, each with how often it has been taken since the automaton is
    /// [counted](Self::counted); none before.
    pub fn taken(&self) -> impl Iterator<Item = (Row<L, E>, u64)> {
        let counts = self.tally.iter().flat_map(|tally| tally.0.iter());
        let counts = counts.map(|count| count.load(Ordering::Relaxed));
        self.rows.iter().copied().zip(counts)
    }
}
