//! `pleach check`: whether a mission can start, and how it would.

use super::arguments::CheckArguments;
use super::output;
use super::plan::{Planned, count_runs};
use super::remarks;
use super::source::Source;
use super::status::{Failure, Status};
use super::sweep::Sweep;
use super::terminal;
use pleach::automaton::network::record::{MissionEvent, Snapshot};
use pleach::automaton::network::scenario::{Fleet, Remark, Scenario, ValidScenario};
use pleach::figures::{Plan, Scene, quantity};
use pleach::mission::{self, Watcher};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Checks scenarios one after another, and draws their starts.
pub fn check(arguments: &CheckArguments) -> Result<Status, Failure> {
    let mut worst = Status::Done;
    let mut mistakes = Vec::new();
    let sources = Source::all(&arguments.scenarios)?;
    let count = count_runs(sources.len(), &arguments.set, 1)?;
    let mut number = 0;
    for source in sources {
        for settings in Sweep::combinations(&arguments.set) {
            number += 1;
            let scenario = match source.parse(&settings) {
                Ok(scenario) => scenario,
                Err(error) => {
                    mistakes.push(error);
                    continue;
                }
            };
            let name = source.name.display().to_string();
            let planned = Planned { number, settings, ..Planned::once(name, scenario) };
            let drawing = draw(&planned, count, arguments)?;
            let remarks = planned.scenario.remarks();
            let told = report(&planned, &remarks, drawing);
            let told = terminal::wrapped(&told, terminal::width(), terminal::SUMMARY_INDENT);
            output::say(&told)?;
            if remarks.iter().any(|remark| matches!(remark, Remark::Task { .. })) {
                worst = Status::Unserviced;
            }
        }
    }
    if mistakes.is_empty() { Ok(worst) } else { Err(Failure::Scenarios(mistakes)) }
}

/// What the scenario holds, and what is worth a remark.
fn report(planned: &Planned, remarks: &[Remark], drawing: Option<PathBuf>) -> String {
    let Planned { source, scenario, settings, .. } = planned;
    let resolved = scenario.settings();
    let set: String = settings.iter().map(|setting| format!(" with {setting}")).collect();
    let (links, crossing) = scenario.count_links();
    let mut rows = vec![
        ("workspace", workspace(scenario)),
        ("access points", scenario.access_point.len().to_string()),
        ("robots", scenario.robot.len().to_string()),
        ("tasks", scenario.task.len().to_string()),
        ("links", format!("{links} at the start, {crossing} of them through walls")),
        ("longest new link", longest_link(scenario)),
        (
            "clearance",
            format!(
                "{}; passages from {} on are open",
                quantity(resolved.clearance),
                quantity(2.0 * resolved.planning_clearance())
            ),
        ),
    ];
    rows.extend(scenario.fleets().iter().map(|fleet| ("team", team(fleet))));
    rows.extend(drawing.map(|path| ("start", path.display().to_string())));
    rows.extend(remarks::lines(remarks).into_iter().map(|line| ("remark", line)));
    let rows = rows.iter().map(|(label, text)| format!("  {label:<19} {text}\n"));
    format!("{source}{set}: a mission can start\n{}", rows.collect::<String>())
}

/// Up to which length links are made; each team has its own.
fn longest_link(scenario: &ValidScenario) -> String {
    let fleets = scenario.fleets().iter().map(Fleet::scenario);
    let scenarios = if scenario.fleets().is_empty() { vec![scenario] } else { fleets.collect() };
    let mut lengths: Vec<String> =
        scenarios.into_iter().map(|it| quantity(it.site().usual.build)).collect();
    lengths.dedup();
    format!("{}, along the shortest way around walls", lengths.join(" and "))
}

fn team(fleet: &Fleet) -> String {
    let Scenario { robot, task, .. } = fleet.scenario().scenario();
    let counted = |count: usize, noun: &str| match count {
        1 => format!("1 {noun}"),
        count => format!("{count} {noun}s"),
    };
    let (robots, tasks) = (counted(robot.len(), "robot"), counted(task.len(), "task"));
    format!("{robots} and {tasks} of access point {}", fleet.access_point())
}

fn workspace(scenario: &ValidScenario) -> String {
    let side = |axis: usize| {
        let values = scenario.workspace.boundary.iter().map(|corner| corner[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        high - low
    };
    let holes = match scenario.workspace.holes.len() {
        1 => "1 hole".to_owned(),
        count => format!("{count} holes"),
    };
    format!("{} by {}, {holes}", quantity(side(0)), quantity(side(1)))
}

/// Draws the network before its first move, one of `count`, and says where.
fn draw(
    planned: &Planned,
    count: usize,
    arguments: &CheckArguments,
) -> Result<Option<PathBuf>, Failure> {
    if arguments.no_figures {
        return Ok(None);
    }
    let scenario = &planned.scenario;
    let name = planned.file_name(count);
    let folder = match &arguments.figures {
        None => Path::new("figures").join(name),
        Some(folder) if count == 1 => folder.clone(),
        Some(folder) => folder.join(name),
    };
    output::create_folder(&folder)?;
    let mut opening = Opening::default();
    mission::run(scenario, &mut [&mut opening])?;
    let Some(snapshot) = opening.snapshot else { return Ok(None) };
    let outline = scenario.site().free_space.outline().iter();
    let corners = |ring: &Vec<_>| ring.iter().map(|&corner| <[f64; 2]>::from(corner)).collect();
    let plan = Plan::new(scenario, outline.map(corners).collect());
    let title = format!("{}: the start", scenario.name);
    let picture = plan.render(&Scene { snapshot: &snapshot, title: &title, trails: &[] });
    let path = folder.join("start.svg");
    fs::write(&path, picture).map_err(|source| Failure::Creation { path: path.clone(), source })?;
    Ok(Some(path))
}

/// Keeps the first snapshot of a mission and ends it.
#[derive(Default)]
struct Opening {
    snapshot: Option<Snapshot>,
}

impl Watcher for Opening {
    fn observe(&mut self, snapshot: &Snapshot, _: &[MissionEvent]) -> io::Result<()> {
        self.snapshot = Some(snapshot.clone());
        Ok(())
    }

    fn interruption(&self) -> Option<String> {
        Some("only the start is looked at".into())
    }
}
