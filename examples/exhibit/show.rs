//! The exhibit at the command line: the story, the comparison, and drawings in a folder.

use std::error::Error;
use std::fs;
use std::path::Path;

use pleach::automaton::composition::Failure;
use pleach::automaton::trajectory::{JumpRecord, Participant};
use pleach::automaton::{Reason, Trajectory};

use super::{Exhibit, number, numbers};

/// The most jumps of a run that are shown.
const MOST_JUMPS: usize = 6;
/// The most components of a jump that are shown.
const MOST_MOVES: usize = 3;

impl Exhibit {
    /// Prints the exhibit and writes its drawings, and a page for each run, to `figures/NAME/`.
    ///
    /// # Errors
    ///
    /// If a file cannot be written, or the run does not give the answer.
    pub fn show(&self) -> Result<(), Box<dyn Error>> {
        for run in &self.runs {
            println!("{}:", run.title);
            for line in &run.story {
                println!("  {line}");
            }
        }
        println!("Compared with the answer:");
        for one in &self.comparisons {
            println!("  {}: {}", one.quantity, numbers(&one.answers));
            if let Some(error) = one.error() {
                println!("    largest error {error:.1e}, allowed {:e}", one.tolerance);
            }
        }
        self.write_figures()?;
        match self.disagreements().join("\n") {
            none if none.is_empty() => Ok(()),
            some => Err(some.into()),
        }
    }

    fn write_figures(&self) -> Result<(), Box<dyn Error>> {
        let folder = Path::new("figures").join(self.name);
        fs::create_dir_all(&folder)?;
        for (name, svg) in self.diagrams() {
            fs::write(folder.join(name), svg)?;
        }
        for (name, svg) in self.plots() {
            fs::write(folder.join(name), svg)?;
        }
        println!("Drawings: {}", folder.display());
        for (name, page) in self.pages() {
            let path = folder.join(name);
            fs::write(&path, page)?;
            println!("A run that plays: open {}", path.display());
        }
        Ok(())
    }
}

/// The first jumps of a run and its ending, a line for each.
pub(super) fn story(trajectory: &Trajectory) -> Vec<String> {
    let jumps = trajectory.jumps();
    let mut lines: Vec<String> =
        jumps.iter().take(MOST_JUMPS).map(|jump| told(trajectory, jump)).collect();
    if jumps.len() > MOST_JUMPS {
        lines.push("…".to_owned());
    }
    lines.push(ending(trajectory));
    lines
}

fn told(trajectory: &Trajectory, jump: &JumpRecord) -> String {
    let moves = jump.moves.iter().take(MOST_MOVES).map(|one| {
        let Participant { name, locations } = &trajectory.components()[one.component];
        let (source, target) = (&locations[one.source], &locations[one.target]);
        let who = if trajectory.components().len() > 1 { format!("{name}: ") } else { "".into() };
        let way = if source == target {
            format!("in {source}")
        } else {
            format!("{source} → {target}")
        };
        who + &way
    });
    let others = jump.moves.len().saturating_sub(MOST_MOVES);
    let moves: Vec<String> =
        moves.chain((others > 0).then(|| format!("{others} others"))).collect();
    format!("({} s, {}) {} — {}", number(jump.at.t), jump.at.j, jump.label, moves.join(", "))
}

fn ending(trajectory: &Trajectory) -> String {
    let t = number(trajectory.ending().at.t);
    match &trajectory.ending().reason {
        Reason::Horizon => format!("The horizon is reached at {t} s."),
        Reason::Zeno(zeno) => format!(
            "The run is Zeno: {} {} of the time of the one before, and all of them end at {} s.",
            if zeno.cycle == 1 { "each flow takes" } else { "each cycle of flows takes" },
            number(zeno.ratio),
            number(zeno.accumulation),
        ),
        Reason::Blocked => format!("Blocked at {t} s: no time can pass and nothing can be taken."),
        Reason::JumpLimit(_) => format!("Jumps without end at {t} s."),
        Reason::Finished(failure) | Reason::Interrupted(failure) => failed(&t, failure),
        other => format!("{other:?} at {t} s"),
    }
}

fn failed(t: &str, failure: &Failure) -> String {
    format!("The run fails at {t} s: {failure}.")
}
