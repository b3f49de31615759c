//! Exploration.
#![allow(clippy::unwrap_used)]
use pleach_verify::exploration::{Fairness, explore, ExplorationError};
use pleach_verify::network::exploration::{graphs, numbered_graphs, ALWAYS, Configuration, Medium, Places, Protocol, has_ended, story};
use std::collections::BTreeMap;

fn env(name: &str, default: &str) -> String { std::env::var(name).unwrap_or(default.into()) }
fn num(name: &str, default: usize) -> usize { std::env::var(name).map_or(default, |v| v.parse().unwrap()) }

fn tail(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let keep = num("TAIL", 40);
    lines[lines.len().saturating_sub(keep)..].join("\n")
}

#[derive(Default)]
struct Tally { configurations: usize, states: usize, transitions: usize, most: usize, too_many: usize, ends: BTreeMap<String, usize>, failures: BTreeMap<String, (usize, String)> }

fn run(name: &str, places: Places, tally: &mut Tally) {
    let medium = match env("MEDIUM", "0,0").as_str() { "any" => Medium::MessagesInAnyOrder, "nodes" => Medium::NodesInAnyOrder, n => { let (l, d) = n.split_once(',').unwrap(); Medium::Rounds { losses: l.parse().unwrap(), delays: d.parse().unwrap() } } };
    let mut protocol = Protocol::new(Configuration { places, medium, contacts: num("CONTACTS", 0) as u32 }).unwrap();
    tally.configurations += 1;
    let exploration = match explore(&mut protocol, ALWAYS, num("LIMIT", 300_000)) { Ok(e) => e, Err(ExplorationError::TooManyStates { .. }) => { tally.too_many += 1; if std::env::var("NAMES").is_ok() { println!("too many: {name}"); } return }, Err(e) => { tally.failures.entry(format!("{e}")).or_insert((0, name.into())).0 += 1; return } };
    tally.states += exploration.states().len();
    tally.most = tally.most.max(exploration.states().len());
    tally.transitions += exploration.transition_count();
    let mut fail = |what: &str, state| {
        let (count, shortest) = tally.failures.entry(what.into()).or_insert((0, String::new()));
        *count += 1;
        let text = story(&protocol, &exploration, state);
        if shortest.is_empty() || text.lines().count() < shortest.lines().count() { *shortest = format!("{name}\n{text}"); }
    };
    for violation in exploration.violations() { fail(violation.property, violation.state); }
    let traps = exploration.traps(|state| has_ended(&protocol, state), Fairness::Weak);
    if let Some(&trap) = traps.first() { fail("trap", trap); }
    for s in exploration.states().iter().filter(|s| has_ended(&protocol, s)) {
        let text = format!("{:?}", protocol.locals(s).next().unwrap().notice());
        *tally.ends.entry(text.chars().take(60).collect()).or_default() += 1;
    }
}

fn print(tally: &Tally, begin: std::time::Instant) {
    println!("{} configurations, {} states, {} transitions, most {}, too many {}, {:?}", tally.configurations, tally.states, tally.transitions, tally.most, tally.too_many, begin.elapsed());
    println!("{:#?}", tally.ends);
    for (what, (count, story)) in &tally.failures { println!("FAILS {what}: {count}\n{}", if std::env::var("HEAD").is_ok() { story.clone() } else { format!("{}\n{}", story.lines().next().unwrap(), tail(story)) }); }
}

#[test]
fn single() {
    let Ok(edges) = std::env::var("EDGES") else { return };
    let robots = num("ROBOTS", 2);
    let edges: Vec<(usize, usize)> = edges.split(',').map(|e| { let (a, b) = e.split_once('-').unwrap(); (a.parse().unwrap(), b.parse().unwrap()) }).collect();
    let tasks: Vec<usize> = env("TASKS", "").split(',').map(|t| t.parse().unwrap()).collect();
    let places = edges.iter().map(|&(a, b)| a.max(b)).max().unwrap() + 1;
    let places = Places::new(robots, num("APS", 1), places, &edges, &tasks).unwrap();
    let mut tally = Tally::default();
    let begin = std::time::Instant::now();
    run("single", places, &mut tally);
    print(&tally, begin);
}

#[test]
fn sweep() {
    let Ok(robots) = std::env::var("SWEEP") else { return };
    let robots: usize = robots.parse().unwrap();
    let all = if std::env::var("NUMBERED").is_ok() { numbered_graphs(robots) } else { graphs(robots) };
    let lengths: Vec<usize> = env("LENGTHS", "1,2").split(',').map(|t| t.parse().unwrap()).collect();
    let mut tally = Tally::default();
    let begin = std::time::Instant::now();
    let one: Vec<(usize, usize)> = (0..=robots).flat_map(|p| lengths.iter().map(move |&l| (p, l))).collect();
    for graph in &all {
        let mut branches: Vec<Vec<(usize, usize)>> = one.iter().map(|&b| vec![b]).collect();
        for _ in 1..num("NTASKS", 1) { branches = branches.iter().flat_map(|bs| one.iter().map(move |&b| { let mut bs = bs.clone(); bs.push(b); bs })).collect(); }
        for branches in branches {
            let places = Places::with_branches(robots, graph, &branches).unwrap();
            run(&format!("{graph:?} {branches:?}"), places, &mut tally);
        }
    }
    print(&tally, begin);
}
