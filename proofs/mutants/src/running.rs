//! Tests run with one mutant after the other.

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::Error;
use crate::report::Verdict;

/// Kilobytes of address space: some mutants ask for more and more memory.
const MEMORY: &str = "6000000";

/// No test takes longer.
const LONGEST: Duration = Duration::from_secs(600);
/// What ends a program that has used up its processor time.
const OUT_OF_TIME: i32 = 24;
/// How many times its processor time a program may take where the machine has other things to do.
const PATIENCE: u32 = 60;
/// Tests that together take less than this are run together.
const SHORT: Duration = Duration::from_millis(100);

/// A test, how long it takes, and which mutants it reaches.
#[derive(Clone, Debug)]
pub struct Test {
    program: PathBuf,
    name: String,
    time: Duration,
    reaches: BTreeSet<usize>,
}

/// How a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Passed,
    Failed,
    TimedOut,
}

/// The tests of these programs that pass without mutants, the quickest first.
pub fn tests(programs: &[PathBuf], folder: &Path, skipped: &[String]) -> Result<Vec<Test>, Error> {
    let mut tests = Vec::new();
    let record = folder.join("reached.txt");
    for program in programs {
        let list = Command::new(program)
            .current_dir(folder)
            .args(["--list", "--format", "terse"])
            .output()?;
        let list = String::from_utf8_lossy(&list.stdout).into_owned();
        let names = list.lines().filter_map(|line| line.strip_suffix(": test"));
        for name in names.filter(|name| !skipped.iter().any(|part| name.contains(part.as_str()))) {
            let _ = fs::remove_file(&record);
            let begin = Instant::now();
            let mut command = command(program, &[name], folder, LONGEST);
            command.env("MUTANTS_REACHED", &record);
            if run(command, LONGEST)? != Outcome::Passed {
                return Err(Error::Fails(name.to_owned()));
            }
            let time = begin.elapsed();
            let reached = fs::read_to_string(&record).unwrap_or_default();
            let reaches = reached.lines().filter_map(|line| line.parse().ok()).collect();
            tests.push(Test { program: program.clone(), name: name.to_owned(), time, reaches });
        }
    }
    tests.sort_by_key(|test| test.time);
    Ok(tests)
}

/// Runs the tests that reach a mutant, the quickest first, until one fails.
pub fn try_out(mutant: usize, tests: &[Test], folder: &Path) -> Result<Verdict, Error> {
    let reaching: Vec<&Test> = tests.iter().filter(|test| test.reaches.contains(&mutant)).collect();
    if reaching.is_empty() {
        return Ok(Verdict::Unreached);
    }
    for group in groups(&reaching) {
        let names: Vec<&str> = group.iter().map(|test| &*test.name).collect();
        let limit = time_limit(total(&group));
        let mut command = command(&group[0].program, &names, folder, limit);
        command.env("MUTANT", mutant.to_string());
        match run(command, limit)? {
            Outcome::Passed => {}
            Outcome::Failed => return Ok(Verdict::Caught),
            Outcome::TimedOut => return Ok(Verdict::TimedOut),
        }
    }
    Ok(Verdict::Survived)
}

/// Processor time: a test that waits for other programs is not one that does not end.
fn time_limit(usual: Duration) -> Duration {
    usual * 10 + Duration::from_secs(5)
}

fn total(tests: &[&Test]) -> Duration {
    tests.iter().map(|test| test.time).sum()
}

/// Tests that are run together, of one program each: many quick ones, slow ones alone.
fn groups<'t>(tests: &[&'t Test]) -> Vec<Vec<&'t Test>> {
    let mut groups: Vec<Vec<&Test>> = Vec::new();
    for &test in tests {
        let joins = groups
            .last_mut()
            .filter(|group| group[0].program == test.program && total(group) + test.time < SHORT);
        match joins {
            Some(group) => group.push(test),
            None => groups.push(vec![test]),
        }
    }
    groups
}

fn command(program: &Path, names: &[&str], folder: &Path, limit: Duration) -> Command {
    let mut command = Command::new("sh");
    let limits = format!("ulimit -v {MEMORY}; ulimit -S -t {}", limit.as_secs() + 1);
    command.args(["-c", &format!("{limits}; exec \"$@\""), "sh"]);
    command.arg(program).args(names).args(["--exact", "--test-threads", "1"]);
    // A failure need not be made small, nor be remembered.
    command.env("PROPTEST_MAX_SHRINK_ITERS", "0").env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "1");
    command
        .env("INSTA_UPDATE", "no")
        .env("INSTA_WORKSPACE_ROOT", folder.parent().unwrap_or(folder));
    command.env("CARGO_MANIFEST_DIR", folder).current_dir(folder);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn run(mut command: Command, limit: Duration) -> Result<Outcome, Error> {
    let begin = Instant::now();
    let mut child = command.spawn()?;
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(match status.signal() {
                Some(OUT_OF_TIME) => Outcome::TimedOut,
                _ if status.success() => Outcome::Passed,
                _ => Outcome::Failed,
            });
        }
        if begin.elapsed() > PATIENCE * limit {
            child.kill()?;
            child.wait()?;
            return Ok(Outcome::TimedOut);
        }
        sleep(Duration::from_millis(2));
    }
}
