//! `pleach check`: whether a mission can start, and how it would.

use super::arguments::CheckArguments;
use super::output;
use super::plan::{Planned, count_runs};
use super::remarks;
use super::source::Source;
use super::status::{Failure, Status};
use super::sweep::Sweep;
use super::terminal;
use pleach::automaton::network::Site;
use pleach::automaton::network::phrase;
use pleach::automaton::network::record::{MissionEvent, Snapshot};
use pleach::automaton::network::scenario::{Fleet, LinkCount, Remark, ValidScenario};
use pleach::figures::{Plan, Scene, quantity};
use pleach::mission::{self, Watcher};
use pleach::task_list;
use pleach::verify::network::TreeLinks;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Checks scenarios one after another, and draws their starts.
pub(super) fn check(arguments: &CheckArguments) -> Result<Status, Failure> {
    let mut worst = Status::Done;
    let (sources, mut mistakes) = Source::all(&arguments.scenarios)?;
    let count = count_runs(sources.len(), &arguments.set, 1)?;
    let tasks = arguments.tasks.as_deref().map(task_list::read).transpose()?;
    let mut number = 0;
    for source in sources {
        for settings in Sweep::combinations(&arguments.set) {
            number += 1;
            let scenario = match source.parse(&settings, tasks.as_deref()) {
                Ok(scenario) => scenario,
                Err(error) => {
                    mistakes.push(error);
                    continue;
                }
            };
            let name = source.name.display().to_string();
            let planned = Planned { number, settings, ..Planned::once(name, scenario) };
            let opening = Opening::of(&planned)?;
            let drawing = draw(&planned, &opening, count, arguments)?;
            let remarks = planned.scenario.remarks();
            let told = report(&planned, opening.links.last(), &remarks, drawing);
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
fn report(
    planned: &Planned,
    tree: LinkCount,
    remarks: &[Remark],
    drawing: Option<PathBuf>,
) -> String {
    let Planned { source, scenario, settings, .. } = planned;
    let resolved = scenario.settings();
    let set: String = settings.iter().map(|setting| format!(" with {setting}")).collect();
    let at_start = |LinkCount { links, through_walls }: LinkCount| {
        format!("{links} at the start, {through_walls} of them through walls")
    };
    let mut rows = vec![
        ("workspace", workspace(scenario)),
        ("access points", scenario.access_point.len().to_string()),
        ("robots", scenario.robot.len().to_string()),
        ("tasks", scenario.task.len().to_string()),
        ("links", at_start(scenario.count_links())),
        ("links of the tree", at_start(tree)),
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
    rows.extend(scenario.fleets().iter().map(|fleet| ("team", team(fleet, scenario))));
    rows.extend(drawing.map(|path| ("start", path.display().to_string())));
    rows.extend(remarks::lines(remarks).into_iter().map(|line| ("remark", line)));
    let rows = rows.iter().map(|(label, text)| format!("  {label:<19} {text}\n"));
    format!("{source}{set}: a mission can start\n{}", rows.collect::<String>())
}

/// Up to which length links are made; each team has its own.
fn longest_link(scenario: &ValidScenario) -> String {
    let fleets = scenario.fleets().iter().map(Fleet::scenario);
    let scenarios = if scenario.fleets().is_empty() { vec![scenario] } else { fleets.collect() };
    let mut lengths: Vec<f64> = scenarios.into_iter().map(|it| it.site().usual.build).collect();
    lengths.sort_by(f64::total_cmp);
    let mut lengths: Vec<String> = lengths.into_iter().map(quantity).collect();
    lengths.dedup();
    format!("{}, along the shortest way around walls", lengths.join(" and "))
}

/// Which robots pursue which tasks, and from where.
fn team(fleet: &Fleet, whole: &ValidScenario) -> String {
    let access_point = fleet.access_point();
    let [x, y] = whole.access_point[access_point].position;
    let tasks = (0..fleet.scenario().task.len()).filter_map(|task| fleet.outward().task(task));
    let tasks = numbered("task", &tasks.collect::<Vec<_>>());
    let robots = numbered("robot", fleet.robots());
    format!("access point {access_point} at ({x}, {y}): {robots}; {tasks}")
}

/// "no robot", "robot 3", "robots 0 to 3 and 6": numbers in a row by the first and the last of them.
fn numbered(noun: &str, numbers: &[usize]) -> String {
    if numbers.is_empty() {
        return format!("no {noun}");
    }
    let plural = if numbers.len() == 1 { "" } else { "s" };
    let rows = numbers.chunk_by(|one, next| one + 1 == *next);
    let rows: Vec<String> = rows.flat_map(row).collect();
    format!("{noun}{plural} {}", phrase::listed(&rows))
}

/// The numbers of a row, or its ends if it is long.
fn row(numbers: &[usize]) -> Vec<String> {
    match numbers {
        [first, _, .., last] => vec![format!("{first} to {last}")],
        few => few.iter().map(usize::to_string).collect(),
    }
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
    opening: &Opening,
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
    let Some(snapshot) = &opening.snapshot else { return Ok(None) };
    let plan = Plan::of(scenario);
    let title = format!("{}: the start", scenario.name);
    let picture = plan.render(&Scene { snapshot, title: &title, trails: &[] });
    let path = folder.join("start.svg");
    output::write(&path, &picture)?;
    Ok(Some(path))
}

/// Keeps the first snapshot of a mission and ends it.
struct Opening {
    site: Arc<Site>,
    snapshot: Option<Snapshot>,
    links: TreeLinks,
}

impl Opening {
    fn of(planned: &Planned) -> Result<Self, Failure> {
        let site = Arc::clone(planned.scenario.site());
        let mut opening = Opening { site, snapshot: None, links: TreeLinks::default() };
        mission::run(&planned.scenario, &mut [&mut opening])?;
        Ok(opening)
    }
}

impl Watcher for Opening {
    fn observe(&mut self, snapshot: &Snapshot, _: &[MissionEvent]) -> io::Result<()> {
        self.links.observe(snapshot, &self.site);
        self.snapshot = Some(snapshot.clone());
        Ok(())
    }

    fn interruption(&self) -> Option<String> {
        Some("only the start is looked at".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pleach::automaton::network::scenario::Scenario;
    use serde_json::json;

    #[test]
    fn numbers_in_a_row_are_told_by_their_ends() {
        let told = [&[4][..], &[0, 1], &[0, 1, 2, 3, 6], &[1, 3, 4, 5, 7]]
            .map(|numbers| numbered("robot", numbers));
        let expected =
            ["robot 4", "robots 0 and 1", "robots 0 to 3 and 6", "robots 1, 3 to 5 and 7"];
        assert_eq!(told, expected);
    }

    /// The teams of access points 0 and 2 have the same rates, and so the same lengths.
    #[test]
    fn every_length_of_links_is_told_once_and_every_team_with_its_tasks() {
        let robot = |x: f64, rate: f64| json!({"position": [x, 0.5], "rate": rate});
        let scenario: Scenario = serde_json::from_value(json!({
            "name": "three",
            "workspace": {"boundary": [[0.0, 0.0], [6.0, 0.0], [6.0, 1.0], [0.0, 1.0]]},
            "link": {"full_range": 0.4, "max_range": 0.5},
            "control": {"teams": "per_access_point"},
            "access_point": [
                {"position": [1.0, 0.2]}, {"position": [3.0, 0.2]}, {"position": [5.0, 0.2]},
            ],
            "robot": [robot(1.0, 0.05), robot(3.0, 0.4), robot(5.0, 0.05)],
            "task": [{"position": [5.2, 0.8]}, {"position": [1.2, 0.8]}, {"position": [5.4, 0.8]}],
        }))
        .unwrap();
        let scenario = ValidScenario::new(scenario).unwrap();
        let [of_first, of_second] = [0, 1].map(|fleet| {
            let fleet: &Fleet = &scenario.fleets()[fleet];
            quantity(fleet.scenario().site().usual.build)
        });
        assert_ne!(of_first, of_second);
        let told = longest_link(&scenario);
        assert_eq!(told.matches(&of_first).count(), 1, "{told}");
        assert_eq!(told.matches(" and ").count(), 1, "{told}");
        let teams: Vec<String> =
            scenario.fleets().iter().map(|fleet| team(fleet, &scenario)).collect();
        let expected = [
            "access point 0 at (1, 0.2): robot 0; task 1",
            "access point 1 at (3, 0.2): robot 1; no task",
            "access point 2 at (5, 0.2): robot 2; tasks 0 and 2",
        ];
        assert_eq!(teams, expected);
    }
}
