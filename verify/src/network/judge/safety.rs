//! What must hold in a mission with faults, whatever fails.

use pleach_automaton::network::record::{End, Faults, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;

use super::Dispute;
use super::clock::Clock;
use super::tasks::TaskClaims;
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
    claims: TaskClaims,
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
            claims: TaskClaims::new(scenario, faults),
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
        if !self.faults.nodes {
            all_are_present(snapshot, "where messages fail, and no nodes").map_err(told)?;
        }
        self.observe_period(snapshot)?;
        instant::shares(snapshot, &self.limits)?;
        self.claims.observe(snapshot, events, &self.limits).map_err(told)?;
        instant::locations(snapshot)?;
        // What flows to a node that does not run is lost.
        if self.claims.all_run() {
            relayed(snapshot, &self.limits)?;
        }
        self.previous = Some(snapshot.clone());
        Ok(())
    }

    fn observe_period(&mut self, snapshot: &Snapshot) -> Result<(), Violation> {
        let Safety { limits, extremes, previous, .. } = self;
        let period = Period::ending(previous.as_ref(), snapshot)?;
        keep_smaller(&mut extremes.pair_distance, period::separation(&period, limits)?);
        keep_smaller(&mut extremes.clearance, period::clearance(&period, limits)?);
        period::step_length(&period, limits)?;
        period::absent_stay(&period)?;
        keep_larger(&mut extremes.load, period::load(&period, limits)?);
        period::service(&period, limits)?;
        period::tree_range(&period, limits)
    }

    /// Judges how the mission ended.
    ///
    /// # Errors
    ///
    /// [`Property::Outcome`] if the record does not show what the outcome says.
    pub fn conclude(&self, end: &End) -> Result<(), Violation> {
        let now = self.previous.as_ref().map_or(Instant { step: 0, time: 0.0 }, Instant::of);
        let concluded = self.claims.conclude(end, &self.clock, &self.limits);
        concluded.map_err(|dispute| dispute.at(now))
    }

    /// How near the mission has come to its bounds so far.
    pub const fn extremes(&self) -> &Extremes {
        &self.extremes
    }
}

/// No node is absent: a clause says in what record.
///
/// # Errors
///
/// The nodes that are, as [`Property::Record`].
pub(super) fn all_are_present(snapshot: &Snapshot, clause: &str) -> Result<(), Dispute> {
    match &*snapshot.absent {
        [] => Ok(()),
        absent => {
            let sentence = format!("nodes {absent:?} are absent {clause}");
            Err(Dispute::of(Property::Record, &[], sentence))
        }
    }
}

/// [`Property::Residual`]: a robot to which others send passes on all of it, and what is its own.
///
/// # Errors
///
/// The first robot that does not.
pub(in crate::network) fn relayed(seen: &Snapshot, limits: &Limits) -> Result<(), Violation> {
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
