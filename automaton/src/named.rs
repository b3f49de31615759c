//! Models made from data: locations, events and coordinates whose names are known at run time.
//!
//! [`Name`] stands for a location or an event, [`Record`] for a state; the builder is the same as
//! for enums and structs. Which locations and events there are, the model says by mentioning them.
//!
//! ```
//! use pleach_automaton::{Automaton, Name, Record, from};
//!
//! let ball = Record::new([("h", 10.0), ("v", 0.0)])?;
//! let [height, velocity] = ball.coordinates().try_into().expect("two names");
//! let (falling, bounce) = (Name::new("falling"), Name::new("bounce"));
//!
//! let ball = Automaton::<Name, Name, Record>::starting_in(falling)
//!     .initially(ball)
//!     .flow(falling, [height.rate(&velocity), velocity.rate(-10.0)])
//!     .transition(
//!         from(falling).on(bounce).to(falling)
//!             .must(height.at_most(0.0) & velocity.less_than(0.0))
//!             .then(velocity.becomes(-0.5 * &velocity)),
//!     )
//!     .build()?;
//! let trajectory = ball.run(2.0)?;
//! assert!((trajectory.jumps()[0].at.t - 2f64.sqrt()).abs() < 1e-12);
//! assert_eq!(trajectory.location(0, 1.0), Some("falling"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::collections::BTreeSet;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;
use thiserror::Error;

use crate::coordinates::{Coordinate, Coordinates};

/// A location or an event that is known by its name alone.
///
/// Two of the same name are the same. Every name that ever occurs is kept as long as the program
/// runs, once.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Name(&'static str);

impl Name {
    /// The location or event called `name`.
    pub fn new(name: &str) -> Self {
        Name(kept(name))
    }

    /// The name.
    pub fn as_str(self) -> &'static str {
        self.0
    }
}

/// The one copy of `name` that stays.
pub(crate) fn kept(name: &str) -> &'static str {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    // A set of names stays whole, whatever happens to the holder of the lock.
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.get(name) {
        return known;
    }
    let new: &'static str = Box::leak(name.into());
    names.insert(new);
    new
}

impl fmt::Debug for Name {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Name({:?})", self.0)
    }
}

impl fmt::Display for Name {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.0)
    }
}

impl Location for Name {
    const ALL: &'static [Self] = &[];
    const IS_OPEN: bool = true;

    fn name(self) -> &'static str {
        self.0
    }
}

impl Event for Name {
    const ALL: &'static [Self] = &[];
    const IS_OPEN: bool = true;

    fn name(self) -> &'static str {
        self.0
    }
}

/// A state whose coordinates have names that are known at run time.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    names: Arc<[&'static str]>,
    values: Vec<f64>,
}

/// Two coordinates of a [`Record`] have one name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("two coordinates are called `{name}`: rename one")]
pub struct RepeatedName {
    /// The name.
    pub name: String,
}

impl Record {
    /// The state with these coordinates, as pairs of name and value.
    ///
    /// # Errors
    ///
    /// [`RepeatedName`] if two names are the same.
    pub fn new<N: AsRef<str>>(
        coordinates: impl IntoIterator<Item = (N, f64)>,
    ) -> Result<Self, RepeatedName> {
        let (mut names, mut values) = (Vec::new(), Vec::new());
        for (name, value) in coordinates {
            let name = kept(name.as_ref());
            if names.contains(&name) {
                return Err(RepeatedName { name: name.to_owned() });
            }
            names.push(name);
            values.push(value);
        }
        Ok(Record { names: names.into(), values })
    }

    /// The coordinates as variables for formulas, in their order.
    pub fn coordinates(&self) -> Vec<Coordinate<Record>> {
        self.names.iter().map(|name| Coordinate::new(name)).collect()
    }

    /// The coordinate called `name`, if there is one.
    pub fn coordinate(&self, name: &str) -> Option<Coordinate<Record>> {
        self.names.iter().find(|known| **known == name).map(|known| Coordinate::new(known))
    }

    /// The values in the order of the names.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

impl Valuation for Record {
    fn value(&self, variable: &str) -> Option<f64> {
        let place = self.names.iter().position(|name| *name == variable)?;
        self.values.get(place).copied()
    }
}

impl Coordinates for Record {
    /// None in the type; each record has its own.
    const NAMES: &'static [&'static str] = &[];

    /// A record without names: only [`like`](Coordinates::like) knows them.
    fn from_values(_values: &[f64]) -> Self {
        Record { names: Arc::new([]), values: Vec::new() }
    }

    fn names(&self) -> &[&'static str] {
        &self.names
    }

    fn like(&self, values: &[f64]) -> Self {
        Record { names: self.names.clone(), values: values.to_vec() }
    }

    fn write(&self, values: &mut [f64]) {
        for (place, value) in values.iter_mut().zip(&self.values) {
            *place = *value;
        }
    }
}
