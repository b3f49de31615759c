//! Which rows of their tables the nodes take, and what they say to each other: in the shipped scenarios,
//! in other missions, in storms, and where everything that can happen to a few robots is explored.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test -p missions --test it coverage` writes the page anew, after
//! `PLEACH_UPDATE_DOCS=1 cargo test -p pleach-exploration --test it campaigns` has written what is explored.

use crate::generated::{self, keep_up_to_date};
use crate::stressed::stressed_scenarios;
use missions::floor_plans::Family;
use missions::{
    Acts, Drawn, counted, files, read, shipped, shipped_mission, shipped_names, strategies, valid,
};
use pleach::automaton::Executor;
use pleach::automaton::network::NamedRow;
use pleach::automaton::network::scenario::RoutingMethod;
use pleach::verify::network::storm::{Kind, draw, network_on};
use pleach_exploration::network::QUICK;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Random missions of each family by each strategy.
const SEEDS: u64 = 2;

/// Why rows are there that none of these takes, by what their names contain: table, source, event,
/// target.
const REASONS: &[([&str; 4], &str)] = &[
    (
        ["service of the tasks", "electing", "no bid", "over"],
        "with unreachable = \"end\"; in a unit test",
    ),
    (["duty", "", "takes ", ""], "an exchange joins two duties whose robots rarely meet"),
    (["duty", "waiting on the path", "leaf kept", ""], "Σ is given up while a leaf waits on it"),
    (
        ["exchange", "refusing", "refusal in vain", ""],
        "the mover stops before it receives the refusal; in a unit test",
    ),
    (["exchange", "", "refus", ""], "after a refusal; in `explore -- thorough`"),
    (
        ["exchange", "offering and refusing", "", ""],
        "a mover in the way of another mover has refused its offer",
    ),
    (["mission", "", "", ""], "the robot has not received the notices in between"),
    (
        ["exchange", "offering", "partner lost", ""],
        "the robot in its way stops in the rounds in which it is offered a duty; in a unit test",
    ),
    (
        ["exchange", "giving", "partner lost", ""],
        "the mover stops in the rounds in which the robot in its way has accepted its offer",
    ),
    (["service", "done", "no robot", ""], "all robots are gone after a task"),
    (
        ["service", "electing", "no answer", ""],
        "a robot sends beacons but answers no election; in a unit test",
    ),
    (["service", "", "closes", ""], "a task ends in the rounds in which robots gather or elect"),
    (
        ["service", "electing", "withdraws", ""],
        "the task is taken back in the rounds in which robots elect",
    ),
    (
        ["service", "", "heard", ""],
        "another access point has gone on, and this one has not received that",
    ),
    (["user", "asking", "missed", ""], "the first access point stops before it announces a task"),
    (["user", "", "", ""], "the message from the access point is late or repeated"),
];

/// What acts in the shipped scenarios.
fn in_shipped() -> Acts {
    let names = shipped_names();
    names.par_iter().map(|name| shipped_mission(name).1.clone()).reduce(Acts::default, Acts::and)
}

/// What acts in random missions, which other tests look at as well, by either strategy.
fn in_random() -> Acts {
    let of_family =
        |family| (1..=SEEDS).flat_map(move |seed| strategies::BOTH.map(|it| (family, seed, it)));
    let families = Family::of_every_day().chain(Family::WINDING);
    let missions: Vec<_> = families.flat_map(of_family).collect();
    let in_each = missions
        .into_par_iter()
        .map(|(family, seed, strategy)| Drawn::shared(family, seed, strategy).acts.clone());
    in_each.reduce(Acts::default, Acts::and)
}

/// What acts in missions under stress, with routes by ADAL, with rates that links cannot carry, and without a task, and
/// in those that have failed once.
fn in_special() -> Acts {
    let mut by_adal = shipped("study-2");
    by_adal.control.routing_method = Some(RoutingMethod::Adal);
    let mut laden = shipped("study-1");
    laden.robot.iter_mut().for_each(|robot| robot.rate = 0.2);
    let mut idle = shipped("study-2");
    idle.task.clear();
    let set_up = stressed_scenarios().chain([by_adal, laden, idle]).map(valid);
    let found = files("tests/scenarios/found").into_iter().map(read);
    let scenarios: Vec<_> = set_up.chain(found).collect();
    let in_each = scenarios.into_par_iter().map(|it| Acts::in_mission(&it, &mut []).1);
    in_each.reduce(Acts::default, Acts::and)
}

fn in_storms() -> Acts {
    let in_each = STORMS.par_iter().map(|&(name, kind, seed)| {
        let scenario = valid(shipped(name));
        let site = counted(&scenario);
        let storm = draw(kind, seed, &scenario, DURATION_OF_STORMS);
        let mut network = network_on(Arc::clone(&site), &scenario, &storm).unwrap();
        let executor = Executor::new(HORIZON_OF_STORMS, 1_000_000).unwrap();
        executor.run(&mut network, &mut ()).unwrap();
        Acts::in_one(&site, &BTreeMap::new())
    });
    in_each.reduce(Acts::default, Acts::and)
}

