//! `docs/proofs.md` names every property and every lemma, and nothing else.

#[path = "../proofs/rounding/src/places.rs"]
mod places;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::sources::{files_below, manifest, read, relative, root};
use pleach::verify::network::Property;
use pleach_exploration::network::{ALWAYS, Campaign, Counts, QUICK, THOROUGH};

/// The packages that may have harnesses.
const PACKAGES: [&str; 8] =
    ["", "guards", "discrete", "continuous", "drawing", "automaton", "verify", "exploration"];

fn document() -> String {
    read("docs/proofs.md")
}

/// The rows of the tables below a heading of the document, up to the next one of its level.
fn rows<'a>(document: &'a str, heading: &str) -> Vec<&'a str> {
    let (_, chapter) = document.split_once(&format!("\n## {heading}\n")).unwrap();
    let chapter = chapter.split("\n## ").next().unwrap();
    chapter.lines().filter(|line| line.starts_with("| ")).collect()
}

/// The text and the target of the link that a row begins with.
fn link(row: &str) -> Option<(String, String)> {
    let (text, rest) = row.strip_prefix("| [")?.split_once("](../")?;
    Some((text.trim_matches('`').to_owned(), rest.split_once(')')?.0.to_owned()))
}

#[test]
fn the_document_names_every_property() {
    let document = document();
    let rows = rows(&document, "Properties and their checks");
    let named: Vec<&str> = rows.iter().map(|row| row.split(" | ").next().unwrap()).collect();
    let named: Vec<&str> = named.iter().filter_map(|cell| cell.strip_prefix("| ")).collect();
    let properties = Property::ALL.map(Property::name);
    // The first two rows are the head of the table.
    assert_eq!(named[2..], properties);
}

#[test]
fn the_document_names_every_lemma() {
    let document = document();
    let named: BTreeSet<String> = rows(&document, "Lemmas over the reals")
        .iter()
        .filter_map(|row| link(row))
        .map(|(_, target)| target)
        .collect();
    let folder = root().join("proofs/smt");
    let lemmas: BTreeSet<String> = files_below(&folder)
        .iter()
        .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".smt2"))
        .map(|name| format!("proofs/smt/{name}"))
        .collect();
    assert_eq!(named, lemmas);
    assert!(document.contains(&format!("{} lemmas proven", lemmas.len())));
}

/// The properties name lemmas, too.
#[test]
fn the_properties_name_lemmas_that_exist() {
    for row in rows(&document(), "Properties and their checks").iter().skip(2) {
        let lemmas = row.split('|').nth(3).unwrap();
        for lemma in lemmas.split(',').map(str::trim).filter(|lemma| !lemma.is_empty()) {
            let file = root().join(format!("proofs/smt/{lemma}.smt2"));
            assert!(file.exists(), "{lemma} in: {row}");
        }
    }
}

/// A property test: its file, how many cases it usually draws, and its name.
type PropertyTest = (String, u32, String);

/// The property tests of a file: those in a `proptest!` block, and those that run a strategy
/// themselves. `cases::usually` says how many cases; without it, the usual number is drawn.
fn property_tests(path: &str, source: &str) -> Vec<PropertyTest> {
    let mut found = Vec::new();
    let mut name = "";
    let mut block: Option<(&str, u32)> = None;
    for line in source.lines() {
        let code = line.trim_start();
        let indent = &line[..line.len() - code.len()];
        if let Some((_, rest)) = code.split_once("cases::usually(")
            && let Some((_, cases)) = &mut block
        {
            *cases = rest.split(')').next().unwrap().parse().unwrap();
        }
        if let Some(rest) = code.strip_prefix("fn ") {
            name = rest.split('(').next().unwrap();
        }
        match block {
            _ if code == "proptest! {" => block = Some((indent, cases::USUAL)),
            Some((begin, _)) if code == "}" && indent == begin => block = None,
            Some((_, cases)) if code.starts_with("fn ") => {
                found.push((path.to_owned(), cases, name.to_owned()));
            }
            None if code.contains("TestRunner::new(") => {
                found.push((path.to_owned(), cases::USUAL, name.to_owned()));
            }
            _ => {}
        }
    }
    found
}

#[test]
fn the_document_counts_the_property_tests_and_their_cases() {
    let folders = PACKAGES.iter().flat_map(|package| ["src", "tests"].map(|it| (package, it)));
    let mut tests = BTreeSet::new();
    for path in folders.map(|(package, it)| root().join(package).join(it)).filter(|it| it.exists())
    {
        for file in
            files_below(&path).iter().filter(|file| file.extension().is_some_and(|it| it == "rs"))
        {
            let source = fs::read_to_string(file).unwrap();
            let file = relative(file);
            // This file only speaks of property tests.
            if file != "tests/proofs.rs" {
                tests.extend(property_tests(&file, &source));
            }
        }
    }
    let document = document();
    assert!(tests.len() > 70, "the property tests are not where they are looked for");
    let count = format!("{} tests draw", tests.len());
    assert!(document.contains(&count), "docs/proofs.md should say: {count}");
    let names: BTreeSet<&str> = tests.iter().map(|(.., name)| name.as_str()).collect();
    assert_eq!(names.len(), tests.len(), "a name stands for one test");
    let drawn: u32 = tests.iter().map(|(_, cases, _)| cases).sum();
    for count in [drawn, 16 * drawn] {
        let text = format!("{} {:03} cases", count / 1000, count % 1000);
        assert!(document.contains(&text), "it should say: {text}");
    }
}

