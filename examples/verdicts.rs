//! Runs missions in small rooms, and writes down those that say what is not so.
//!
//! `cargo run --release --example verdicts -- rooms FIRST_SEED COUNT [FOLDER]` compares what missions say of tasks that
//! they do not service with a search for an arrangement; `settings` in the place of `rooms` looks for violated
//! invariants where settings are at the ends of their ranges. The scenarios are written to the folder, with an index.

use clap::{Parser, ValueEnum};
use missions::floor_plans::{edge_settings, small_room};
use missions::verdicts::{Falsehood, verdict, violation};
use pleach::automaton::network::scenario::ValidScenario;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::PathBuf;

/// Looks for missions in small rooms that say what is not so
#[derive(Parser)]
struct Arguments {
    /// What is drawn
    drawn: Draw,
    /// The seed of the first room
    first: u64,
    /// How many rooms
    count: u64,
    /// Where scenarios with falsehoods are written
    folder: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Draw {
    /// Rooms with few robots
    Rooms,
    /// Settings at the ends of their ranges
    Settings,
}

impl Draw {
    fn scenario(self, seed: u64) -> ValidScenario {
        match self {
            Draw::Rooms => small_room(seed),
            Draw::Settings => edge_settings(seed),
        }
    }

    /// How the mission with this seed ends, and what is false about that.
    fn examined(self, seed: u64) -> (String, Vec<Falsehood>) {
        let scenario = self.scenario(seed);
        match self {
            Draw::Rooms => {
                let verdict = verdict(&scenario);
                let open = if verdict.open > 0 { ", open" } else { "" };
                (format!("{}{open}", verdict.outcome.name()), verdict.falsehoods)
            }
            Draw::Settings => {
                let (outcome, falsehood) = violation(&scenario);
                (outcome, falsehood.into_iter().collect())
            }
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { drawn, first, count, folder } = Arguments::parse();
    let seeds = first..first.saturating_add(count);
    let examined: Vec<(u64, (String, Vec<Falsehood>))> =
        seeds.into_par_iter().map(|seed| (seed, drawn.examined(seed))).collect();
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut index = String::new();
    for (seed, (outcome, falsehoods)) in &examined {
        *counts.entry(outcome.clone()).or_default() += 1;
        if falsehoods.is_empty() {
            continue;
        }
        let scenario = drawn.scenario(*seed);
        for falsehood in falsehoods {
            *counts.entry(format!("false: {}", falsehood.kind)).or_default() += 1;
            index += &format!("\n{}: {falsehood}\n", scenario.name);
        }
        if let Some(folder) = &folder {
            std::fs::create_dir_all(folder)?;
            let file = folder.join(format!("{}.toml", scenario.name));
            std::fs::write(file, toml::to_string(scenario.scenario())?)?;
        }
    }
    let counts: String = counts.iter().map(|(what, count)| format!("{count:5} {what}\n")).collect();
    let report = format!("{} missions from seed {first} on\n{counts}{index}", examined.len());
    print!("{report}");
    if let Some(folder) = &folder {
        std::fs::write(folder.join("index.txt"), &report)?;
    }
    Ok(())
}
