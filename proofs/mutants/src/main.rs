//! Mutation testing with every mutant in one build, each behind a switch.
//!
//! ```text
//! proofs/check mutants PACKAGE [PART OF A PATH]...
//! ```
//!
//! cargo-mutants says which mutants there are. They are [woven](weaving) into a copy of the workspace, which is
//! [built](building) once. Each test then tells which mutants it reaches, and each mutant is [run](running)
//! with the tests of its own package that reach it, the quickest first, until one fails. Mutants that no
//! test fails for are named. The copy, and what is built of it, stay in `target/mutants`.

mod building;
mod listing;
mod report;
mod running;
mod weaving;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, io, thread};

use clap::Parser;

use building::{Built, Copy};
use listing::{Mutant, mutants};
use report::Report;
use running::{Test, tests, try_out};

/// Runs the tests of a package with each of its mutants
#[derive(Parser)]
struct Arguments {
    /// The package, such as `pleach-automaton`
    package: String,
    /// Only files with one of these in their path
    parts: Vec<String>,
    /// How many mutants are run at the same time
    #[arg(long, default_value_t = 1)]
    jobs: usize,
    /// Tests with this in their name are not run
    #[arg(long)]
    skip: Vec<String>,
    /// Runs a sample, one mutant in this many
    #[arg(long, default_value_t = 1)]
    one_in: u64,
    /// Another seed draws another sample
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Only the mutants whose names stand at the ends of lines of this file
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
    #[error("{0} has no mutants there")]
    Nothing(String),
    #[error("{file}: {source}")]
    Syntax { file: String, source: syn::Error },
    #[error("the package does not build, whatever is left out:\n{0}")]
    Build(String),
    #[error("{0} fails although no mutant is switched on")]
    Fails(String),
}

fn main() -> Result<ExitCode, Error> {
    let arguments = Arguments::parse();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize()?;
    let mutants = chosen(&root, &arguments)?;
    println!("{} mutants", mutants.len());
    let copy = Copy::of(&root, &arguments.package, &mutants)?;
    let built = copy.build(&mutants)?;
    let tests = tests(&built.programs, &copy.package_folder(), &arguments.skip)?;
    println!("{} tests", tests.len());
    let report = run_all(&mutants, &built, &tests, &copy.package_folder(), arguments.jobs)?;
    print!("{report}");
    Ok(if report.is_clean() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The mutants that are asked for.
fn chosen(root: &Path, arguments: &Arguments) -> Result<Vec<Mutant>, Error> {
    let mut mutants = mutants(root, &arguments.package, &arguments.parts)?;
    if let Some(only) = &arguments.only {
        let names = fs::read_to_string(only)?;
        mutants.retain(|mutant| names.lines().any(|line| line.ends_with(&mutant.name)));
    }
    mutants.retain(|mutant| is_drawn(mutant, arguments.one_in, arguments.seed));
    if mutants.is_empty() { Err(Error::Nothing(arguments.package.clone())) } else { Ok(mutants) }
}

/// Whether a mutant is in the sample, which its name and the seed decide.
fn is_drawn(mutant: &Mutant, one_in: u64, seed: u64) -> bool {
    let mut hasher = DefaultHasher::new();
    (seed, &mutant.name).hash(&mut hasher);
    hasher.finish().is_multiple_of(one_in.max(1))
}

/// What becomes of each mutant, with its name where no test fails for it.
fn run_all(
    mutants: &[Mutant],
    built: &Built,
    tests: &[Test],
    folder: &Path,
    jobs: usize,
) -> Result<Report, Error> {
    let next = AtomicUsize::new(0);
    let report = Mutex::new(Report::default());
    let work = || -> Result<(), Error> {
        while let Some(mutant) = mutants.get(next.fetch_add(1, Ordering::Relaxed)) {
            let verdict = match built.unusable.get(&mutant.number) {
                Some(&verdict) => verdict,
                None => try_out(mutant.number, tests, folder)?,
            };
            report.lock().expect("no thread panics").enter(mutant, verdict);
        }
        Ok(())
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..jobs.max(1)).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| worker.join().expect("no thread panics"))
    })?;
    Ok(report.into_inner().expect("no thread panics"))
}
