//! What missions say of tasks that they give up, compared with a [search](Arrangements) for an arrangement.

use crate::arrangements::Arrangements;
use pleach::automaton::network::certificate::Certificate;
use pleach::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::continuous::Point;
use pleach::continuous::network::LinkReliability;
use pleach::mission::{self, Watcher};
use std::{fmt, io};

/// How a mission ended, and what a search says of the tasks that it gave up.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// How it ended.
    pub outcome: Outcome,
    /// What is false.
    pub falsehoods: Vec<Falsehood>,
    /// How many tasks are given up with a reason that the search neither confirms nor contradicts.
    pub open: usize,
}

/// What a mission says that is not so.
#[derive(Clone, Debug)]
pub struct Falsehood {
    /// What kind of falsehood it is.
    pub kind: String,
    /// What contradicts it.
    pub contradiction: String,
}

impl fmt::Display for Falsehood {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", self.kind, self.contradiction)
    }
}

/// Runs the mission of a scenario, and compares what it says of each task that it gives up.
pub fn verdict(scenario: &ValidScenario) -> Verdict {
    let mut account = Account::new(scenario);
    let end = mission::run(scenario, &mut [&mut account]).expect("a mission without errors").end;
    let search = Arrangements::of(scenario);
    let mut verdict = Verdict { outcome: end.outcome, falsehoods: Vec::new(), open: 0 };
    for (claim, state) in &account.claims {
        match compared(scenario, &search, claim) {
            Opinion::Confirmed => {}
            Opinion::Open => verdict.open += 1,
            Opinion::Contradicted(Falsehood { kind, contradiction }) => {
                let kind = format!("{kind}; {}", state.cause);
                let contradiction = format!("{contradiction}\n  then {}", state.standing);
                verdict.falsehoods.push(Falsehood { kind, contradiction });
            }
        }
    }
    verdict.falsehoods.extend(false_end(scenario, &search, &end, &account.serviced));
    verdict
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

/// What is false about the end itself: the mission does not come to one, or services what the search says it cannot.
fn false_end(
    scenario: &ValidScenario,
    search: &Arrangements,
    end: &End,
    serviced: &[usize],
) -> Option<Falsehood> {
    if matches!(end.outcome, Outcome::InvariantViolated | Outcome::StepLimit) {
        let kind = end.outcome.name().to_owned();
        return Some(Falsehood { kind, contradiction: end.reason.clone() });
    }
    let (least, robots) = (search.least(serviced), scenario.robot.len());
    let contradiction = format!("{robots} robots service tasks {serviced:?}, which take {least:?}");
    let is_wrong = least.is_none_or(|least| least > robots);
    is_wrong.then(|| Falsehood { kind: "the search is wrong".to_owned(), contradiction })
}

/// Why a task is given up.
#[derive(Clone, Debug)]
pub struct Claim {
    /// The task.
    pub task: usize,
    /// The tasks that are serviced at the same time.
    pub serviced: Vec<usize>,
    /// What it ends like.
    pub outcome: Outcome,
    /// The reason, as a sentence.
    pub reason: String,
    /// What observers add to show it.
    pub certificate: Option<Certificate>,
}

/// What a search says of a claim.
#[derive(Clone, Debug)]
pub enum Opinion {
    /// It is true.
    Confirmed,
    /// The grid is too coarse to say.
    Open,
    /// It is false.
    Contradicted(Falsehood),
}

impl Opinion {
    fn open_if(is_open: bool) -> Self {
        if is_open { Opinion::Open } else { Opinion::Confirmed }
    }
}

/// What a search says of a claim about a task of this scenario.
pub fn compared(scenario: &ValidScenario, search: &Arrangements, claim: &Claim) -> Opinion {
    let Claim { task, serviced, outcome, reason, certificate } = claim;
    if *outcome == Outcome::UnreachableTask {
        return match search.is_in_reach(*task) {
            true => Opinion::Contradicted(Falsehood {
                kind: outcome.name().to_owned(),
                contradiction: format!("a robot can come within δ of task {task}: {reason}"),
            }),
            false => Opinion::open_if(!search.is_out_of_reach(*task)),
        };
    }
    let tasks: Vec<usize> = serviced.iter().chain([task]).copied().collect();
    let most = match certificate {
        Some(Certificate::Bound(bound)) => bound.least - 1,
        _ => search.team(),
    };
    let Some(found) = Found::new(scenario, search, &tasks, most) else {
        return Opinion::open_if(search.least(&tasks).is_some_and(|least| least <= most));
    };
    let proof = certificate.as_ref().map_or("no certificate", Certificate::name);
    Opinion::Contradicted(Falsehood {
        kind: format!("{}, {proof}; {}", outcome.name(), found.links()),
        contradiction: format!("task {task}: {reason}\n  but {found}"),
    })
}

/// An arrangement that contradicts a claim.
struct Found<'s> {
    scenario: &'s ValidScenario,
    /// How long its links may be.
    reach: f64,
    places: Vec<Point>,
}

