//! What missions say of tasks that they do not service, compared with a [search](Arrangements) for an arrangement.

use crate::arrangements::Arrangements;
use pleach::automaton::network::certificate::Certificate;
use pleach::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::continuous::Point;
use pleach::continuous::network::LinkReliability;
use pleach::mission::{self, Watcher};
use std::{fmt, io};

/// How a mission ended, and what a search says of that.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// How it ended.
    pub end: End,
    /// What is false about that, if anything is.
    pub falsehood: Option<Falsehood>,
    /// Whether the search neither confirms nor contradicts it.
    pub is_open: bool,
}

/// Why a verdict is false.
#[derive(Clone, Debug)]
pub struct Falsehood {
    /// What kind of verdict it is.
    pub kind: String,
    /// What contradicts it, as a sentence.
    pub contradiction: String,
}

impl fmt::Display for Falsehood {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", self.kind, self.contradiction)
    }
}

/// Runs the mission of a scenario, and compares what it says at its end.
pub fn verdict(scenario: &ValidScenario) -> Verdict {
    let mut last = Last::default();
    let end = mission::run(scenario, &mut [&mut last]).expect("a mission without errors").end;
    let opinion = compared(scenario, &end);
    let falsehood = match &opinion {
        Opinion::Contradicted(falsehood) => {
            let Falsehood { kind, contradiction } = falsehood;
            let contradiction = format!("{contradiction}\n  at the end {}", last.standing());
            Some(Falsehood {
                kind: format!("{kind}; {}", last.cause(scenario, &end)),
                contradiction,
            })
        }
        _ => None,
    };
    Verdict { end, falsehood, is_open: matches!(opinion, Opinion::Open) }
}

/// Runs the mission of a scenario: its outcome, and the violation with which it ends, if it does.
pub fn violation(scenario: &ValidScenario) -> (String, Option<Falsehood>) {
    let (outcome, found) = match mission::run(scenario, &mut []) {
        Ok(completed) => {
            let End { outcome, reason, .. } = completed.end;
            let violated = outcome == Outcome::InvariantViolated;
            (outcome.name(), violated.then_some(("invariant violated", reason)))
        }
        Err(error) => ("error", Some(("error", error.to_string()))),
    };
    let falsehood =
        |(kind, contradiction): (&str, String)| Falsehood { kind: kind.to_owned(), contradiction };
    (outcome.to_owned(), found.map(falsehood))
}

/// What a search says of the end of a mission.
#[derive(Clone, Debug)]
pub enum Opinion {
    /// It had to be so.
    Confirmed,
    /// The grid is too coarse to say.
    Open,
    /// It is false.
    Contradicted(Falsehood),
}

impl Opinion {
    fn contradicted(kind: impl Into<String>, contradiction: String) -> Self {
        Opinion::Contradicted(Falsehood { kind: kind.into(), contradiction })
    }

    fn open_if(is_open: bool) -> Self {
        if is_open { Opinion::Open } else { Opinion::Confirmed }
    }
}

/// What a search says of the end of a mission of this scenario.
pub fn compared(scenario: &ValidScenario, end: &End) -> Opinion {
    let (search, robots) = (Arrangements::of(scenario), scenario.robot.len());
    let task = end.task.unwrap_or_default();
    match end.outcome {
        Outcome::Serviced => {
            let all: Vec<usize> = (0..scenario.task.len()).collect();
            match search.least(&all) {
                Some(least) if least <= robots => Opinion::Confirmed,
                least => {
                    let told = format!("{robots} robots service what takes {least:?}");
                    Opinion::contradicted("the search is wrong", told)
                }
            }
        }
        Outcome::UnreachableTask if search.is_in_reach(task) => Opinion::contradicted(
            "unreachable",
            format!("a robot can come within δ of task {task}"),
        ),
        Outcome::UnreachableTask => Opinion::open_if(!search.is_out_of_reach(task)),
        Outcome::InsufficientRobots | Outcome::Blocked => {
            let tasks: Vec<usize> = (0..=task).collect();
            let (certificate, most) = match &end.certificate {
                Some(Certificate::Bound(bound)) => ("bound", bound.least - 1),
                certificate => {
                    let name = certificate.as_ref().map_or("no certificate", Certificate::name);
                    (name, search.team())
                }
            };
            match arrangement(scenario, &search, &tasks, most) {
                Some(found) => {
                    let kind = format!("{}, {certificate}, {}", end.outcome.name(), found.links());
                    Opinion::contradicted(kind, format!("{}\n  but {found}", end.reason))
                }
                None => Opinion::open_if(search.least(&tasks).is_some_and(|least| least <= most)),
            }
        }
        _ => Opinion::contradicted("the end", end.reason.clone()),
    }
}

