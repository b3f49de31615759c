//! The judge: a whole record of a mission, held against the definitions.
//!
//! What a record shows is of three kinds, and each is judged in its own way:
//!
//! - **the world**: positions, flows, parents. The [`Monitor`] holds them against the
//!   [properties](Property) that speak of one instant or one control period;
//! - **events**: each is a claim, that it is true of the world at its instant (`claims`) and
//!   that it follows from the events before it (`ledger`);
//! - **what observers conclude**: phase, task, teams, posts, who answers for a task. The judge
//!   derives them from the events and the world, and they are compared (`conclusions`).
//!
//! So nothing is taken on trust but that robots are where the record shows them. A run is judged
//! while it goes on, and a trace afterwards, by the same code.
//!
//! Where messages are lost and nodes stop, robots need not know the same, and observers cannot
//! conclude what they can without faults. Such a record is held against what must hold under any fault
//! ([`Safety`]). The [`Referee`] is the one or the other, or has one of them for each of several fleets
//! ([`JudgeOfFleets`]).

mod account;
mod certificate;
mod claims;
mod clock;
mod conclusions;
mod fleets;
mod ground;
mod lately;
mod ledger;
mod places;
mod posts;
mod referee;
mod safety;
mod states;
mod tasks;
mod terms;
mod verdicts;
mod walk;

use std::collections::VecDeque;

use pleach_automaton::network::certificate::{Certificate, Then};
use pleach_automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use pleach_automaton::network::scenario::{Strategy, ValidScenario};
use pleach_continuous::Point;
use pleach_discrete::network::{Phase, Role};

use super::extremes::Extremes;
use super::instant;
use super::limits::Limits;
use super::monitor::Monitor;
use super::property::Property;
use super::violation::{Instant, Violation};
use certificate::Claim;
pub(super) use clock::Clock;
use conclusions::Conclusions;
pub use fleets::JudgeOfFleets;
use ground::Ground;
use ledger::{Ledger, Stage};
use places::Places;
pub use referee::{Referee, judged_faults};
pub use safety::Safety;
pub(super) use safety::relayed;
pub(super) use tasks::TaskClaims;
use terms::Terms;
use verdicts::{Trial, Tried};

/// What is wrong with an entry of the record; the instant is added where it is known.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dispute {
    /// The property that fails.
    pub property: Property,
    /// The robots concerned.
    pub robots: Vec<usize>,
    /// What was measured, and what it is compared with.
    pub measured: (f64, f64),
    /// What is wrong, as a clause without a full stop.
    pub sentence: String,
}

/// "task 3", or "no task".
fn task_or_none(task: Option<usize>) -> String {
    task.map_or_else(|| "no task".to_owned(), |task| format!("task {task}"))
}

impl Dispute {
    fn of(property: Property, robots: &[usize], sentence: String) -> Self {
        Dispute { property, robots: robots.to_vec(), measured: (0.0, 1.0), sentence }
    }

    fn measuring(self, value: f64, bound: f64) -> Self {
        Dispute { measured: (value, bound), ..self }
    }

    pub(super) fn at(self, instant: Instant) -> Violation {
        instant.violation(self.property, &self.robots, self.measured, self.sentence)
    }
}

/// An instant of the record with all that the judge knows of it.
struct Scene<'a> {
    snapshot: &'a Snapshot,
    /// What is told of the period that ends with the snapshot.
    events: &'a [MissionEvent],
    previous: Option<&'a Snapshot>,
    /// Where the robots were at the ends of the last [`RECENT`] periods.
    recent: &'a VecDeque<Vec<Point>>,
    limits: &'a Limits,
    places: &'a Places,
}

/// How many control periods are looked back on: a robot that moves back and forth between a few places
/// makes no progress.
const RECENT: usize = 16;

/// Judges a mission, period by period, and stops at the first violation.
///
/// Events of one control period are told by robots that do not wait for each other: they count as
/// happened in an order in which each can follow those before it.
#[derive(Clone, Debug)]
pub struct Judge<'a> {
    monitor: Monitor<'a>,
    clock: Clock,
    ledger: Ledger,
    conclusions: Conclusions,
    terms: Terms,
    /// The step at which the task that was pursued has been taken back.
    dissolved: Option<usize>,
    /// The last step at which a recruit was called for or a secondary team was on its way.
    busy: usize,
    places: Places,
    tried: Tried,
    scenario: ValidScenario,
    previous: Option<Snapshot>,
    /// The snapshot before robots knew that the mission has ended, if they do.
    undecided: Option<Snapshot>,
    recent: VecDeque<Vec<Point>>,
    /// Where each robot went last: one that has given up goes nowhere.
    headings: Vec<Option<Point>>,
    /// Where the robots of other fleets are at the last snapshot.
    bodies: Vec<Point>,
}

