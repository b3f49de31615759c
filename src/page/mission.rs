//! The page of a mission: what it shows is collected while the mission runs, or from its trace.

use std::io;

use pleach_automaton::network::record::{End, Faults, MissionEvent, Outcome, Pursuit, Snapshot};
use pleach_automaton::network::scenario::{Scenario, Settings, ValidScenario};
use pleach_continuous::geometry::{Destination, FreeSpace};
use pleach_discrete::network::activity::may_follow;
use pleach_verify::network::{Referee, Violation, judged_faults};
use serde_json::{Map, Value, json};

use crate::figures::{self, Mark, TaskState, Walls};
use crate::mission::Watcher;
use crate::story;
use crate::summary::{self, Measured, Summary};
use crate::trace;

use super::document::{Document, Outcome as Shown, Row};
use super::steps::Steps;

/// Lengths are kept to a ten-thousandth of ρ or better.
const LENGTHS_PER_CLEARANCE: f64 = 1e4;

/// Watches a mission and makes the page on which it plays: one HTML file that needs no other.
///
/// The page shows the plan with robots, links and tree at every control period, the roles over
/// time, the curves, the story and a summary. Positions and other numbers are those of the trace,
/// rounded: lengths to a ten-thousandth of ρ, others to six decimals.
#[derive(Debug)]
pub struct MissionPage {
    scenario: Scenario,
    settings: Settings,
    free_space: FreeSpace,
    walls: Walls,
    /// By task: where its leader goes.
    destinations: Vec<Destination>,
    summary: Summary,
    judge: Referee<'static>,
    /// Whether that is by what no fault may break, and not by all definitions.
    has_faults: bool,
    /// What the judge found; it looks no further.
    violation: Option<Violation>,
    steps: Steps,
    events: Vec<Value>,
    /// The nodes that were absent in the control period before.
    absent: Vec<usize>,
    end: Option<End>,
}

impl MissionPage {
    /// The page of a mission of `scenario` that has not begun.
    pub fn new(scenario: &ValidScenario) -> MissionPage {
        MissionPage::with_faults(scenario, Faults::default())
    }

    /// The same of a mission in which these faults occur.
    pub fn with_faults(scenario: &ValidScenario, faults: Faults) -> MissionPage {
        let settings = *scenario.settings();
        let free_space = scenario.site().free_space.clone();
        let site = scenario.site();
        let start = scenario.robot.first().map_or([0.0; 2], |robot| robot.position).into();
        let goal =
            |place: [f64; 2]| free_space.destination(site.place_to_service(place.into(), start));
        let decimals = (LENGTHS_PER_CLEARANCE / settings.clearance).log10().ceil();
        MissionPage {
            destinations: scenario.task.iter().map(|task| goal(task.position)).collect(),
            walls: Walls::new(&scenario.workspace),
            summary: Summary::new(scenario),
            judge: Referee::new(scenario, faults, may_follow),
            has_faults: !judged_faults(&settings, faults).are_none(),
            violation: None,
            steps: Steps::new(decimals.clamp(0.0, 9.0) as i32),
            events: Vec::new(),
            absent: Vec::new(),
            end: None,
            scenario: scenario.with_defaults(),
            settings,
            free_space,
        }
    }

    /// The page so far, as an HTML document.
    #[must_use]
    pub fn render(&self) -> String {
        let document = Document {
            title: &self.scenario.name,
            lead: self.scenario.description.as_deref(),
            outcome: self.outcome(),
            summary: self.rows(),
            data: self.data(),
        };
        document.render()
    }

    fn data(&self) -> Value {
        let outline = self.free_space.outline().iter();
        let rings: Vec<Vec<[f64; 2]>> =
            outline.map(|ring| ring.iter().map(|&corner| corner.into()).collect()).collect();
        json!({
            "kind": "mission",
            "scenario": self.scenario,
            "free_space": rings,
            "marks": Mark::ALL.map(figures::mark_data),
            "moments": story::Moment::ALL.map(figures::moment_data),
            "tasks": TaskState::ALL.map(TaskState::name),
            "link": figures::link_data(),
            "steps": self.steps,
            "events": self.told_events(),
            "ended": self.end.is_some(),
        })
    }
}

