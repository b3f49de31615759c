//! What `solve_ivp` of SciPy takes, as a script says that is run by `python3`.

use std::process::{Command, Stdio};
use std::time::Duration;

use super::Row;

const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/solve_ivp.py");

/// What the script has measured, by name.
pub struct Scipy(Vec<(String, Row)>);

impl Scipy {
    /// Runs the script. Without Python or SciPy there are no rows, and a message says so.
    pub fn run() -> Self {
        let output = Command::new("python3").arg(SCRIPT).stderr(Stdio::inherit()).output();
        let text = match output {
            Ok(output) if output.status.success() => output.stdout,
            Ok(_) | Err(_) => {
                eprintln!("`python3 {SCRIPT}` fails: there are no times of SciPy");
                Vec::new()
            }
        };
        Scipy(String::from_utf8_lossy(&text).lines().filter_map(read).collect())
    }

    pub(super) fn row(&self, name: &str) -> Option<&Row> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, row)| row)
    }
}

fn read(line: &str) -> Option<(String, Row)> {
    let mut cells = line.split('\t');
    let (name, mut next) = (cells.next()?.to_owned(), || cells.next());
    let (count, microseconds, end): (_, f64, _) =
        (next()?.parse().ok()?, next()?.parse().ok()?, next()?.parse().ok()?);
    let time = Duration::try_from_secs_f64(1e-6 * microseconds).ok()?;
    Some((name, Row { count, time, end }))
}
