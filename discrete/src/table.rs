//! The transition table: the single source of the discrete behaviour.

use std::error::Error;
use std::fmt::{self, Write};

use crate::location::{Event, Location};
use crate::superstate::{Rule, Source, Superstate};
use crate::urgency::Urgency;

/// One transition: on `event`, from `source` to `target`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row<L, E> {
    /// The location that the transition leaves.
    pub source: L,
    /// The event on which it is taken.
    pub event: E,
    /// The location that it enters.
    pub target: L,
    /// Whether it has to be taken when its guard holds.
    pub urgency: Urgency,
    /// Which of several transitions that are possible at once goes first: 0 before 1, and so on.
    pub priority: u8,
}

/// All transitions of one automaton, in the order of their declaration.
///
/// A table only refers to its rows, so that it can be a constant. Wherever several rows could be
/// meant, the one of the smallest priority number comes first, and of those the one declared
/// first: a total order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransitionTable<'a, L: 'static, E> {
    /// Those that the rows are written out of, if it is declared so.
    rules: &'a [Rule<L, E>],
    rows: &'a [Row<L, E>],
}

impl<'a, L: 'static, E> TransitionTable<'a, L, E> {
    /// The table of these rows.
    pub const fn new(rows: &'a [Row<L, E>]) -> Self {
        TransitionTable { rules: &[], rows }
    }

    /// The table of these rules, which the rows are written out of; see [`transitions!`](crate::transitions!).
    pub const fn of_rules(rules: &'a [Rule<L, E>], rows: &'a [Row<L, E>]) -> Self {
        TransitionTable { rules, rows }
    }

    /// The rows in the order of their declaration.
    pub const fn rows(&self) -> &'a [Row<L, E>] {
        self.rows
    }
}

impl<'a, L: Location, E: Event> TransitionTable<'a, L, E> {
    /// The superstates that rules leave, each once.
    pub fn superstates(&self) -> impl Iterator<Item = Superstate<L>> + use<L, E> {
        let superstates = self.rules.iter().filter_map(|rule| match *rule.source() {
            Source::Superstate(superstate) => Some(superstate),
            Source::Location(_) => None,
        });
        first_mentions(superstates).into_iter()
    }

    /// Where `event` leads from `location`.
    ///
    /// # Errors
    ///
    /// [`InvalidTransition`] if no row says so.
    pub fn next(&self, location: L, event: E) -> Result<L, InvalidTransition<L, E>> {
        let mut first: Option<(u8, L)> = None;
        for row in self.rows {
            let comes_first = first.is_none_or(|(priority, _)| row.priority < priority);
            if row.source == location && row.event == event && comes_first {
                first = Some((row.priority, row.target));
            }
        }
        first.map(|(_, target)| target).ok_or(InvalidTransition { location, event })
    }

    /// The rows that leave `location`, in their total order. Nothing is allocated.
    pub fn enabled(&self, location: L) -> impl Iterator<Item = &'a Row<L, E>> + use<'a, L, E> {
        let rows = self.rows;
        let mut last = None;
        std::iter::from_fn(move || {
            let (rank, row) = rows
                .iter()
                .enumerate()
                .filter(|(_, row)| row.source == location)
                .map(|(position, row)| ((row.priority, position), row))
                .filter(|(rank, _)| last.is_none_or(|last| *rank > last))
                .min_by_key(|(rank, _)| *rank)?;
            last = Some(rank);
            Some(row)
        })
    }

    /// Whether every location has at most one row for every event.
    pub fn is_deterministic(&self) -> bool {
        self.conflict().is_none()
    }

