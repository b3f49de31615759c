//! Missions in storms: messages are lost, late and copied, robots crash, restart and join late, and
//! positions and moves have errors.
//!
//! `cargo run --release --example storm -- COUNT [FIRST_SEED]` runs as many missions, of all kinds, in shipped
//! scenarios and on random floor plans in turn, and tells the first that breaks a promise of safety, shrunk; it
//! ends with status 1 if there is one.
//! `cargo run --release --example storm -- seed SEED` tells the mission of that seed.
//! `cargo run --release --example storm -- one SCENARIO KIND SEED` tells that of a shipped scenario.
//! `cargo run --release --example storm -- table SEEDS [KIND]` prints a table of what becomes of
//! missions under each kind of storm, and of what breaks.
//!
//! `--settings` draws the settings of the missions of COUNT and SEED as well. `--strategy paper` and `--strategy eager`
//! say when recruits are called for. Without it that is what the scenario says: in the studies the paper's order,
//! elsewhere the default.

#[macro_use]
mod say;

use clap::builder::PossibleValuesParser;
use clap::{Parser, Subcommand};
use missions::in_storms::{SHIPPED, mission_in_storm, mission_with_settings_in_storm};
use missions::{arguments, shipped, strategies, valid};
use pleach::automaton::network::record::Outcome;
use pleach::automaton::network::scenario::{Strategy, ValidScenario};
use pleach::story;
use pleach::verify::network::storm::{
    Kind, Storm, Verdict, allowing_for, draw, judged_run, judged_run_watched, shrink,
};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Control periods after which a mission is given up.
const MOST_PERIODS: usize = 3_000;

#[derive(Parser)]
#[command(about = "Runs missions in storms", args_conflicts_with_subcommands = true)]
struct CommandLine {
    #[command(subcommand)]
    command: Option<Command>,
    /// How many missions, of all kinds, in shipped scenarios and on random floor plans in turn
    #[arg(required = true, value_parser = arguments::missions)]
    missions: Option<u64>,
    /// The seed of the first
    #[arg(default_value_t = 0, value_parser = arguments::seed)]
    first: u64,
    /// When recruits are called for: paper or eager
    #[arg(long, global = true, value_parser = strategies::named)]
    strategy: Option<Strategy>,
    /// Draw the settings of missions as well: lengths, rounds, periods, rates, routing
    #[arg(long, global = true)]
    settings: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Tells the mission of a seed
    Seed {
        #[arg(value_parser = arguments::seed)]
        seed: u64,
    },
    /// Tells the mission of a shipped scenario in a kind of storm
    One {
        #[arg(value_parser = PossibleValuesParser::new(SHIPPED))]
        scenario: String,
        #[arg(value_parser = kind)]
        kind: Kind,
        #[arg(value_parser = arguments::seed)]
        seed: u64,
    },
    /// Prints what becomes of shipped scenarios under each kind of storm
    Table {
        /// Storms of each kind for each scenario
        #[arg(value_parser = arguments::count)]
        seeds: u64,
        /// Only kinds with this in their name
        kind: Option<String>,
    },
}

fn kind(name: &str) -> Result<Kind, String> {
    let known = Kind::ALL.iter().find(|kind| kind.name() == name);
    known.copied().ok_or_else(|| format!("no kind of storm has this name; {}", kinds()))
}

fn kinds() -> String {
    let names: Vec<String> = Kind::ALL.iter().map(|kind| kind.name()).collect();
    format!("there are: {}", names.join(", "))
}

fn main() -> ExitCode {
    run().unwrap_or_else(|error| {
        eprintln!("error: {error}");
        ExitCode::from(2)
    })
}

fn run() -> Result<ExitCode, Box<dyn Error>> {
    let CommandLine { command, missions, first, strategy, settings } = CommandLine::parse();
    let mission = |seed| mission(seed, strategy, settings);
    match command {
        Some(Command::One { scenario, kind, seed }) => {
            one(strategies::following(strategy, valid(shipped(&scenario))), kind, seed)?;
        }
        Some(Command::Seed { seed }) => {
            let (scenario, storm) = mission(seed);
            tell_in_full(&scenario, seed, &storm, MOST_PERIODS)?;
        }
        Some(Command::Table { seeds, kind }) => table(seeds, kind.as_deref(), strategy)?,
        None => return many(first, missions.unwrap_or_default(), mission),
    }
    Ok(ExitCode::SUCCESS)
}

/// The mission of a seed with this strategy, and its storm.
fn mission(seed: u64, strategy: Option<Strategy>, settings: bool) -> (ValidScenario, Storm) {
    let (scenario, storm) = match settings {
        true => mission_with_settings_in_storm(seed),
        false => mission_in_storm(seed),
    };
    (strategies::following(strategy, scenario), storm)
}

fn is_serviced(verdict: &Verdict) -> bool {
    verdict.end.as_ref().is_some_and(|end| end.outcome == Outcome::Serviced)
}

