//! What a mission with faults claims of its tasks.

use pleach_automaton::network::record::{End, Faults, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::Scenario;

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
    /// The step of the last snapshot.
    last: Option<usize>,
}

impl TaskClaims {
    /// Of a mission with these faults in which nothing has been claimed yet.
    pub(in crate::network) fn new(scenario: &Scenario, faults: Faults) -> Self {
        TaskClaims { terms: Terms::of(scenario), all_run: !faults.nodes, last: None }
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
            }
        }
        self.announcements_follow(events)
    }

    /// Tasks are announced one after another, in one control period where they are serviced at once.
    fn announcements_follow(&self, events: &[MissionEvent]) -> Result<(), Dispute> {
        let announced = events.iter().filter_map(|event| match *event {
            MissionEvent::TaskAnnounced { task } => Some(task),
            _ => None,
        });
        for task in announced {
            if let Some(before) = self.terms.unfinished_before(task) {
                let sentence =
                    format!("task {task} is announced, and task {before} has not been serviced");
                return Err(Dispute::of(Property::Events, &[], sentence));
            }
        }
        Ok(())
    }

    /// What contradicts the end of the mission, in a clause.
    pub(in crate::network) fn contradiction(
        &self,
        end: &End,
        clock: &Clock,
        limits: &Limits,
    ) -> Option<String> {
        let (done, tasks) = (self.terms.done(), limits.tasks().len());
        let told = clock.contradiction(end, self.last, (done, tasks));
        told.or_else(|| self.terms.contradiction(end.outcome)).or_else(|| {
            let is_done = done == tasks && self.terms.pursued().is_none();
            self.needless(end).filter(|_| is_done)
        })
    }

    /// A mission is given up over a task. Where nodes stop or are cut off, the one that gives it up need not know
    /// that it has been serviced.
    fn needless(&self, end: &End) -> Option<String> {
        let name = end.outcome.name();
        (self.all_run && end.outcome.is_given_up())
            .then(|| format!("the outcome is “{name}”, and all tasks are serviced"))
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
