//! Trajectories: what a run went through, in full.

mod account;
mod doubt;
mod strand;

use std::fmt;
use std::io;

use pleach_guards::{EvaluationError, Expression, Valuation};
use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use account::{Account, Gap, Look, Passage, Unevaluated};
pub use doubt::{Doubt, Why};
pub(crate) use strand::{Strand, Stretch};

use crate::composition::Move;
use crate::composition::{Failure, Settings};
use crate::executor::Ending;
use crate::signals::Signal;
use crate::time::HybridTime;

/// The run of a composition: a hybrid arc x(t, j) with the locations along it.
///
/// It is a list of intervals with a jump between any two: in phase j, between jump j − 1 and jump j,
/// the locations rest and the state flows. The flows are kept as they were solved, in pieces that
/// are polynomials in time, so that values can be read at every instant as exactly as at any other.
/// Where it is undecided whether something happens, there is a [`Doubt`]. What is written to a
/// file and read back is equal to the bit.
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
/// assert_eq!(trajectory.value("clock", 1.5)?, 1.5);
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
    /// Names of formulas of the variables, with these.
    pub(crate) signals: Vec<Signal>,
    pub(crate) components: Vec<Participant>,
    /// The locations at the start, by component.
    pub(crate) initial: Vec<usize>,
    pub(crate) settings: Settings,
    pub(crate) horizon: f64,
    pub(crate) strands: Vec<Strand>,
    pub(crate) jumps: Vec<JumpRecord>,
    pub(crate) doubts: Vec<Doubt>,
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
#[derive(Clone, Debug, PartialEq)]
pub struct FlowInterval {
    /// The locations of the components, as numbers in their lists.
    pub locations: Vec<usize>,
    /// At least one: the first is x⁺ of the jump before, the last x⁻ of the jump after. If no time
    /// passes there is one only. They are close enough for cubics through them to look like the
    /// trajectory.
    pub samples: Vec<Sample>,
}

/// The state at an instant.
#[derive(Clone, Debug, PartialEq)]
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
    /// The names of the components that take part, with commas between them; empty in a run of a single
    /// component.
    pub by: String,
    /// The moves of the components.
    pub moves: Vec<Move>,
}

/// A trajectory cannot be written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// The text is no trajectory, or the file fails.
    #[error("a trajectory cannot be written or read: {0}")]
    Json(#[from] serde_json::Error),
    /// The text is a trajectory in form only.
    #[error("the file is not a trajectory of a run: {0}")]
    Inconsistent(&'static str),
}

/// Why there is no value.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoValue {
    /// No variable and no signal has the name.
    #[error("there is no variable or signal `{name}`: there are {}", known.join(", "))]
    Unknown {
        /// The name.
        name: String,
        /// The names that exist.
        known: Vec<String>,
    },
    /// The instant is not within the run.
    #[error("{t} s is not within the run, which lasts from 0 to {end} s")]
    Outside {
        /// The instant, in seconds.
        t: f64,
        /// When the run ends, in seconds.
        end: f64,
    },
    /// The formula of a signal has no value in the state at the instant.
    #[error("signal `{name}` has no value at {t} s: {error}")]
    Undefined {
        /// The signal.
        name: String,
        /// The instant, in seconds.
        t: f64,
        /// Why.
        error: EvaluationError,
    },
}

impl Trajectory {
    /// The names of the variables, in the order of the values in samples.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// The signals, each with its formula of variables.
    pub fn signals(&self) -> impl ExactSizeIterator<Item = (&str, &Expression)> {
        self.signals.iter().map(|(name, formula)| (name.as_str(), formula))
    }

    /// The components in their order.
    pub fn components(&self) -> &[Participant] {
        &self.components
    }

    /// The intervals in their order, one more than there are jumps.
    ///
    /// They are put together one by one from what each component went through; with many components
    /// and jumps, [`values_at`](Self::values_at) and [`jumps`](Self::jumps) cost less.
    pub fn intervals(&self) -> impl ExactSizeIterator<Item = FlowInterval> {
        let mut locations = self.initial.clone();
        (0..self.jumps.len() + 1).map(move |number| {
            if let Some(jump) = number.checked_sub(1).and_then(|last| self.jumps.get(last)) {
                for one in &jump.moves {
                    locations[one.component] = one.target;
                }
            }
            FlowInterval { locations: locations.clone(), samples: self.samples_of(number) }
        })
    }