/// Every planted fault is one of the sources as they are, and a test may catch it.
#[test]
fn every_fault_applies() {
    let packages = Packages::read();
    for patch in files_below(root().join("proofs/faults")) {
        let text = fs::read_to_string(&patch).unwrap();
        let head = |key: &str| text.lines().find_map(|line| line.strip_prefix(key));
        let (run, prints) = (head("Run: cargo test -p "), head("Prints: "));
        assert!(prints.is_some(), "{}: it should say what the test prints", patch.display());
        let test = run.map(|rest| format!("-p {rest}")).filter(|it| packages.have_test_for(it));
        assert!(test.is_some(), "{}: no test for {run:?}", patch.display());
        let git = Command::new("git")
            .args(["apply", "--check", "-C1"])
            .arg(&patch)
            .current_dir(root())
            .output()
            .unwrap();
        let error = String::from_utf8_lossy(&git.stderr);
        assert!(git.status.success(), "{}: {error}", patch.display());
    }
}

/// Every place of the list is in the sources, and the document counts them.
#[test]
fn the_document_counts_the_places_of_rounding_and_each_applies() {
    let places = places::places(root()).unwrap();
    let sources = places::with_choices(root(), &places).unwrap();
    let choices: usize =
        sources.values().map(|it| it.matches("if crate::is_unrounded(").count()).sum();
    assert_eq!(choices, places.len());
    let unseen = places.iter().filter(|place| place.unseen.is_some()).count();
    let sentence = format!("{} places, a test fails at all but {unseen}", places.len());
    assert!(document().contains(&sentence), "it should say: {sentence}");
    let packages = Packages::read();
    for place in &places {
        assert!(packages.have_test_for(&place.test), "no test for {}", place.test);
    }
}

/// The names that a filter of tests may fit: of files, of folders, and of functions in sources and tests.
#[derive(Default)]
struct Names {
    files: BTreeSet<String>,
    functions: BTreeSet<String>,
}

/// The names in each package, by what it is called.
struct Packages(BTreeMap<String, Names>);

impl Packages {
    fn read() -> Self {
        let mut packages: BTreeMap<PathBuf, Names> = BTreeMap::new();
        let folders = PACKAGES.iter().flat_map(|package| ["src", "tests"].map(|it| (package, it)));
        let folders = folders.map(|(package, it)| root().join(package).join(it));
        for file in folders.filter(|folder| folder.exists()).flat_map(files_below) {
            let path = relative(&file);
            let names = packages.entry(folder_of_package(&file).to_owned()).or_default();
            let parts = Path::new(&path).with_extension("");
            names.files.extend(parts.iter().map(|part| part.to_string_lossy().into_owned()));
            let source = fs::read_to_string(&file).unwrap_or_default();
            let found = source.lines().filter_map(|line| line.trim_start().strip_prefix("fn "));
            names.functions.extend(found.filter_map(|it| Some(it.split_once('(')?.0.to_owned())));
        }
        let name = |folder: &Path| manifest(folder)["package"]["name"].as_str().unwrap().to_owned();
        Self(packages.into_iter().map(|(folder, names)| (name(&folder), names)).collect())
    }

    /// Whether the filter of a command, `-p PACKAGE ... FILTER`, fits a test of its package: it is the name of a file
    /// or a folder, or part of that of a function. A command whose filter fits nothing passes.
    fn have_test_for(&self, command: &str) -> bool {
        let package = command.split("-p ").nth(1).and_then(|rest| rest.split(' ').next());
        let filter = command.rsplit([' ', ':']).find(|part| !part.is_empty()).unwrap();
        let names = package.and_then(|package| self.0.get(package));
        names.is_some_and(|names| {
            names.files.contains(filter) || names.functions.iter().any(|it| it.contains(filter))
        })
    }
}

/// The nearest folder above a file that has a manifest: that of its package.
fn folder_of_package(file: &Path) -> &Path {
    file.ancestors().skip(1).find(|folder| folder.join("Cargo.toml").exists()).unwrap()
}

/// A number in groups of three digits.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(str::from_utf8);
    groups.collect::<Result<Vec<_>, _>>().unwrap().join(" ")
}

#[test]
fn the_document_of_the_exploration_counts_every_campaign() {
    let exploration = read("docs/exploration.md");
    let sum = |campaigns: &[&Campaign], count: fn(&Counts) -> usize| {
        grouped(campaigns.iter().map(|campaign| count(&campaign.expected)).sum())
    };
    let [quick, thorough] = [QUICK, THOROUGH].map(|campaigns| campaigns.iter().collect::<Vec<_>>());
    let counts: [fn(&Counts) -> usize; 3] =
        [|it| it.configurations, |it| it.states, |it| it.transitions];
    for (name, campaigns) in [("quick", &quick), ("thorough", &thorough)] {
        let sums = counts.map(|count| sum(campaigns, count)).join(" | ");
        let row = format!("| {name} | {} | {sums} |", campaigns.len());
        assert!(exploration.contains(&row), "docs/exploration.md should say: {row}");
    }
    assert_eq!(ALWAYS.len(), 17, "docs/proofs.md says how many properties are explored");
    let all = [quick, thorough].concat();
    let total =
        format!("{} states of {} configurations", sum(&all, counts[1]), sum(&all, counts[0]));
    assert!(document().contains(&total), "docs/proofs.md should say: {total}");
}
