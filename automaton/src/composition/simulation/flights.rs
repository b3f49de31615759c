//! Flights of groups: planned, ended, and what comes of them.

use std::collections::BTreeSet;

use pleach_guards::Verdict;

use super::{Due, Failure, Halt, Simulation};
use crate::composition::field::Field;
use crate::composition::flight::{Flight, Plan};
use crate::composition::group::Group;
use crate::composition::jumps::Standing;
use crate::composition::tension::{Conditions, Readiness};
use crate::composition::{Accumulation, Policy};
use crate::moment::Moment;
use crate::zeno::{Zeno, ZenoDetector};

/// The largest part of the state by which a landing may be outside an invariant. Margins of smooth
/// guards stay far below it; those that are only signs are not believed.
const LARGEST_ALLOWANCE: f64 = 1e-9;

impl<'a> Simulation<'a> {
    /// Plans the flow of a group from here on, unless that is done.
    pub(super) fn plan(&mut self, group: usize) -> Result<(), Halt> {
        if self.groups[group].flight.is_some() {
            return Ok(());
        }
        let policy = self.policy_of(group);
        let mut flight = self.fly(group, policy)?;
        let draws = matches!(self.settings.policy, Policy::Random { .. });
        if draws && policy == Policy::Late && flight.halt.is_none() {
            let first = self.fly(group, Policy::Early)?.duration.seconds();
            let last = flight.duration.seconds();
            if first < last {
                let share = self.groups[group].chance.share();
                flight = flight.cut(first + share * (last - first));
                self.groups[group].is_eager = true;
            }
        }
        self.queue.insert(Due { at: flight.due(), group });
        self.groups[group].flight = Some(flight);
        Ok(())
    }

    /// Plans what is left at the horizon: flights of groups that end there for rounding, with a jump.
    pub(super) fn plan_last(&mut self, awake: BTreeSet<usize>) {
        for group in awake {
            // A flow that fails beyond the horizon is no matter.
            let is_planned = self.plan(group).is_ok();
            let is_last =
                |flight: &Flight| flight.halt.is_none() && flight.due().seconds() <= self.horizon;
            if !is_planned || !self.groups[group].flight.as_ref().is_some_and(is_last) {
                self.ground(group);
            }
        }
    }

    /// The flow of a group from here on.
    fn fly(&mut self, group: usize, policy: Policy) -> Result<Flight, Halt> {
        let parts = &self.composition.groups[group];
        let left = (Moment::from(self.horizon) - self.now).seconds();
        let mut linear = std::mem::take(&mut self.groups[group].linear);
        let plan = Plan {
            group: parts,
            standing: Standing { is_local: true, ..self.standing() },
            settings: &self.settings,
            policy,
            allowance: self.groups[group].allowance,
            since: self.now,
            start: self.start_of(parts),
            last: self.groups[group].last,
            horizon: left,
            limit: left + f64::EPSILON * self.horizon,
            linear: &mut linear,
        };
        let mut steps = self.steps;
        let flight = plan.fly(&mut steps);
        self.steps = steps;
        self.groups[group].linear = linear;
        flight
    }

    /// Forgets the flight that is planned.
    pub(super) fn ground(&mut self, group: usize) {
        if let Some(flight) = self.groups[group].flight.take() {
            self.queue.remove(&Due { at: flight.due(), group });
        }
    }

    /// Ends the flight of a group now.
    pub(super) fn land(&mut self, group: usize) -> Result<(), Halt> {
        let Some(flight) = self.groups[group].flight.take() else { return Ok(()) };
        let parts = &self.composition.groups[group];
        for (&slot, &value) in parts.slots.iter().zip(&flight.landing) {
            // What rests keeps its rest.
            if self.values[slot] != value {
                self.rests[slot] = 0.0;
            }
            self.values[slot] = value;
        }
        for (place, line) in &flight.lines {
            self.rests[parts.slots[*place]] = line.at(flight.duration).rest();
        }
        let outside = self.outside(group)?;
        self.groups[group].allowance = self.allowance_of(group, outside, &flight.landing)?;
        self.groups[group].must_leave = flight.must_leave || outside.holds;
        self.awake.insert(group);
        let duration = flight.duration.seconds();
        if duration > 0.0 {
            self.groups[group].last = duration;
        }
        let halt = flight.halt.clone();
        if let Some(record) = &mut self.record {
            record.flown(group, flight);
        }
        if let Some(halt) = halt {
            return Err(halt);
        }
        match self.groups[group].zeno.after_flow(self.now.seconds(), duration) {
            Some(zeno) => self.accumulate(group, zeno),
            None => Ok(()),
        }
    }

    /// Does what the model or the settings say where jumps of a group accumulate.
    fn accumulate(&mut self, group: usize, zeno: Zeno) -> Result<(), Halt> {
        let components = &self.composition.components;
        let members = || self.composition.groups[group].components.iter();
        let going_on = members().find_map(|&one| Some((one, components[one].continuation?)));
        let own = members().find_map(|&one| components[one].accumulation);
        match (going_on, own.unwrap_or(self.settings.accumulation)) {
            (Some(continuation), _) => self.pass_limit(group, zeno, continuation),
            (None, Accumulation::End) => return Err(Halt::Zeno(zeno)),
            (None, Accumulation::Off) => {}
        }
        Ok(())
    }

    /// Lets time go on to the limit point of the group's jumps, where it takes what it is made to.
    fn pass_limit(&mut self, group: usize, zeno: Zeno, continuation: (usize, usize)) {
        let field = self.field(group, &self.locations);
        let rest = zeno.accumulation - self.now.seconds();
        self.groups[group].zeno = ZenoDetector::new(self.horizon);
        self.groups[group].compelled = Some(continuation);
        if rest > 0.0 {
            let flight = Flight::of_lines(self.now, rest, &field);
            self.awake.remove(&group);
            self.queue.insert(Due { at: flight.due(), group });
            self.groups[group].flight = Some(flight);
        }
    }

    /// The flows of a group in these locations, from the present state on.
    pub(super) fn field(&self, group: usize, locations: &[usize]) -> Field<'a> {
        let parts = &self.composition.groups[group];
        Field::of(self.composition, parts, locations, self.start_of(parts))
    }

    /// The present state of a group.
    fn start_of(&self, group: &Group) -> Vec<Moment> {
        group.slots.iter().map(|&slot| (self.values[slot], self.rests[slot]).into()).collect()
    }

    /// Whether the group is outside an invariant, by however little.
    fn outside(&self, group: usize) -> Result<Verdict, Failure> {
        let conditions = Conditions { allowance: 0.0, ..self.conditions(group) };
        Ok(conditions.invariants(&self.values)?.opposite())
    }

    /// How far beyond the boundary of its guard, or of an invariant, a flow has landed, as far as that
    /// is rounding.
    fn allowance_of(
        &self,
        group: usize,
        outside: Verdict,
        landing: &[f64],
    ) -> Result<f64, Failure> {
        let forced = self.conditions(group).any_transition(&self.values, Readiness::Forced)?;
        let beyond = forced.margin.max(outside.margin).max(0.0);
        let largest = landing.iter().fold(1.0, |largest: f64, value| largest.max(value.abs()));
        Ok(if beyond.is_finite() { beyond.min(LARGEST_ALLOWANCE * largest) } else { 0.0 })
    }
}
