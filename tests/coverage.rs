//! Which rows of their tables the nodes take: in the shipped scenarios, in random missions, and where
//! everything that can happen to a few robots is explored.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test --test it coverage` writes the page anew.

use crate::floor_plans::{Family, scenario};
use crate::generated::keep_up_to_date;
use crate::missions::{shipped, shipped_names, valid};
use pleach::automaton::network::scenario::{RoutingMethod, ValidScenario};
use pleach::automaton::network::{NamedRow, Network, Radio, Site};
use pleach::mission;
use pleach_exploration::network::{Findings, QUICK};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Random missions of each family of every day.
const SEEDS: u64 = 2;

/// Why rows are there that none of these takes, by what their names contain: table, source, event,
/// target.
const REASONS: &[([&str; 4], &str)] = &[
    (
        ["duty", "", "takes ", ""],
        "every two duties that an exchange may join have a row, so that none can fail half way; \
         robots with these two meet rarely",
    ),
    (
        ["duty", "", "resumed", ""],
        "another task is announced before the leader is released: by an access point that has not \
         heard of the election",
    ),
    (["duty", "waiting on the path", "leaf kept", ""], "Σ is given up while a leaf waits on it"),
    (
        ["exchange", "", "refuses", ""],
        "the robot that is asked has children that would lose their link; taken by \
         `explore -- thorough`",
    ),
    (["exchange", "", "refus", ""], "follows a refusal; taken by `explore -- thorough`"),
    (
        ["exchange", "offering and refusing", "", ""],
        "a mover that is itself in the way of another has refused its offer",
    ),
    (["attendance", "", "", ""], "robots do not answer any more, or come back; taken in storms"),
    (["service", "", "announces again", ""], "robots do not answer any more; taken in storms"),
    (
        ["duty", "", "attached", ""],
        "no robot holds the post of its parent any more; taken in storms",
    ),
    (["duty", "standby", "joined", ""], "a robot joins a mission under way; taken in storms"),
    (
        ["duty", "awaiting release", "standby kept", ""],
        "robots do not answer any more while the leader is relieved",
    ),
    (["mission", "advance", "blocked", ""], "the team stands still although no link holds it back"),
    (
        ["mission", "recruit election", "resumed", ""],
        "the notice between is not heard; taken by `explore -- thorough`",
    ),
    (["mission", "", "", ""], "notices between this one and the one before are not heard"),
    (
        ["service", "gathering", "no robot", ""],
        "no robot is connected to an access point at the start",
    ),
    (["service", "serviced", "no robot", ""], "the robots are all gone after a task"),
    (["service", "electing", "no answer", ""], "the robots are all gone during an election"),
    (
        ["service", "", "heard", ""],
        "another access point has gone on although this one has not heard of it",
    ),
    (["user", "", "", ""], "the message from the access point is late or repeated"),
];

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
    shipped_names().into_iter().map(|name| valid(shipped(&name)))
}

/// Random missions, one with routes by ADAL, one with rates that links cannot carry, and one without
/// a task.
fn drawn_scenarios() -> impl Iterator<Item = ValidScenario> {
    let random = Family::of_every_day()
        .flat_map(|family| (1..=SEEDS).map(move |seed| scenario(family, seed)));
    let mut by_adal = shipped("study-2");
    by_adal.control.routing_method = Some(RoutingMethod::Adal);
    let mut laden = shipped("study-1");
    laden.robot.iter_mut().for_each(|robot| robot.rate = 0.2);
    let mut idle = shipped("study-2");
    idle.task.clear();
    random.chain([by_adal, laden, idle].into_iter().map(valid))
}

fn explored() -> (usize, Rows) {
    let all = QUICK.iter().map(|campaign| campaign.run().unwrap());
    let findings = all.fold(Findings::default(), Findings::and);
    assert!(findings.failures.is_empty(), "{:?}", findings.failures);
    (findings.counts.configurations, findings.rows)
}

fn reason(row: &NamedRow) -> Option<&'static str> {
    let names = [row.table, row.source, row.event, row.target];
    let fits = |parts: &[&str; 4]| names.iter().zip(parts).all(|(name, part)| name.contains(part));
    REASONS.iter().find(|(parts, _)| fits(parts)).map(|(_, reason)| *reason)
}

#[test]
fn every_row_is_taken_or_has_a_reason() {
    let (scenarios, in_scenarios) = sum(shipped_scenarios());
    let (drawn, in_drawn) = sum(drawn_scenarios());
    let (configurations, in_explored) = explored();
    let mut page = format!(
        "<!-- Generated: PLEACH_UPDATE_DOCS=1 cargo test --test it coverage -->\n\n\
         # Which rows nodes take\n\n\
         In how many of the {scenarios} shipped scenarios, of {drawn} random missions, and of \
         {configurations} configurations that are explored exhaustively some node takes each row of \
         its tables. The explorer stands for routes and motion: rows of the control period are not \
         taken there. For a row that none of them takes, the last column says why it is there.\n"
    );
    let (mut unexplained, mut used, mut title) = (Vec::new(), BTreeSet::new(), "");
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
        let is_taken = times + random + explored > 0;
        let why = if is_taken { None } else { reason(row) };
        page += &format!(
            "| {source} | {event} | {target} | {times} | {random} | {explored} | {} |\n",
            why.unwrap_or_default()
        );
        used.extend(why);
        if !is_taken && why.is_none() {
            unexplained.push(row.to_string());
        }
    }
    let needless = REASONS.iter().filter(|(_, reason)| !used.contains(reason));
    unexplained.extend(needless.map(|(_, reason)| format!("needless: {reason}")));
    keep_up_to_date("docs/coverage.md", &page, "coverage");
    assert!(
        unexplained.is_empty(),
        "rows that nothing takes have a reason, and reasons have a row:\n{}",
        unexplained.join("\n")
    );
}
