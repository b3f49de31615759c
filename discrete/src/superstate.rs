//! Superstates: several locations under one name, and what leaves all of them.

use crate::table::Row;
use crate::urgency::Urgency;

/// Several locations under one name, as in statecharts (Harel 1987,
/// [doi:10.1016/0167-6423(87)90035-9](https://doi.org/10.1016/0167-6423(87)90035-9)): a transition from a superstate
/// leaves each of them.
///
/// ```
/// use pleach_discrete::{Superstate, TransitionTable, from, from_any, transitions, vocabulary};
///
/// vocabulary! {
///     enum Pump: Location { Off = "off", Filling = "filling", Draining = "draining" }
///     enum Command: Event { Fill = "fill", Turn = "turn", Stop = "stop" }
/// }
/// use {Command::{Fill, Stop, Turn}, Pump::{Draining, Filling, Off}};
///
/// const RUNNING: Superstate<Pump> = Superstate::new("running", &[Filling, Draining]);
/// const PUMP: TransitionTable<Pump, Command> = transitions![Pump, Command;
///     from(Off).on(Fill).to(Filling),
///     from(Filling).on(Turn).to(Draining),
///     from_any(RUNNING).on(Stop).to(Off),
/// ];
///
/// assert_eq!(PUMP.rows().len(), 4);
/// assert_eq!((PUMP.next(Filling, Stop), PUMP.next(Draining, Stop)), (Ok(Off), Ok(Off)));
/// assert!(PUMP.superstates().eq([RUNNING]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Superstate<L: 'static> {
    name: &'static str,
    members: &'static [L],
}

/// Where transitions begin: in a location, or in any of a superstate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source<L: 'static> {
    /// In this location.
    Location(L),
    /// In any location of this superstate.
    Superstate(Superstate<L>),
}

/// Transitions as one declares them: a [`Row`] for each location in which they begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule<L: 'static, E> {
    source: Source<L>,
    event: E,
    /// The location that is entered; none: the location stays the same.
    target: Option<L>,
    urgency: Urgency,
    priority: u8,
}

impl<L> Superstate<L> {
    /// These locations under this name. An automaton requires that the name is no location's or other superstate's, that
    /// there are locations, each once, and that of two superstates which share locations one contains the other.
    pub const fn new(name: &'static str, members: &'static [L]) -> Self {
        Superstate { name, members }
    }

    /// The name in tables and diagrams.
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// The locations.
    pub const fn members(&self) -> &'static [L] {
        self.members
    }
}

impl<L> Source<L> {
    /// The locations.
    pub const fn locations(&self) -> &[L] {
        match self {
            Source::Location(location) => std::slice::from_ref(location),
            Source::Superstate(superstate) => superstate.members,
        }
    }
}

/// A rule that says where it begins.
#[must_use = "say on which event"]
#[derive(Clone, Copy, Debug)]
pub struct Departure<L: 'static>(Source<L>);

/// A rule that says where it begins and on which event.
#[must_use = "say where it leads"]
#[derive(Clone, Copy, Debug)]
pub struct Trigger<L: 'static, E>(Source<L>, E);

/// Begins a rule that leaves one location.
pub const fn from<L>(location: L) -> Departure<L> {
    Departure(Source::Location(location))
}

/// Begins a rule that leaves each location of a superstate.
pub const fn from_any<L>(superstate: Superstate<L>) -> Departure<L> {
    Departure(Source::Superstate(superstate))
}

impl<L: Copy, E: Copy> Rule<L, E> {
    /// Whether it has to be taken when its guard holds; at once by default.
    #[must_use]
    pub const fn urgency(self, urgency: Urgency) -> Self {
        Rule { urgency, ..self }
    }

    /// Which of several transitions that are possible at once goes first: 0, the default, before 1, and so on.
    #[must_use]
    pub const fn priority(self, priority: u8) -> Self {
        Rule { priority, ..self }
    }

    /// The rule of one row.
    pub const fn of(row: Row<L, E>) -> Self {
        let Row { source, event, target, urgency, priority } = row;
        from(source).on(event).to(target).urgency(urgency).priority(priority)
    }

    /// Its rows, in the order of the locations.
    pub fn rows(&self) -> impl Iterator<Item = Row<L, E>> {
        self.source.locations().iter().map(|&location| self.row(location))
    }

    /// Where it begins.
    pub const fn source(&self) -> &Source<L> {
        &self.source
    }

    /// The row from this location.
    const fn row(&self, source: L) -> Row<L, E> {
        let Rule { event, urgency, priority, .. } = *self;
        let target = match self.target {
            Some(target) => target,
            None => source,
        };
        Row { source, event, target, urgency, priority }
    }
}

impl<L: Copy> Departure<L> {
    /// On this event.
    pub const fn on<E: Copy>(self, event: E) -> Trigger<L, E> {
        Trigger(self.0, event)
    }
}

