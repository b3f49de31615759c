//! Running a composition.

mod failure;
mod flights;
mod rounds;
mod run;
mod sliding;

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

pub use failure::{Failure, Halt, SimulationError};

use super::Composition;
use super::flight::Flight;
use super::linear::LinearFlows;
use super::record::Record;
use super::settings::{Policy, Settings};
use super::tension::Readiness;
use crate::chance::Chance;
use crate::executor::{Ending, Round, System};
use crate::moment::Moment;
use crate::time::HybridTime;
use crate::trajectory::Trajectory;
use crate::zeno::ZenoDetector;

/// A jump as a simulation reports it.
#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// The event or the label.
    pub label: String,
    /// The moves, by ascending component.
    pub moves: Vec<Move>,
    /// The variables that are assigned to, by their number, and what they become.
    pub changes: Vec<(usize, f64)>,
}

/// What a component does in a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Move {
    /// The component.
    pub component: usize,
    /// The location that it leaves.
    pub source: usize,
    /// The location that it enters.
    pub target: usize,
    /// Which of the transitions that leave the source it takes, in their total order.
    pub transition: usize,
}

/// A composition with locations and a state: a [`System`] for the executor.
///
/// Each group of components is followed by itself, from one of its jumps to the next; a queue says
/// which comes first. What happens in one group costs nothing in others.
pub struct Simulation<'a> {
    composition: &'a Composition,
    settings: Settings,
    horizon: f64,
    now: Moment,
    jumps: u64,
    locations: Vec<usize>,
    /// By slot: those of a group are what they were when it landed or jumped last.
    values: Vec<f64>,
    /// By slot: what the number of a variable that has moved along a line leaves of it.
    rests: Vec<f64>,
    groups: Vec<GroupState>,
    /// The groups in flight, by the end of their flights.
    queue: BTreeSet<Due>,
    /// The groups that are looked at now.
    awake: BTreeSet<usize>,
    /// By component: the number of the round in which it has jumped last.
    jumped: Vec<u64>,
    round: u64,
    /// The group that has jumped last.
    latest: usize,
    /// How many more pieces and spans may be looked at.
    steps: u64,
    record: Option<Record>,
}

struct GroupState {
    flight: Option<Flight>,
    /// Whether what may be taken is waited for no longer; only by the policy of chance.
    is_eager: bool,
    chance: Chance,
    /// What has to be taken now, whatever its guard says: a component and an event.
    compelled: Option<(usize, usize)>,
    /// How far, in the margin of a guard or an invariant, the last flow has landed beyond the boundary:
    /// the state may be outside an invariant by as much. It is a rounding error of the instant of the event.
    allowance: f64,
    /// Whether no time can pass, because an invariant has ended the last flow and nothing was taken since.
    must_leave: bool,
    zeno: ZenoDetector,
    /// What was done in the last two jumps, by the first who took part.
    latest: [Option<Move>; 2],
    /// How many jumps in a row have gone to and fro over a boundary, for rounding alone.
    chattering: u32,
    /// How long the last flight was, in seconds; infinite before the first.
    last: f64,
    /// What is known of its linear flows.
    linear: LinearFlows,
}

/// When a group's flight ends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Due {
    at: Moment,
    group: usize,
}

impl Eq for Due {}

impl Ord for Due {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.at.total_cmp(&other.at).then(self.group.cmp(&other.group))
    }
}

impl PartialOrd for Due {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl<'a> Simulation<'a> {
    /// The composition in its initial state; flows are looked at up to `horizon` seconds ahead.
    ///
    /// # Errors
    ///
    /// [`SimulationError`] if the settings make no sense, or time would not advance from one sample to the next.
    pub fn new(
        composition: &'a Composition,
        settings: Settings,
        horizon: f64,
    ) -> Result<Self, SimulationError> {
        settings.check()?;
        composition.check_samplings(horizon)?;
        let initial = composition.components.iter().map(|component| component.blueprint.initial);
        let seed = match settings.policy {
            Policy::Random { seed } => seed,
            Policy::Late | Policy::Early => 0,
        };
        let group = |number: usize| GroupState {
            flight: None,
            is_eager: false,
            chance: Chance::new(seed, number),
            compelled: None,
            allowance: 0.0,
            must_leave: false,
            zeno: ZenoDetector::new(horizon),
            latest: [None; 2],
            chattering: 0,
            last: f64::INFINITY,
            linear: LinearFlows::default(),
        };
        Ok(Simulation {
            composition,
            settings,
            horizon,
            now: Moment::default(),
            jumps: 0,
            locations: initial.collect(),
            values: composition.initial.clone(),
            rests: vec![0.0; composition.initial.len()],
            groups: (0..composition.groups.len()).map(group).collect(),
            queue: BTreeSet::new(),
            awake: (0..composition.groups.len()).collect(),
            jumped: vec![0; composition.components.len()],
            round: 0,
            latest: 0,
            steps: settings.step_limit,
            record: None,
        })
    }

