//! Texts that are wrong in every way: whatever reads them answers, and never panics.
//!
//! Each input is a text of the right kind, changed at random places: parts are dropped, repeated and
//! exchanged, and numbers and words replaced. The same seed gives the same inputs.
//! `cargo run --release --example fuzz -- COUNT [SEED]` reads many.

#![allow(dead_code)] // not every program needs everything
#![allow(clippy::unwrap_used)] // texts of the project itself are read to begin with

mod alter;
mod ear;

use alter::alter;
use ear::{Ear, Listeners};
use pleach::automaton::network::record::{MissionEvent, Snapshot};
use pleach::guards::{Expression, Predicate};
use pleach::judge::judge;
use pleach::mission::{self, Watcher};
use pleach::scenario_file;
use pleach::trace::{TraceReader, TraceWriter};
use std::fmt;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// What reads a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reader {
    /// [`scenario_file::parse`], with the validation of the scenario.
    Scenario,
    /// The parser of guards.
    Predicate,
    /// The parser of expressions.
    Expression,
    /// [`TraceReader`] and the judge.
    Trace,
    /// Messages, and the nodes that hear them.
    Message,
}

impl Reader {
    pub const ALL: [Reader; 5] =
        [Reader::Scenario, Reader::Predicate, Reader::Expression, Reader::Trace, Reader::Message];

    /// Whether the text can be read.
    fn accepts(self, text: &str, listeners: &Listeners) -> bool {
        match self {
            Reader::Message => listeners.hear(text),
            Reader::Scenario => scenario_file::parse(text, Path::new("fuzz.toml")).is_ok(),
            Reader::Predicate => text.parse::<Predicate>().is_ok(),
            Reader::Expression => text.parse::<Expression>().is_ok(),
            Reader::Trace => {
                TraceReader::new(text.as_bytes()).is_ok_and(|trace| judge(trace).is_ok())
            }
        }
    }

    /// Texts that it can read.
    fn samples(self, overheard: &[String]) -> Vec<String> {
        let owned = |texts: &[&str]| texts.iter().map(|&text| text.to_owned()).collect();
        match self {
            Reader::Scenario => ["scenarios/too-few.toml", "tests/scenarios/room.toml"]
                .map(|path| std::fs::read_to_string(path).unwrap())
                .into(),
            Reader::Predicate => owned(&[
                "x <= 1 && y >= 2 || !(z < 3)",
                "not always and `a name` or x + 2 · y² ≥ −∞",
                "min(x, y) < abs(z) ∧ ¬never",
            ]),
            Reader::Expression => owned(&[
                "x^2 - 1e-3*y^-1 + sqrt(|z|) / 2",
                "max(x, 2 · (y − 3)) ÷ −x⁻²",
                "sin(x) * cos(y) - exp(-t)",
            ]),
            Reader::Trace => vec![short_trace()],
            Reader::Message => overheard.to_vec(),
        }
    }
}

/// What became of the inputs of one reader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub read: u64,
    pub refused: u64,
}

/// An input on which a reader panics.
#[derive(Clone, Debug)]
pub struct Panic {
    pub reader: Reader,
    pub text: String,
}

impl fmt::Display for Panic {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:?} panics on:\n{}", self.reader, self.text)
    }
}

/// Has a reader read `count` inputs.
///
/// # Errors
/// The first input on which it panics.
pub fn read(reader: Reader, seed: u64, count: u64) -> Result<Tally, Panic> {
    let (listeners, overheard) = Ear::listen();
    let samples = reader.samples(&overheard);
    let mut tally = Tally::default();
    for number in 0..count {
        let text = alter(&samples, &[reader as u64, seed, number]);
        match catch_unwind(AssertUnwindSafe(|| reader.accepts(&text, &listeners))) {
            Ok(true) => tally.read += 1,
            Ok(false) => tally.refused += 1,
            Err(_) => return Err(Panic { reader, text }),
        }
    }
    Ok(tally)
}

/// The trace of the first control periods of a mission.
fn short_trace() -> String {
    struct Impatient(usize);

    impl Watcher for Impatient {
        fn observe(&mut self, _: &Snapshot, _: &[MissionEvent]) -> io::Result<()> {
            self.0 += 1;
            Ok(())
        }

        fn interruption(&self) -> Option<String> {
            (self.0 > 3).then(|| "enough is seen".to_owned())
        }
    }

    let scenario = scenario_file::read(Path::new("scenarios/too-few.toml")).unwrap();
    let mut writer = TraceWriter::new(Vec::new(), &scenario).unwrap();
    mission::run(&scenario, &mut [&mut writer, &mut Impatient(0)]).unwrap();
    String::from_utf8(writer.finish().unwrap()).unwrap()
}