impl<'a> Judge<'a> {
    /// A judge that has seen nothing yet; `role_table` tells whether a role may turn into another
    /// in one transition.
    pub fn new(scenario: &ValidScenario, role_table: impl Fn(Role, Role) -> bool + 'a) -> Self {
        let monitor = Monitor::new(scenario, role_table);
        let (robots, nodes) = (monitor.limits().robots(), monitor.limits().nodes());
        Judge {
            clock: Clock::of(scenario),
            ledger: Ledger::new(robots),
            conclusions: Conclusions::new(nodes),
            terms: Terms::of(scenario),
            dissolved: None,
            busy: 0,
            places: Places::new(robots),
            tried: Tried::default(),
            scenario: scenario.clone(),
            previous: None,
            undecided: None,
            recent: VecDeque::with_capacity(RECENT + 1),
            headings: vec![None; robots],
            bodies: Vec::new(),
            monitor,
        }
    }

    /// Where the robots of other fleets are at the next snapshot.
    pub(super) fn show_bodies(&mut self, bodies: Vec<Point>) {
        self.bodies = bodies;
    }

    /// Judges the control period that ends with this snapshot, its events, and the snapshot.
    ///
    /// # Errors
    ///
    /// The first violation; what is observed after it has no meaning.
    pub fn observe(
        &mut self,
        snapshot: &Snapshot,
        events: &[MissionEvent],
    ) -> Result<(), Violation> {
        let now = Instant::of(snapshot);
        self.monitor.expect(events);
        self.monitor.observe(snapshot)?;
        let opens = self.previous.is_none();
        self.clock.check(snapshot, opens).map_err(|dispute| dispute.at(now))?;
        safety::all_are_present(snapshot, "where nothing fails")
            .map_err(|dispute| dispute.at(now))?;
        for event in events {
            let limits = self.monitor.limits();
            claims::names_exist(event, limits).map_err(|dispute| dispute.at(now))?;
            self.monitor.observe_event(event)?;
        }
        self.enter_all(events, snapshot).map_err(|dispute| dispute.at(now))?;
        self.tasks_are_closed(snapshot).map_err(|dispute| dispute.at(now))?;
        self.conclude_period(snapshot, events).map_err(|dispute| dispute.at(now))?;
        instant::locations(snapshot)?;
        self.recent.push_back(snapshot.positions.clone());
        if self.recent.len() > RECENT {
            self.recent.pop_front();
        }
        for (heading, shown) in self.headings.iter_mut().zip(&snapshot.robots) {
            *heading = shown.target.or(*heading);
        }
        let before = self.previous.replace(snapshot.clone());
        self.undecided = match snapshot.phase {
            Phase::Ended => self.undecided.take().or(before),
            _ => None,
        };
        Ok(())
    }

    /// Tasks that are taken back, and those that have lasted as long as they should, are closed before news
    /// can be everywhere.
    fn tasks_are_closed(&mut self, snapshot: &Snapshot) -> Result<(), Dispute> {
        let patience = self.monitor.limits().nodes();
        if self.ledger.outdated.is_none() {
            self.dissolved = None;
        } else if *self.dissolved.get_or_insert(snapshot.step) + patience < snapshot.step {
            self.ledger.forget_outdated();
        }
        if matches!(self.ledger.stage(), Stage::Calling | Stage::Shifting) {
            self.busy = snapshot.step;
        }
        let overdue = || self.terms.overdue(snapshot.step, self.busy, patience);
        match (snapshot.phase != Phase::Ended).then(overdue).flatten() {
            None => Ok(()),
            Some(sentence) => Err(Dispute::of(Property::Duties, &[], sentence)),
        }
    }

