//! Plants faults in a copy of the sources, one after the other, and sees whether the checks fail.
//!
//! ```text
//! cargo run --example planted_faults -- [NAME]...
//! cargo run --example planted_faults -- rounding
//! ```
//!
//! The faults are those of `proofs/faults.toml`; `docs/proofs.md` says what came of them. A fault
//! is caught if its command fails and says what it should. With `rounding`, rounding outward is left
//! out at each place of `proofs/rounding.toml` instead. The copy, what is built of it and what each
//! command said stay in `faults`, a folder beside what cargo builds.

mod catalogue;
mod rounding;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;
use std::{env, fmt, fs, io};

use catalogue::{CatalogueError, Engine, Fault, faults};
use rounding::{CHOICE, Rounding, places, with_choices};

/// What is not copied: what cargo builds, and history.
const LEFT_OUT: [&str; 2] = ["target", ".git"];

/// Seconds after which a command is ended: a fault may give the protocol endlessly many states.
const TIME_LIMIT: &str = "900";
/// The exit status of `timeout` when it has ended the command.
const TIMED_OUT: i32 = 124;

/// Why the faults cannot be planted.
#[derive(Debug, thiserror::Error)]
enum Error {
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("there is no fault “{0}” in proofs/faults.toml")]
    Unknown(String),
    #[error("`cargo test {0}` fails although no rounding is left out")]
    FailsAnyway(String),
}

/// What has become of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Caught,
    Survived,
    OtherReason,
    DoesNotBuild,
    TimedOut,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Caught => "caught",
            Verdict::Survived => "SURVIVED",
            Verdict::OtherReason => "FAILS FOR ANOTHER REASON",
            Verdict::DoesNotBuild => "DOES NOT BUILD",
            Verdict::TimedOut => "TIMED OUT",
        })
    }
}

fn main() -> Result<ExitCode, Error> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    if env::args().skip(1).eq(["rounding"]) {
        return leave_out_rounding(root);
    }
    let planted = chosen(faults(root)?, env::args().skip(1).collect())?;
    let workshop = Workshop::new(root);
    let mut uncaught = 0;
    for fault in &planted {
        let begin = Instant::now();
        let verdict = workshop.try_out(fault)?;
        uncaught += usize::from(verdict != Verdict::Caught);
        let seconds = begin.elapsed().as_secs();
        println!("{verdict}: {} ({}, {seconds} s)", fault.name, fault.engine);
        println!("    {}", fault.wrong);
    }
    println!("{} faults, {} of them caught", planted.len(), planted.len() - uncaught);
    Ok(if uncaught == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Leaves out rounding at one place after the other, and sees whether tests fail.
fn leave_out_rounding(root: &Path) -> Result<ExitCode, Error> {
    let places = places(root)?;
    let workshop = Workshop::new(root);
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

/// The faults with these names, or all.
fn chosen(all: Vec<Fault>, names: Vec<String>) -> Result<Vec<Fault>, Error> {
    if let Some(name) = names.iter().find(|name| all.iter().all(|fault| fault.name != **name)) {
        return Err(Error::Unknown(name.clone()));
    }
    let is_chosen = |fault: &Fault| names.is_empty() || names.contains(&fault.name);
    Ok(all.into_iter().filter(is_chosen).collect())
}

/// Where faults are planted.
struct Workshop<'a> {
    root: &'a Path,
    copy: PathBuf,
    built: PathBuf,
    said: PathBuf,
}

impl<'a> Workshop<'a> {
    fn new(root: &'a Path) -> Self {
        let target = env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
        let folder = root.join(target).join("faults");
        Workshop {
            root,
            copy: folder.join("copy"),
            built: folder.join("built"),
            said: folder.join("said"),
        }
    }

    /// Makes the copy one in which rounding can be left out at each place, and runs the tests without.
    fn plant_choices(&self, places: &[Rounding]) -> Result<(), Error> {
        let sources = with_choices(self.root, places)?;
        renew(self.root, &self.copy, &|file| {
            sources.keys().any(|planted| self.copy.join(planted) == *file)
        })?;
        for (file, source) in &sources {
            write_if_new(&self.copy.join(file), source.as_bytes())?;
        }
        let mut tests: Vec<&str> = places.iter().map(|place| place.test.as_str()).collect();
        tests.sort_unstable();
        tests.dedup();
        for test in tests {
            let mut command = self.cargo(&format!("test {test}"));
            if !command.env_remove(CHOICE).output()?.status.success() {
                return Err(Error::FailsAnyway(test.to_owned()));
            }
            println!("passes with rounding everywhere: cargo test {test}");
        }
        Ok(())
    }

    /// Whether the tests of a place fail where rounding is left out there.
    fn fails_unrounded(&self, number: usize, place: &Rounding) -> Result<bool, Error> {
        let mut command = self.cargo(&format!("test {}", place.test));
        Ok(!command.env(CHOICE, number.to_string()).output()?.status.success())
    }

    /// A command of cargo in the copy, which ends after some time.
    fn cargo(&self, command: &str) -> Command {
        let mut cargo = Command::new("timeout");
        cargo
            .args([TIME_LIMIT, "cargo"])
            .args(command.split_whitespace())
            .current_dir(&self.copy)
            .env("CARGO_TARGET_DIR", &self.built);
        cargo
    }

    /// Plants one fault in sources that have no other, and runs its command.
    fn try_out(&self, fault: &Fault) -> Result<Verdict, Error> {
        let planted = self.copy.join(&fault.file);
        renew(self.root, &self.copy, &|file| *file == *planted)?;
        write_if_new(&self.copy.join(&fault.file), fault.planted(self.root)?.as_bytes())?;
        let mut command = self.cargo(&fault.command);
        // Only explorations run for longer than it takes to optimise what they run.
        if matches!(fault.engine, Engine::Harness | Engine::Test) {
            command.env("CARGO_PROFILE_DEV_OPT_LEVEL", "0");
        }
        let output = command.output()?;
        let said = [output.stdout, output.stderr].concat();
        fs::create_dir_all(&self.said)?;
        fs::write(self.said.join(&fault.name).with_extension("txt"), &said)?;
        let said = String::from_utf8_lossy(&said);
        Ok(match output.status.code() {
            Some(0) => Verdict::Survived,
            Some(TIMED_OUT) => Verdict::TimedOut,
            _ if said.contains("error: could not compile") => Verdict::DoesNotBuild,
            _ if said.contains(&fault.says) => Verdict::Caught,
            _ => Verdict::OtherReason,
        })
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
