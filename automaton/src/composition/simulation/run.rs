//! Whole runs, from the initial state to the end, with a record.

use pleach_discrete::{Event, Location};

use super::{Failure, Move, Simulation, SimulationError};
use crate::automaton::Automaton;
use crate::composition::record::Record;
use crate::composition::stream::Finish;
use crate::composition::{Composition, CompositionError, Settings};
use crate::coordinates::Coordinates;
use crate::executor::{Ending, Executor, LastJump, Observer, Reason};
use crate::time::HybridTime;
use crate::trajectory::Trajectory;

impl<L: Location, E: Event, S: Coordinates> Automaton<L, E, S> {
    /// The automaton as the only component of a composition, from its initial state.
    ///
    /// # Errors
    ///
    /// [`CompositionError`] if it has no initial state.
    pub fn alone(&self) -> Result<Composition, CompositionError> {
        Composition::builder().add("automaton", self).build()
    }

    /// Runs the automaton by itself, from its initial state, for `horizon` seconds.
    ///
    /// # Errors
    ///
    /// [`SimulationError`] if it has no initial state, or the horizon is negative or not finite.
    /// What happens on the way is told by the [ending](Trajectory::ending) of the trajectory.
    pub fn run(&self, horizon: f64) -> Result<Trajectory, SimulationError> {
        self.alone()?.run(horizon)
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
        self.alone()?.run_with(settings, horizon)
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
        let mut simulation = Simulation::new(self, settings, horizon)?;
        simulation.record = Some(Record::of(self));
        let ending = simulation.run(&mut ())?;
        Ok(simulation.into_trajectory(ending))
    }
}

impl<'a> Simulation<'a> {
    /// The same with a record of doubts alone.
    pub(in crate::composition) fn unrecorded(mut self) -> Self {
        self.record = Some(Record::of_doubts(self.composition));
        self
    }

    /// Runs to the end, and says where it is.
    pub(in crate::composition) fn finish(
        mut self,
        observer: &mut impl Observer<Self>,
    ) -> Result<Finish, SimulationError> {
        let ending = self.run(observer)?;
        let values = self.values();
        let doubts = self.record.take().map(Record::into_doubts).unwrap_or_default();
        Ok(Finish { ending, values, locations: self.locations, doubts })
    }

    fn run(
        &mut self,
        observer: &mut impl Observer<Self>,
    ) -> Result<Ending<Failure>, SimulationError> {
        let executor = Executor::new(self.horizon, self.settings.round_limit)?;
        Ok(match executor.without_zeno_detection().run(self, observer) {
            Ok(Ending { at, reason }) => {
                let reason = match reason.without_finish() {
                    Reason::JumpLimit(_) => match self.sliding(self.latest) {
                        Some(sliding) => Reason::Sliding(sliding),
                        None => Reason::JumpLimit(self.last_jump()),
                    },
                    Reason::Blocked if at == HybridTime::START => {
                        self.begins_outside().map_or(Reason::Blocked, Reason::Finished)
                    }
                    reason => reason,
                };
                Ending { at, reason }
            }
            Err(halt) => Ending { at: self.hybrid_time(), reason: halt.into() },
        })
    }

    fn last_jump(&self) -> Option<LastJump> {
        let [_, last] = self.groups[self.latest].latest;
        last.map(|Move { component, target: location, .. }| LastJump { component, location })
    }

    /// The first component that is outside the invariant of its location, as the reason why nothing goes on.
    fn begins_outside(&self) -> Option<Failure> {
        self.composition.components.iter().zip(&self.locations).find_map(|(component, location)| {
            let mode = component.mode(*location);
            let invariant = mode.invariant.as_ref()?;
            let verdict = invariant.evaluate_at(&self.values, &component.slots).ok()?;
            (!verdict.holds).then(|| Failure::BeginsOutside {
                component: component.name.clone(),
                location: mode.name.to_owned(),
                invariant: invariant.to_string(),
            })
        })
    }
}
