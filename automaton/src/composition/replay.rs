//! Running again what was recorded.

use thiserror::Error;

use super::{Composition, SimulationError};
use crate::time::HybridTime;
use crate::trajectory::Trajectory;

/// A recorded run does not happen again.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// The composition has other variables, components or locations than the recorded one.
    #[error("the trajectory was recorded from a composition with other {0}")]
    OtherComposition(&'static str),
    /// The composition cannot be run as the recorded one was.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The runs differ.
    #[error("from {at} on the run differs from what was recorded")]
    Diverged {
        /// The first hybrid time at which they do.
        at: HybridTime,
    },
}

impl Composition {
    /// Runs the composition once more as `recorded` was run, and compares the two to the bit.
    ///
    /// # Errors
    ///
    /// [`ReplayError`] where they differ, or if the composition cannot be the recorded one.
    pub fn replay(&self, recorded: &Trajectory) -> Result<(), ReplayError> {
        self.check_origin(recorded)?;
        let again = self.run_with(recorded.settings, recorded.horizon)?;
        if again == *recorded {
            return Ok(());
        }
        let mut pairs = again.samples().zip(recorded.samples());
        let samples = again.samples().count().min(recorded.samples().count());
        if let Some((_, (at, _))) = pairs.find(|(new, old)| new != old) {
            return Err(ReplayError::Diverged { at });
        }
        let last = recorded.samples().nth(samples.saturating_sub(1));
        Err(ReplayError::Diverged { at: last.map_or(HybridTime::START, |(at, _)| at) })
    }

    fn check_origin(&self, recorded: &Trajectory) -> Result<(), ReplayError> {
        if self.variables != recorded.variables {
            return Err(ReplayError::OtherComposition("variables"));
        }
        if !self.components().eq(recorded.components.iter().map(|one| &*one.name)) {
            return Err(ReplayError::OtherComposition("components"));
        }
        let same_locations = recorded.components.iter().enumerate().all(|(index, component)| {
            self.locations(index).eq(component.locations.iter().map(String::as_str))
        });
        if same_locations { Ok(()) } else { Err(ReplayError::OtherComposition("locations")) }
    }
}