impl<L: Copy, E: Copy> Trigger<L, E> {
    /// To this location.
    pub const fn to(self, location: L) -> Rule<L, E> {
        self.leading(Some(location))
    }

    /// To the location in which it is taken.
    pub const fn stay(self) -> Rule<L, E> {
        self.leading(None)
    }

    const fn leading(self, target: Option<L>) -> Rule<L, E> {
        Rule { source: self.0, event: self.1, target, urgency: Urgency::AtOnce, priority: 0 }
    }
}

/// How many rows these rules stand for.
pub const fn rows_of<L: Copy, E: Copy>(rules: &[Rule<L, E>]) -> usize {
    let (mut count, mut at) = (0, 0);
    while at < rules.len() {
        count += rules[at].source.locations().len();
        at += 1;
    }
    count
}

/// The rows of these rules, of which there are `N` as [`rows_of`] counts them, in the order of the rules and of the
/// locations of each.
///
/// # Panics
/// Where no rule has a location, or `N` is another number: in a constant that does not compile.
pub const fn expanded<L: Copy, E: Copy, const N: usize>(rules: &[Rule<L, E>]) -> [Row<L, E>; N] {
    assert!(rows_of(rules) == N, "there is another number of rows");
    assert!(N > 0, "no rule has a location");
    let (mut first, mut rule) = (0, 0);
    while rules[first].source.locations().is_empty() {
        first += 1;
    }
    let mut rows = [rules[first].row(rules[first].source.locations()[0]); N];
    let mut count = 0;
    while rule < rules.len() {
        let (sources, mut at) = (rules[rule].source.locations(), 0);
        while at < sources.len() {
            rows[count] = rules[rule].row(sources[at]);
            (count, at) = (count + 1, at + 1);
        }
        rule += 1;
    }
    rows
}

/// A constant [`TransitionTable`](crate::TransitionTable) of [rules](crate::Rule): after the types of its locations and
/// events and a semicolon, one rule after another. Rules begin with [`from`](crate::from) and
/// [`from_any`](crate::from_any) of this package; those of `pleach_automaton` make transitions with guards.
#[macro_export]
macro_rules! transitions {
    ($location:ty, $event:ty; $($rule:expr),+ $(,)?) => {{
        const RULES: &[$crate::Rule<$location, $event>] = &[$($rule),+];
        const ROWS: [$crate::Row<$location, $event>; $crate::superstate::rows_of(RULES)] =
            $crate::superstate::expanded(RULES);
        $crate::TransitionTable::of_rules(RULES, &ROWS)
    }};
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{TransitionTable, vocabulary};

    vocabulary! {
        enum Place: Location { Out, In, Above }
        enum Sound: Event { Bell, Whistle, Silence }
    }
    use Place::{Above, In, Out};
    use Sound::{Bell, Silence, Whistle};

    const INSIDE: Superstate<Place> = Superstate::new("inside", &[In, Above]);
    const ANYWHERE: Superstate<Place> = Superstate::new("anywhere", Place::ALL_PLACES);
    const TABLE: TransitionTable<Place, Sound> = transitions![Place, Sound;
        from(Out).on(Bell).to(In),
        from_any(INSIDE).on(Whistle).to(Out).priority(2).urgency(Urgency::May),
        from_any(ANYWHERE).on(Silence).stay(),
    ];

    impl Place {
        const ALL_PLACES: &'static [Place] = &[Out, In, Above];
    }

    #[test]
    fn a_rule_of_a_superstate_leaves_each_of_its_locations() {
        let row = |source, event, target, urgency, priority| Row {
            source,
            event,
            target,
            urgency,
            priority,
        };
        let silence = |place| row(place, Silence, place, Urgency::AtOnce, 0);
        let rows = [
            row(Out, Bell, In, Urgency::AtOnce, 0),
            row(In, Whistle, Out, Urgency::May, 2),
            row(Above, Whistle, Out, Urgency::May, 2),
            silence(Out),
            silence(In),
            silence(Above),
        ];
        assert_eq!(TABLE.rows(), rows);
        assert!(TABLE.superstates().eq([INSIDE, ANYWHERE]));
    }

    #[test]
    fn a_superstate_is_listed_once() {
        const NOWHERE: Superstate<Place> = Superstate::new("nowhere", &[]);
        const TWICE: TransitionTable<Place, Sound> = transitions![Place, Sound;
            from_any(NOWHERE).on(Silence).to(Out),
            from_any(INSIDE).on(Bell).to(Out),
            from_any(INSIDE).on(Whistle).to(Out),
        ];
        assert!(TWICE.superstates().eq([NOWHERE, INSIDE]));
        assert_eq!(TWICE.rows().len(), 4);
    }
}
