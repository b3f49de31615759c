//! What acts in missions: which rows of their tables the nodes take, and what they say to each other.

use crate::medium::Noted;
use pleach::automaton::network::scenario::{Fleet, ValidScenario};
use pleach::automaton::network::{Fleets, NamedRow, Network, Site};
use pleach::mission::{self, Completed, Watcher};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What acts in missions.
#[derive(Clone, Debug, Default)]
pub struct Acts {
    /// How many missions there are.
    pub missions: usize,
    /// In how many of them each row is taken.
    pub rows: BTreeMap<NamedRow, usize>,
    /// In how many of them each kind of message is heard.
    pub heard: BTreeMap<&'static str, usize>,
}

impl Acts {
    /// Runs the mission of a scenario, with the monitor watching.
    pub fn in_mission(
        scenario: &ValidScenario,
        watchers: &mut [&mut dyn Watcher],
    ) -> (Completed, Self) {
        let site = counted(scenario);
        let medium = Noted::new(&site);
        let mut network = Network::with_medium(scenario, Arc::clone(&site), medium).unwrap();
        let completed = mission::run_network(scenario, &mut network, watchers)
            .expect("a mission without errors");
        (completed, Acts::in_one(&site, network.medium().counts()))
    }

    /// Runs the missions of the fleets of a scenario, with the monitor watching.
    pub fn in_fleets(
        scenario: &ValidScenario,
        watchers: &mut [&mut dyn Watcher],
    ) -> (Completed, Self) {
        let network = |fleet: &Fleet| {
            let mut site = Site::clone(fleet.scenario().site());
            site.automata = site.automata.counted();
            let medium = Noted::new(&site);
            Network::with_medium(fleet.scenario(), Arc::new(site), medium)
        };
        let mut fleets = Fleets::of_networks(scenario, network).unwrap();
        let completed =
            mission::run_fleets(scenario, &mut fleets, watchers).expect("missions without errors");
        let acts = fleets.networks().map(|it| Acts::in_one(it.site(), it.medium().counts()));
        let mut acts = acts.reduce(Acts::and).expect("there is a fleet");
        let counts = acts.rows.values_mut().chain(acts.heard.values_mut());
        counts.for_each(|count| *count = (*count).min(1));
        (completed, Acts { missions: 1, ..acts })
    }

    /// What has acted in one mission on this site.
    pub fn in_one(site: &Site, heard: &BTreeMap<&'static str, u64>) -> Self {
        let mut acts = Acts { missions: 1, ..Acts::default() };
        for (row, times) in site.automata.taken() {
            *acts.rows.entry(row).or_default() += usize::from(times > 0);
        }
        acts.heard.extend(heard.keys().map(|&kind| (kind, 1)));
        acts
    }

    /// What acts in these missions and in others.
    #[must_use]
    pub fn and(mut self, other: Acts) -> Self {
        self.missions += other.missions;
        for (row, times) in other.rows {
            *self.rows.entry(row).or_default() += times;
        }
        for (kind, times) in other.heard {
            *self.heard.entry(kind).or_default() += times;
        }
        self
    }
}

/// The site of a scenario, with automata that count.
pub fn counted(scenario: &ValidScenario) -> Arc<Site> {
    let mut site = Site::new(scenario).unwrap();
    site.automata = site.automata.counted();
    Arc::new(site)
}