/// An arrangement that contradicts a verdict.
struct Found<'s> {
    scenario: &'s ValidScenario,
    /// How long its links may be.
    reach: f64,
    places: Vec<Point>,
}

/// An arrangement with fully reliable links, or else with links each of which carries the rates of all robots.
fn arrangement<'s>(
    scenario: &'s ValidScenario,
    search: &Arrangements,
    tasks: &[usize],
    most: usize,
) -> Option<Found<'s>> {
    let site = scenario.site();
    let rates: f64 = scenario.robot.iter().map(|robot| robot.rate).sum();
    let carrying = site.radio.distance_at(rates.max(site.settings.tree_reliability));
    [site.settings.link.full_range, carrying].into_iter().find_map(|reach| {
        let places = search.found(tasks, reach, most)?;
        Some(Found { scenario, reach, places })
    })
}

impl Found<'_> {
    fn links(&self) -> &'static str {
        match self.reach <= self.scenario.link.full_range {
            true => "with links that are fully reliable",
            false => "with longer links",
        }
    }

    /// How many of its robots see no node in their reach.
    fn hidden(&self) -> usize {
        let site = self.scenario.site();
        let nodes: Vec<Point> = self.places.iter().chain(&site.access_points).copied().collect();
        let is_linked = |one: Point, other: Point| {
            one != other
                && (one - other).norm() <= self.reach
                && site.workspace.segment_clearance(one, other) > 0.0
        };
        let is_hidden = |place: &&Point| !nodes.iter().any(|&other| is_linked(**place, other));
        self.places.iter().filter(is_hidden).count()
    }
}

impl fmt::Display for Found<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (count, robots) = (self.places.len(), self.scenario.robot.len());
        write!(formatter, "{count} robots suffice, and there are {robots}; with links up to ")?;
        write!(formatter, "{:.3}, at{}", self.reach, listed(&self.places))?;
        match self.hidden() {
            0 => Ok(()),
            hidden => write!(formatter, "; {hidden} of them linked through walls alone"),
        }
    }
}

fn listed(places: &[Point]) -> String {
    places.iter().map(|place| format!(" ({:.3}, {:.3})", place.x, place.y)).collect()
}

/// The last that a mission showed, and what its last leader was bound to when it was elected.
#[derive(Default)]
struct Last {
    snapshot: Option<Snapshot>,
    leader: Option<Bonds>,
}

/// What binds a robot to its place.
#[derive(Clone, Copy, Debug)]
enum Bonds {
    None,
    UnusedPost,
    Duties,
}

impl Watcher for Last {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        for event in events {
            if let MissionEvent::LeaderElected { robot, conflict, .. } = *event {
                let has_child = snapshot.tree.iter().any(|&(_, parent)| parent == robot);
                let has_task = snapshot.serviced.iter().any(|&(_, holder)| holder == robot);
                self.leader = Some(match (conflict, has_child || has_task) {
                    (false, _) => Bonds::None,
                    (true, false) => Bonds::UnusedPost,
                    (true, true) => Bonds::Duties,
                });
            }
        }
        self.snapshot = Some(snapshot.clone());
        Ok(())
    }
}

impl Last {
    /// What the last state has to do with the end, as far as that is seen from outside.
    fn cause(&self, scenario: &ValidScenario, end: &End) -> &'static str {
        let delta = scenario.site().settings.service_radius;
        let places = self.snapshot.as_ref().map_or(&[][..], |last| &last.positions);
        let is_within = |task: usize| {
            let task = Point::from(scenario.task[task].position);
            places.iter().any(|place| (place - task).norm() <= delta)
        };
        match self.leader {
            _ if end.task.is_some_and(is_within) => "a robot is within δ of the task",
            None => "nobody leads",
            Some(Bonds::None) => "the leader is free",
            Some(Bonds::UnusedPost) => "the leader is bound to a post that nothing depends on",
            Some(Bonds::Duties) => "the leader is bound to its duties",
        }
    }

    /// Where robots stand, and as what.
    fn standing(&self) -> String {
        let Some(last) = &self.snapshot else { return "nothing was seen".to_owned() };
        let robots = last.roles.iter().zip(&last.positions);
        let told = robots.map(|(role, place)| format!("{} at{}", role.name(), listed(&[*place])));
        format!("k = {}: {}", last.step, told.collect::<Vec<_>>().join(", "))
    }
}
