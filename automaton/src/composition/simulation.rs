//! Running a composition.

use std::collections::BTreeSet;

use pleach_continuous::flow::VectorField;
use pleach_discrete::{Event, Location};
use pleach_guards::{Enclosure, Interval};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::chance::Chance;
use super::field::Field;
use super::flight::{Flight, Plan};
use super::jumps::{Joint, Standing};
use super::record::Record;
use super::settings::{Accumulation, Policy, Settings};
use super::tension::{Conditions, Readiness};
use super::{Composition, CompositionError};
use crate::automaton::Automaton;
use crate::coordinates::Coordinates;
use crate::executor::{Ending, Executor, InvalidLimit, Limit, Reason, Round, Sliding, System};
use crate::moment::Moment;
use crate::time::HybridTime;
use crate::trajectory::Trajectory;
use crate::zeno::{Zeno, ZenoDetector};

/// Why a simulation cannot begin.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The automaton makes no component.
    #[error(transparent)]
    Composition(#[from] CompositionError),
    /// The horizon or the limit of rounds makes no sense.
    #[error(transparent)]
    Limit(#[from] InvalidLimit),
    /// A tolerance or the resolution makes no sense.
    #[error("the settings cannot be used: {0}")]
    Settings(String),
}

/// What keeps a run from going on.
#[derive(Clone, Debug, PartialEq, Error, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Failure {
    /// A guard, an invariant or a reset has no value.
    #[error("component `{component}` in location `{location}`, {part}: {reason}")]
    Formula {
        /// The component.
        component: String,
        /// Its location.
        location: String,
        /// What has no value.
        part: String,
        /// Why.
        reason: String,
    },
    /// The flow cannot be followed any farther.
    #[error("the flow in {locations} fails: {reason}")]
    Flow {
        /// The locations of the components.
        locations: String,
        /// Where and why.
        reason: String,
    },
}

