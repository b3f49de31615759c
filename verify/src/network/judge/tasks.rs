//! What a mission with faults claims of its tasks.

use std::collections::BTreeMap;

use pleach_automaton::network::record::{End, Faults, MissionEvent, Outcome, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;

use super::clock::Clock;
use super::terms::Terms;
use super::{Dispute, claims};
use crate::network::limits::Limits;
use crate::network::property::Property;

/// The events and the outcome of a mission with faults, as far as they speak of tasks, held against where robots
/// are and against what the user asks for.
#[derive(Clone, Debug)]
pub(in crate::network) struct TaskClaims {
    terms: Terms,
    /// Whether all nodes run and none is cut off, so far.
    all_run: bool,
    /// The step of the last snapshot, and the nodes that were absent.
    last: Option<usize>,
    absent: Vec<usize>,
    /// The last step at which a robot was seen to service a task.
    seen: BTreeMap<usize, usize>,
    /// How many control periods news of a service may take to the access point that ends the mission.
    news: usize,
}

impl TaskClaims {
    /// Of a mission with these faults in which nothing has been claimed yet.
    pub(in crate::network) fn new(scenario: &ValidScenario, faults: Faults) -> Self {
        TaskClaims {
            terms: Terms::of(scenario),
            all_run: !faults.nodes,
            last: None,
            absent: Vec::new(),
            seen: BTreeMap::new(),
            news: scenario.site().patience_with_tasks() as usize,
        }
    }

    /// Whether all nodes run and none is cut off, so far.
    pub(in crate::network) const fn all_run(&self) -> bool {
        self.all_run
    }

    /// The events of the control period that ends with this snapshot.
    ///
    /// # Errors
    ///
    /// The first that is not true.
    pub(in crate::network) fn observe(
        &mut self,
        snapshot: &Snapshot,
        events: &[MissionEvent],
        limits: &Limits,
    ) -> Result<(), Dispute> {
        self.last = Some(snapshot.step);
        self.all_run &= snapshot.absent.is_empty();
        if snapshot.absent.contains(&limits.robots()) {
            self.terms.miss_access_point();
        }
        for event in events {
            claims::names_exist(event, limits)?;
        }
        for event in in_order(events) {
            self.terms.enter(event, snapshot.step)?;
            if let MissionEvent::TaskServiced { task, robot } = *event {
                claims::is_at_task(task, robot, snapshot, limits)?;
                self.runs(robot, snapshot, || format!("robot {robot} services task {task}"))?;
            }
        }
        self.announcements_follow(events, snapshot.step)?;
        for &(task, robot) in &snapshot.serviced {
            let clause = || format!("robot {robot} is said to service task {task}");
            self.runs(robot, snapshot, clause)?;
            if !self.terms.has_been_serviced(task) {
                let sentence = format!("{}, and no event says that it does", clause());
                return Err(Dispute::of(Property::Service, &[robot], sentence));
            }
            self.seen.insert(task, snapshot.step);
        }
        self.absent.clone_from(&snapshot.absent);
        Ok(())
    }

    /// Whether a robot has run in the control period that ends with this snapshot: it may have stopped in it.
    fn runs(
        &self,
        robot: usize,
        snapshot: &Snapshot,
        clause: impl Fn() -> String,
    ) -> Result<(), Dispute> {
        let is_absent = |absent: &Vec<usize>| absent.binary_search(&robot).is_ok();
        match is_absent(&self.absent) && is_absent(&snapshot.absent) {
            true => Err(Dispute::of(
                Property::Service,
                &[robot],
                format!("{}, and it has not run since the step before", clause()),
            )),
            false => Ok(()),
        }
    }

    /// A task that is to be serviced at the end, and has not been seen to be for longer than news of it takes.
    fn abandoned(&self, tasks: usize) -> Option<String> {
        let last = self.last?;
        let is_abandoned = |task: &usize| {
            let seen = self.seen.get(task).copied().unwrap_or_default();
            !self.terms.is_closed(*task) && seen + self.news < last
        };
        let task = (0..tasks).find(is_abandoned)?;
        Some(format!("the outcome is “serviced”, and no robot has serviced task {task} of late"))
    }

    /// Tasks are announced one after another, in one control period where they are serviced at once.
    fn announcements_follow(&self, events: &[MissionEvent], step: usize) -> Result<(), Dispute> {
        let announced = events.iter().filter_map(|event| match *event {
            MissionEvent::TaskAnnounced { task } => Some(task),
            _ => None,
        });
        for task in announced {
            if let Some(before) = self.terms.unfinished_before(task, step) {
                let sentence =
                    format!("task {task} is announced, and task {before} has not been serviced");
                return Err(Dispute::of(Property::Events, &[], sentence));
            }
        }
        Ok(())
    }

    /// The mission has ended.
    ///
    /// # Errors
    ///
    /// [`Property::Outcome`] if what has been observed contradicts it.
    pub(in crate::network) fn conclude(
        &self,
        end: &End,
        clock: &Clock,
        limits: &Limits,
    ) -> Result<(), Dispute> {
        let tasks = limits.tasks().len();
        let abandoned = || match end.outcome {
            Outcome::Serviced => self.abandoned(tasks),
            _ => None,
        };
        let contradiction = clock
            .contradiction(end, self.last, (self.terms.done(), tasks))
            .or_else(|| self.terms.contradiction(end))
            .or_else(abandoned)
            .or_else(|| self.needless(end, tasks));
        match contradiction {
            None => Ok(()),
            Some(sentence) => Err(Dispute::of(Property::Outcome, &[], sentence)),
        }
    }

    /// A mission is given up over a task. Where nodes stop or are cut off, the one that gives it up need not know
    /// that it has been serviced.
    fn needless(&self, end: &End, tasks: usize) -> Option<String> {
        let is_done = self.terms.done() == tasks && self.terms.pursued().is_none();
        let gave_none_up = self.terms.given_up().is_empty();
        (self.all_run && end.outcome.is_given_up() && is_done && gave_none_up)
            .then(|| format!("the outcome is “{}”, and all tasks are serviced", end.outcome.name()))
    }
}

/// The events of a control period as they can follow each other: nodes tell them in no order. What is announced
/// comes first, then what is serviced, and then what is over.
fn in_order(events: &[MissionEvent]) -> Vec<&MissionEvent> {
    let rank = |event: &&MissionEvent| match event {
        MissionEvent::TaskAnnounced { .. } | MissionEvent::TaskReannounced { .. } => 0,
        MissionEvent::TaskServiced { .. } => 1,
        _ => 2,
    };
    let mut events: Vec<&MissionEvent> = events.iter().collect();
    events.sort_by_key(rank);
    events
}