impl<'s> Found<'s> {
    /// One with fully reliable links, or else with links each of which carries the rates of all robots.
    fn new(
        scenario: &'s ValidScenario,
        search: &Arrangements,
        tasks: &[usize],
        most: usize,
    ) -> Option<Self> {
        let site = scenario.site();
        let rates: f64 = scenario.robot.iter().map(|robot| robot.rate).sum();
        let carrying = site.radio.distance_at(rates.max(site.settings.tree_reliability));
        [site.settings.link.full_range, carrying].into_iter().find_map(|reach| {
            let places = search.found(tasks, reach, most)?;
            Some(Found { scenario, reach, places })
        })
    }

    fn links(&self) -> &'static str {
        match self.reach <= self.scenario.link.full_range {
            true => "reliable links suffice",
            false => "longer links suffice",
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

/// What a mission claims, each with the state in which it does.
struct Account<'s> {
    scenario: &'s ValidScenario,
    /// What binds the robot that was elected last.
    leader: Option<Bonds>,
    claims: Vec<(Claim, State)>,
    /// The tasks that are serviced now.
    serviced: Vec<usize>,
}

/// What binds a robot to its place when it is elected.
#[derive(Clone, Copy, Debug)]
enum Bonds {
    None,
    UnusedPost,
    Duties,
}

/// What a state has to do with a claim, as far as that is seen from outside.
struct State {
    cause: &'static str,
    /// Where robots stand, and as what.
    standing: String,
}

impl<'s> Account<'s> {
    fn new(scenario: &'s ValidScenario) -> Self {
        Account { scenario, leader: None, claims: Vec::new(), serviced: Vec::new() }
    }

    fn state(&self, task: usize, snapshot: &Snapshot) -> State {
        let delta = self.scenario.site().settings.service_radius;
        let place = Point::from(self.scenario.task[task].position);
        let cause = match self.leader {
            _ if snapshot.positions.iter().any(|robot| (robot - place).norm() <= delta) => {
                "a robot is within δ of the task"
            }
            None => "nobody was elected",
            Some(Bonds::None) => "the leader was free",
            Some(Bonds::UnusedPost) => "the leader was bound to a post that nothing depends on",
            Some(Bonds::Duties) => "the leader was bound to its duties",
        };
        let robots = snapshot.roles.iter().zip(&snapshot.positions);
        let told = robots.map(|(role, place)| format!("{} at{}", role.name(), listed(&[*place])));
        let standing = format!("k = {}: {}", snapshot.step, told.collect::<Vec<_>>().join(", "));
        State { cause, standing }
    }
}

impl Watcher for Account<'_> {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        self.serviced = snapshot.serviced.iter().map(|&(task, _)| task).collect();
        for event in events {
            match event {
                &MissionEvent::LeaderElected { robot, conflict, .. } => {
                    let has_child = snapshot.tree.iter().any(|&(_, parent)| parent == robot);
                    let has_task = snapshot.serviced.iter().any(|&(_, holder)| holder == robot);
                    self.leader = Some(match (conflict, has_child || has_task) {
                        (false, _) => Bonds::None,
                        (true, false) => Bonds::UnusedPost,
                        (true, true) => Bonds::Duties,
                    });
                }
                MissionEvent::TaskAnnounced { .. } => self.leader = None,
                MissionEvent::TaskGivenUp { task, outcome, reason, certificate } => {
                    let claim = Claim {
                        task: *task,
                        serviced: self.serviced.clone(),
                        outcome: *outcome,
                        reason: reason.clone(),
                        certificate: certificate.as_deref().cloned(),
                    };
                    self.claims.push((claim, self.state(*task, snapshot)));
                }
                _ => {}
            }
        }
        Ok(())
    }
}
