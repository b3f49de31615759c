//! Plants faults in a copy of the sources, and sees whether the checks fail.
//!
//! ```text
//! proofs/check faults             all
//! proofs/check faults NAME...     these
//! proofs/check rounding
//! ```
//!
//! The faults are those of `proofs/faults.toml`; `docs/proofs.md` says what came of them. A fault is caught if its command
//! fails and says what it should. Of all faults, most are [woven](weaving) into one build, and switched on one after the
//! other; the others, and those that are named, are planted alone, each in a build of its own. With `rounding`, rounding
//! outward is left out at each place of `proofs/rounding.toml` instead. The copy, what is built of it and what each command
//! said stay in `faults`, a folder beside what cargo builds.

mod catalogue;
mod rounding;
mod verdict;
mod weaving;
mod workshop;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;
use std::{env, io};

use catalogue::{CatalogueError, Fault, faults};
use rounding::places;
use verdict::Verdict;
use weaving::Numbered;
use workshop::Workshop;

/// Why the faults cannot be planted.
#[derive(Debug, thiserror::Error)]
enum Error {
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("there is no fault “{0}” in proofs/faults.toml")]
    Unknown(String),
    #[error("`cargo {0}` fails although no fault is in effect")]
    FailsAnyway(String),
    #[error("{file}: {source}")]
    Syntax { file: String, source: syn::Error },
    #[error("what cargo says cannot be read: {0}")]
    Json(#[from] serde_json::Error),
    #[error("the copy does not build, whatever is left out:\n{0}")]
    Build(String),
}

fn main() -> Result<ExitCode, Error> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize()?;
    let workshop = Workshop::new(&root);
    let names: Vec<String> = env::args().skip(1).collect();
    if names == ["rounding"] {
        return leave_out_rounding(&root, &workshop);
    }
    let all = faults(&root)?;
    let numbered: Vec<Numbered> = (1..).zip(&all).collect();
    let mut report = Report::default();
    if names.is_empty() {
        plant_all(&workshop, &numbered, &mut report)?;
    }
    for (_, fault) in named(&numbered, &names)? {
        report.enter(fault, || workshop.try_alone(fault))?;
    }
    println!("{} faults, {} of them caught", report.planted, report.caught);
    Ok(if report.is_clean() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Plants as many faults as possible in one build, and each of the others alone.
fn plant_all(workshop: &Workshop, faults: &[Numbered], report: &mut Report) -> Result<(), Error> {
    let alone = workshop.weave(faults)?;
    println!("{} faults in one build, {} alone", faults.len() - alone.len(), alone.len());
    let (alone, woven): (Vec<Numbered>, Vec<Numbered>) =
        faults.iter().partition(|(number, _)| alone.contains(number));
    let mut programs: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (_, fault) in &woven {
        let (program, tests) = fault.command.rsplit_once(' ').unwrap_or((&fault.command, ""));
        programs.entry(program).or_default().insert(tests);
    }
    for (program, tests) in programs {
        let tests: Vec<&str> = tests.into_iter().collect();
        workshop.passes(&format!("{program} -- {}", tests.join(" ")))?;
    }
    for one in woven {
        report.enter(one.1, || workshop.try_woven(one))?;
    }
    for (_, fault) in alone {
        report.enter(fault, || workshop.try_alone(fault))?;
    }
    Ok(())
}

/// Leaves out rounding at one place after the other, and sees whether tests fail.
fn leave_out_rounding(root: &Path, workshop: &Workshop) -> Result<ExitCode, Error> {
    let places = places(root)?;
    workshop.plant_choices(&places)?;
    let (mut seen, mut unseen, mut wrong) = (0, 0, 0);
    for (number, place) in places.iter().enumerate() {
        let fails = workshop.fails_unrounded(number, place)?;
        match (fails, &place.unseen) {
            (true, None) => seen += 1,
            (false, Some(_)) => unseen += 1,
            (fails, _) => {
                wrong += 1;
                let what = if fails { "SEEN AFTER ALL" } else { "NOT SEEN" };
                println!("{what}: {}: {}", place.file, place.before);
            }
        }
    }
    println!("{} places: {seen} seen, {unseen} lawful, {wrong} not as the list says", places.len());
    Ok(if wrong == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The faults with these names.
fn named<'a>(all: &[Numbered<'a>], names: &[String]) -> Result<Vec<Numbered<'a>>, Error> {
    let find = |name: &String| {
        let found = all.iter().find(|(_, fault)| fault.name == *name);
        found.copied().ok_or_else(|| Error::Unknown(name.clone()))
    };
    names.iter().map(find).collect()
}

/// How many faults have been planted, and how many of them caught.
#[derive(Default)]
struct Report {
    planted: usize,
    caught: usize,
}

impl Report {
    /// Plants a fault, and prints what becomes of it.
    fn enter(
        &mut self,
        fault: &Fault,
        plant: impl FnOnce() -> Result<Verdict, Error>,
    ) -> Result<(), Error> {
        let begin = Instant::now();
        let verdict = plant()?;
        self.planted += 1;
        self.caught += usize::from(verdict == Verdict::Caught);
        let seconds = begin.elapsed().as_secs();
        println!("{verdict}: {} ({}, {seconds} s)", fault.name, fault.engine);
        println!("    {}", fault.wrong);
        Ok(())
    }

    fn is_clean(&self) -> bool {
        self.caught == self.planted
    }
}
