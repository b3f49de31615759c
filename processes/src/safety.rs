//! What must hold whatever fails, for missions in which messages are lost or processes killed.
//!
//! The monitor of a mission without faults also checks that what nodes know of each other agrees,
//! flows and residuals for example. After a message was lost it need not, until the next one. Here is
//! what no fault may break: distances between robots and to walls, the length of steps, loads, and the
//! length of links of the tree. Nodes that are not heard are bodies, and nothing else.

use pleach::automaton::network::KernelTimes;
use pleach::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::node::NodeId;
use pleach::cli::status::Failure;
use pleach::mission::{Completed, Watcher};
use pleach::verify::network::period::{self, Period};
use pleach::verify::network::{Extreme, Extremes, Limits, Violation, instant};
use std::collections::BTreeSet;
use std::io;

/// The watchers of a mission with faults, and what must hold in it.
pub struct Safety<'a, 'w> {
    limits: Limits,
    watchers: &'a mut [&'w mut dyn Watcher],
    previous: Option<Snapshot>,
    extremes: Extremes,
    failure: Option<io::Error>,
}

impl<'a, 'w> Safety<'a, 'w> {
    /// Those who watch a mission of `scenario` from its beginning.
    pub fn new(scenario: &ValidScenario, watchers: &'a mut [&'w mut dyn Watcher]) -> Self {
        Safety {
            limits: Limits::of(scenario),
            watchers,
            previous: None,
            extremes: Extremes::default(),
            failure: None,
        }
    }

    /// Shows a control period in which the nodes `present` were heard, and says how the mission ends
    /// if it has to.
    pub fn observe(
        &mut self,
        snapshot: &Snapshot,
        events: &[MissionEvent],
        present: &BTreeSet<NodeId>,
    ) -> Option<End> {
        let shown = self.watchers.iter_mut().try_for_each(|it| it.observe(snapshot, events));
        if let Err(error) = shown {
            let reason = error.to_string();
            self.failure = Some(error);
            return Some(End { outcome: Outcome::Blocked, reason, task: None });
        }
        let violation = self.check(of_present(snapshot, present)).err()?;
        let reason = violation.to_string();
        Some(End { outcome: Outcome::InvariantViolated, reason, task: snapshot.task })
    }

    fn check(&mut self, seen: Snapshot) -> Result<(), Violation> {
        instant::shares(&seen, &self.limits)?;
        if let Some(before) = &self.previous {
            let period = Period::between(before, &seen)?;
            period::step_length(&period, &self.limits)?;
            period::tree_range(&period, &self.limits)?;
            let Extremes { pair_distance, clearance, load, .. } = &mut self.extremes;
            keep(pair_distance, period::separation(&period, &self.limits)?, f64::lt);
            keep(clearance, period::clearance(&period, &self.limits)?, f64::lt);
            keep(load, period::load(&period, &self.limits)?, f64::gt);
        }
        self.previous = Some(seen);
        Ok(())
    }

    /// The mission has ended so: tells the watchers.
    ///
    /// # Errors
    /// When a watcher has failed.
    pub fn conclude(self, end: End) -> Result<Completed, Failure> {
        if let Some(error) = self.failure {
            return Err(error.into());
        }
        self.watchers.iter_mut().try_for_each(|watcher| watcher.end(&end))?;
        Ok(Completed { end, extremes: self.extremes, times: KernelTimes::default() })
    }
}

/// Keeps the more extreme one.
fn keep(kept: &mut Option<Extreme>, found: Option<Extreme>, beats: fn(&f64, &f64) -> bool) {
    if let Some(found) = found
        && kept.as_ref().is_none_or(|kept| beats(&found.value, &kept.value))
    {
        *kept = Some(found);
    }
}

/// The same, with the bodies of nodes that are not heard and nothing else of them.
fn of_present(snapshot: &Snapshot, present: &BTreeSet<NodeId>) -> Snapshot {
    let mut seen = snapshot.clone();
    seen.routes.retain(|route| present.contains(&route.from) && present.contains(&route.to));
    seen.tree.retain(|(child, parent)| present.contains(child) && present.contains(parent));
    seen
}
