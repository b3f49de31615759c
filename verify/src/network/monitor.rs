//! The monitor: every property of the world and of teams, over every snapshot of a mission. What events claim and
//! observers conclude, the [judge](super::judge) checks.

use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

use pleach_automaton::network::record::{MissionEvent, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;
use pleach_discrete::network::Role;

use super::duty::{self, RoleRelation};
use super::extremes::{Extremes, keep_larger, keep_smaller};
use super::limits::Limits;
use super::period::Period;
use super::property::Property;
use super::violation::{Instant, Violation};
use super::{instant, period, team};

/// Whether a role may turn into another in one transition.
pub type RoleTable<'a> = Arc<dyn Fn(Role, Role) -> bool + 'a>;

/// Observes a mission snapshot by snapshot and stops it at the first violation.
///
/// It reads what observers see and nothing else, and decides nothing for the robots. A period
/// costs O(N log N) for bounded neighbours, path lengths and depth of the tree.
#[derive(Clone)]
pub struct Monitor<'a> {
    limits: Limits,
    role_table: RoleTable<'a>,
    role_relation: RoleRelation,
    previous: Option<Snapshot>,
    /// The tasks that are over.
    closed: BTreeSet<usize>,
    extremes: Extremes,
}

impl<'a> Monitor<'a> {
    /// A monitor that has seen nothing yet; `role_table` tells whether a role may turn into
    /// another in one transition.
    pub fn new(scenario: &ValidScenario, role_table: impl Fn(Role, Role) -> bool + 'a) -> Self {
        Monitor {
            limits: Limits::of(scenario),
            role_relation: duty::closure(&role_table),
            role_table: Arc::new(role_table),
            previous: None,
            closed: BTreeSet::new(),
            extremes: Extremes::default(),
        }
    }

    /// Takes note of what is told of the period that ends with the next snapshot: robots leave tasks that are
    /// over.
    pub fn expect(&mut self, events: &[MissionEvent]) {
        self.closed.extend(events.iter().filter_map(|event| match *event {
            MissionEvent::TaskEnded { task }
            | MissionEvent::TaskWithdrawn { task }
            | MissionEvent::TaskGivenUp { task, .. } => Some(task),
            _ => None,
        }));
    }

    /// Checks the period that ends with this snapshot, and the snapshot.
    ///
    /// # Errors
    ///
    /// The first property that fails; what is observed after it has no meaning.
    pub fn observe(&mut self, snapshot: &Snapshot) -> Result<(), Violation> {
        instant::record(snapshot, &self.limits)?;
        let previous = self.previous.take();
        let period = Period::ending(previous.as_ref(), snapshot)?;
        self.observe_period(&period)?;
        self.observe_instant(snapshot)?;
        self.previous = Some(snapshot.clone());
        Ok(())
    }

    fn observe_period(&mut self, period: &Period) -> Result<(), Violation> {
        let Monitor { limits, extremes, closed, .. } = self;
        keep_smaller(&mut extremes.pair_distance, period::separation(period, limits)?);
        keep_smaller(&mut extremes.clearance, period::clearance(period, limits)?);
        period::step_length(period, limits)?;
        period::standstill(period)?;
        keep_larger(&mut extremes.load, period::load(period, limits)?);
        period::tree_range(period, limits)?;
        period::role_transitions(period, &self.role_relation)?;
        period::duties(period, closed)?;
        period::service(period, limits)?;
        period::occupancy(period, limits)
    }

    fn observe_instant(&mut self, snapshot: &Snapshot) -> Result<(), Violation> {
        let Monitor { limits, extremes, .. } = self;
        instant::reliability(snapshot, limits)?;
        instant::shares(snapshot, limits)?;
        instant::accounting(snapshot, limits)?;
        keep_smaller(&mut extremes.residual, instant::residual(snapshot, limits)?);
        instant::connectivity(snapshot, limits)?;
        instant::tree(snapshot, limits)?;
        instant::teams(snapshot)?;
        instant::service(snapshot, limits)?;
        instant::occupancy(snapshot, limits)
    }

    /// Checks an event: a change of role is a transition of the table, and the break points of
    /// a recruit election divide the path.
    ///
    /// # Errors
    ///
    /// [`Property::RoleTransition`] or [`Property::Subgroups`], at the instant of the last
    /// snapshot observed.
    pub fn observe_event(&self, event: &MissionEvent) -> Result<(), Violation> {
        let now = self.previous.as_ref().map_or(Instant { step: 0, time: 0.0 }, Instant::of);
        match event {
            MissionEvent::RoleChanged { robot, from, to } if !(self.role_table)(*from, *to) => {
                let sentence = format!(
                    "robot {robot} turns from {} to {}, which is not in the table",
                    from.name(),
                    to.name()
                );
                Err(now.violation(Property::RoleTransition, &[*robot], (0.0, 1.0), sentence))
            }
            MissionEvent::RecruitElected { path, break_points, .. }
                if !team::break_points_divide(path, break_points) =>
            {
                let sentence =
                    format!("the break points {break_points:?} do not divide the path {path:?}");
                Err(now.violation(Property::Subgroups, path, (0.0, 1.0), sentence))
            }
            _ => Ok(()),
        }
    }

    /// How near the mission has come to its bounds so far.
    pub fn extremes(&self) -> &Extremes {
        &self.extremes
    }

    /// What the mission is held against.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }
}

impl fmt::Debug for Monitor<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Monitor")
            .field("limits", &self.limits)
            .field("previous", &self.previous)
            .field("extremes", &self.extremes)
            .finish_non_exhaustive()
    }
}

/// Runs a monitor over a whole mission.
///
/// # Errors
///
/// The first violation.
pub fn audit<'s>(
    mut monitor: Monitor,
    snapshots: impl IntoIterator<Item = &'s Snapshot>,
) -> Result<Extremes, Violation> {
    for snapshot in snapshots {
        monitor.observe(snapshot)?;
    }
    Ok(monitor.extremes)
}