    /// The locations of the components, as numbers.
    pub fn locations(&self) -> &[usize] {
        &self.locations
    }

    pub(super) fn composition(&self) -> &'a Composition {
        self.composition
    }

    /// The values of the variables now.
    pub fn values(&self) -> Vec<f64> {
        self.values_at(self.now)
    }

    /// The values at a moment from now on, up to the end of the first flight.
    pub(super) fn values_at(&self, moment: Moment) -> Vec<f64> {
        let mut values = self.values.clone();
        for (state, group) in self.groups.iter().zip(&self.composition.groups) {
            if let Some(flight) = &state.flight {
                let now = match moment >= flight.due() {
                    true => flight.landing.clone(),
                    false => flight.state_at((moment - flight.since).seconds()),
                };
                group.slots.iter().zip(now).for_each(|(&slot, value)| values[slot] = value);
            }
        }
        values
    }

    /// When a flow of this duration from now on ends: exactly where a flight does, if it is meant.
    pub(super) fn end_of(&self, duration: f64) -> Moment {
        let first = self.queue.first().map(|due| due.at);
        let planned = first.filter(|at| (*at - self.now).seconds() == duration);
        planned.unwrap_or(self.now + Moment::from(duration))
    }

    fn hybrid_time(&self) -> HybridTime {
        let j = u32::try_from(self.jumps).unwrap_or(u32::MAX);
        HybridTime { t: self.now.seconds(), j }
    }

    fn into_trajectory(mut self, ending: Ending<Failure>) -> Trajectory {
        let mut record = self.record.take().unwrap_or_else(|| Record::of(self.composition));
        let end = Moment::from(ending.at.t);
        for (number, state) in self.groups.into_iter().enumerate() {
            if let Some(flight) = state.flight {
                let lasted = (end - flight.since).seconds();
                if lasted > 0.0 {
                    record.flown(number, flight.cut(lasted));
                }
            }
        }
        record.into_trajectory(self.composition, self.settings, self.horizon, ending)
    }
}

impl System for Simulation<'_> {
    type Jump = Taken;
    type Finish = std::convert::Infallible;
    type Error = Halt;

    fn finished(&self) -> Option<Self::Finish> {
        None
    }

    fn jump(&mut self, round: &mut Round<'_, Taken>) -> Result<(), Halt> {
        let awake = std::mem::take(&mut self.awake);
        let mut jumped = self.take_round(round, &awake, Readiness::Forced)?;
        if !jumped {
            jumped = self.leave(round, &awake)?;
        }
        if !jumped && self.now.seconds() >= self.horizon {
            self.plan_last(awake);
            return Ok(());
        }
        if !jumped {
            let mut stuck = BTreeSet::new();
            for &group in &awake {
                self.plan(group)?;
                let flight = self.groups[group].flight.as_ref();
                if flight.is_some_and(|flight| flight.duration <= Moment::default()) {
                    stuck.insert(group);
                }
            }
            if !stuck.is_empty() {
                jumped = self.take_round(round, &stuck, Readiness::Possible)?;
            }
        }
        if jumped {
            self.awake = awake;
        }
        Ok(())
    }

    fn time_to_jump(&self) -> Result<Option<f64>, Halt> {
        let due = self.queue.first().map(|due| (due.at - self.now).seconds());
        Ok(due)
    }

    fn next_jump(&self, _now: Moment) -> Result<Option<Moment>, Halt> {
        Ok(self.queue.first().map(|due| due.at))
    }

    fn flow(&mut self, duration: f64) -> Result<(), Halt> {
        self.now = self.end_of(duration);
        while let Some(due) = self.queue.first().copied().filter(|due| due.at <= self.now) {
            self.queue.pop_first();
            self.land(due.group)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The order of a queue is that of the operators, too.
    #[test]
    fn what_is_due_first_comes_first_and_of_those_the_first_group() {
        let due = |seconds: f64, group: usize| Due { at: Moment::from(seconds), group };
        let later = Due { at: Moment::from(1.0) + Moment::from(1e-20), group: 0 };
        let all = [due(0.5, 3), due(1.0, 0), due(1.0, 2), later, due(2.0, 1)];
        assert!(all.is_sorted_by(|one, other| one < other));
        let queue: BTreeSet<Due> = all.into_iter().rev().collect();
        assert!(queue.into_iter().eq(all));
    }
}
