//! The progress of a mission on the error output, while it runs.
//!
//! On a terminal the telling events scroll by above a line that says where the mission stands.
//! Elsewhere only the events are written, one a line.

use super::{output, terminal};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pleach::automaton::network::record::{End, FleetView, MissionEvent, Snapshot};
use pleach::automaton::network::scenario::Scenario;
use pleach::discrete::Location as _;
use pleach::mission::Watcher;
use pleach::story;
use std::io;

/// An observer that shows the progress.
#[derive(Debug)]
pub struct Progress {
    display: Display,
    tasks: usize,
}

#[derive(Debug)]
enum Display {
    Quiet,
    Lines,
    Live(ProgressBar),
}

impl Progress {
    /// Progress of a mission of `scenario`, shown as the error output can.
    pub fn new(scenario: &Scenario, quiet: bool) -> Self {
        let display = if quiet {
            Display::Quiet
        } else if terminal::is_lively() {
            Display::Live(spinner())
        } else {
            Display::Lines
        };
        Self { display, tasks: scenario.task.len() }
    }

    /// Clears the line that says where the mission stands.
    pub(super) fn finish(&self) {
        if let Display::Live(bar) = &self.display {
            bar.finish_and_clear();
        }
    }
}

impl Watcher for Progress {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        // The line first, so that it is never behind the story above it.
        if let Display::Live(bar) = &self.display {
            bar.set_message(standing(snapshot, self.tasks));
            bar.inc(1);
        }
        for event in events.iter().filter(|event| story::is_telling(event)) {
            let line = format!("k = {:<6} {}", snapshot.step, story::tell(event));
            let line = terminal::wrapped(&line, terminal::error_width(), terminal::STORY_INDENT);
            match &self.display {
                Display::Quiet => {}
                Display::Lines => output::tell(line),
                Display::Live(bar) => bar.println(line),
            }
        }
        Ok(())
    }

    fn end(&mut self, _: &End) -> io::Result<()> {
        self.finish();
        Ok(())
    }
}

fn spinner() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    match ProgressStyle::with_template("{spinner} {elapsed} {wide_msg}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Where the mission stands: step, phase, task, leader.
fn standing(snapshot: &Snapshot, tasks: usize) -> String {
    let serviced = snapshot.serviced.len();
    if !snapshot.fleets.is_empty() {
        let phases: Vec<String> = snapshot.fleets.iter().map(phase_of_fleet).collect();
        return format!(
            "k = {}  {}  {serviced} of {tasks} tasks serviced",
            snapshot.step,
            phases.join(", ")
        );
    }
    let phase = snapshot.phase.name();
    let task = match snapshot.task {
        Some(task) => format!("task {task} ({serviced} of {tasks} serviced)"),
        None => format!("{serviced} of {tasks} tasks serviced"),
    };
    let leader = match snapshot.primary_team.last() {
        Some(leader) => format!("robot {leader} leads"),
        None => "no leader".into(),
    };
    format!("k = {}  {phase}  {task}  {leader}", snapshot.step)
}

/// Where the mission of a fleet stands.
fn phase_of_fleet(fleet: &FleetView) -> String {
    format!("access point {}: {}", fleet.access_point, fleet.phase.name())
}
