//! A copy of the workspace in which faults are planted.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use serde::Deserialize;

use crate::Error;
use crate::catalogue::{Engine, Fault, add_to_roots, read};
use crate::rounding::{self, Rounding, with_choices};
use crate::verdict::Verdict;
use crate::weaving::{self, Numbered, Woven, decision};

/// What is not copied: what cargo builds, and history.
const LEFT_OUT: [&str; 2] = ["target", ".git"];

/// Seconds after which a command is ended: a fault may give the protocol endlessly many states.
const TIME_LIMIT: &str = "900";

/// Of a command that names many tests only the beginning is shown.
const COMMAND_SHOWN: usize = 100;

/// Where faults are planted.
pub struct Workshop<'a> {
    root: &'a Path,
    copy: PathBuf,
    built: PathBuf,
    said: PathBuf,
}

impl<'a> Workshop<'a> {
    /// The one for the workspace `root`.
    pub fn new(root: &'a Path) -> Self {
        let target = env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
        let folder = root.join(target).join("faults");
        Workshop {
            root,
            copy: folder.join("copy"),
            built: folder.join("built"),
            said: folder.join("said"),
        }
    }

    /// Makes the copy one that holds all faults that one build can hold; returns the numbers of the others.
    pub fn weave(&self, faults: &[Numbered]) -> Result<BTreeSet<usize>, Error> {
        let mut left_out = BTreeSet::new();
        loop {
            let files = self.woven(faults, &left_out)?;
            let texts = files.iter().map(|(file, woven)| (file.clone(), woven.text.clone()));
            let mut sources = texts.collect();
            add_to_roots(self.root, &mut sources, &decision())?;
            self.plant(&sources)?;
            let woven: BTreeSet<usize> = files.values().flat_map(Woven::faults).collect();
            left_out
                .extend(faults.iter().map(|(number, _)| *number).filter(|it| !woven.contains(it)));
            let complaints = self.complaints()?;
            if complaints.is_empty() {
                return Ok(left_out);
            }
            let known = left_out.len();
            left_out.extend(complaints.iter().flat_map(|complaint| complaint.faults(&files)));
            if left_out.len() == known {
                let all: Vec<String> = complaints.into_iter().map(|it| it.rendered).collect();
                return Err(Error::Build(all.join("\n")));
            }
        }
    }

    /// The files in which there are faults, with those that are not left out.
    fn woven(
        &self,
        faults: &[Numbered],
        left_out: &BTreeSet<usize>,
    ) -> Result<BTreeMap<String, Woven>, Error> {
        let mut by_file: BTreeMap<&str, Vec<Numbered>> = BTreeMap::new();
        for &(number, fault) in faults.iter().filter(|(number, _)| !left_out.contains(number)) {
            // An error where the fault does not apply.
            fault.planted(self.root)?;
            by_file.entry(&fault.file).or_default().push((number, fault));
        }
        let woven = by_file.into_iter().map(|(file, faults)| {
            let woven = Woven::of(&read(self.root, file)?, &faults);
            let woven = woven.map_err(|source| Error::Syntax { file: file.to_owned(), source })?;
            Ok((file.to_owned(), woven))
        });
        woven.collect()
    }

    /// What the compiler objects to in the libraries of the copy.
    fn complaints(&self) -> Result<Vec<Complaint>, Error> {
        let output = self
            .cargo("check --quiet --lib --workspace --exclude pleach-benches --message-format json")
            .output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let lines = text.lines().map(serde_json::from_str::<Line>);
        let messages = lines.filter_map(|line| line.map(|line| line.message).transpose());
        let messages = messages.collect::<Result<Vec<Complaint>, _>>()?;
        let errors: Vec<Complaint> =
            messages.into_iter().filter(|message| message.level == "error").collect();
        if errors.is_empty() && !output.status.success() {
            return Err(Error::Build(String::from_utf8_lossy(&output.stderr).into_owned()));
        }
        Ok(errors)
    }

    /// Makes the copy one in which rounding can be left out at each place, and runs the tests without.
    pub fn plant_choices(&self, places: &[Rounding]) -> Result<(), Error> {
        self.plant(&with_choices(self.root, places)?)?;
        let tests: BTreeSet<&str> = places.iter().map(|place| &*place.test).collect();
        for test in tests {
            self.passes(&format!("test {test}"))?;
        }
        Ok(())
    }

    /// Whether the tests of a place fail where rounding is left out there.
    pub fn fails_unrounded(&self, number: usize, place: &Rounding) -> Result<bool, Error> {
        let mut command = self.cargo(&format!("test {}", place.test));
        Ok(!command.env(rounding::CHOICE, number.to_string()).output()?.status.success())
    }

