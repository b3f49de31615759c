//! Missions on random floor plans, each run once for all tests.

use crate::floor_plans::{Family, scenario};
use crate::{Acts, strategies};
use pleach::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::Strategy;
use pleach::discrete::network::Role;
use pleach::mission::Watcher;
use std::collections::BTreeMap;
use std::io;
use std::sync::{Mutex, OnceLock};

/// How a mission on a random floor plan went.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Family and seed.
    pub name: String,
    /// How it ended.
    pub end: End,
    /// The number of control periods.
    pub periods: usize,
    /// What the observers saw last.
    pub last: Snapshot,
    /// What acted in it.
    pub acts: Acts,
}

impl Drawn {
    /// The mission of a family and a seed in this order, with the monitor watching.
    fn new(family: Family, seed: u64, strategy: Strategy) -> Self {
        let scenario = strategies::following(Some(strategy), scenario(family, seed));
        let mut ending = Ending::default();
        let (completed, acts) = Acts::in_mission(&scenario, &mut [&mut ending]);
        let Ending { periods, last } = ending;
        let last = last.expect("a mission has a beginning");
        Drawn { name: scenario.name.clone(), end: completed.end, periods, last, acts }
    }

    /// The same, from those that have run.
    pub fn shared(family: Family, seed: u64, strategy: Strategy) -> &'static Self {
        type Missions = BTreeMap<String, &'static OnceLock<Drawn>>;
        static MISSIONS: Mutex<Missions> = Mutex::new(BTreeMap::new());
        let key = format!("{}-{seed} {strategy:?}", family.name());
        let mission: &'static OnceLock<Drawn> =
            MISSIONS.lock().unwrap().entry(key).or_insert_with(|| Box::leak(Box::default()));
        mission.get_or_init(|| Drawn::new(family, seed, strategy))
    }

    /// Whether all tasks were serviced.
    pub fn is_serviced(&self) -> bool {
        self.end.outcome == Outcome::Serviced
    }
}

/// The last that a mission showed.
#[derive(Debug, Default)]
struct Ending {
    periods: usize,
    last: Option<Snapshot>,
}

impl Watcher for Ending {
    fn observe(&mut self, snapshot: &Snapshot, _: &[MissionEvent]) -> io::Result<()> {
        self.periods += 1;
        self.last = Some(snapshot.clone());
        Ok(())
    }
}

/// How many robots of a mission are not needed.
pub fn redundant(snapshot: &Snapshot) -> usize {
    snapshot.roles.iter().filter(|&&role| role == Role::Redundant).count()
}

/// How many robots of a mission are needed.
pub fn used(snapshot: &Snapshot) -> usize {
    snapshot.roles.len() - redundant(snapshot)
}
