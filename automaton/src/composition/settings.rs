//! How a composition is run.

use pleach_continuous::flow::{EventSearch, Method, Tolerances};
use serde::{Deserialize, Serialize};

use super::simulation::SimulationError;

/// How a composition is run. The default is fit for most models.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// When transitions are taken that only may be, and what is taken of intervals.
    pub policy: Policy,
    /// How flows are integrated that have no closed form.
    #[serde(default)]
    pub method: Method,
    /// The error of an integration step, relative to the state; 1e-9 by default.
    pub relative_tolerance: f64,
    /// The error of an integration step, in the unit of the state; 1e-9 by default.
    pub absolute_tolerance: f64,
    /// The longest integration step, in seconds; infinite by default, which JSON writes as null.
    #[serde(with = "unbounded")]
    pub largest_step: f64,
    /// How exactly events are located, in seconds; 0, the default, is as exactly as numbers allow.
    pub resolution: f64,
    /// The most rounds of jumps at one instant, at least 1; 1,000 by default.
    pub round_limit: u32,
    /// The most jumps in all; 10⁷ by default.
    pub jump_limit: u64,
    /// The most pieces of flows and spans of time examined for events; 10⁸ by default.
    pub step_limit: u64,
    /// The most memory for the trajectory, in bytes; 2³¹ by default. Names and the like come to it.
    pub memory_limit: u64,
    /// What happens where jumps accumulate, unless a component says otherwise.
    pub accumulation: Accumulation,
}

/// What happens where infinitely many jumps of a group would happen before an instant that time
/// never reaches. A composition can say it for [each
/// component](crate::CompositionBuilder::at_accumulation), and [how to go
/// on](crate::CompositionBuilder::past_accumulation) beyond that instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Accumulation {
    /// The run ends, with an estimate of the instant.
    #[default]
    End,
    /// Nothing: jumps go on until a transition, a limit of the run or the horizon ends them.
    Off,
}

/// When a transition is taken that only may be, and which value of an interval a reset takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Policy {
    /// As late as possible: where no time can pass, because an invariant ends. Of an interval its
    /// upper end.
    Late,
    /// As soon as its guard holds. Of an interval its lower end.
    Early,
    /// At an instant drawn evenly from those between the first at which a guard holds and the last
    /// at which time can pass, or as soon after it as a guard holds again; of the transitions that
    /// can be taken one is drawn, each as likely as the others, and of an interval a number, evenly.
    /// Equal seeds give equal runs, and what one
    /// group draws is no matter to another.
    Random {
        /// Where the sequence of draws begins.
        seed: u64,
    },
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            policy: Policy::Late,
            method: Method::Automatic,
            relative_tolerance: 1e-9,
            absolute_tolerance: 1e-9,
            largest_step: f64::INFINITY,
            resolution: 0.0,
            round_limit: 1000,
            jump_limit: 10_000_000,
            step_limit: 100_000_000,
            memory_limit: 1 << 31,
            accumulation: Accumulation::End,
        }
    }
}

impl Settings {
    pub(super) fn tolerances(&self) -> Tolerances {
        self.try_tolerances().unwrap_or_default()
    }

    pub(super) fn search(&self) -> EventSearch {
        let default = EventSearch::default();
        EventSearch::new(self.resolution, default.looks()).unwrap_or(default)
    }

    fn try_tolerances(&self) -> Result<Tolerances, String> {
        let tolerances = Tolerances::new(self.relative_tolerance, self.absolute_tolerance)
            .map_err(|fault| fault.to_string())?;
        if self.largest_step == f64::INFINITY {
            return Ok(tolerances);
        }
        tolerances.with_largest_step(self.largest_step).map_err(|fault| fault.to_string())
    }

    /// Whether the settings make sense.
    ///
    /// # Errors
    ///
    /// [`SimulationError::Settings`] if a tolerance or the resolution does not.
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        self.try_tolerances().map_err(SimulationError::Settings)?;
        let looks = EventSearch::default().looks();
        EventSearch::new(self.resolution, looks)
            .map_err(|fault| SimulationError::Settings(fault.to_string()))?;
        Ok(())
    }
}

/// JSON has no infinity.
mod unbounded {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        value.is_finite().then_some(*value).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or(f64::INFINITY))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flows and events are looked for as the settings say.
    #[test]
    fn tolerances_and_the_resolution_are_those_of_the_settings() {
        let settings = Settings {
            relative_tolerance: 1e-3,
            absolute_tolerance: 1e-5,
            resolution: 0.25,
            ..Settings::default()
        };
        let tolerances = Tolerances::new(1e-3, 1e-5).expect("they make sense");
        assert_eq!(settings.tolerances(), tolerances);
        let shorter = Settings { largest_step: 0.5, ..settings };
        let tolerances = tolerances.with_largest_step(0.5).expect("it makes sense");
        assert_eq!(shorter.tolerances(), tolerances);
        let search = EventSearch::new(0.25, EventSearch::default().looks());
        assert_eq!(settings.search(), search.expect("it makes sense"));
    }

    /// An infinite step is no number in JSON, and is read back.
    #[test]
    fn settings_are_written_and_read() {
        for largest_step in [0.5, f64::INFINITY] {
            let settings = Settings { largest_step, step_limit: 7, ..Settings::default() };
            let text = serde_json::to_string(&settings).expect("it is written");
            assert_eq!(text.contains(r#""largest_step":null"#), largest_step.is_infinite());
            let read: Settings = serde_json::from_str(&text).expect("it is read");
            assert_eq!(read, settings);
        }
    }
}
