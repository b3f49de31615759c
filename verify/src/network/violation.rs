//! A property that fails: which, where and when.

use std::fmt;

use pleach_automaton::network::record::Snapshot;

use super::property::Property;

/// The first violation of a property, with what a person needs to find it.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// The property that fails.
    pub property: Property,
    /// k: the control period, counted from 0.
    pub step: usize,
    /// The instant in seconds, between two snapshots where the failure lies there.
    pub time: f64,
    /// The robots concerned (in a route or edge, the node that ends it may be an access point).
    pub robots: Vec<usize>,
    /// What was measured, in the unit of the property.
    pub measured: f64,
    /// What it is compared with.
    pub bound: f64,
    /// What is wrong, as a clause without a full stop.
    pub sentence: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{} is violated in step {} at t = {:.3} s: {}",
            self.property, self.step, self.time, self.sentence
        )
    }
}

impl std::error::Error for Violation {}

/// When something was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// k: the control period.
    pub step: usize,
    /// Seconds since the mission began.
    pub time: f64,
}

impl Instant {
    /// The instant of a snapshot.
    pub fn of(snapshot: &Snapshot) -> Self {
        Instant { step: snapshot.step, time: snapshot.time }
    }

    /// The instant at `fraction` ∈ [0, 1] of the period between two snapshots.
    pub fn between(before: &Snapshot, after: &Snapshot, fraction: f64) -> Self {
        let time = before.time + fraction * (after.time - before.time);
        Instant { step: before.step, time }
    }

    /// A violation found now.
    pub fn violation(
        self,
        property: Property,
        robots: &[usize],
        (measured, bound): (f64, f64),
        sentence: String,
    ) -> Violation {
        let Instant { step, time } = self;
        Violation { property, step, time, robots: robots.to_vec(), measured, bound, sentence }
    }
}