/// The duration of this number of control periods, in seconds.
fn seconds(periods: usize, scenario: &ValidScenario) -> f64 {
    periods as f64 * scenario.settings().period
}

/// What becomes of missions under each kind of storm.
fn table(seeds: u64, only: Option<&str>, strategy: Option<Strategy>) -> Result<(), Box<dyn Error>> {
    let wanted = kinds_with(only.unwrap_or_default())?;
    let mut missions = Vec::new();
    for name in SHIPPED {
        let scenario = strategies::following(strategy, valid(shipped(name)));
        let calm = judged_run(&scenario, &Storm::default(), MOST_PERIODS)?.periods;
        say!("{name}: {calm} periods without faults");
        missions.push((scenario, calm));
    }
    say!("| faults | serviced | longest | contacts | walls touched | other |");
    say!("| --- | ---: | ---: | ---: | ---: | --- |");
    for kind in wanted {
        let mut row = Row::default();
        for (scenario, calm) in &missions {
            let scenario = match allowing_for(kind, scenario) {
                Ok(scenario) => scenario,
                Err(no_room) => {
                    say!("{}: {no_room}", scenario.name);
                    continue;
                }
            };
            for seed in 0..seeds {
                let storm = draw(kind, seed, &scenario, seconds(*calm, &scenario));
                let verdict = judged_run(&scenario, &storm, MOST_PERIODS.min(3 * calm));
                if let (Some(_), Ok(verdict)) = (only, &verdict) {
                    report(&scenario, seed, verdict);
                }
                row.enter(verdict, *calm);
            }
        }
        say!("| {} | {row} |", kind.name());
    }
    Ok(())
}

/// The kinds of storms with this in their name.
fn kinds_with(part: &str) -> Result<Vec<Kind>, String> {
    let found = Kind::ALL.iter().filter(|kind| kind.name().contains(part));
    let found: Vec<Kind> = found.copied().collect();
    match found.is_empty() {
        true => Err(format!("no kind of storm has '{part}' in its name; {}", kinds())),
        false => Ok(found),
    }
}

/// What has become of missions under one kind of storm: a row of the table.
#[derive(Default)]
struct Row {
    missions: usize,
    serviced: usize,
    /// The most periods of a mission that is serviced, as a multiple of those without faults.
    longest: f64,
    /// How often each property was violated, and other mishaps.
    broken: BTreeMap<String, usize>,
}

impl Row {
    /// Adds a mission. Without faults it takes `calm` control periods.
    fn enter<E: Display>(&mut self, verdict: Result<Verdict, E>, calm: usize) {
        self.missions += 1;
        let mut count = |what: String| *self.broken.entry(what).or_default() += 1;
        let verdict = match verdict {
            Ok(verdict) => verdict,
            Err(error) => return count(error.to_string()),
        };
        for violation in &verdict.violations {
            count(violation.property.name().to_owned());
        }
        if verdict.unheard.is_some() {
            count("(contact before it joins)".to_owned());
        }
        if is_serviced(&verdict) {
            self.serviced += 1;
            self.longest = self.longest.max(verdict.periods as f64 / calm as f64);
        }
    }
}

impl Display for Row {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        const COLUMNS: [&str; 2] = ["separation", "clearance"];
        let [contacts, walls] = COLUMNS.map(|name| self.broken.get(name).unwrap_or(&0));
        let others = self.broken.iter().filter(|(name, _)| !COLUMNS.contains(&name.as_str()));
        let others: Vec<String> = others.map(|(name, times)| format!("{name} {times}")).collect();
        write!(f, "{} of {} | ", self.serviced, self.missions)?;
        if self.serviced > 0 {
            write!(f, "×{:.2}", self.longest)?;
        }
        write!(f, " | {contacts} | {walls} | {}", others.join(", "))
    }
}

/// What was not as it should be.
fn report(scenario: &ValidScenario, seed: u64, verdict: &Verdict) {
    if !is_serviced(verdict) {
        let end = verdict.end.as_ref().map_or("time is up", |end| end.reason.as_str());
        let last = verdict.events.last().map(|(step, event)| (step, story::tell(event)));
        say!(
            "  {} {seed}: k = {}, last motion {}, {end}; {last:?}",
            scenario.name,
            verdict.periods,
            verdict.last_motion
        );
    }
    for violation in &verdict.violations {
        say!("  {} {seed}: {violation}", scenario.name);
    }
}

/// Tells one mission.
fn one(scenario: ValidScenario, kind: Kind, seed: u64) -> Result<(), Box<dyn Error>> {
    let calm = judged_run(&scenario, &Storm::default(), MOST_PERIODS)?;
    let scenario = allowing_for(kind, &scenario)?;
    let storm = draw(kind, seed, &scenario, seconds(calm.periods, &scenario));
    tell_in_full(&scenario, seed, &storm, MOST_PERIODS.min(3 * calm.periods))
}

