//! Runs many random missions and tells what became of them, family by family.
//!
//! `cargo run --release --example outcomes -- MISSIONS [FOLDER]` runs so many of each family (a tenth
//! as many of the halls, which take fifty times as long) and prints a table:
//!
//! - *serviced*, *proved* and *unproved*: all tasks were serviced; robots were too few, by a bound that
//!   rests on lengths alone ([`Spans`]); they were too few by that bound or not, and the mission ended
//!   all the same. *Bad* are ends that must not be: blocked, out of time, in violation, in error.
//! - *robots*: of the missions that are serviced, those robots that are not redundant at the end, as a
//!   multiple of a spanning tree of the access points and tasks over d_build, median and worst.
//! - *time*: their control periods, as a multiple of the ways from access points to all tasks at full
//!   speed, one after the other, median and worst.
//!
//! With a folder, scenarios that are not serviced are written there.

#[path = "../tests/floor_plans/mod.rs"]
mod floor_plans;

use clap::Parser;
use floor_plans::{Family, scenario};
use pleach::automaton::network::record::{MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::discrete::network::Role;
use pleach::mission::{Watcher, run};
use pleach::verify::network::Spans;
use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

/// Runs random missions and tells what became of them, family by family
#[derive(Parser)]
struct Arguments {
    /// How many of each family, and a tenth as many of the halls
    missions: u64,
    /// Where scenarios that are not serviced are written
    folder: Option<PathBuf>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { missions, folder } = Arguments::parse();
    if let Some(folder) = &folder {
        std::fs::create_dir_all(folder)?;
    }
    let folder = folder.as_deref();
    println!(
        "family        missions serviced proved unproved  bad   robots median worst   time median worst"
    );
    let mut all = Vec::new();
    for family in Family::ALL.into_iter().chain(Family::WINDING) {
        let count = if family == Family::Hall { missions.div_ceil(10) } else { missions };
        let mut results = Vec::new();
        for seed in 1..=count {
            results.push(mission(&scenario(family, seed), folder)?);
        }
        println!("{}", row(family.name(), &results));
        all.extend(results);
    }
    println!("{}", row("all", &all));
    Ok(())
}

/// What became of a mission.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// With what robots and time amount to, as multiples of their bounds.
    Serviced { robots: f64, time: f64 },
    /// Too few robots, and whether that is proved.
    Insufficient { proved: bool },
    /// It must not end like this.
    Bad,
}

/// Counts the control periods, and the robots that a mission uses.
#[derive(Default)]
struct Usage {
    periods: usize,
    robots: usize,
    tasks: usize,
}

impl Watcher for Usage {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        self.periods = snapshot.step;
        self.robots = snapshot.roles.iter().filter(|&&role| role != Role::Redundant).count();
        let announced = |event: &&MissionEvent| matches!(event, MissionEvent::TaskAnnounced { .. });
        self.tasks += events.iter().filter(announced).count();
        Ok(())
    }
}

fn mission(scenario: &ValidScenario, folder: Option<&Path>) -> Result<End, Box<dyn Error>> {
    let spans = Spans::of(scenario)?;
    let mut usage = Usage::default();
    let (outcome, reason) = match run(scenario, &mut [&mut usage]) {
        Ok(completed) => (Some(completed.end.outcome), completed.end.reason),
        Err(error) => (None, error.to_string()),
    };
    let tasks = scenario.task.len();
    let end = match outcome {
        Some(Outcome::Serviced) => {
            let links = spans.spanning_tree(tasks) / scenario.site().usual.build;
            let ways: f64 = (0..tasks).map(|task| spans.way_to(task)).sum();
            let periods = ways / scenario.site().settings.step_radius;
            End::Serviced {
                robots: usage.robots as f64 / links.max(tasks as f64),
                time: usage.periods as f64 / periods.max(1.0),
            }
        }
        Some(Outcome::InsufficientRobots) => {
            let least = spans.least_robots(usage.tasks);
            End::Insufficient { proved: least.is_none_or(|least| least > scenario.robot.len()) }
        }
        _ => End::Bad,
    };
    if !matches!(end, End::Serviced { .. }) {
        eprintln!("{}: {end:?}: {reason}", scenario.name);
        if let Some(folder) = folder {
            let text = toml::to_string(scenario.scenario())?;
            std::fs::write(folder.join(format!("{}.toml", scenario.name)), text)?;
        }
    }
    Ok(end)
}

fn row(name: &str, results: &[End]) -> String {
    let count = |fits: &dyn Fn(&End) -> bool| results.iter().filter(|end| fits(end)).count();
    let sorted = |of: &dyn Fn(&End) -> Option<f64>| {
        let mut values: Vec<f64> = results.iter().filter_map(of).collect();
        values.sort_by(f64::total_cmp);
        let median = values.get(values.len() / 2).copied().unwrap_or(f64::NAN);
        (median, values.last().copied().unwrap_or(f64::NAN))
    };
    let robots = sorted(&|end| match end {
        End::Serviced { robots, .. } => Some(*robots),
        _ => None,
    });
    let time = sorted(&|end| match end {
        End::Serviced { time, .. } => Some(*time),
        _ => None,
    });
    format!(
        "{name:13} {:8} {:8} {:6} {:8} {:4}          {:5.2} {:5.2}        {:5.2} {:5.2}",
        results.len(),
        count(&|end| matches!(end, End::Serviced { .. })),
        count(&|end| *end == End::Insufficient { proved: true }),
        count(&|end| *end == End::Insufficient { proved: false }),
        count(&|end| *end == End::Bad),
        robots.0,
        robots.1,
        time.0,
        time.1,
    )
}
