//! What has become of the mutants, file by file.

use std::collections::BTreeMap;
use std::fmt;

use crate::listing::Mutant;

/// What has become of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// It does not compile.
    Unviable,
    /// It cannot stand behind a switch: in a constant, or as another type of iterator.
    NoSwitch,
    /// A test fails.
    Caught,
    /// A test does not end.
    TimedOut,
    /// No test comes where it is.
    Unreached,
    /// No test fails.
    Survived,
}

impl Verdict {
    const ALL: [Verdict; 6] = [
        Verdict::Unviable,
        Verdict::NoSwitch,
        Verdict::Caught,
        Verdict::TimedOut,
        Verdict::Unreached,
        Verdict::Survived,
    ];

    const fn name(self) -> &'static str {
        match self {
            Verdict::Unviable => "unviable",
            Verdict::NoSwitch => "no switch",
            Verdict::Caught => "caught",
            Verdict::TimedOut => "timed out",
            Verdict::Unreached => "unreached",
            Verdict::Survived => "survived",
        }
    }
}

/// How many mutants of each file have met which end.
#[derive(Default)]
pub struct Report {
    files: BTreeMap<String, BTreeMap<Verdict, usize>>,
}

impl Report {
    /// Enters a mutant, and names it if no test has failed for it: one that did not end may have had no time to,
    /// and can be run again.
    pub fn enter(&mut self, mutant: &Mutant, verdict: Verdict) {
        if !matches!(verdict, Verdict::Unviable | Verdict::Caught) {
            println!("{}: {}", verdict.name(), mutant.name);
        }
        *self.files.entry(mutant.file.clone()).or_default().entry(verdict).or_default() += 1;
    }

    /// Whether a test has failed for each mutant that has run.
    pub fn is_clean(&self) -> bool {
        let lives = |counts: &BTreeMap<Verdict, usize>| {
            counts.contains_key(&Verdict::Unreached) || counts.contains_key(&Verdict::Survived)
        };
        !self.files.values().any(lives)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = Verdict::ALL.map(Verdict::name).join(" | ");
        writeln!(f, "| file | mutants | {names} |\n|{}", " --- |".repeat(2 + Verdict::ALL.len()))?;
        let mut all = BTreeMap::new();
        for (file, counts) in &self.files {
            row(f, file, counts)?;
            for (verdict, count) in counts {
                *all.entry(*verdict).or_default() += count;
            }
        }
        row(f, "all", &all)
    }
}

fn row(f: &mut fmt::Formatter<'_>, name: &str, counts: &BTreeMap<Verdict, usize>) -> fmt::Result {
    write!(f, "| {name} | {} |", counts.values().sum::<usize>())?;
    for verdict in Verdict::ALL {
        write!(f, " {} |", counts.get(&verdict).unwrap_or(&0))?;
    }
    writeln!(f)
}
