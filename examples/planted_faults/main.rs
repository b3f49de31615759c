//! Plants faults in a copy of the sources, one after the other, and sees whether the checks fail.
//!
//! ```text
//! cargo run --example planted_faults -- [NAME]...
//! ```
//!
//! The faults are those of `proofs/faults.toml`; `docs/proofs.md` says what came of them. A fault
//! is caught if its command fails and says what it should. The copy, what is built of it and what
//! each command said stay in `faults`, a folder beside what cargo builds.

mod catalogue;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;
use std::{env, fmt, fs, io};

use catalogue::{CatalogueError, Fault, faults};

/// What is copied from the root of the workspace: all that the packages are built from.
const SOURCES: [&str; 16] = [
    "Cargo.toml",
    "Cargo.lock",
    "rustfmt.toml",
    "src",
    "guards",
    "discrete",
    "continuous",
    "automaton",
    "verify",
    "proofs",
    "tests",
    "examples",
    "benches",
    "scenarios",
    "docs",
    "README.md",
];

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

    /// Plants one fault in sources that have no other, and runs its command.
    fn try_out(&self, fault: &Fault) -> Result<Verdict, Error> {
        fs::create_dir_all(&self.copy)?;
        for path in SOURCES {
            renew(&self.root.join(path), &self.copy.join(path), &self.copy.join(&fault.file))?;
        }
        write_if_new(&self.copy.join(&fault.file), fault.planted(self.root)?.as_bytes())?;
        let output = Command::new("timeout")
            .args([TIME_LIMIT, "cargo"])
            .args(fault.command.split_whitespace())
            .current_dir(&self.copy)
            .env("CARGO_TARGET_DIR", &self.built)
            .output()?;
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
/// does not build them again; so does `planted`, which is written next.
fn renew(original: &Path, copy: &Path, planted: &Path) -> io::Result<()> {
    if original.is_dir() {
        fs::create_dir_all(copy)?;
        for entry in fs::read_dir(original)? {
            let entry = entry?;
            renew(&entry.path(), &copy.join(entry.file_name()), planted)?;
        }
    } else if original.exists() && copy != planted {
        write_if_new(copy, &fs::read(original)?)?;
    }
    Ok(())
}

fn write_if_new(path: &Path, content: &[u8]) -> io::Result<()> {
    match fs::read(path) {
        Ok(present) if present == content => Ok(()),
        _ => fs::write(path, content),
    }
}