/// Tells a mission, and what led to what it breaks.
fn tell_in_full(
    scenario: &ValidScenario,
    seed: u64,
    storm: &Storm,
    periods: usize,
) -> Result<(), Box<dyn Error>> {
    say!("{} in {storm:#?}", scenario.name);
    let verdict = judged_run(scenario, storm, periods)?;
    for (step, event) in &verdict.events {
        say!("k = {step:<6} {}", story::tell(event));
    }
    report(scenario, seed, &verdict);
    if let Some(violation) = verdict.violations.first() {
        let concerned = |node: usize| violation.robots.contains(&node);
        judged_run_watched(scenario, storm, violation.step + 2, |snapshot| {
            if snapshot.step + 6 < violation.step {
                return;
            }
            say!("k = {}", snapshot.step);
            for &robot in violation.robots.iter().filter(|&&r| r < snapshot.positions.len()) {
                say!(
                    "  {robot} at {:?}, c = {:.6}, active {}",
                    snapshot.positions[robot],
                    snapshot.residuals[robot],
                    snapshot.active.contains(&robot)
                );
            }
            for route in &snapshot.routes {
                if concerned(route.from) || concerned(route.to) {
                    let flow = route.share * route.reliability;
                    say!(
                        "  {} -> {}: F {flow:.6} R {:.6}",
                        route.from,
                        route.to,
                        route.reliability
                    );
                }
            }
        })?;
    }
    Ok(())
}

/// Runs missions on all cores, and tells the first that breaks a promise.
fn many(
    first: u64,
    missions: u64,
    mission: impl Fn(u64) -> (ValidScenario, Storm) + Sync,
) -> Result<ExitCode, Box<dyn Error>> {
    let start = Instant::now();
    let last =
        first.checked_add(missions).ok_or("the last mission would have no seed: begin earlier")?;
    let (mut serviced, mut given_up) = (0, 0);
    let (mut under_way, mut broken) = (Vec::new(), Vec::new());
    let (done, failed) = (AtomicU64::new(0), AtomicU64::new(0));
    let run = |seed: u64| -> Result<(u64, Verdict), String> {
        let (scenario, storm) = mission(seed);
        let verdict = judged_run(&scenario, &storm, MOST_PERIODS);
        let breaks = verdict.as_ref().is_ok_and(|verdict| !verdict.violations.is_empty());
        let failed = failed.fetch_add(u64::from(breaks), Ordering::Relaxed) + u64::from(breaks);
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if done.is_multiple_of(STRIDE) || done == missions {
            eprint!("\r{done} of {missions} missions, {failed} broke a promise");
        }
        verdict.map(|verdict| (seed, verdict)).map_err(|error| format!("seed {seed}: {error}"))
    };
    for begin in (first..last).step_by(BATCH) {
        let batch = begin..last.min(begin.saturating_add(BATCH as u64));
        for told in batch.into_par_iter().map(run).collect::<Vec<_>>() {
            let (seed, verdict) = told?;
            match &verdict.end {
                Some(_) if is_serviced(&verdict) => serviced += 1,
                Some(_) => given_up += 1,
                None => under_way.push(seed),
            }
            if !verdict.violations.is_empty() {
                if broken.is_empty() {
                    let (scenario, storm) = mission(seed);
                    tell(&scenario, &storm, &verdict)?;
                }
                broken.push((seed, verdict.violations[0].property.name()));
            }
        }
    }
    eprintln!();
    say!(
        "{missions} missions in {:.0} s: {serviced} serviced, {given_up} given up, {} broke a promise {broken:?}",
        start.elapsed().as_secs_f64(),
        broken.len(),
    );
    if !under_way.is_empty() {
        say!("still under way after {MOST_PERIODS} control periods: seeds {under_way:?}");
    }
    Ok(if broken.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Missions that run side by side before the first that breaks a promise is told.
const BATCH: usize = 1024;
/// Missions after which progress is told.
const STRIDE: u64 = 64;

/// Tells the smallest storm that breaks the same promise.
fn tell(scenario: &ValidScenario, storm: &Storm, verdict: &Verdict) -> Result<(), Box<dyn Error>> {
    let Some(violation) = verdict.violations.first() else { return Ok(()) };
    let property = violation.property;
    let periods = violation.step + 2;
    let fails = |storm: &Storm| {
        judged_run(scenario, storm, periods).is_ok_and(|verdict| {
            verdict.violations.iter().any(|violation| violation.property == property)
        })
    };
    let smallest = shrink(storm, fails);
    let verdict = judged_run(scenario, &smallest, periods)?;
    say!("{} in {smallest:#?}", scenario.name);
    for (step, event) in &verdict.events {
        say!("k = {step:<6} {}", story::tell(event));
    }
    for violation in &verdict.violations {
        say!("{violation}");
    }
    Ok(())
}