    /// Enters the events of a period, each as soon as it can follow those before it.
    fn enter_all(&mut self, events: &[MissionEvent], snapshot: &Snapshot) -> Result<(), Dispute> {
        let mut pending: Vec<&MissionEvent> = events.iter().collect();
        while !pending.is_empty() {
            let mut first = None;
            let entered = pending.iter().enumerate().find_map(|(at, event)| {
                match self.follows(event, events, snapshot) {
                    Ok(ledger) => Some((at, ledger)),
                    Err(dispute) => {
                        first.get_or_insert(dispute);
                        None
                    }
                }
            });
            match (entered, first) {
                (Some((at, ledger)), _) => self.enter(pending.remove(at), ledger, snapshot)?,
                (None, Some(dispute)) => return Err(dispute),
                (None, None) => break,
            }
        }
        Ok(())
    }

    fn scene<'s>(&'s self, snapshot: &'s Snapshot, events: &'s [MissionEvent]) -> Scene<'s> {
        Scene {
            snapshot,
            events,
            previous: self.previous.as_ref(),
            recent: &self.recent,
            limits: self.monitor.limits(),
            places: &self.places,
        }
    }

    /// The ledger after an event that is true and can follow those before it.
    fn follows(
        &self,
        event: &MissionEvent,
        events: &[MissionEvent],
        snapshot: &Snapshot,
    ) -> Result<Ledger, Dispute> {
        let scene = self.scene(snapshot, events);
        let told = claims::is_true(event, &self.ledger, &scene);
        // Robots that have not heard that their task is taken back go on as if it were not.
        match (told, &self.ledger.outdated) {
            (Err(dispute), Some(known)) => {
                claims::is_true(event, known, &scene).map_err(|_| dispute)?;
            }
            (told, _) => told?,
        }
        self.stretches_for_want_of_a_robot(event)?;
        self.comes_next(event, snapshot)?;
        self.has_to_be_given_up(event)?;
        self.terms.clone().enter(event, snapshot.step)?;
        self.calls_for_want_of_length(event, snapshot)?;
        let mut ledger = self.ledger.clone();
        ledger.enter(event)?;
        Ok(ledger)
    }

    /// Tasks are announced in the order of the mission.
    fn comes_next(&self, event: &MissionEvent, snapshot: &Snapshot) -> Result<(), Dispute> {
        let MissionEvent::TaskAnnounced { task } = *event else { return Ok(()) };
        let earlier = self.terms.unfinished_before(task, snapshot.step);
        match earlier.or_else(|| self.nearer_than(task, snapshot.step)) {
            None => Ok(()),
            Some(other) => {
                let sentence = format!("task {task} is announced, and task {other} is the next");
                Err(Dispute::of(Property::Events, &[], sentence))
            }
        }
    }

    /// With `order = "nearest"`, a task that is clearly nearer to the access points and the tasks that are serviced.
    fn nearer_than(&self, task: usize, step: usize) -> Option<usize> {
        let rivals = self.terms.rivals_of(task, step);
        let limits = self.monitor.limits();
        let ground = Ground::of(&self.scenario, limits).filter(|_| !rivals.is_empty())?;
        let serviced = self.terms.serviced().map(|task| limits.tasks()[task]);
        let roots: Vec<Point> = limits.access_points().iter().copied().chain(serviced).collect();
        let way = |task: usize| ground.way_between(&roots, limits.tasks()[task]);
        let least = way(task) - ground.tolerance();
        rivals.into_iter().find(|&rival| way(rival) < least)
    }

    /// A task is given up where no robot could service it.
    fn has_to_be_given_up(&self, event: &MissionEvent) -> Result<(), Dispute> {
        let MissionEvent::TaskGivenUp { task, outcome, certificate, .. } = event else {
            return Ok(());
        };
        let claim =
            Claim { outcome: *outcome, task: Some(*task), certificate: certificate.as_deref() };
        let complaint = certificate::check(self, &claim).err();
        match complaint.or_else(|| self.refutation(*outcome)) {
            None => Ok(()),
            Some(sentence) => {
                Err(Dispute::of(Property::Outcome, &[], format!("task {task}: {sentence}")))
            }
        }
    }

    /// A team stretches its links where no robot could have come.
    fn stretches_for_want_of_a_robot(&self, event: &MissionEvent) -> Result<(), Dispute> {
        let (MissionEvent::LinksStretched { robot }, Some(previous)) = (event, &self.previous)
        else {
            return Ok(());
        };
        match self.tried.overlooked(&self.ledger, previous) {
            None => Ok(()),
            Some(overlooked) => {
                let sentence = format!("links are stretched for lack of a robot, but {overlooked}");
                Err(Dispute::of(Property::Events, &[*robot], sentence))
            }
        }
    }

    /// A team calls for a recruit before it stands still where its links cannot reach the task.
    fn calls_for_want_of_length(
        &self,
        event: &MissionEvent,
        snapshot: &Snapshot,
    ) -> Result<(), Dispute> {
        let MissionEvent::RecruitCalled { robot } = *event else { return Ok(()) };
        let limits = self.monitor.limits();
        // Robots that have not heard that their task is taken back pursue it.
        let mut known = [Some(&self.ledger), self.ledger.outdated.as_deref()].into_iter().flatten();
        let clause = match limits.settings().strategy {
            Strategy::Eager if known.any(|it| self.is_too_short(it, robot, snapshot)) => {
                return Ok(());
            }
            Strategy::Eager => "although the links of its team reach the task",
            _ => "and teams call only when they stand still",
        };
        let sentence = format!("robot {robot} calls for a recruit ahead of a standstill, {clause}");
        Err(Dispute::of(Property::Events, &[robot], sentence))
    }

    /// Whether more links than the team has robots lead from the parent of p₁ to the place nearest to the task, at the
    /// beginning or at the end of the period.
    fn is_too_short(&self, ledger: &Ledger, first: usize, snapshot: &Snapshot) -> bool {
        let limits = self.monitor.limits();
        let ground = Ground::of(&self.scenario, limits);
        let Some((ground, task)) = ground.zip(ledger.task()) else { return false };
        let (members, link) = (ledger.primary_team.len() as u32, self.link_limit());
        [self.previous.as_ref(), Some(snapshot)].into_iter().flatten().any(|snapshot| {
            let parent = verdicts::parent_of(first, snapshot);
            parent.is_some_and(|parent| {
                ground.links_to(limits.tasks()[task], parent, snapshot, link) > members
            })
        })
    }

    /// Takes an event with the ledger after it.
    fn enter(
        &mut self,
        event: &MissionEvent,
        ledger: Ledger,
        snapshot: &Snapshot,
    ) -> Result<(), Dispute> {
        self.tried.enter(event, &self.ledger, [self.previous.as_ref(), Some(snapshot)]);
        self.ledger = ledger;
        self.terms.enter(event, snapshot.step)?;
        self.places.enter(event, snapshot);
        self.conclusions.enter(event, &self.ledger, snapshot.step)
    }

    fn conclude_period(
        &mut self,
        snapshot: &Snapshot,
        events: &[MissionEvent],
    ) -> Result<(), Dispute> {
        self.conclusions.named_teams_are_those(events, &self.ledger, snapshot)?;
        let scene = Scene {
            snapshot,
            events,
            previous: self.previous.as_ref(),
            recent: &self.recent,
            limits: self.monitor.limits(),
            places: &self.places,
        };
        self.conclusions.compare(&self.ledger, &scene)?;
        self.places.hold(&scene)?;
        self.conclusions.posts_stay(&scene)?;
        self.conclusions.moves_have_a_cause(&self.ledger, &scene)?;
        self.places.update(snapshot);
        Ok(())
    }

    /// Judges how the mission ended.
    ///
    /// # Errors
    ///
    /// [`Property::Outcome`] if the record does not show what the outcome says.
    pub fn conclude(&self, end: &End) -> Result<(), Violation> {
        let now = self.previous.as_ref().map_or(Instant { step: 0, time: 0.0 }, Instant::of);
        let done = self.terms.done();
        let tasks = self.monitor.limits().tasks().len();
        let last = self.previous.as_ref().map(|snapshot| snapshot.step);
        let complaint = self.clock.contradiction(end, last, (done, tasks));
        let complaint = complaint.or_else(|| self.terms.contradiction(end));
        let is_done = done == tasks && self.terms.awaits_no_end();
        let complaint = complaint.or_else(|| match end.outcome {
            _ if self.conclusions.overdue(now.step, self.settles(end.outcome)) => {
                Some("the robots knew that the mission had ended, and it went on".to_owned())
            }
            // Each of these tasks has come with its own certificate.
            _ if end.tasks.is_empty() && !self.terms.given_up().is_empty() => {
                Some("tasks were given up, and the end lists none".to_owned())
            }
            _ if end.outcome.is_given_up() && end.is_of_given_up_tasks() => None,
            Outcome::InsufficientRobots | Outcome::UnreachableTask | Outcome::Blocked
                if end.task.is_some() && end.task != self.ledger.task() =>
            {
                Some(format!(
                    "the mission ends over {}, and {} is pursued",
                    task_or_none(end.task),
                    task_or_none(self.ledger.task())
                ))
            }
            Outcome::Serviced | Outcome::StepLimit | Outcome::Interrupted => None,
            _ if is_done && tasks > 0 => {
                Some(format!("the outcome is “{}”, and all tasks are serviced", end.outcome.name()))
            }
            _ if end.outcome.is_given_up() => {
                let complaint = certificate::check(self, &Claim::of(end)).err();
                complaint.or_else(|| self.refutation(end.outcome))
            }
            _ => None,
        });
        match complaint {
            None => Ok(()),
            Some(sentence) => Err(Dispute::of(Property::Outcome, &[], sentence).at(now)),
        }
    }

    /// Whether robots may change their places in the tree before a mission with this outcome is over.
    fn settles(&self, outcome: Outcome) -> bool {
        let strategy = self.monitor.limits().settings().strategy;
        strategy == Strategy::Eager && !outcome.is_given_up()
    }

    /// An observer's account of why the mission ended: what its end should come with.
    pub fn account(&self, end: &End) -> Option<Certificate> {
        account::of(self, end.outcome, end.task)
    }

    /// The same of why a task is given up in the period that ends with this snapshot, among these events.
    fn account_of_task(
        &self,
        task: usize,
        outcome: Outcome,
        snapshot: &Snapshot,
        events: &[MissionEvent],
    ) -> Option<Certificate> {
        let is_before = |event: &&MissionEvent| match **event {
            MissionEvent::TaskAnnounced { task: announced } => announced == task,
            MissionEvent::TaskGivenUp { .. } => false,
            _ => true,
        };
        let before: Vec<MissionEvent> = events.iter().filter(is_before).cloned().collect();
        let mut then = self.clone();
        // What cannot be entered is disputed when the period is judged.
        let _ = then.enter_all(&before, snapshot);
        account::of(&then, outcome, Some(task))
    }

    /// The tasks that are serviced at the same time as the one that is pursued.
    fn tasks_together(&self) -> Vec<usize> {
        self.ledger.serviced.keys().copied().chain(self.ledger.task()).collect()
    }

    /// The call for a recruit with which the mission ended, if it ended with one.
    fn last_trial(&self) -> Option<Trial> {
        self.tried.trial(&self.ledger, self.instant_of_last_call()?, Then::Ended)
    }

    /// The instant by which it is judged whether a robot could have come: the last one or, if a robot has become
    /// redundant since robots knew that the mission has ended, the one before they did.
    fn instant_of_last_call(&self) -> Option<&Snapshot> {
        let last = self.previous.as_ref()?;
        let is_late = |before: &&Snapshot| {
            let mut roles = before.roles.iter().zip(&last.roles);
            roles.any(|(&was, &is)| was != Role::Redundant && is == Role::Redundant)
        };
        self.undecided.as_ref().filter(is_late).or(Some(last))
    }

    /// Whether the election was repeated, and has no leader.
    fn nobody_leads(&self) -> bool {
        let last = self.tried.trials().last().map(|trial| trial.then);
        self.ledger.stage() == Stage::Electing && last == Some(Then::ElectionRepeated)
    }

    /// Up to which length links of the tree are made now.
    fn link_limit(&self) -> f64 {
        self.monitor.limits().link_to_be_made(self.ledger.stretched)
    }

    /// Why robots are not too few although the mission ended for that reason, as a clause.
    fn refutation(&self, outcome: Outcome) -> Option<String> {
        if outcome != Outcome::InsufficientRobots {
            return None;
        }
        let overlooked = self.tried.overlooked(&self.ledger, self.instant_of_last_call()?)?;
        match verdicts::missing(&self.scenario, &self.tasks_together()) {
            Some(_) => None,
            None => Some(format!("the mission ends for lack of a robot, but {overlooked}")),
        }
    }

    /// How near the mission has come to its bounds so far.
    pub fn extremes(&self) -> &Extremes {
        self.monitor.extremes()
    }
}
