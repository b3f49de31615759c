//! Mutation testing with every mutant in one build, each behind a switch.
//!
//! ```text
//! cargo run -p mutants -- PACKAGE [PART OF A PATH]...
//! ```
//!
//! cargo-mutants says which mutants there are. They are woven into a copy of the workspace, which is built once.
//! Each test then tells which mutants it reaches, and each mutant is run with the tests of its own package that
//! reach it. The copy stays in `target/mutants`.

mod building;
mod listing;
mod running;
mod weaving;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, io, thread};

use clap::Parser;

use building::Copy;
use listing::{Mutant, mutants};
use running::{Outcome, tests, try_out};

/// Runs the tests of a package with each of its mutants.
#[derive(Parser)]
struct Arguments {
    /// The package, such as `pleach-guards`
    package: String,
    /// Only files with one of these in their path
    parts: Vec<String>,
    /// Mutants that are run at the same time
    #[arg(long, default_value_t = 1)]
    jobs: usize,
    /// Tests with one of these in their name are not run
    #[arg(long)]
    skip: Vec<String>,
    /// Only a sample: every so manieth mutant
    #[arg(long, default_value_t = 1)]
    one_in: usize,
    /// Only mutants that are named in this file, one a line
    #[arg(long)]
    only: Option<PathBuf>,
}

/// Why mutants cannot be run.
#[derive(Debug, thiserror::Error)]
enum Error {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("what a tool says cannot be read: {0}")]
    Json(#[from] serde_json::Error),
    #[error("cargo mutants --list: {0}")]
    Listing(String),
    #[error("{file}: {source}")]
    Syntax { file: String, source: syn::Error },
    #[error("the package does not build, whatever is left out:\n{0}")]
    Build(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    Unviable,
    NoSwitch,
    Caught,
    TimedOut,
    Unreached,
    Survived,
}

fn main() -> Result<ExitCode, Error> {
    let arguments = Arguments::parse();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let root = root.canonicalize()?;
    let mut mutants = mutants(&root, &arguments.package, &arguments.parts)?;
    if let Some(only) = &arguments.only {
        let names = fs::read_to_string(only)?;
        mutants.retain(|mutant| names.lines().any(|name| name.ends_with(&mutant.name)));
    }
    let mutants: Vec<Mutant> = mutants.into_iter().step_by(arguments.one_in.max(1)).collect();
    eprintln!("{} mutants", mutants.len());
    let place = root.join("target/mutants").join(&arguments.package);
    let copy = Copy::of(&root, place, &arguments.package, &mutants)?;
    let built = copy.build(&mutants)?;
    let folder = copy.package_folder();
    let tests = tests(&built.programs, &folder, &arguments.skip)?;
    eprintln!("{} tests", tests.len());
    let next = AtomicUsize::new(1);
    let verdicts: Mutex<BTreeMap<usize, Verdict>> = Mutex::default();
    thread::scope(|scope| {
        let work = || -> Result<(), Error> {
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(mutant) = mutants.get(number - 1) else { return Ok(()) };
                let verdict = if built.unviable.contains(&number) {
                    Verdict::Unviable
                } else if built.fixed.contains(&number) {
                    println!("NO SWITCH {}", mutant.name);
                    Verdict::NoSwitch
                } else if tests.iter().all(|test| !test.reaches.contains(&number)) {
                    println!("UNREACHED {}", mutant.name);
                    Verdict::Unreached
                } else {
                    let (outcome, by) = try_out(number, &tests, &folder)?;
                    let verdict = match outcome {
                        Outcome::Passed => Verdict::Survived,
                        Outcome::Failed => Verdict::Caught,
                        Outcome::TimedOut => Verdict::TimedOut,
                    };
                    match verdict {
                        Verdict::Survived => println!("SURVIVED {}", mutant.name),
                        _ => eprintln!("{verdict:?} {} by {by}", mutant.name),
                    }
                    verdict
                };
                verdicts.lock().expect("no thread panics").insert(number, verdict);
            }
        };
        let workers: Vec<_> = (0..arguments.jobs).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| worker.join().expect("no thread panics"))
    })?;
    report(&mutants, &verdicts.into_inner().expect("no thread panics"));
    Ok(ExitCode::SUCCESS)
}

fn report(mutants: &[Mutant], verdicts: &BTreeMap<usize, Verdict>) {
    let mut files: BTreeMap<&str, BTreeMap<Verdict, usize>> = BTreeMap::new();
    for (number, verdict) in verdicts {
        for row in [&*mutants[number - 1].file, "~ all"] {
            *files.entry(row).or_default().entry(*verdict).or_default() += 1;
        }
    }
    println!(
        "| file | mutants | unviable | no switch | caught | timed out | unreached | survived |"
    );
    for (file, counts) in files {
        let count = |verdict| counts.get(&verdict).copied().unwrap_or(0);
        let all: usize = counts.values().sum();
        println!(
            "| {file} | {all} | {} | {} | {} | {} | {} | {} |",
            count(Verdict::Unviable),
            count(Verdict::NoSwitch),
            count(Verdict::Caught),
            count(Verdict::TimedOut),
            count(Verdict::Unreached),
            count(Verdict::Survived),
        );
    }
}
