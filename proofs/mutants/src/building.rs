//! A copy of the workspace in which the mutants of a package are woven in, and its test programs.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde::Deserialize;

use crate::Error;
use crate::listing::Mutant;
use crate::report::Verdict;
use crate::weaving::{SWITCHES, Woven, woven};

/// Where the manifest of the workspace says what the compiler objects to, and what it says there of mutants
/// that overflow: they are run.
const LINTS: &str = "[workspace.lints.rust]\n";
const LENIENT: &str = "arithmetic_overflow = \"allow\"\nunconditional_panic = \"allow\"\n";

/// What cargo is asked for, one after the other: the first tells quickly what does not compile.
const STEPS: [&[&str]; 2] = [&["check", "--lib"], &["test", "--no-run", "--lib", "--tests"]];

/// The copy.
pub struct Copy {
    root: PathBuf,
    /// What is built of copies.
    target: PathBuf,
    package: String,
    /// The folder of the package in the workspace.
    folder: String,
    /// What the files are without mutants.
    originals: BTreeMap<String, String>,
}

/// What has come of building.
pub struct Built {
    /// The test programs.
    pub programs: Vec<PathBuf>,
    /// The mutants that are not in them.
    pub unusable: BTreeMap<usize, Verdict>,
}

impl Copy {
    /// Copies the files of the workspace `root` that are under version control or about to be.
    pub fn of(root: &Path, package: &str, mutants: &[Mutant]) -> Result<Self, Error> {
        let place = root.join("target/mutants");
        let copy = place.join(package);
        let list = Command::new("git")
            .current_dir(root)
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .output()?;
        let names = String::from_utf8_lossy(&list.stdout).into_owned();
        for name in names.split_terminator('\0').filter(|name| root.join(name).is_file()) {
            let mut content = fs::read(root.join(name))?;
            if name == "Cargo.toml" {
                let manifest = String::from_utf8_lossy(&content);
                content = manifest.replace(LINTS, &[LINTS, LENIENT].concat()).into_bytes();
            }
            write_if_changed(&copy.join(name), &content)?;
        }
        let folder = mutants.first().and_then(|mutant| mutant.file.split_once("src/"));
        let folder = folder.map(|(folder, _)| folder.to_owned()).unwrap_or_default();
        let library = format!("{folder}src/lib.rs");
        let files = mutants.iter().map(|mutant| &mutant.file).chain([&library]);
        let originals = files
            .map(|file| Ok((file.clone(), fs::read_to_string(root.join(file))?)))
            .collect::<Result<_, Error>>()?;
        let (package, target) = (package.to_owned(), place.join("built"));
        Ok(Copy { root: copy, target, package, folder, originals })
    }

    /// The folder in which the tests of the package run.
    pub fn package_folder(&self) -> PathBuf {
        self.root.join(&self.folder)
    }

    /// Builds the tests with all mutants that compile, leaving out those of which the compiler complains
    /// until it does no more.
    pub fn build(&self, mutants: &[Mutant]) -> Result<Built, Error> {
        let mut unusable = BTreeMap::new();
        let mut programs = Vec::new();
        for step in STEPS {
            loop {
                let files = self.weave(mutants, &mut unusable)?;
                let said = self.cargo(step)?;
                let messages = said.iter().filter_map(|line| line.message.as_ref());
                let errors: Vec<_> = messages.filter(|it| it.level == "error").collect();
                if errors.is_empty() {
                    programs = said.into_iter().filter_map(|line| line.executable).collect();
                    break;
                }
                let known = unusable.len();
                errors.iter().for_each(|error| error.blame(&files, &mut unusable));
                if unusable.len() == known {
                    let all: Vec<&str> = errors.iter().map(|error| &*error.rendered).collect();
                    return Err(Error::Build(all.join("\n")));
                }
            }
        }
        Ok(Built { programs, unusable })
    }

    /// Writes all files with the mutants that are not known to be unusable. Those for which there is no place
    /// are.
    fn weave(
        &self,
        mutants: &[Mutant],
        unusable: &mut BTreeMap<usize, Verdict>,
    ) -> Result<BTreeMap<String, Woven>, Error> {
        let mut files = BTreeMap::new();
        for (file, original) in &self.originals {
            let is_here =
                |mutant: &&Mutant| mutant.file == *file && !unusable.contains_key(&mutant.number);
            let here: Vec<&Mutant> = mutants.iter().filter(is_here).collect();
            let woven = woven(file, original, &here)?;
            let placed: BTreeSet<usize> = woven.mutants().collect();
            let unplaced = here.iter().filter(|mutant| !placed.contains(&mutant.number));
            unusable.extend(unplaced.map(|mutant| (mutant.number, Verdict::NoSwitch)));
            let switches = if file.ends_with("src/lib.rs") { SWITCHES } else { "" };
            write_if_changed(&self.root.join(file), [&woven.text, switches].concat().as_bytes())?;
            files.insert(file.clone(), woven);
        }
        Ok(files)
    }

    /// What cargo says of the package.
    fn cargo(&self, step: &[&str]) -> Result<Vec<Line>, Error> {
        let output = Command::new("cargo")
            .current_dir(&self.root)
            .args(step)
            .args(["--quiet", "--package", &self.package, "--message-format", "json"])
            .arg("--target-dir")
            .arg(&self.target)
            .stderr(Stdio::null())
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

/// What the compiler says.
#[derive(Deserialize)]
struct Message {
    level: String,
    code: Option<Code>,
    rendered: String,
    spans: Vec<MessageSpan>,
}

#[derive(Deserialize)]
struct Code {
    code: String,
}

#[derive(Deserialize)]
struct MessageSpan {
    file_name: String,
    byte_start: usize,
    is_primary: bool,
}

impl Message {
    /// The compiler complains of one mutant, which is unviable, or of what is left where several are: these
    /// may be viable, but not behind a switch. Nor may they where the compiler has to know the value.
    fn blame(&self, files: &BTreeMap<String, Woven>, unusable: &mut BTreeMap<usize, Verdict>) {
        let is_constant = self.code.as_ref().is_some_and(|code| code.code == "E0015");
        for span in self.spans.iter().filter(|span| span.is_primary) {
            let at_fault = files.get(&span.file_name).and_then(|woven| woven.at(span.byte_start));
            let verdict = match at_fault {
                Some([_]) if !is_constant => Verdict::Unviable,
                _ => Verdict::NoSwitch,
            };
            unusable.extend(at_fault.unwrap_or_default().iter().map(|&mutant| (mutant, verdict)));
        }
    }
}
