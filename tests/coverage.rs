//! Which rows of their tables the nodes take: in the shipped scenarios, in random missions, and where
//! everything that can happen to a few robots is explored.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test --test it coverage` writes the page anew.

use crate::floor_plans::{Family, scenario};
use crate::generated::keep_up_to_date;
use crate::missions::{shipped, valid};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{NamedRow, Network, Radio, Site};
use pleach::mission;
use pleach_exploration::network::{Findings, QUICK};
use std::collections::BTreeMap;
use std::fs;
use std::sync::Arc;

/// Random missions of each family; those of the hall take too long for every day.
const SEEDS: u64 = 2;

/// Why a row is there that none of these takes: by source, event and target.
const REASONS: &[([&str; 3], &str)] = &[];

/// How often each row is taken.
type Rows = BTreeMap<NamedRow, usize>;

/// In which missions each row is taken, and how many missions these are.
fn sum(missions: impl Iterator<Item = ValidScenario>) -> (usize, Rows) {
    let (mut count, mut sums) = (0, Rows::new());
    for scenario in missions {
        count += 1;
        for (row, times) in taken(&scenario) {
            *sums.entry(row).or_default() += usize::from(times > 0);
        }
    }
    (count, sums)
}

/// How often each row is taken in a mission.
fn taken(scenario: &ValidScenario) -> Vec<(NamedRow, u64)> {
    let mut site = Site::new(scenario).unwrap();
    site.automata = site.automata.counted();
    let (radio, site) = (Radio::new(&site), Arc::new(site));
    let mut network = Network::with_medium(scenario, Arc::clone(&site), radio).unwrap();
    mission::run_network(scenario, &mut network, &mut []).unwrap();
    site.automata.taken()
}

fn shipped_scenarios() -> impl Iterator<Item = ValidScenario> {
    let files = fs::read_dir("scenarios").unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> =
        files.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    names.sort();
    names.into_iter().map(|name| valid(shipped(&name)))
}

fn random_scenarios() -> impl Iterator<Item = ValidScenario> {
    let families = Family::ALL.into_iter().filter(|&family| family != Family::Hall);
    families.flat_map(|family| (1..=SEEDS).map(move |seed| scenario(family, seed)))
}

fn explored() -> (usize, Rows) {
    let all = QUICK.iter().map(|campaign| campaign.run().unwrap());
    let findings = all.fold(Findings::default(), Findings::and);
    (findings.counts.configurations, findings.rows)
}

fn reason(row: &NamedRow) -> Option<&'static str> {
    let names = [row.source, row.event, row.target];
    REASONS.iter().find(|(known, _)| *known == names).map(|(_, reason)| *reason)
}

#[test]
fn every_row_is_taken_or_has_a_reason() {
    let (scenarios, in_scenarios) = sum(shipped_scenarios());
    let (drawn, in_drawn) = sum(random_scenarios());
    let (configurations, in_explored) = explored();
    let mut page = format!(
        "<!-- Generated: PLEACH_UPDATE_DOCS=1 cargo test --test it coverage -->\n\n\
         # Which rows nodes take\n\n\
         In how many of the {scenarios} shipped scenarios, of {drawn} random missions, and of \
         {configurations} configurations that are explored exhaustively some node takes each row of \
         its tables. The explorer stands for routes and motion: rows of the control period are not \
         taken there. For a row that none of them takes, the last column says why it is there.\n"
    );
    let (mut unexplained, mut title) = (Vec::new(), "");
    for (row, times) in &in_scenarios {
        if row.table != title {
            title = row.table;
            page += &format!(
                "\n## Table: {title}\n\n\
                 | source | event | target | scenarios | random | explored | otherwise |\n\
                 | --- | --- | --- | --: | --: | --: | --- |\n"
            );
        }
        let others = [&in_drawn, &in_explored].map(|taken| taken.get(row).copied().unwrap_or(0));
        let (NamedRow { source, event, target, .. }, [random, explored]) = (row, others);
        let why = reason(row);
        page += &format!(
            "| {source} | {event} | {target} | {times} | {random} | {explored} | {} |\n",
            why.unwrap_or_default()
        );
        if why.is_some() == (times + random + explored > 0) {
            unexplained.push(row.to_string());
        }
    }
    keep_up_to_date("docs/coverage.md", &page, "coverage");
    assert!(
        unexplained.is_empty(),
        "a row has a reason exactly if nothing takes it:\n{}",
        unexplained.join("\n")
    );
}
