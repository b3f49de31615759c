//! What must hold in a mission with faults, whatever fails.

use pleach_automaton::network::record::{End, Faults, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;

use super::clock::Clock;
use super::terms::Terms;
use super::{Dispute, claims};
use crate::network::extremes::{Extremes, keep_larger, keep_smaller};
use crate::network::limits::{Limits, SLACK};
use crate::network::period::{self, Period};
use crate::network::property::Property;
use crate::network::violation::{Instant, Violation};
use crate::network::{instant, link};

/// Judges a mission with faults, period by period, and stops at the first violation.
///
/// What it holds a record against is what no fault breaks: distances between robots and to walls, the
/// length of steps, shares, loads, the length of links of the tree, and, as long as all nodes run,
/// that no robot is sent more than it forwards. Of events it checks that robots are at the tasks that they
/// service, which have been announced, and that tasks are announced one after another, taken back and ended as
/// the user wants it; of the outcome, that all tasks have been serviced, or are over, where it says so, and, as
/// long as all nodes run, that not all of them are where a mission is given up. What nodes know of each other may
/// differ, and is not compared.
///
/// Nodes that do not run or are not heard ([`Snapshot::absent`]) are bodies that stay where they are, and
/// nothing else.
#[derive(Clone, Debug)]
pub struct Safety {
    limits: Limits,
    faults: Faults,
    clock: Clock,
    previous: Option<Snapshot>,
    /// Whether a node has been absent: what flowed there is lost.
    has_lost_nodes: bool,
    terms: Terms,
    extremes: Extremes,
}

impl Safety {
    /// A judge of missions with these faults that has seen nothing yet.
    pub fn new(scenario: &ValidScenario, faults: Faults) -> Self {
        Safety {
            limits: Limits::of(scenario),
            faults,
            clock: Clock::of(scenario),
            previous: None,
            has_lost_nodes: false,
            terms: Terms::of(scenario),
            extremes: Extremes::default(),
        }
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
        let told = |dispute: Dispute| dispute.at(now);
        instant::record(snapshot, &self.limits)?;
        self.clock.check(snapshot, self.previous.is_none()).map_err(told)?;
        self.observe_period(snapshot)?;
        self.observe_instant(snapshot)?;
        if snapshot.absent.contains(&self.limits.robots()) {
            self.terms.miss_access_point();
        }
        for event in events {
            claims::names_exist(event, &self.limits).map_err(told)?;
        }
        for event in in_order(events) {
            self.enter(event, snapshot).map_err(told)?;
        }
        self.announcements_follow(events).map_err(told)?;
        self.previous = Some(snapshot.clone());
        Ok(())
    }

    fn enter(&mut self, event: &MissionEvent, snapshot: &Snapshot) -> Result<(), Dispute> {
        self.terms.enter(event, snapshot.step)?;
        match *event {
            MissionEvent::TaskServiced { task, robot } => {
                claims::is_at_task(task, robot, snapshot, &self.limits)
            }
            _ => Ok(()),
        }
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

    fn observe_period(&mut self, snapshot: &Snapshot) -> Result<(), Violation> {
        let Safety { limits, extremes, previous, .. } = self;
        let period = match previous {
            Some(previous) => Period::between(previous, snapshot)?,
            None => Period::opening(snapshot),
        };
        keep_smaller(&mut extremes.pair_distance, period::separation(&period, limits)?);
        keep_smaller(&mut extremes.clearance, period::clearance(&period, limits)?);
        period::step_length(&period, limits)?;
        period::absent_stay(&period)?;
        keep_larger(&mut extremes.load, period::load(&period, limits)?);
        period::tree_range(&period, limits)
    }

    fn observe_instant(&mut self, snapshot: &Snapshot) -> Result<(), Violation> {
        self.has_lost_nodes |= !snapshot.absent.is_empty();
        instant::shares(snapshot, &self.limits)?;
        if !self.faults.nodes && !self.has_lost_nodes {
            relayed(snapshot, &self.limits)?;
        }
        Ok(())
    }

    /// Judges how the mission ended.
    ///
    /// # Errors
    ///
    /// [`Property::Outcome`] if the record does not show what the outcome says.
    pub fn conclude(&self, end: &End) -> Result<(), Violation> {
        let now = self.previous.as_ref().map_or(Instant { step: 0, time: 0.0 }, Instant::of);
        let last = self.previous.as_ref().map(|snapshot| snapshot.step);
        let (done, tasks) = (self.terms.done(), self.limits.tasks().len());
        let contradiction = self.clock.contradiction(end, last, (done, tasks));
        let contradiction = contradiction.or_else(|| self.terms.contradiction(end.outcome));
        match contradiction.or_else(|| self.needless_end(end, done)) {
            None => Ok(()),
            Some(sentence) => Err(Dispute::of(Property::Outcome, &[], sentence).at(now)),
        }
    }

    /// A mission is given up over a task. Where nodes stop or are cut off, the one that gives it up need not know
    /// that it has been serviced.
    fn needless_end(&self, end: &End, done: usize) -> Option<String> {
        let all_run = !self.faults.nodes && !self.has_lost_nodes;
        let is_done = done == self.limits.tasks().len() && self.terms.pursued().is_none();
        let is_needless = end.outcome.is_given_up() && all_run && is_done;
        is_needless
            .then(|| format!("the outcome is “{}”, and all tasks are serviced", end.outcome.name()))
    }

    /// How near the mission has come to its bounds so far.
    pub const fn extremes(&self) -> &Extremes {
        &self.extremes
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

/// [`Property::Residual`]: a robot to which others send passes on all of it, and what is its own.
///
/// # Errors
///
/// The first robot that does not.
pub fn relayed(seen: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let residuals = link::residuals(&seen.routes, limits.rates());
    let bound = limits.least_residual();
    let is_sent_to = |robot| {
        seen.routes.iter().any(|route| route.to == robot && route.share * route.reliability > SLACK)
    };
    let short = |&robot: &usize| residuals[robot] < bound - SLACK && is_sent_to(robot);
    match (0..residuals.len()).find(short) {
        None => Ok(()),
        Some(robot) => Err(Instant::of(seen).violation(
            Property::Residual,
            &[robot],
            (residuals[robot], bound),
            format!("robot {robot} is sent more than it passes on: c = {:.6}", residuals[robot]),
        )),
    }
}