/// Storms in which robots stop, come back, join late and lose what they say.
const STORMS: &[(&str, Kind, u64)] = &[
    ("corridor", Kind::Crash, 0),
    ("corridor", Kind::Crash, 1),
    ("corridor", Kind::Restart, 1),
    ("corridor", Kind::Restart, 2),
    ("corridor", Kind::Partition, 3),
    ("study-2", Kind::Crash, 0),
    ("study-2", Kind::Restart, 0),
    ("study-2", Kind::Late, 0),
    ("study-2", Kind::Late, 1),
    ("study-2", Kind::Everything, 0),
    ("study-2", Kind::Everything, 1),
    ("corridor", Kind::Everything, 2),
    ("corridor", Kind::AccessPoint, 1),
];
const DURATION_OF_STORMS: f64 = 300.0;
const HORIZON_OF_STORMS: f64 = 900.0;

/// How many configurations the quick campaigns explore, and in how many of them each row is taken, as their own
/// test keeps it.
fn explored() -> (usize, BTreeMap<String, usize>) {
    let kept = generated::read("../../exploration/tests/rows.txt");
    let rows = kept.lines().map(|line| {
        let (configurations, row) = line.split_once(' ').unwrap();
        (row.to_owned(), configurations.parse().unwrap())
    });
    (QUICK.iter().map(|campaign| campaign.expected.configurations).sum(), rows.collect())
}

fn reason(row: &NamedRow) -> Option<&'static str> {
    let names = [row.table, row.source, row.event, row.target];
    let fits = |parts: &[&str; 4]| names.iter().zip(parts).all(|(name, part)| name.contains(part));
    REASONS.iter().find(|(parts, _)| fits(parts)).map(|(_, reason)| *reason)
}

#[test]
fn every_row_is_taken_or_has_a_reason() {
    let in_scenarios = in_shipped();
    let (in_others, in_storms) = (in_random().and(in_special()), in_storms());
    let (configurations, in_explored) = explored();
    let mut page = format!(
        "<!-- Generated: PLEACH_UPDATE_DOCS=1 cargo test -p missions --test it coverage -->\n\n\
         # Coverage of the tables by tests\n\n\
         *For people who change the protocol: which rows of the tables do tests take, and why are the others there?*\n\n\
         The table counts the rows that some node takes in {} shipped scenarios, {} other missions (random, under stress, \
         at their limits, and those that failed once), {} missions with random faults, and {configurations} exhaustively \
         explored configurations. The explorer replaces routes and motion and takes none of their rows.\n\n\
         | table | rows | scenarios | others | faults | explored | none |\n\
         | --- | --: | --: | --: | --: | --: | --: |\n",
        in_scenarios.missions, in_others.missions, in_storms.missions,
    );
    let mut tables = BTreeMap::<&str, [usize; 6]>::new();
    let mut without = BTreeMap::<&str, Vec<String>>::new();
    let mut unexplained = Vec::new();
    for (row, &times) in &in_scenarios.rows {
        let [other, storms] =
            [&in_others.rows, &in_storms.rows].map(|taken| taken.get(row).copied().unwrap_or(0));
        let taken = [times, other, storms, in_explored[&row.to_string()]].map(|count| count > 0);
        let is_untaken = taken == [false; 4];
        let [scenarios, others, storms, explored] = taken;
        let counts = [true, scenarios, others, storms, explored, is_untaken].map(usize::from);
        let sums = tables.entry(row.table).or_default();
        sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        match reason(row) {
            Some(why) if is_untaken => without.entry(why).or_default().push(row.to_string()),
            None if is_untaken => unexplained.push(row.to_string()),
            _ => {}
        }
    }
    for (table, counts) in tables {
        page += &format!("| {table} | {} |\n", counts.map(|count| count.to_string()).join(" | "));
    }
    page += "\n## Rows that none of them takes\n\n| rows | for example | when a node takes them |\n| --: | --- | --- |\n";
    for (why, rows) in &without {
        page += &format!("| {} | {} | {why} |\n", rows.len(), rows[0]);
    }
    page += "\n## Messages\n\nThe number of missions in which a node receives each kind of message.\n\n\
             | message | scenarios | others | otherwise |\n| --- | --: | --: | --- |\n";
    for &(kind, why) in SAID {
        let [here, there] =
            [&in_scenarios, &in_others].map(|acts| acts.heard.get(kind).copied().unwrap_or(0));
        page += &format!("| {kind} | {here} | {there} | {why} |\n");
        if (here + there == 0) == why.is_empty() {
            unexplained.push(format!("{kind} is heard in {} missions", here + there));
        }
    }
    let needless = REASONS.iter().filter(|(_, reason)| !without.contains_key(reason));
    unexplained.extend(needless.map(|(_, reason)| format!("needless: {reason}")));
    keep_up_to_date("../../docs/coverage.md", &page, "coverage");
    assert!(
        unexplained.is_empty(),
        "rows that nothing takes have a reason, and reasons have a row:\n{}",
        unexplained.join("\n")
    );
}

/// What nodes say to each other, by what comes of it, and why it is said where none of these missions
/// shows it.
const SAID: &[(&str, &str)] = &[
    ("proposal", ""),
    ("proposal of a move that has been halved", ""),
    ("objection", ""),
    ("consent", ""),
    ("request for a flow", ""),
    ("grant", ""),
    ("grant of less than is asked for", ""),
    ("demand", ""),
    ("shortage", ""),
    ("offer to exchange duties", ""),
    ("acceptance of an offer", ""),
    ("refusal of an offer", "only between robots with different information; in a unit test"),
    ("request to make way", ""),
];
