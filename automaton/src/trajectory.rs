//! Trajectories: what a run went through, in full.

use std::fmt;
use std::io;

use pleach_guards::Valuation;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::composition::Move;
use crate::composition::{Failure, Settings, Taken};
use crate::executor::Ending;
use crate::time::HybridTime;

/// The run of a composition: a hybrid arc x(t, j) with the locations along it.
///
/// It is a list of phases with a jump between any two: in phase j, between jump j − 1 and jump j,
/// the locations rest and the state flows. What is written to a file and read back is equal to the
/// bit.
///
/// ```
/// use pleach_automaton::{coordinates, from, Automaton, Trajectory};
/// use pleach_discrete::vocabulary;
///
/// vocabulary! {
///     enum Lamp: Location { Dark = "dark", Lit = "lit" }
///     enum Timer: Event { Elapsed = "elapsed" }
/// }
/// coordinates! { struct Clock { clock } }
/// let Clock { clock } = Clock::coordinates();
///
/// let lamp = Automaton::starting_in(Lamp::Lit)
///     .initially(Clock { clock: 0.0 })
///     .flow(Lamp::Lit, clock.rate(1.0))
///     .transition(from(Lamp::Lit).on(Timer::Elapsed).to(Lamp::Dark).must(clock.at_least(2.5)))
///     .build()?;
/// let trajectory = lamp.run(4.0)?;
///
/// assert_eq!(trajectory.value("clock", 1.5), Some(1.5));
/// assert_eq!(trajectory.location(0, 3.0), Some("dark"));
/// assert_eq!(trajectory.jumps()[0].to_string(), "(2.5 s, 0) elapsed");
///
/// let mut file = Vec::new();
/// trajectory.write(&mut file)?;
/// assert_eq!(Trajectory::read(&file[..])?, trajectory);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trajectory {
    pub(crate) variables: Vec<String>,
    pub(crate) components: Vec<Participant>,
    pub(crate) settings: Settings,
    pub(crate) horizon: f64,
    pub(crate) phases: Vec<Phase>,
    pub(crate) jumps: Vec<JumpRecord>,
    pub(crate) ending: Ending<Failure>,
}

/// A component as a trajectory knows it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Participant {
    /// The name.
    pub name: String,
    /// The names of its locations.
    pub locations: Vec<String>,
}

/// What lies between two jumps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Phase {
    /// The locations of the components, as numbers in their lists.
    pub locations: Vec<usize>,
    /// At least one: the first is x⁺ of the jump before, the last x⁻ of the jump after. If no time
    /// passes there is one only.
    pub samples: Vec<Sample>,
}

/// The state at an instant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// The instant, in seconds.
    pub t: f64,
    /// The values of the variables.
    pub values: Vec<f64>,
    /// How fast they change, per second.
    pub rates: Vec<f64>,
}

/// A jump of a composition: one component's own, or a label that several take together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JumpRecord {
    /// The jump leads from (t, j) to (t, j + 1).
    pub at: HybridTime,
    /// The event or the label.
    pub label: String,
    /// Who goes where.
    pub moves: Vec<Move>,
}