    /// The first row that repeats the source and the event of an earlier one.
    pub fn conflict(&self) -> Option<&'a Row<L, E>> {
        let repeats = |position: usize, row: &Row<L, E>| {
            self.rows[..position]
                .iter()
                .any(|earlier| earlier.source == row.source && earlier.event == row.event)
        };
        self.rows
            .iter()
            .enumerate()
            .find(|(position, row)| repeats(*position, row))
            .map(|(_, row)| row)
    }

    /// The locations that no sequence of events reaches from `initial`, in the order of
    /// [`Location::ALL`].
    pub fn unreachable_from(&self, initial: L) -> Vec<L> {
        let mut reached = vec![false; L::ALL.len()];
        self.mark_reachable(initial, &mut reached);
        let marked = L::ALL.iter().zip(reached);
        marked.filter(|(_, is_reached)| !is_reached).map(|(&location, _)| location).collect()
    }

    /// Marks the locations that some sequence of events reaches from `initial`: `reached` has one
    /// place for each of [`Location::ALL`], in that order. Nothing is allocated.
    ///
    /// The rows are swept until nothing changes: at most once for each location.
    pub fn mark_reachable(&self, initial: L, reached: &mut [bool]) {
        for (mark, &location) in reached.iter_mut().zip(L::ALL) {
            *mark = location == initial;
        }
        let place = |location| L::ALL.iter().position(|&other| other == location);
        for _ in L::ALL {
            let mut changed = false;
            for row in self.rows {
                let is_left = place(row.source).is_some_and(|at| reached.get(at) == Some(&true));
                if let Some(mark) = place(row.target).and_then(|at| reached.get_mut(at))
                    && is_left
                    && !*mark
                {
                    *mark = true;
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }

    /// The full location × event table in Markdown: a cell names the location entered, or shows a
    /// dash where the event is refused. Of names that are known at run time, it has those in rows.
    pub fn to_markdown(&self) -> String {
        let places = self.rows.iter().flat_map(|row| [row.source, row.target]);
        let locations = if L::IS_OPEN { first_mentions(places) } else { L::ALL.to_vec() };
        let taken = self.rows.iter().map(|row| row.event);
        let events = if E::IS_OPEN { first_mentions(taken) } else { E::ALL.to_vec() };
        let mut text = String::from("| location |");
        for event in &events {
            // Writing into a string cannot fail, here and below.
            let _ = write!(text, " {} |", cell(event.name()));
        }
        text.push_str("\n| --- |");
        text.push_str(&" --- |".repeat(events.len()));
        for &location in &locations {
            let _ = write!(text, "\n| **{}** |", cell(location.name()));
            for &event in &events {
                let target = self.next(location, event).map_or("—", Location::name);
                let _ = write!(text, " {} |", cell(target));
            }
        }
        text.push('\n');
        text
    }
}

/// Each value once, in the order in which they occur first.
pub fn first_mentions<T: PartialEq>(mentioned: impl Iterator<Item = T>) -> Vec<T> {
    let mut new = Vec::new();
    for one in mentioned {
        if !new.contains(&one) {
            new.push(one);
        }
    }
    new
}

/// A bar would end the cell.
fn cell(text: &str) -> String {
    text.replace('|', r"\|")
}

/// A location was offered an event that it has no transition for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InvalidTransition<L, E> {
    /// The location that refused.
    pub location: L,
    /// The event that it refused.
    pub event: E,
}

impl<L: Location, E: Event> fmt::Display for InvalidTransition<L, E> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (location, event) = (self.location.name(), self.event.name());
        write!(formatter, "no transition leaves location `{location}` on event `{event}`")
    }
}