    fn samples_of(&self, phase: usize) -> Vec<Sample> {
        let [from, _] = self.ends_of(phase);
        let instants = self.instants_of(phase).into_iter();
        instants.map(|t| self.sample(HybridTime { t, ..from })).collect()
    }

    /// When the samples of a phase are taken.
    fn instants_of(&self, phase: usize) -> Vec<f64> {
        let [from, to] = self.ends_of(phase);
        let mut instants = vec![from.t];
        if to.t > from.t {
            for strand in &self.strands {
                let stretches = strand.during(from, to).iter();
                stretches.for_each(|stretch| stretch.instants(from.t, to.t, &mut instants));
            }
            instants.sort_by(f64::total_cmp);
            instants.dedup();
            instants.push(to.t);
        }
        instants
    }

    /// The hybrid times between which a phase lies.
    fn ends_of(&self, phase: usize) -> [HybridTime; 2] {
        let j = u32::try_from(phase).unwrap_or(u32::MAX);
        let from = phase.checked_sub(1).map_or(0.0, |last| self.jumps[last].at.t);
        let to = self.jumps.get(phase).map_or(self.ending.at.t, |jump| jump.at.t);
        [HybridTime { t: from, j }, HybridTime { t: to, j }]
    }

    /// The state at a hybrid time within the run.
    fn sample(&self, at: HybridTime) -> Sample {
        let (mut values, mut rates) =
            (vec![0.0; self.variables.len()], vec![0.0; self.variables.len()]);
        let mut own = Vec::new();
        for strand in &self.strands {
            let stretch = strand.stretch(at);
            stretch.values(at.t, &mut own);
            strand.slots.iter().zip(&own).for_each(|(&slot, &value)| values[slot] = value);
            stretch.rates(at.t, &mut own);
            strand.slots.iter().zip(&own).for_each(|(&slot, &rate)| rates[slot] = rate);
        }
        Sample { t: at.t, values, rates }
    }

