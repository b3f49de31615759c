//! Whether single runs are in the enclosure of all runs.

use std::fmt;

use pleach_automaton::Trajectory;

use super::explore::{Enclosure, Segment};
use super::model::Model;

/// A state of a run that is in no set of an enclosure.
#[derive(Clone, Debug, PartialEq)]
pub struct Escape {
    /// The location.
    pub location: String,
    /// When, in seconds.
    pub t: f64,
    /// The state.
    pub state: Vec<f64>,
}

impl fmt::Display for Escape {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Escape { location, t, state } = self;
        write!(formatter, "{location} at {t} s: {state:?}")
    }
}

impl Enclosure {
    /// The first sample of a run of one automaton that is in no set of its location at its time; up to
    /// `error`, which is how far, as a share of 1 and its size, a sample may be from the exact run.
    /// `constants` are the values of the model's variables that the run does not have, which rest.
    ///
    /// It is a test of the enclosure: of a complete one that is right, no run has any.
    pub fn escape(
        &self,
        model: &Model,
        run: &Trajectory,
        constants: &[f64],
        error: f64,
    ) -> Option<Escape> {
        let names = &run.components().first()?.locations;
        for interval in run.intervals() {
            let name = interval.locations.first().and_then(|number| names.get(*number))?;
            let location = model.locations().iter().position(|place| place.name == *name)?;
            let visits = self.visits.iter().filter(|visit| visit.location == location);
            let segments: Vec<&Segment> = visits.flat_map(|visit| &visit.segments).collect();
            for sample in &interval.samples {
                let state = [&sample.values[..], constants].concat();
                if !segments.iter().any(|segment| holds(segment, sample.t, &state, error)) {
                    return Some(Escape { location: name.clone(), t: sample.t, state });
                }
            }
        }
        None
    }
}

/// Whether a set has a state at a time, up to an error.
fn holds(segment: &Segment, t: f64, state: &[f64], error: f64) -> bool {
    let slack = error * (1.0 + t.abs());
    if t < segment.time.lower() - slack || t > segment.time.upper() + slack {
        return false;
    }
    let directions = segment.set.template().directions().iter();
    directions.zip(segment.set.bounds()).all(|(direction, bound)| {
        let (mut along, mut size) = (0.0, 0.0);
        for (entry, value) in direction.iter().zip(state) {
            along += entry * value;
            size += entry.abs() * (1.0 + value.abs());
        }
        along <= bound + error * size
    })
}
