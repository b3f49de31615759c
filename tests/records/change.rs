//! A change of a record, and the record that it changes.

use missions::{Mission, Period};
use pleach::automaton::network::record::{End, MissionEvent, Snapshot};

/// What a trace holds after its header.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    pub periods: Vec<Period>,
    pub end: End,
}

/// A change that begins at a control period.
#[derive(Clone, Copy)]
pub struct Change {
    pub name: &'static str,
    pub make: fn(&mut Record, usize),
}

impl Record {
    pub fn of(mission: &Mission) -> Self {
        Record { periods: mission.periods.clone(), end: mission.end.clone() }
    }

    pub fn at(&mut self, site: usize) -> &mut Snapshot {
        &mut self.periods[site].snapshot
    }

    pub fn events(&mut self, site: usize) -> &mut Vec<MissionEvent> {
        &mut self.periods[site].events
    }

    /// Every snapshot from `site` on.
    pub fn from(&mut self, site: usize) -> impl Iterator<Item = &mut Snapshot> {
        self.periods[site..].iter_mut().map(|period| &mut period.snapshot)
    }
}

/// A list of changes, each with its name.
macro_rules! changes {
    ($($name:literal => |$record:pat_param, $site:pat_param| $make:expr;)+) => {
        &[$(Change {
            name: $name,
            make: |$record, $site| {
                $make;
            },
        }),+]
    };
}

pub(super) use changes;