/// A trajectory cannot be written or read.
#[derive(Debug, Error)]
pub enum FileError {
    /// The text is no trajectory, or the file fails.
    #[error("a trajectory cannot be written or read: {0}")]
    Json(#[from] serde_json::Error),
    /// The text is a trajectory in form only.
    #[error("the file is no trajectory of a run: {0}")]
    Inconsistent(&'static str),
}

impl Trajectory {
    /// The names of the variables, in the order of the values in samples.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// The components in their order.
    pub fn components(&self) -> &[Participant] {
        &self.components
    }

    /// The phases in their order, one more than there are jumps.
    pub fn phases(&self) -> &[Phase] {
        &self.phases
    }

    /// The jumps in their order: the discrete projection, or trace, of the run.
    pub fn jumps(&self) -> &[JumpRecord] {
        &self.jumps
    }

    /// When and why the run ended.
    pub fn ending(&self) -> &Ending<Failure> {
        &self.ending
    }

    /// How the run was made.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Every sample in the order of hybrid time, with that time.
    pub fn samples(&self) -> impl Iterator<Item = (HybridTime, &Sample)> {
        (0..).zip(&self.phases).flat_map(|(j, phase)| {
            phase.samples.iter().map(move |sample| (HybridTime { t: sample.t, j }, sample))
        })
    }

    /// The state of the sample as a valuation.
    pub fn state<'a>(&'a self, sample: &'a Sample) -> State<'a> {
        State { variables: &self.variables, values: &sample.values }
    }

    /// The values at instant `t`, after all jumps there; `None` outside the run.
    ///
    /// Between samples it is the cubic that has their values and rates.
    pub fn values_at(&self, t: f64) -> Option<Vec<f64>> {
        let phase = self.phase_at(t)?;
        let after = phase.samples.partition_point(|sample| sample.t <= t);
        let before = phase.samples.get(after.checked_sub(1)?)?;
        Some(match phase.samples.get(after) {
            Some(after) => between(before, after, t),
            None => before.values.clone(),
        })
    }

    /// The value of `variable` at instant `t`, after all jumps there; `None` outside the run and
    /// for a variable that does not exist.
    pub fn value(&self, variable: &str, t: f64) -> Option<f64> {
        let place = self.variables.iter().position(|name| name == variable)?;
        self.values_at(t).map(|values| values[place])
    }

    /// The location of a component at instant `t`, after all jumps there.
    pub fn location(&self, component: usize, t: f64) -> Option<&str> {
        let location = *self.phase_at(t)?.locations.get(component)?;
        self.components.get(component)?.locations.get(location).map(String::as_str)
    }

    /// The values at 0, `period`, 2 `period`, … up to the end; nothing unless `period` > 0.
    pub fn resample(&self, period: f64) -> impl Iterator<Item = (f64, Vec<f64>)> {
        let count = if period > 0.0 { self.ending.at.t / period } else { -1.0 };
        (0..).map(f64::from).take_while(move |number| *number <= count).filter_map(
            move |number: f64| {
                let t = number * period;
                self.values_at(t).map(|values| (t, values))
            },
        )
    }

    /// Writes the trajectory as JSON.
    ///
    /// # Errors
    ///
    /// [`FileError::Json`] if the writer fails.
    pub fn write(&self, writer: impl io::Write) -> Result<(), FileError> {
        // Numbers are written one by one: unbuffered, each would be a call of the system.
        let mut buffered = io::BufWriter::new(writer);
        serde_json::to_writer(&mut buffered, self)?;
        io::Write::flush(&mut buffered).map_err(serde_json::Error::io)?;
        Ok(())
    }

    /// Reads what [`write`](Self::write) has written.
    ///
    /// # Errors
    ///
    /// [`FileError`] if it is something else.
    pub fn read(reader: impl io::Read) -> Result<Trajectory, FileError> {
        let trajectory: Trajectory = serde_json::from_reader(reader)?;
        trajectory.check()?;
        Ok(trajectory)
    }

    /// What all other functions rely on.
    fn check(&self) -> Result<(), FileError> {
        let wrong = FileError::Inconsistent;
        if self.phases.len() != self.jumps.len() + 1 {
            return Err(wrong("between any two phases there must be a jump"));
        }
        let width = self.variables.len();
        for phase in &self.phases {
            let sizes = phase.samples.iter().map(|one| (one.values.len(), one.rates.len()));
            if phase.samples.is_empty() || sizes.into_iter().any(|sizes| sizes != (width, width)) {
                return Err(wrong("every phase needs samples with a value for each variable"));
            }
            if !phase.samples.is_sorted_by(|one, next| one.t <= next.t) {
                return Err(wrong("samples must be in the order of time"));
            }
            let known = phase.locations.iter().zip(&self.components);
            if phase.locations.len() != self.components.len()
                || known.into_iter().any(|(one, component)| *one >= component.locations.len())
            {
                return Err(wrong("every phase needs a location for each component"));
            }
        }
        Ok(())
    }

    /// The last phase that has begun at `t`.
    fn phase_at(&self, t: f64) -> Option<&Phase> {
        let within = t >= 0.0 && t <= self.ending.at.t;
        let begun = self.phases.partition_point(|phase| phase.samples[0].t <= t);
        within.then(|| self.phases.get(begun.checked_sub(1)?)).flatten()
    }

    pub(crate) fn jumped(&mut self, at: HybridTime, taken: Taken) {
        let mut locations =
            self.phases.last().map(|phase| phase.locations.clone()).unwrap_or_default();
        for one in &taken.moves {
            locations[one.component] = one.target;
        }
        let rates = vec![0.0; taken.values.len()];
        let first = Sample { t: at.t, values: taken.values, rates };
        self.phases.push(Phase { locations, samples: vec![first] });
        self.jumps.push(JumpRecord { at, label: taken.label, moves: taken.moves });
    }
}

/// The cubic Hermite interpolation, exact for flows of third degree.
pub(crate) fn between(before: &Sample, after: &Sample, t: f64) -> Vec<f64> {
    let width = after.t - before.t;
    let s = (t - before.t) / width;
    let (rest, square) = (1.0 - s, s * s);
    let places = 0..before.values.len();
    places
        .map(|place| {
            let (from, to) = (before.values[place], after.values[place]);
            let (start, end) = (before.rates[place] * width, after.rates[place] * width);
            let value = from * (1.0 + 2.0 * s) * rest * rest + to * square * (3.0 - 2.0 * s);
            value + start * s * rest * rest - end * square * rest
        })
        .collect()
}

/// The state of a sample under the names of the variables.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    variables: &'a [String],
    values: &'a [f64],
}

impl Valuation for State<'_> {
    fn value(&self, variable: &str) -> Option<f64> {
        let place = self.variables.iter().position(|name| name == variable)?;
        self.values.get(place).copied()
    }
}

impl fmt::Display for JumpRecord {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} {}", self.at, self.label)
    }
}