/// Why a simulation stops by itself.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Halt {
    /// A formula has no value, or a flow cannot be followed.
    #[error(transparent)]
    Failure(#[from] Failure),
    /// It has used up what it may.
    #[error(transparent)]
    Limit(#[from] Limit),
    /// Jumps accumulate.
    #[error("jumps accumulate at {} s", .0.accumulation)]
    Zeno(Zeno),
}

impl From<Halt> for Reason<Failure> {
    fn from(halt: Halt) -> Self {
        match halt {
            Halt::Failure(failure) => Reason::Finished(failure),
            Halt::Limit(limit) => Reason::Limit(limit),
            Halt::Zeno(zeno) => Reason::Zeno(zeno),
        }
    }
}

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
    groups: Vec<GroupState>,
    /// The groups in flight, by the end of their flights.
    queue: BTreeSet<Due>,
    /// The groups that are looked at now.
    awake: BTreeSet<usize>,
    /// By component: the number of the round in which it has jumped last.
    jumped: Vec<u64>,
    round: u64,
    /// What was done in the last two jumps, by the first who took part.
    latest: [Option<Move>; 2],
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
    /// How far, in the margin of a guard, the last flow has landed beyond the boundary: the state
    /// may be outside an invariant by as much. It is a rounding error of the instant of the event.
    allowance: f64,
    zeno: ZenoDetector,
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

/// The largest part of the state by which a landing may be outside an invariant. Margins of smooth
/// guards stay far below it; those that are only signs are not believed.
const LARGEST_ALLOWANCE: f64 = 1e-9;

impl<L: Location, E: Event, S: Coordinates> Automaton<L, E, S> {
    /// Runs the automaton by itself, from its initial state, for `horizon` seconds.
    ///
    /// # Errors
    ///
    /// [`SimulationError`] if it has no initial state, or the horizon is negative or not finite.
    /// What happens on the way is told by the [ending](Trajectory::ending) of the trajectory.
    pub fn run(&self, horizon: f64) -> Result<Trajectory, SimulationError> {
        Composition::builder().add("automaton", self).build()?.run(horizon)
    }

    /// Runs the automaton by itself with the given settings.
    ///
    /// # Errors
    ///
    /// As for [`run`](Self::run), and if the settings make no sense.
    pub fn run_with(
        &self,
        settings: Settings,
        horizon: f64,
    ) -> Result<Trajectory, SimulationError> {
        Composition::builder().add("automaton", self).build()?.run_with(settings, horizon)
    }

    /// Runs the automaton by itself, from `state`, for `horizon` seconds.
    ///
    /// # Errors
    ///
    /// As for [`run`](Self::run).
    pub fn run_from(&self, state: S, horizon: f64) -> Result<Trajectory, SimulationError> {
        Composition::builder().add_in("automaton", self, state).build()?.run(horizon)
    }
}

impl Composition {
    /// Runs the composition from its initial state for `horizon` seconds.
    ///
    /// # Errors
    ///
    /// [`SimulationError`] if the horizon is negative or not finite.
    pub fn run(&self, horizon: f64) -> Result<Trajectory, SimulationError> {
        self.run_with(Settings::default(), horizon)
    }

    /// Runs the composition with the given settings.
    ///
    /// # Errors
    ///
    /// [`SimulationError`] if the horizon or the settings make no sense.
    pub fn run_with(
        &self,
        settings: Settings,
        horizon: f64,
    ) -> Result<Trajectory, SimulationError> {
        let executor = Executor::new(horizon, settings.round_limit)?.without_zeno_detection();
        let mut simulation = Simulation::new(self, settings, horizon)?;
        simulation.record = Some(Record::of(self));
        let ending = match executor.run(&mut simulation, &mut ()) {
            Ok(Ending { at, reason }) => {
                let reason = match (reason.without_finish(), simulation.sliding()) {
                    (Reason::JumpLimit, Some(sliding)) => Reason::Sliding(sliding),
                    (reason, _) => reason,
                };
                Ending { at, reason }
            }
            Err(halt) => Ending { at: simulation.hybrid_time(), reason: halt.into() },
        };
        Ok(simulation.into_trajectory(ending))
    }
}

impl<'a> Simulation<'a> {
    /// The composition in its initial state; flows are looked at up to `horizon` seconds ahead.
    ///
    /// # Errors
    ///
    /// [`SimulationError::Settings`] if the settings make no sense.
    pub fn new(
        composition: &'a Composition,
        settings: Settings,
        horizon: f64,
    ) -> Result<Self, SimulationError> {
        settings.check()?;
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
            zeno: ZenoDetector::new(horizon),
        };
        Ok(Simulation {
            composition,
            settings,
            horizon,
            now: Moment::default(),
            jumps: 0,
            locations: initial.collect(),
            values: composition.initial.clone(),
            groups: (0..composition.groups.len()).map(group).collect(),
            queue: BTreeSet::new(),
            awake: (0..composition.groups.len()).collect(),
            jumped: vec![0; composition.components.len()],
            round: 0,
            latest: [None; 2],
            steps: settings.step_limit,
            record: None,
        })
    }

    /// The locations of the components, as numbers.
    pub fn locations(&self) -> &[usize] {
        &self.locations
    }

    /// The values of the variables now.
    pub fn values(&self) -> Vec<f64> {
        let mut values = self.values.clone();
        for (state, group) in self.groups.iter().zip(&self.composition.groups) {
            if let Some(flight) = &state.flight {
                let now = flight.state_at((self.now - flight.since).seconds());
                group.slots.iter().zip(now).for_each(|(&slot, value)| values[slot] = value);
            }
        }
        values
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

    // ---- Jumps -----------------------------------------------------------------------------

    /// Takes one round of jumps of these groups; says whether there was one.
    fn take_round(
        &mut self,
        round: &mut Round<'_, Taken>,
        groups: &BTreeSet<usize>,
        readiness: Readiness,
    ) -> Result<bool, Halt> {
        self.round += 1;
        let members = groups.iter().map(|&group| &self.composition.groups[group].components);
        let mut components: Vec<usize> = members.flatten().copied().collect();
        if groups.len() > 1 {
            components.sort_unstable();
        }
        let mut any = false;
        for component in components {
            if self.jumped[component] == self.round {
                continue;
            }
            if let Some(jump) = self.next_of(component, readiness)? {
                self.take(&jump, round)?;
                any = true;
            }
        }
        Ok(any)
    }

    /// The first jump in total order that `component` can take part in.
    fn next_of(
        &mut self,
        component: usize,
        readiness: Readiness,
    ) -> Result<Option<Joint>, Failure> {
        let group = self.composition.components[component].group;
        if let Some(joint) = self.compelled(group, component) {
            return Ok(Some(joint));
        }
        if !matches!(self.settings.policy, Policy::Random { .. }) {
            return Ok(self.candidates(component, readiness, 1)?.pop());
        }
        let mut candidates = self.candidates(component, readiness, usize::MAX)?;
        if candidates.is_empty() {
            return Ok(None);
        }
        let drawn = self.groups[group].chance.below(candidates.len());
        Ok(Some(candidates.swap_remove(drawn)))
    }

    /// The jump that a component is made to take beyond an accumulation of jumps.
    fn compelled(&mut self, group: usize, component: usize) -> Option<Joint> {
        let compelled = self.groups[group].compelled;
        let (_, event) = compelled.filter(|(compelled, _)| *compelled == component)?;
        self.groups[group].compelled = None;
        let mut leaving = self.standing().leaving(component).iter();
        let transition = leaving.position(|leaving| leaving.event == event)?;
        Some(Joint { label: None, parts: vec![(component, transition)] })
    }

    /// The first jumps in total order that `component` can take part in, `most` of them.
    fn candidates(
        &self,
        component: usize,
        readiness: Readiness,
        most: usize,
    ) -> Result<Vec<Joint>, Failure> {
        let conditions = self.conditions(self.composition.components[component].group);
        let mut candidates = Vec::new();
        for (transition, leaving) in self.standing().leaving(component).iter().enumerate() {
            let label = self.composition.components[component].labels[leaving.event];
            let joint = match label {
                None if !conditions.is_wanted(leaving, readiness) => None,
                None => self.standing().alone(component, transition, &self.values)?,
                Some(label) => self.joint(label, &conditions, readiness)?,
            };
            candidates.extend(joint);
            if candidates.len() >= most {
                break;
            }
        }
        Ok(candidates)
    }

    /// The jump that all participants of a label take together, if they can and one of them wants.
    fn joint(
        &self,
        label: usize,
        conditions: &Conditions<'_>,
        readiness: Readiness,
    ) -> Result<Option<Joint>, Failure> {
        let participants = &self.composition.labels[label].participants;
        if participants.iter().any(|(component, _)| self.jumped[*component] == self.round) {
            return Ok(None);
        }
        let joint = self.standing().together(label, &self.values)?;
        Ok(joint.filter(|joint| {
            let mut parts = self.standing().parts(joint);
            parts.any(|leaving| conditions.is_wanted(leaving, readiness))
        }))
    }

    fn take(&mut self, jump: &Joint, round: &mut Round<'_, Taken>) -> Result<(), Halt> {
        if self.jumps >= self.settings.jump_limit {
            return Err(Limit::Jumps(self.settings.jump_limit).into());
        }
        let taken = self.standing().taken(jump, &self.values)?;
        taken.changes.iter().for_each(|&(slot, value)| self.values[slot] = value);
        for one in &taken.moves {
            self.locations[one.component] = one.target;
            self.jumped[one.component] = self.round;
        }
        self.jumps += 1;
        self.latest = [self.latest[1], taken.moves.first().copied()];
        let group = self.composition.components[taken.moves[0].component].group;
        // What was planned was planned for other locations.
        self.ground(group);
        self.groups[group].is_eager = false;
        if let Some(record) = &mut self.record {
            record.jumped(
                round.now(),
                group,
                &taken,
                &self.composition.groups[group],
                &self.values,
            );
            let memory = self.settings.memory_limit;
            if record.size() > memory {
                return Err(Limit::Memory(memory).into());
            }
        }
        let participants: Box<[usize]> = taken.moves.iter().map(|one| one.component).collect();
        match &*participants {
            [alone] => round.jumped(*alone, taken),
            all if all.len() == self.locations.len() => round.jumped_together(taken),
            _ => round.jumped_some(participants, taken),
        }
        Ok(())
    }

    fn standing(&self) -> Standing<'_> {
        Standing::new(self.composition, &self.locations)
    }

    fn conditions(&self, group: usize) -> Conditions<'_> {
        Conditions {
            standing: self.standing(),
            group: &self.composition.groups[group],
            policy: self.policy_of(group),
            allowance: self.groups[group].allowance,
        }
    }

    /// Whether what may be taken is taken as soon as it can be, or as late.
    fn policy_of(&self, group: usize) -> Policy {
        match self.settings.policy {
            Policy::Random { .. } if self.groups[group].is_eager => Policy::Early,
            Policy::Random { .. } => Policy::Late,
            policy => policy,
        }
    }

    // ---- Flights ---------------------------------------------------------------------------

    /// Plans the flow of a group from here on, unless that is done.
    fn plan(&mut self, group: usize) -> Result<(), Halt> {
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

    /// The flow of a group from here on.
    fn fly(&mut self, group: usize, policy: Policy) -> Result<Flight, Halt> {
        let parts = &self.composition.groups[group];
        let left = Moment::from(self.horizon) - self.now;
        let plan = Plan {
            group: parts,
            standing: Standing { is_local: true, ..self.standing() },
            settings: &self.settings,
            policy,
            allowance: self.groups[group].allowance,
            since: self.now,
            start: parts.slots.iter().map(|&slot| self.values[slot]).collect(),
            // A little more, for what happens at the instant nearest to the horizon.
            limit: left.seconds() + f64::EPSILON * self.horizon,
        };
        let mut steps = self.steps;
        let flight = plan.fly(&mut steps);
        self.steps = steps;
        flight
    }

    /// Forgets the flight that is planned.
    fn ground(&mut self, group: usize) {
        if let Some(flight) = self.groups[group].flight.take() {
            self.queue.remove(&Due { at: flight.due(), group });
        }
    }

    /// Ends the flight of a group now.
    fn land(&mut self, group: usize) -> Result<(), Halt> {
        let Some(flight) = self.groups[group].flight.take() else { return Ok(()) };
        let parts = &self.composition.groups[group];
        for (&slot, &value) in parts.slots.iter().zip(&flight.landing) {
            self.values[slot] = value;
        }
        self.groups[group].allowance = self.allowance_of(group, &flight.landing)?;
        self.awake.insert(group);
        let duration = flight.duration.seconds();
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
    fn field(&self, group: usize, locations: &[usize]) -> Field<'a> {
        let parts = &self.composition.groups[group];
        let start = parts.slots.iter().map(|&slot| self.values[slot]).collect();
        Field::of(self.composition, parts, locations, start)
    }

    /// Whether the last two jumps go back and forth over a boundary to which the flows of both
    /// sides lead.
    fn sliding(&self) -> Option<Sliding> {
        let [Some(there), Some(back)] = self.latest else { return None };
        let returns = (there.source, there.target) == (back.target, back.source);
        if there.component != back.component || !returns || there.source == there.target {
            return None;
        }
        let component = &self.composition.components[there.component];
        let guard = &component.place(there.source).leaving[there.transition].guard;
        let margins = |location: usize| -> Vec<f64> {
            let mut locations = self.locations.clone();
            locations[there.component] = location;
            let field = self.field(component.group, &locations);
            let mut rates = vec![0.0; field.start.len()];
            field.rates(0.0, &field.start, &mut rates);
            let point = |(value, rate): (&f64, &f64)| {
                let value = Interval::point(*value);
                Enclosure { middle: value, range: value, rate: Interval::point(*rate) }
            };
            let states: Vec<Enclosure> = field.start.iter().zip(&rates).map(point).collect();
            let comparisons = guard.tracker.comparisons().iter();
            comparisons
                .map(|one| one.margin(&states, &component.places, 0.0).rate.midpoint())
                .collect()
        };
        let sides = margins(there.source).into_iter().zip(margins(there.target));
        let (here, beyond) =
            sides.into_iter().find(|(here, beyond)| *here > 0.0 && *beyond < 0.0)?;
        Some(Sliding {
            component: there.component,
            locations: [there.source, there.target],
            share: here / (here - beyond),
        })
    }

    /// How far beyond the boundary of its guard a flow has landed, as far as that is rounding.
    fn allowance_of(&self, group: usize, landing: &[f64]) -> Result<f64, Failure> {
        let forced = self.conditions(group).any_transition(&self.values, Readiness::Forced)?;
        let beyond = forced.margin.max(0.0);
        let largest = landing.iter().fold(1.0, |largest: f64, value| largest.max(value.abs()));
        Ok(if beyond.is_finite() { beyond.min(LARGEST_ALLOWANCE * largest) } else { 0.0 })
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
        let awake = self.awake.clone();
        let mut jumped = self.take_round(round, &awake, Readiness::Forced)?;
        // At the horizon there is no flow to come.
        if !jumped && self.now.seconds() < self.horizon {
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
            if !jumped {
                self.awake.clear();
            }
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
        let first = self.queue.first().map(|due| due.at);
        let planned = first.filter(|at| (*at - self.now).seconds() == duration);
        self.now = planned.unwrap_or(self.now + Moment::from(duration));
        while let Some(due) = self.queue.first().copied().filter(|due| due.at <= self.now) {
            self.queue.pop_first();
            self.land(due.group)?;
        }
        Ok(())
    }
}
