//! Why a simulation cannot begin, cannot go on, or stops.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::composition::CompositionError;
use crate::executor::{InvalidLimit, Limit, Reason, Sliding};
use crate::zeno::Zeno;

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
    /// An event is sampled so often that time does not advance from one sample to the next.
    #[error(
        "the {clock} samples every {period:e} s, which numbers near the horizon, {horizon} s, do not resolve: \
         choose a longer period"
    )]
    Sampling {
        /// The clock that samples, as a component, which is called after the event.
        clock: String,
        /// The period in seconds.
        period: f64,
        /// The horizon in seconds.
        horizon: f64,
    },
    /// A tolerance or the resolution makes no sense.
    #[error("the settings cannot be used: {0}")]
    Settings(String),
    /// An observer cannot see such a run.
    #[error("the run cannot be observed: {0}")]
    Observer(String),
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
    /// A component begins outside the invariant of its location, where no time can pass, and no
    /// transition leads out.
    #[error(
        "component `{component}` begins in location `{location}` outside its invariant `{invariant}`, and \
         no transition can be taken"
    )]
    BeginsOutside {
        /// The component.
        component: String,
        /// Its location.
        location: String,
        /// The invariant.
        invariant: String,
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
    /// Two flows lead to the boundary between them.
    #[error("the flows of two locations lead to the boundary between them")]
    Sliding(Sliding),
    /// Jumps accumulate.
    #[error("jumps accumulate at {} s", .0.accumulation)]
    Zeno(Zeno),
}

impl From<Halt> for Reason<Failure> {
    fn from(halt: Halt) -> Self {
        match halt {
            Halt::Failure(failure) => Reason::Finished(failure),
            Halt::Limit(limit) => Reason::Limit(limit),
            Halt::Sliding(sliding) => Reason::Sliding(sliding),
            Halt::Zeno(zeno) => Reason::Zeno(zeno),
        }
    }
}