impl<L: Location, E: Event> Error for InvalidTransition<L, E> {}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    enum Door {
        Open,
        Closed,
        Locked,
        Removed,
    }

    impl Location for Door {
        const ALL: &'static [Self] = &[Door::Open, Door::Closed, Door::Locked, Door::Removed];

        fn name(self) -> &'static str {
            match self {
                Door::Open => "open",
                Door::Closed => "closed",
                Door::Locked => "locked",
                Door::Removed => "removed",
            }
        }
    }

    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    enum Hand {
        Push,
        Pull,
        Turn,
    }

    impl Event for Hand {
        const ALL: &'static [Self] = &[Hand::Push, Hand::Pull, Hand::Turn];

        fn name(self) -> &'static str {
            match self {
                Hand::Push => "push",
                Hand::Pull => "pull",
                Hand::Turn => "turn|key",
            }
        }
    }

    const fn row(source: Door, event: Hand, target: Door, priority: u8) -> Row<Door, Hand> {
        Row { source, event, target, urgency: Urgency::May, priority }
    }

    const DOOR: TransitionTable<Door, Hand> = TransitionTable::new(&[
        row(Door::Open, Hand::Push, Door::Closed, 0),
        row(Door::Closed, Hand::Turn, Door::Locked, 1),
        row(Door::Closed, Hand::Push, Door::Closed, 1),
        row(Door::Closed, Hand::Pull, Door::Open, 0),
        row(Door::Locked, Hand::Turn, Door::Closed, 0),
    ]);

    /// A place or an event that is known at run time.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    struct Named(&'static str);

    impl Location for Named {
        const ALL: &'static [Self] = &[];
        const IS_OPEN: bool = true;

        fn name(self) -> &'static str {
            self.0
        }
    }

    impl Event for Named {
        const ALL: &'static [Self] = &[];
        const IS_OPEN: bool = true;

        fn name(self) -> &'static str {
            self.0
        }
    }

    #[test]
    fn tables_of_names_show_those_in_the_rows() {
        let row = |[source, event, target]: [&'static str; 3]| Row {
            source: Named(source),
            event: Named(event),
            target: Named(target),
            urgency: Urgency::May,
            priority: 0,
        };
        let rows = [["in", "go", "out"], ["out", "come", "in"], ["out", "stay", "out"]].map(row);
        let expected = "| location | go | come | stay |\n\
                        | --- | --- | --- | --- |\n\
                        | **in** | out | — | — |\n\
                        | **out** | — | in | out |\n";
        assert_eq!(TransitionTable::new(&rows).to_markdown(), expected);
    }

    #[test]
    fn events_lead_where_the_rows_say_and_nowhere_else() {
        for &location in Door::ALL {
            for &event in Hand::ALL {
                let row =
                    DOOR.rows().iter().find(|row| row.source == location && row.event == event);
                let refusal = InvalidTransition { location, event };
                assert_eq!(DOOR.next(location, event), row.map(|row| row.target).ok_or(refusal));
            }
        }
    }

    #[test]
    fn a_refusal_names_location_and_event() {
        let refusal = InvalidTransition { location: Door::Open, event: Hand::Pull };
        let text = "no transition leaves location `open` on event `pull`";
        assert_eq!(refusal.to_string(), text);
    }

    #[test]
    fn rows_come_by_priority_and_then_by_declaration() {
        let events = DOOR.enabled(Door::Closed).map(|row| row.event);
        assert!(events.eq([Hand::Pull, Hand::Turn, Hand::Push]));
        assert_eq!(DOOR.enabled(Door::Removed).count(), 0);
    }

    #[test]
    fn conflicts_are_found_and_priority_settles_them() {
        assert!(DOOR.is_deterministic());
        const TWICE: TransitionTable<Door, Hand> = TransitionTable::new(&[
            row(Door::Open, Hand::Push, Door::Closed, 1),
            row(Door::Open, Hand::Push, Door::Removed, 0),
            row(Door::Open, Hand::Push, Door::Locked, 0),
        ]);
        assert!(!TWICE.is_deterministic());
        assert_eq!(TWICE.conflict(), Some(&TWICE.rows()[1]));
        assert_eq!(TWICE.next(Door::Open, Hand::Push), Ok(Door::Removed));
    }

    #[test]
    fn what_no_event_reaches_is_listed() {
        assert_eq!(DOOR.unreachable_from(Door::Locked), [Door::Removed]);
        let others = [Door::Open, Door::Closed, Door::Locked];
        assert_eq!(DOOR.unreachable_from(Door::Removed), others);
    }

    #[test]
    fn the_markdown_table_is_complete() {
        let expected = "\
| location | push | pull | turn\\|key |
| --- | --- | --- | --- |
| **open** | closed | — | — |
| **closed** | closed | open | locked |
| **locked** | — | — | closed |
| **removed** | — | — | — |
";
        assert_eq!(DOOR.to_markdown(), expected);
    }
}