/// What the page says in words.
impl MissionPage {
    /// The events, a violated property among them, and last how the mission ended.
    fn told_events(&self) -> Vec<Value> {
        let mut events = self.events.clone();
        let last = self.steps.count().saturating_sub(1);
        if let Some(violation) = &self.violation {
            let at = violation.step.min(last);
            let text = violation.to_string();
            let place = events.partition_point(|event| event["at"].as_u64() <= Some(at as u64));
            let told = json!({ "event": "violated", "at": at, "text": text, "telling": true });
            events.insert(place, told);
        }
        if let Some(end) = &self.end {
            let text = format!("the mission ends: {}", end.outcome.name().replace('_', " "));
            events.push(json!({ "event": "end", "at": last, "text": text, "telling": true }));
        }
        events
    }
}

impl Watcher for MissionPage {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        self.take_in(snapshot, events).map(|_| ())
    }

    fn end(&mut self, end: &End) -> io::Result<()> {
        // That a run was stopped for a violation is its outcome, and no finding of the judge.
        if end.outcome != Outcome::InvariantViolated && self.violation.is_none() {
            self.violation = self.judge.conclude(end).err();
        }
        self.end = Some(end.clone());
        Ok(())
    }
}

/// What a step shows beside its line in the trace.
impl MissionPage {
    /// Takes what is wrong with the order of the record; only what is found first counts.
    pub(super) fn note(&mut self, fault: Option<Violation>) {
        self.violation = self.violation.take().or(fault);
    }

    /// Observes a control period; also says how near robots are to each other and to walls.
    pub(crate) fn take_in(
        &mut self,
        snapshot: &Snapshot,
        events: &[MissionEvent],
    ) -> io::Result<[f64; 2]> {
        self.summary.observe(snapshot, events)?;
        self.note_attendance(snapshot);
        for event in events {
            self.events.push(event_data(snapshot.step, event)?);
        }
        let points: Vec<[f64; 2]> = snapshot.positions.iter().map(|&point| point.into()).collect();
        let distances = self.walls.distances(&points);
        let more = self.derived(snapshot, distances);
        let mut line = trace::step_line(snapshot)?;
        line.entry("absent").or_insert_with(|| json!([]));
        // What is over is among the states of tasks.
        line.remove("closed");
        self.steps.push(line, more);
        if self.violation.is_none() {
            self.violation = self.judge.observe(snapshot, events).err();
        }
        Ok(distances)
    }

    /// Tells which nodes have stopped or are back since the control period before.
    fn note_attendance(&mut self, snapshot: &Snapshot) {
        let robots = self.scenario.robot.len();
        let changed = |these: &[usize], others: &[usize], event: &str, what: &str| {
            let new = these.iter().filter(|node| !others.contains(node));
            let told = new.map(|&node| {
                let text = match node.checked_sub(robots) {
                    None => format!("robot {node} {what}"),
                    Some(number) => format!("access point {number} {what}"),
                };
                json!({ "event": event, "at": snapshot.step, "text": text, "telling": true })
            });
            told.collect::<Vec<_>>()
        };
        let (before, now) = (&self.absent, &snapshot.absent);
        let stopped = changed(now, before, "stopped", "has stopped, or is not received");
        let restarted = changed(before, now, "restarted", "is back");
        self.events.extend(stopped.into_iter().chain(restarted));
        self.absent.clone_from(now);
    }

    fn derived(&self, snapshot: &Snapshot, distances: [f64; 2]) -> Map<String, Value> {
        let marks: Vec<&str> =
            (0..snapshot.positions.len()).map(|robot| Mark::of(snapshot, robot).key()).collect();
        let tasks: Vec<&str> = (0..self.scenario.task.len())
            .map(|task| TaskState::of(snapshot, task).name())
            .collect();
        [
            ("mark", json!(marks)),
            ("task_state", json!(tasks)),
            ("distance", json!(distances)),
            ("geodesic", json!(self.geodesics(snapshot))),
        ]
        .map(|(name, value)| (name.to_owned(), value))
        .into_iter()
        .collect()
    }

