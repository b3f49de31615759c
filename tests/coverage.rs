//! Which rows of their tables the nodes take, in the shipped scenarios and in random missions.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test --test it coverage` writes the page anew.

use crate::floor_plans::{Family, scenario};
use crate::generated::keep_up_to_date;
use crate::missions::{shipped, valid};
use pleach::automaton::network::scenario::{Scenario, ValidScenario};
use pleach::automaton::network::{Automata, Network, Radio, Site};
use pleach::discrete::{Event, Location, Row};
use pleach::mission;
use std::fs;
use std::sync::Arc;

/// Random missions of each family; those of the hall take too long for every day.
const SEEDS: u64 = 2;

/// Why a row is there that no shipped scenario takes: by source, event and target.
const REASONS: &[([&str; 3], &str)] = &[];

/// A row by name, and in how many missions it is taken.
struct Taken {
    row: [&'static str; 3],
    missions: usize,
}

/// The tables of robots, access points and the user, each with its title.
fn tables(automata: &Automata) -> Vec<(&'static str, Vec<Taken>)> {
    fn rows<L: Location, E: Event>(taken: impl Iterator<Item = (Row<L, E>, u64)>) -> Vec<Taken> {
        taken
            .map(|(row, count)| Taken {
                row: [row.source.name(), row.event.name(), row.target.name()],
                missions: usize::from(count > 0),
            })
            .collect()
    }
    vec![
        ("The duty", rows(automata.duty.taken())),
        ("The mission", rows(automata.mission.taken())),
        ("The exchange of duties", rows(automata.dealing.taken())),
        ("The control period", rows(automata.control.taken())),
        ("The service of the tasks", rows(automata.service.taken())),
        ("The control period of an access point", rows(automata.rounds.taken())),
        ("The user", rows(automata.request.taken())),
    ]
}

/// The tables after a mission, by the robots of which a row has been taken or not.
fn after(scenario: &ValidScenario) -> Vec<(&'static str, Vec<Taken>)> {
    let mut site = Site::new(scenario).unwrap();
    site.automata = site.automata.counted();
    let (site, medium) = (Arc::new(site), |site: &Site| Radio::new(site));
    let medium = medium(&site);
    let mut network = Network::with_medium(scenario, Arc::clone(&site), medium).unwrap();
    mission::run_network(scenario, &mut network, &mut []).unwrap();
    tables(&site.automata)
}

/// In how many of these missions each row is taken.
fn tally(scenarios: impl Iterator<Item = Scenario>) -> (usize, Vec<(&'static str, Vec<Taken>)>) {
    let mut missions = scenarios.map(|scenario| after(&valid(scenario)));
    let mut sums = missions.next().unwrap();
    let mut count = 1;
    for mission in missions {
        count += 1;
        for ((_, sums), (_, rows)) in sums.iter_mut().zip(mission) {
            sums.iter_mut().zip(rows).for_each(|(sum, row)| sum.missions += row.missions);
        }
    }
    (count, sums)
}

fn shipped_scenarios() -> impl Iterator<Item = Scenario> {
    let files = fs::read_dir("scenarios").unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> =
        files.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    names.sort();
    names.into_iter().map(|name| shipped(&name))
}

fn random_scenarios() -> impl Iterator<Item = Scenario> {
    let families = Family::ALL.into_iter().filter(|&family| family != Family::Hall);
    families.flat_map(|family| (1..=SEEDS).map(move |seed| scenario(family, seed).into_scenario()))
}

fn reason(row: [&str; 3]) -> Option<&'static str> {
    REASONS.iter().find(|(known, _)| *known == row).map(|(_, reason)| *reason)
}

#[test]
fn every_row_is_taken_or_has_a_reason() {
    let (scenarios, in_scenarios) = tally(shipped_scenarios());
    let (drawn, in_drawn) = tally(random_scenarios());
    let mut page = format!(
        "<!-- Generated: PLEACH_UPDATE_DOCS=1 cargo test --test it coverage -->\n\n\
         # Which rows nodes take\n\n\
         In how many of the {scenarios} shipped scenarios, and of {drawn} random missions, some \
         node takes each row of its tables. For a row that no shipped scenario takes, the last \
         column says what does.\n"
    );
    let mut unexplained = Vec::new();
    for ((title, rows), (_, in_drawn)) in in_scenarios.iter().zip(&in_drawn) {
        page += &format!(
            "\n## {title}\n\n| source | event | target | scenarios | random | otherwise |\n\
             | --- | --- | --- | --: | --: | --- |\n"
        );
        for (Taken { row, missions }, random) in rows.iter().zip(in_drawn) {
            let ([source, event, target], why) = (row, reason(*row));
            page += &format!(
                "| {source} | {event} | {target} | {missions} | {} | {} |\n",
                random.missions,
                why.unwrap_or_default()
            );
            if why.is_some() == (*missions > 0) {
                unexplained.push(format!("{source} on {event} to {target}: {missions} missions"));
            }
        }
    }
    keep_up_to_date("docs/coverage.md", &page, "coverage");
    assert!(
        unexplained.is_empty(),
        "a row has a reason exactly if no shipped scenario takes it:\n{}",
        unexplained.join("\n")
    );
}
