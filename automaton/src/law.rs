//! Laws: what a location commands, as a table.
//!
//! A flow says how the state changes while time passes. In a sampled system part of it is chosen
//! anew at each sample: a set point, a command to an actuator. [`Laws`] say for each location what
//! is chosen, case by case in order, each case under a guard; the first whose guard holds gives the
//! value. [`Builder::commanding`](crate::Builder::commanding) attaches them to an automaton, so
//! that drawings and tables show them.
//!
//! ```
//! use pleach_automaton::law::Laws;
//! use pleach_automaton::{Automaton, Reset, observed};
//! use pleach_discrete::{Row, TransitionTable, Urgency, vocabulary};
//! use pleach_guards::{always, proposition, variable};
//!
//! vocabulary! {
//!     enum Room: Location { Empty = "empty", Used = "used" }
//!     enum Seen: Event { Entered = "entered" }
//! }
//! struct Thermostat { people: u32, is_night: bool }
//! observed! {
//!     impl Observed for Thermostat as thermostat;
//!     const GLOSSARY;
//!     quantities {
//!         /// How many people are in the room.
//!         people: thermostat.people.into(),
//!     }
//!     propositions {
//!         /// It is between ten in the evening and six in the morning.
//!         night: thermostat.is_night,
//!     }
//! }
//!
//! let laws = Laws::of("θ")
//!     .case(Room::Empty, always(), "15 °C", |_: &Thermostat| Some(15.0))
//!     .case(Room::Used, proposition("night"), "18 °C", |_| Some(18.0))
//!     .case(Room::Used, always(), "21 °C", |_| Some(21.0));
//! let now = Thermostat { people: 3, is_night: false };
//! assert_eq!(laws.value(Room::Used, &now)?, Some(21.0));
//!
//! let table = TransitionTable::new(&[Row {
//!     source: Room::Empty, event: Seen::Entered, target: Room::Used,
//!     urgency: Urgency::AtOnce, priority: 0,
//! }]);
//! let room = Automaton::builder(table, Room::Empty)
//!     .observing()
//!     .commanding(&laws)
//!     .on(Seen::Entered, variable("people").at_least(1.0), Reset::new("", |_| ()))
//!     .build()?;
//! let shown = &room.mode(Room::Used).expect("a location of the table").commands;
//! assert_eq!(shown[0].to_string(), "θ := 18 °C where night");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::fmt;

use pleach_discrete::Location;
use pleach_guards::Predicate;

use crate::automaton::TransitionError;
use crate::observed::{self, Observed, Watch};

/// What the locations `L` of a component with state `S` command: values of type `T`.
#[derive(Clone, Debug)]
pub struct Laws<L, S, T> {
    commanded: String,
    cases: Vec<Case<L, S, T>>,
}

#[derive(Debug)]
struct Case<L, S, T> {
    location: L,
    command: Command,
    watch: Option<Watch<S>>,
    value: fn(&S) -> Option<T>,
}

/// One case of a law, in words: what is commanded, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Command {
    /// What is chosen, such as `ψ`.
    pub commanded: String,
    /// Under which name.
    pub name: String,
    /// Where this case applies, unless one before it does.
    pub guard: Predicate,
}

impl fmt::Display for Command {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} := {}", self.commanded, self.name)?;
        if self.guard == pleach_guards::always() {
            return Ok(());
        }
        write!(formatter, " where {}", self.guard)
    }
}

impl<L: Location, S: Observed, T> Laws<L, S, T> {
    /// No law yet for what is called `commanded`.
    pub fn of(commanded: &str) -> Self {
        Laws { commanded: commanded.to_owned(), cases: Vec::new() }
    }

    /// One more case in `location`: where `guard` holds, and no case of this location before it
    /// applies, `value` is chosen, called `name`. A case that finds nothing to choose does not apply.
    #[must_use]
    pub fn case(
        mut self,
        location: L,
        guard: Predicate,
        name: &str,
        value: fn(&S) -> Option<T>,
    ) -> Self {
        let watch = Watch::of(&guard);
        let command = Command { commanded: self.commanded.clone(), name: name.to_owned(), guard };
        self.cases.push(Case { location, command, watch, value });
        self
    }

    /// What `state` commands in `location`, if a case applies.
    ///
    /// # Errors
    ///
    /// [`TransitionError`] for the first guard before that case that has no value.
    pub fn value(&self, location: L, state: &S) -> Result<Option<T>, TransitionError> {
        for case in self.cases.iter().filter(|case| case.location == location) {
            if case.holds(state)?
                && let Some(value) = (case.value)(state)
            {
                return Ok(Some(value));
            }
        }
        Ok(None)
    }

    /// The cases with their locations, in their order.
    pub fn commands(&self) -> impl Iterator<Item = (L, &Command)> {
        self.cases.iter().map(|case| (case.location, &case.command))
    }
}

impl<L: Location, S: Observed, T> Case<L, S, T> {
    fn holds(&self, state: &S) -> Result<bool, TransitionError> {
        let Command { commanded, name, guard } = &self.command;
        observed::holds(guard, self.watch.as_ref(), state).map_err(|source| TransitionError {
            location: self.location.name(),
            event: "sample",
            part: format!("guard of the law `{commanded} := {name}`"),
            source,
        })
    }
}

// Written by hand, because a derive would ask the same of S and T.

impl<L: Clone, S, T> Clone for Case<L, S, T> {
    fn clone(&self) -> Self {
        Case {
            location: self.location.clone(),
            command: self.command.clone(),
            watch: self.watch.clone(),
            value: self.value,
        }
    }
}
