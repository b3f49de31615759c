//! Runs random missions and prints a line for each.
//!
//! `cargo run --release --example stress -- FAMILY FIRST_SEED COUNT [FOLDER]`, with `all` for
//! every family; scenarios that are not serviced are written to the folder.

use clap::Parser;
use missions::floor_plans::{Family, scenario};
use missions::redundant;
use pleach::automaton::network::record::{MissionEvent, Outcome, Snapshot};
use pleach::mission::{Watcher, run};
use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Remembers how things stand.
#[derive(Default)]
struct LastSight {
    step: usize,
    /// When something was reported last.
    eventful: usize,
    redundant: usize,
}

impl Watcher for LastSight {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        self.step = snapshot.step;
        if !events.is_empty() {
            self.eventful = snapshot.step;
        }
        self.redundant = redundant(snapshot);
        Ok(())
    }
}

/// Runs random missions and prints a line for each
#[derive(Parser)]
struct Arguments {
    /// The name of a family, or `all`
    #[arg(value_parser = families)]
    families: Families,
    /// The seed of the first mission
    first: u64,
    /// How many missions of each family
    count: u64,
    /// Where scenarios that are not serviced are written
    folder: Option<PathBuf>,
}

#[derive(Clone)]
struct Families(Vec<Family>);

fn families(name: &str) -> Result<Families, String> {
    let named = |known: &Family| name == "all" || name == known.name();
    let found: Vec<Family> = Family::ALL.into_iter().filter(named).collect();
    match found.is_empty() {
        false => Ok(Families(found)),
        true => {
            let names = Family::ALL.map(|family| family.name());
            Err(format!("no family has this name; there are: all, {}", names.join(", ")))
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { families: Families(families), first, count, folder } = Arguments::parse();
    if let Some(folder) = &folder {
        std::fs::create_dir_all(folder)?;
    }
    for family in families {
        for seed in first..first.saturating_add(count) {
            mission(family, seed, folder.as_deref())?;
        }
    }
    Ok(())
}

fn mission(family: Family, seed: u64, folder: Option<&Path>) -> Result<(), Box<dyn Error>> {
    let scenario = scenario(family, seed);
    let mut sight = LastSight::default();
    let start = Instant::now();
    let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        run(&scenario, &mut [&mut sight]).map_err(|error| error.to_string())
    }));
    let (outcome, reason) = match caught {
        Ok(Ok(completed)) => (format!("{:?}", completed.end.outcome), completed.end.reason),
        Ok(Err(error)) => ("Error".to_owned(), error),
        Err(_) => ("Panic".to_owned(), String::new()),
    };
    println!(
        "{:12} {seed:4} {outcome:18} steps {:5} (eventful until {:5}) {:6.1} s, {} robots, {} \
         redundant left, {} tasks. {reason}",
        family.name(),
        sight.step,
        sight.eventful,
        start.elapsed().as_secs_f64(),
        scenario.robot.len(),
        sight.redundant,
        scenario.task.len(),
    );
    if outcome != format!("{:?}", Outcome::Serviced)
        && let Some(folder) = folder
    {
        std::fs::write(
            folder.join(format!("{}.toml", scenario.name)),
            toml::to_string(scenario.scenario())?,
        )?;
    }
    Ok(())
}