    /// Where it is undecided whether something happens; see [`Doubt`].
    pub fn doubts(&self) -> &[Doubt] {
        &self.doubts
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
    pub fn samples(&self) -> impl Iterator<Item = (HybridTime, Sample)> {
        (0..).zip(self.intervals()).flat_map(|(j, phase)| {
            let samples = phase.samples.into_iter();
            samples.map(move |sample| (HybridTime { t: sample.t, j }, sample))
        })
    }

    /// The state of the sample as a valuation.
    pub fn state<'a>(&'a self, sample: &'a Sample) -> State<'a> {
        State { trajectory: self, values: &sample.values }
    }

    /// The values at instant `t`, after all jumps there; `None` outside the run.
    pub fn values_at(&self, t: f64) -> Option<Vec<f64>> {
        let at = self.last_at(t)?;
        let mut values = vec![0.0; self.variables.len()];
        let mut own = Vec::new();
        for strand in &self.strands {
            strand.stretch(at).values(t, &mut own);
            strand.slots.iter().zip(&own).for_each(|(&slot, &value)| values[slot] = value);
        }
        Some(values)
    }

    /// The value of the variable or signal called `name` at instant `t`, after all jumps there.
    ///
    /// # Errors
    ///
    /// [`NoValue`] for a name that does not exist, outside the run, and where a signal has no value.
    pub fn value(&self, name: &str, t: f64) -> Result<f64, NoValue> {
        let slot = self.variables.iter().position(|variable| variable == name);
        let Some(slot) = slot else { return self.signal_value(name, t) };
        let at = self.within(t)?;
        let strands = self.strands.iter();
        let mut places = strands
            .filter_map(|strand| Some((strand, strand.slots.iter().position(|one| *one == slot)?)));
        let mut own = Vec::new();
        let value = places.next().and_then(|(strand, place)| {
            strand.stretch(at).values(t, &mut own);
            own.get(place).copied()
        });
        value.ok_or_else(|| self.unknown(name))
    }

    fn signal_value(&self, name: &str, t: f64) -> Result<f64, NoValue> {
        let mut signals = self.signals.iter();
        let (_, formula) = signals.find(|one| one.0 == name).ok_or_else(|| self.unknown(name))?;
        self.within(t)?;
        let values = self.values_at(t).unwrap_or_default();
        let state = State { trajectory: self, values: &values };
        let undefined = |error| NoValue::Undefined { name: name.to_owned(), t, error };
        formula.evaluate(&state).map_err(undefined)
    }

    fn unknown(&self, name: &str) -> NoValue {
        let signals = self.signals.iter().map(|(name, _)| name);
        let known = self.variables.iter().chain(signals).cloned().collect();
        NoValue::Unknown { name: name.to_owned(), known }
    }

    fn within(&self, t: f64) -> Result<HybridTime, NoValue> {
        let end = self.ending.at.t;
        self.last_at(t).ok_or(NoValue::Outside { t, end })
    }

    /// The location of a component at instant `t`, after all jumps there.
    pub fn location(&self, component: usize, t: f64) -> Option<&str> {
        let at = self.last_at(t)?;
        let taken = self.jumps.iter().take(at.j as usize).rev();
        let mut moves = taken.flat_map(|jump| &jump.moves);
        let last = moves.find(|one| one.component == component).map(|one| one.target);
        let location = last.or(self.initial.get(component).copied())?;
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
        let trajectory: Trajectory = serde_json::from_reader(io::BufReader::new(reader))?;
        trajectory.check()?;
        Ok(trajectory)
    }

    /// What all other functions rely on.
    fn check(&self) -> Result<(), FileError> {
        let wrong = FileError::Inconsistent;
        let (variables, components) = (self.variables.len(), self.components.len());
        if !self.strands.iter().all(|strand| strand.is_consistent(variables, components)) {
            return Err(wrong(
                "every flow needs a value for each of its variables, in order of time",
            ));
        }
        let is_variable = |name: &str| self.variables.iter().any(|variable| variable == name);
        let mut read = self.signals.iter().flat_map(|(_, formula)| formula.variables());
        if !read.all(is_variable) {
            return Err(wrong("signals must be formulas of the variables"));
        }
        let mut slots: Vec<usize> =
            self.strands.iter().flat_map(|strand| strand.slots.iter().copied()).collect();
        slots.sort_unstable();
        if !slots.into_iter().eq(0..variables) {
            return Err(wrong("every variable needs one course"));
        }
        if !self.jumps.is_sorted_by(|one, next| one.at <= next.at) {
            return Err(wrong("jumps must be in the order of time"));
        }
        let known = |component: usize, location: usize| {
            self.components.get(component).is_some_and(|one| location < one.locations.len())
        };
        let mut moves = self.jumps.iter().flat_map(|jump| &jump.moves);
        let initial = self.initial.iter().enumerate();
        let starts = initial.clone().count() == components
            && initial.into_iter().all(|(component, &location)| known(component, location));
        if !(starts && moves.all(|one| known(one.component, one.target))) {
            return Err(wrong("every component needs a location that it has"));
        }
        Ok(())
    }

    /// The last hybrid time of the run at `t`.
    fn last_at(&self, t: f64) -> Option<HybridTime> {
        let within = t >= 0.0 && t <= self.ending.at.t;
        let taken = self.jumps.partition_point(|jump| jump.at.t <= t);
        within.then(|| HybridTime { t, j: u32::try_from(taken).unwrap_or(u32::MAX) })
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

/// The state of a sample under the names of variables and signals.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    trajectory: &'a Trajectory,
    values: &'a [f64],
}

impl Valuation for State<'_> {
    fn value(&self, name: &str) -> Option<f64> {
        let Trajectory { variables, signals, .. } = self.trajectory;
        match variables.iter().position(|variable| variable == name) {
            Some(place) => self.values.get(place).copied(),
            None => signals.iter().find(|one| one.0 == name)?.1.evaluate(self).ok(),
        }
    }
}

impl fmt::Display for JumpRecord {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &*self.by {
            "" => write!(formatter, "{} {}", self.at, self.label),
            components => write!(formatter, "{} {components}: {}", self.at, self.label),
        }
    }
}
