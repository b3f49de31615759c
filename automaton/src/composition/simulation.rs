//! Running a composition.

use pleach_discrete::{Event, Location};
use pleach_guards::Verdict;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::blueprint::Leaving;
use super::flight::Flight;
use super::jumps::{Joint, Standing};
use super::settings::{Policy, Settings};
use super::{Component, Composition, CompositionError};
use crate::automaton::Automaton;
use crate::coordinates::Coordinates;
use crate::executor::{Ending, Executor, InvalidLimit, Observer, Reason, Round, System};
use crate::time::HybridTime;
use crate::trace::TraceEntry;
use crate::trajectory::{Participant, Phase, Sample, Trajectory};

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

/// A jump as a simulation reports it.
#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// The event or the label.
    pub label: String,
    /// Who goes where, by ascending component.
    pub moves: Vec<Move>,
    /// The values of all variables afterwards, x⁺.
    pub values: Vec<f64>,
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
pub struct Simulation<'a> {
    pub(super) composition: &'a Composition,
    pub(super) settings: Settings,
    horizon: f64,
    pub(super) now: HybridTime,
    pub(super) locations: Vec<usize>,
    pub(super) values: Vec<f64>,
    /// The flow to come, once no jump is left to be taken.
    flight: Option<Flight>,
    /// How far, in the margin of a guard, the last flow has landed beyond the boundary: the state
    /// may be outside an invariant by as much. It is a rounding error of the instant of the event.
    allowance: f64,
    /// By component: whether it has jumped in this round.
    jumped: Vec<bool>,
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

    /// Runs the automaton by itself with settings of one's own.
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

    /// Runs the composition with settings of one's own.
    ///
    /// # Errors
    ///
    /// [`SimulationError`] if the horizon or the settings make no sense.
    pub fn run_with(
        &self,
        settings: Settings,
        horizon: f64,
    ) -> Result<Trajectory, SimulationError> {
        let executor = Executor::new(horizon, settings.round_limit)?;
        let mut simulation = Simulation::new(self, settings, horizon)?;
        let mut recorder = Recorder(simulation.beginning());
        let ending = executor.run(&mut simulation, &mut recorder);
        let Recorder(mut trajectory) = recorder;
        trajectory.ending = match ending {
            Ok(Ending { at, reason }) => Ending { at, reason: reason.without_finish() },
            Err(failure) => Ending { at: simulation.now, reason: Reason::Finished(failure) },
        };
        Ok(trajectory)
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
        Ok(Simulation {
            composition,
            settings,
            horizon,
            now: HybridTime::START,
            locations: initial.collect(),
            values: composition.initial.clone(),
            flight: None,
            allowance: 0.0,
            jumped: vec![false; composition.components.len()],
        })
    }

    /// The locations of the components, as numbers.
    pub fn locations(&self) -> &[usize] {
        &self.locations
    }

    /// The values of the variables.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    fn beginning(&self) -> Trajectory {
        let participant = |(index, component): (usize, &Component)| Participant {
            name: component.name.clone(),
            locations: self.composition.locations(index).map(str::to_owned).collect(),
        };
        let rates = vec![0.0; self.values.len()];
        let first = Sample { t: 0.0, values: self.values.clone(), rates };
        Trajectory {
            variables: self.composition.variables.clone(),
            components: self.composition.components.iter().enumerate().map(participant).collect(),
            settings: self.settings,
            horizon: self.horizon,
            phases: vec![Phase { locations: self.locations.clone(), samples: vec![first] }],
            jumps: Vec::new(),
            ending: Ending { at: HybridTime::START, reason: Reason::Horizon },
        }
    }

    // ---- Jumps -----------------------------------------------------------------------------

    /// Takes one round of jumps; says whether there was one.
    fn take_round(
        &mut self,
        round: &mut Round<'_, Taken>,
        readiness: Readiness,
    ) -> Result<bool, Failure> {
        self.jumped.fill(false);
        let mut any = false;
        for component in 0..self.locations.len() {
            if self.jumped[component] {
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
    fn next_of(&self, component: usize, readiness: Readiness) -> Result<Option<Joint>, Failure> {
        for (transition, leaving) in self.standing().leaving(component).iter().enumerate() {
            let label = self.composition.components[component].labels[leaving.event];
            let joint = match label {
                None if !self.is_wanted(leaving, readiness) => None,
                None => self.standing().alone(component, transition, &self.values)?,
                Some(label) => self.joint(label, readiness)?,
            };
            if joint.is_some() {
                return Ok(joint);
            }
        }
        Ok(None)
    }

    /// The jump that all participants of a label take together, if they can and one of them wants.
    fn joint(&self, label: usize, readiness: Readiness) -> Result<Option<Joint>, Failure> {
        let participants = &self.composition.labels[label].participants;
        if participants.iter().any(|(component, _)| self.jumped[*component]) {
            return Ok(None);
        }
        let joint = self.standing().together(label, &self.values)?;
        Ok(joint.filter(|joint| {
            self.standing().parts(joint).any(|leaving| self.is_wanted(leaving, readiness))
        }))
    }

    fn is_wanted(&self, leaving: &Leaving, readiness: Readiness) -> bool {
        leaving.urgency.is_forced()
            || readiness == Readiness::Possible
            || self.settings.policy == Policy::Early
    }

    fn take(&mut self, jump: &Joint, round: &mut Round<'_, Taken>) -> Result<(), Failure> {
        let taken = self.standing().taken(jump, &self.values)?;
        self.values.clone_from(&taken.values);
        for one in &taken.moves {
            self.locations[one.component] = one.target;
            self.jumped[one.component] = true;
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
        Standing { composition: self.composition, locations: &self.locations }
    }

    // ---- Verdicts --------------------------------------------------------------------------

    /// Holds where a transition has to be taken.
    pub(super) fn forced(&self, state: &[f64]) -> Result<Verdict, Failure> {
        self.any_transition(state, Readiness::Forced)
    }

    /// Whether any transition can be taken, forced or not.
    pub(super) fn can_jump(&self, state: &[f64]) -> Result<bool, Failure> {
        Ok(self.any_transition(state, Readiness::Possible)?.holds)
    }

    /// Holds where all components are within their invariants, but for what the last landing may
    /// have lost to rounding.
    pub(super) fn invariants(&self, state: &[f64]) -> Result<Verdict, Failure> {
        let mut verdict = Verdict::ALWAYS;
        for (index, component) in self.composition.components.iter().enumerate() {
            let location = self.locations[index];
            if let Some(invariant) = &component.place(location).invariant {
                let part = || format!("the invariant `{invariant}`");
                let own = invariant
                    .evaluate_at(state, &component.slots)
                    .map_err(|fault| self.standing().formula(index, location, part(), &fault))?;
                verdict = verdict.and(own);
            }
        }
        let margin = verdict.margin + self.allowance;
        let holds = verdict.holds || (self.allowance > 0.0 && margin >= 0.0);
        Ok(Verdict { margin, holds })
    }

    /// How far beyond the boundary of its guard a flow has landed, as far as that is rounding.
    fn allowance_at(&self, landing: &[f64]) -> Result<f64, Failure> {
        let beyond = self.forced(landing)?.margin.max(0.0);
        let largest = landing.iter().fold(1.0, |largest: f64, value| largest.max(value.abs()));
        Ok(if beyond.is_finite() { beyond.min(LARGEST_ALLOWANCE * largest) } else { 0.0 })
    }

    fn any_transition(&self, state: &[f64], readiness: Readiness) -> Result<Verdict, Failure> {
        let mut verdict = Verdict::NEVER;
        for (index, component) in self.composition.components.iter().enumerate() {
            for leaving in &component.place(self.locations[index]).leaving {
                let is_own = component.labels[leaving.event].is_none();
                if is_own && self.is_wanted(leaving, readiness) {
                    verdict = verdict.or(self.standing().allows(index, leaving, state)?);
                }
            }
        }
        for label in 0..self.composition.labels.len() {
            verdict = verdict.or(self.label_verdict(label, state, readiness)?);
        }
        Ok(verdict)
    }

    /// Holds where the label can be taken, if any participant wants it.
    fn label_verdict(
        &self,
        label: usize,
        state: &[f64],
        readiness: Readiness,
    ) -> Result<Verdict, Failure> {
        let mut all = Verdict::ALWAYS;
        // Which part of the participants makes the label forced, depends on the state, too.
        let mut wanted = Verdict::NEVER;
        for &(index, event) in &self.composition.labels[label].participants {
            let component = &self.composition.components[index];
            let mut any = Verdict::NEVER;
            let leaving = &component.place(self.locations[index]).leaving;
            for leaving in leaving.iter().filter(|leaving| leaving.event == event) {
                let allowed = self.standing().allows(index, leaving, state)?;
                any = any.or(allowed);
                if self.is_wanted(leaving, readiness) {
                    wanted = wanted.or(allowed);
                }
            }
            all = all.and(any);
        }
        Ok(all.and(wanted))
    }

    pub(super) fn failure(&self, reason: String) -> Failure {
        Failure::Flow { locations: self.standing().names(), reason }
    }
}

/// Which transitions are looked for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Readiness {
    /// Those that have to be taken.
    Forced,
    /// All.
    Possible,
}

impl System for Simulation<'_> {
    type Jump = Taken;
    type Finish = std::convert::Infallible;
    type Error = Failure;

    fn finished(&self) -> Option<Self::Finish> {
        None
    }

    fn jump(&mut self, round: &mut Round<'_, Taken>) -> Result<(), Failure> {
        self.now = round.now();
        self.flight = None;
        let mut jumped = self.take_round(round, Readiness::Forced)?;
        let left = self.horizon - self.now.t;
        // At the horizon there is no flow to come.
        if !jumped && left > 0.0 {
            let flight = self.plan(left)?;
            if flight.duration <= 0.0 {
                jumped = self.take_round(round, Readiness::Possible)?;
            }
            self.flight = (!jumped).then_some(flight);
        }
        self.now = round.now();
        Ok(())
    }

    fn time_to_jump(&self) -> Result<Option<f64>, Failure> {
        Ok(self.flight.as_ref().filter(|flight| flight.is_eventful).map(|flight| flight.duration))
    }

    fn flow(&mut self, duration: f64) -> Result<(), Failure> {
        let planned = match self.flight.take() {
            Some(flight) if flight.duration == duration => flight,
            _ => self.plan(duration)?,
        };
        if let Some(landing) = planned.samples.into_iter().next_back() {
            self.values = landing.values;
        }
        self.allowance = self.allowance_at(&self.values)?;
        self.now = self.now.after_flow(duration);
        Ok(())
    }
}

/// Writes the trajectory while the simulation runs.
struct Recorder(Trajectory);

impl Observer<Simulation<'_>> for Recorder {
    fn jumped(&mut self, entry: TraceEntry<Taken>) {
        self.0.jumped(entry.at, entry.jump);
    }

    fn flows(
        &mut self,
        simulation: &Simulation<'_>,
        now: HybridTime,
        _duration: f64,
    ) -> std::ops::ControlFlow<std::convert::Infallible> {
        if let (Some(flight), Some(phase)) = (&simulation.flight, self.0.phases.last_mut()) {
            phase.samples.clear();
            let shifted = |sample: &Sample| Sample { t: now.t + sample.t, ..sample.clone() };
            phase.samples.extend(flight.samples.iter().map(shifted));
        }
        std::ops::ControlFlow::Continue(())
    }
}