    /// Runs a command that passes while nothing is chosen.
    pub fn passes(&self, command: &str) -> Result<(), Error> {
        if !self.cargo(command).output()?.status.success() {
            return Err(Error::FailsAnyway(command.to_owned()));
        }
        let shown: String = command.chars().take(COMMAND_SHOWN).collect();
        println!("passes without a fault: cargo {shown}");
        Ok(())
    }

    /// Runs the command of a fault that is woven in.
    pub fn try_woven(&self, (number, fault): Numbered) -> Result<Verdict, Error> {
        let mut command = self.cargo(&fault.command);
        command.env(weaving::CHOICE, number.to_string());
        self.verdict(fault, command)
    }

    /// Plants one fault in sources that have no other, and runs its command.
    pub fn try_alone(&self, fault: &Fault) -> Result<Verdict, Error> {
        self.plant(&BTreeMap::from([(fault.file.clone(), fault.planted(self.root)?)]))?;
        let mut command = self.cargo(&fault.command);
        // Only explorations run for longer than it takes to optimise what they run.
        if matches!(fault.engine, Engine::Harness | Engine::Test) {
            command.env("CARGO_PROFILE_DEV_OPT_LEVEL", "0");
        }
        self.verdict(fault, command)
    }

    fn verdict(&self, fault: &Fault, mut command: Command) -> Result<Verdict, Error> {
        let output = command.output()?;
        let said = [output.stdout, output.stderr].concat();
        fs::create_dir_all(&self.said)?;
        fs::write(self.said.join(&fault.name).with_extension("txt"), &said)?;
        Ok(Verdict::of(output.status.code(), &String::from_utf8_lossy(&said), &fault.says))
    }

    /// Makes the copy what the original is, but for these files.
    fn plant(&self, sources: &BTreeMap<String, String>) -> io::Result<()> {
        let is_planted =
            |file: &Path| sources.keys().any(|planted| self.copy.join(planted) == *file);
        renew(self.root, &self.copy, &is_planted)?;
        for (file, source) in sources {
            write_if_new(&self.copy.join(file), source.as_bytes())?;
        }
        Ok(())
    }

    /// A command of cargo in the copy, which ends after some time.
    fn cargo(&self, command: &str) -> Command {
        let mut cargo = Command::new("timeout");
        cargo
            .args([TIME_LIMIT, "cargo"])
            .args(command.split_whitespace())
            .current_dir(&self.copy)
            .env("CARGO_TARGET_DIR", &self.built)
            .env_remove(weaving::CHOICE)
            .env_remove(rounding::CHOICE);
        cargo
    }
}

/// Makes a copy what the original is. Files that are so already stay untouched, so that cargo
/// does not build them again; so do those that are planted, which are written next.
fn renew(original: &Path, copy: &Path, is_planted: &dyn Fn(&Path) -> bool) -> io::Result<()> {
    if original.is_dir() {
        fs::create_dir_all(copy)?;
        for entry in fs::read_dir(copy)? {
            let entry = entry?;
            if !original.join(entry.file_name()).exists() {
                remove(&entry.path())?;
            }
        }
        for entry in fs::read_dir(original)? {
            let entry = entry?;
            if LEFT_OUT.iter().all(|name| entry.file_name() != *name) {
                renew(&entry.path(), &copy.join(entry.file_name()), is_planted)?;
            }
        }
    } else if !is_planted(copy) {
        write_if_new(copy, &fs::read(original)?)?;
    }
    Ok(())
}

fn remove(path: &Path) -> io::Result<()> {
    if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) }
}

fn write_if_new(path: &Path, content: &[u8]) -> io::Result<()> {
    match fs::read(path) {
        Ok(present) if present == content => Ok(()),
        _ => fs::write(path, content),
    }
}

/// A line of what cargo says.
#[derive(Deserialize)]
struct Line {
    message: Option<Complaint>,
}

/// What the compiler says.
#[derive(Deserialize)]
struct Complaint {
    level: String,
    rendered: String,
    spans: Vec<ComplaintSpan>,
}

#[derive(Deserialize)]
struct ComplaintSpan {
    file_name: String,
    byte_start: usize,
    is_primary: bool,
}

impl Complaint {
    /// The faults that it is about.
    fn faults(&self, files: &BTreeMap<String, Woven>) -> BTreeSet<usize> {
        let primary = self.spans.iter().filter(|span| span.is_primary);
        let woven = primary.filter_map(|span| Some((files.get(&span.file_name)?, span.byte_start)));
        woven.flat_map(|(woven, byte)| woven.at(byte).iter().copied()).collect()
    }
}
