//! A copy of the workspace in which the mutants of a package are woven in, and its test programs.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde::Deserialize;

use crate::Error;
use crate::listing::Mutant;
use crate::weaving::{SWITCHES, Woven, woven};

/// Where the manifest of the workspace says what the compiler objects to, and what it says there of mutants
/// that overflow: they are run.
const LINTS: &str = "[workspace.lints.rust]\n";
const LENIENT: &str = "arithmetic_overflow = \"allow\"\nunconditional_panic = \"allow\"\n";

/// The copy.
pub struct Copy {
    root: PathBuf,
    target: PathBuf,
    package: String,
    /// The folder of the package in the workspace.
    folder: String,
    /// What the files are without mutants.
    originals: BTreeMap<String, String>,
}

/// What has come of building.
pub struct Built {
    pub programs: Vec<PathBuf>,
    /// The mutants that do not compile.
    pub unviable: BTreeSet<usize>,
    /// Those that might, and cannot be behind a switch.
    pub fixed: BTreeSet<usize>,
}

impl Copy {
    /// Copies the files of the workspace `root` that are under version control or about to be.
    pub fn of(root: &Path, to: PathBuf, package: &str, mutants: &[Mutant]) -> Result<Self, Error> {
        let list = Command::new("git")
            .current_dir(root)
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .output()?;
        let names = String::from_utf8_lossy(&list.stdout).into_owned();
        for name in names
            .split_terminator('\0')
            .filter(|name| root.join(name).is_file() && *name != "Cargo.toml")
        {
            write_if_changed(&to.join(name), &fs::read(root.join(name))?)?;
        }
        let manifest = fs::read_to_string(root.join("Cargo.toml"))?;
        let manifest = manifest.replace(LINTS, &[LINTS, LENIENT].concat());
        write_if_changed(&to.join("Cargo.toml"), manifest.as_bytes())?;
        let folder = mutants.first().and_then(|mutant| mutant.file.split_once("/src/"));
        let folder = folder.map(|(folder, _)| folder.to_owned()).unwrap_or_default();
        let mut originals = BTreeMap::new();
        for file in mutants.iter().map(|mutant| &mutant.file) {
            originals.insert(file.clone(), fs::read_to_string(root.join(file))?);
        }
        let library = format!("{folder}/src/lib.rs");
        originals.insert(library.clone(), fs::read_to_string(root.join(&library))?);
        Ok(Copy {
            root: to,
            target: root.join("target"),
            package: package.to_owned(),
            folder,
            originals,
        })
    }

    /// The folder in which the tests of the package run.
    pub fn package_folder(&self) -> PathBuf {
        self.root.join(&self.folder)
    }

    /// Builds the tests with all mutants that compile, leaving out those that the compiler complains of until
    /// it does no more. Numbers of mutants begin with one.
    pub fn build(&self, mutants: &[Mutant]) -> Result<Built, Error> {
        let (mut unviable, mut fixed) = (BTreeSet::new(), BTreeSet::new());
        for step in [&["check", "--lib"][..], &["test", "--no-run", "--lib", "--tests"]] {
            loop {
                let files = self.weave(mutants, &(&unviable | &fixed))?;
                let said = self.cargo(step)?;
                let errors = said.iter().filter_map(|line| line.message.as_ref());
                let errors: Vec<_> = errors.filter(|message| message.level == "error").collect();
                if errors.is_empty() {
                    let programs: Vec<PathBuf> =
                        said.into_iter().filter_map(|line| line.executable).collect();
                    if step[0] == "test" {
                        let woven: BTreeSet<usize> =
                            files.values().flat_map(Woven::mutants).collect();
                        let is_left = |number: &usize| !unviable.contains(number);
                        fixed = (1..=mutants.len())
                            .filter(is_left)
                            .collect::<BTreeSet<_>>()
                            .difference(&woven)
                            .copied()
                            .collect();
                        return Ok(Built { programs, unviable, fixed });
                    }
                    break;
                }
                let known = unviable.len() + fixed.len();
                for error in &errors {
                    for span in error.spans.iter().filter(|span| span.is_primary) {
                        let woven = files.get(&span.file_name);
                        let at_fault = woven.and_then(|woven| woven.at(span.byte_start));
                        match at_fault {
                            Some([mutant]) if !error.needs_constants() => {
                                unviable.extend([*mutant])
                            }
                            Some(mutants) => fixed.extend(mutants),
                            None => {}
                        };
                    }
                }
                eprintln!(
                    "{} errors: {} unviable, {} without a switch",
                    errors.len(),
                    unviable.len(),
                    fixed.len()
                );
                if unviable.len() + fixed.len() == known {
                    let all: Vec<&str> = errors.iter().map(|error| &*error.rendered).collect();
                    return Err(Error::Build(all.join("\n")));
                }
            }
        }
        unreachable!("the last step returns")
    }

    /// Writes all files with the mutants that are not known to be unviable.
    fn weave(
        &self,
        mutants: &[Mutant],
        unviable: &BTreeSet<usize>,
    ) -> Result<BTreeMap<String, Woven>, Error> {
        let mut files = BTreeMap::new();
        for (file, original) in &self.originals {
            let numbered = mutants.iter().enumerate().map(|(place, mutant)| (place + 1, mutant));
            let here: Vec<(usize, &Mutant)> = numbered
                .filter(|(number, mutant)| mutant.file == *file && !unviable.contains(number))
                .collect();
            let woven = woven(file, original, &here)?;
            let added = if file.ends_with("src/lib.rs") { SWITCHES } else { "" };
            let text = [&woven.text, added].concat();
            write_if_changed(&self.root.join(file), text.as_bytes())?;
            files.insert(file.clone(), woven);
        }
        Ok(files)
    }

    /// What cargo says of the package.
    fn cargo(&self, step: &[&str]) -> Result<Vec<Line>, Error> {
        let output = Command::new("cargo")
            .current_dir(&self.root)
            .env("CARGO_TARGET_DIR", &self.target)
            .args(step)
            .args(["--quiet", "--package", &self.package, "--message-format", "json"])
            .stderr(Stdio::inherit())
            .output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        text.lines().map(|line| Ok(serde_json::from_str(line)?)).collect()
    }
}

fn write_if_changed(path: &Path, content: &[u8]) -> Result<(), Error> {
    if fs::read(path).is_ok_and(|old| old == content) {
        return Ok(());
    }
    fs::create_dir_all(path.parent().unwrap_or(path))?;
    Ok(fs::write(path, content)?)
}

/// A line of what cargo says.
#[derive(Deserialize)]
struct Line {
    message: Option<Message>,
    executable: Option<PathBuf>,
}

#[derive(Deserialize)]
struct Message {
    level: String,
    code: Option<Code>,
    rendered: String,
    spans: Vec<MessageSpan>,
}

#[derive(Deserialize)]
struct MessageSpan {
    file_name: String,
    byte_start: usize,
    is_primary: bool,
}

#[derive(Deserialize)]
struct Code {
    code: String,
}

impl Message {
    /// Whether a switch is where the compiler has to know the value: the mutant may be viable.
    fn needs_constants(&self) -> bool {
        self.code.as_ref().is_some_and(|code| code.code == "E0015")
    }
}