    /// The waypoints of the shortest way from each leader to its task, with the leader.
    fn geodesics(&self, snapshot: &Snapshot) -> Vec<(usize, Vec<[f64; 2]>)> {
        let way = |pursuit: Pursuit| {
            let leader = *pursuit.primary_team.last()?;
            let (place, task) = (*snapshot.positions.get(leader)?, pursuit.task?);
            let way = self.free_space.geodesic_to(place, self.destinations.get(task)?)?;
            Some((leader, way.waypoints.into_iter().map(Into::into).collect()))
        };
        snapshot.pursuits().into_iter().filter_map(way).collect()
    }
}

/// The summary.
impl MissionPage {
    /// How the run ended, and by what it is judged if not by all definitions.
    fn outcome(&self) -> Shown {
        let mut shown = self.ending();
        if self.has_faults {
            shown.text += "; judged by what must hold under any fault";
        }
        shown
    }

    /// How the run ended, or what is wrong with its record unless the run says itself that it was stopped for that.
    fn ending(&self) -> Shown {
        let serviced = self.summary.serviced();
        let tally = format!("{serviced} of {} tasks serviced", self.scenario.task.len());
        let periods = self.steps.count();
        if let Some(violation) = &self.violation
            && self.end.as_ref().is_none_or(|end| end.outcome != Outcome::InvariantViolated)
        {
            let said = match &self.end {
                Some(end) => format!("the run says: {}", end.outcome.name().replace('_', " ")),
                None => "the trace stops without an outcome".to_owned(),
            };
            return Shown {
                class: "bad",
                headline: "violated".to_owned(),
                text: format!("{violation}; {said}, {tally} in {periods} control periods"),
            };
        }
        match &self.end {
            Some(end) if end.outcome == Outcome::Serviced => Shown {
                class: "good",
                headline: "serviced".to_owned(),
                text: format!("{tally} in {periods} control periods"),
            },
            Some(end) => Shown {
                class: if end.outcome == Outcome::InvariantViolated { "bad" } else { "doubtful" },
                headline: end.outcome.name().replace('_', " "),
                text: format!("{tally} in {periods} control periods; {}", end.reason),
            },
            None => Shown {
                class: "doubtful",
                headline: "no end".to_owned(),
                text: format!(
                    "{tally} in {periods} control periods; the trace stops without an outcome"
                ),
            },
        }
    }

    fn rows(&self) -> Vec<Row> {
        let mut rows: Vec<Row> = (0..)
            .zip(self.summary.tasks())
            .map(|(number, task)| {
                let [x, y] = task.position;
                let name = format!("task {number} at ({x}, {y})");
                match task.serviced.zip(task.robots()) {
                    Some(((step, _), robots)) => Row::at(name, format!("serviced {robots}"), step),
                    None => Row::new(name, task.unserviced(self.end.as_ref())),
                }
            })
            .collect();
        rows.push(Row::new("recruits elected", self.summary.recruits().to_string()));
        rows.push(Row::new("stationary points", self.summary.stationary_points().to_string()));
        let links = self.summary.links();
        let told = summary::links_told(links);
        rows.push(match links.most() {
            Some((_, instant)) => Row::at("links through walls", told, instant.step),
            None => Row::new("links through walls", told),
        });
        if links.are_worth_a_warning() {
            rows.push(Row::new("warning", summary::LINKS_WARNING.to_owned()));
        }
        let measured = summary::measured(self.judge.extremes(), &self.settings);
        rows.extend(measured.into_iter().map(|Measured { name, value, step, robots, bound }| {
            Row::at(name, format!("{value} ({robots}); {bound}"), step)
        }));
        rows.extend(
            self.violation
                .as_ref()
                .map(|violation| Row::at("violated", violation.to_string(), violation.step)),
        );
        rows
    }
}

/// An event as the trace writes it, with what the page says of it.
fn event_data(step: usize, event: &MissionEvent) -> io::Result<Value> {
    let mut data = serde_json::to_value(event)?;
    data["at"] = json!(step);
    data["text"] = json!(story::tell(event));
    data["telling"] = json!(story::is_telling(event));
    if let Some(caption) = story::caption(event) {
        data["moment"] = json!(caption.moment.name());
    }
    Ok(data)
}
