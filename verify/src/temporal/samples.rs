//! Trajectories as the formulas see them: states at successive instants.

use std::error::Error;
use std::fmt;

use pleach_automaton::{HybridTime, Trajectory};
use pleach_guards::{Comparison, EvaluationError, Predicate, Relation, Valuation, Verdict};

use super::pointwise::crossing;
use super::signal::{Flow, Knot, Origin, Signal, Span, Time, Value};

/// The states of a trajectory at successive instants of hybrid time.
///
/// Times are in seconds, finite, and do not decrease. Between two samples of different times the
/// state flows; two samples of the same time are what is before and after a jump, and both count.
///
/// ```
/// use pleach_verify::temporal::Samples;
///
/// // A ball falls until 1 s, where its velocity jumps.
/// let velocities = [(0.0, -1.0), (1.0, -9.0), (1.0, 6.0)];
/// let fall = velocities.map(|(t, velocity)| (t, [("velocity", velocity)]));
/// let mut last = f64::NAN;
/// fall.for_each(&mut |t, _state| last = t);
/// assert_eq!(last, 1.0);
/// ```
pub trait Samples {
    /// Calls `visit` with the time and the state of every sample, in order.
    fn for_each(&self, visit: &mut dyn FnMut(f64, &dyn Valuation));

    /// The same with the samples that tell about these predicates, where a choice can be made: all
    /// instants at which one of them may change.
    ///
    /// # Errors
    ///
    /// [`EvaluationError`] if a predicate names a variable that no state has.
    fn for_each_that_tells(
        &self,
        _predicates: &[Predicate],
        visit: &mut dyn FnMut(f64, &dyn Valuation),
    ) -> Result<(), EvaluationError> {
        self.for_each(visit);
        Ok(())
    }
}

impl<V: Valuation> Samples for [(f64, V)] {
    fn for_each(&self, visit: &mut dyn FnMut(f64, &dyn Valuation)) {
        self.iter().for_each(|(t, state)| visit(*t, state));
    }
}

impl<V: Valuation, const N: usize> Samples for [(f64, V); N] {
    fn for_each(&self, visit: &mut dyn FnMut(f64, &dyn Valuation)) {
        self.as_slice().for_each(visit);
    }
}

impl<V: Valuation> Samples for Vec<(f64, V)> {
    fn for_each(&self, visit: &mut dyn FnMut(f64, &dyn Valuation)) {
        self.as_slice().for_each(visit);
    }
}

/// The samples of every phase; for a formula, also those at which the margins of its predicates turn
/// or pass zero, so that none of them changes between two samples.
impl Samples for Trajectory {
    fn for_each(&self, visit: &mut dyn FnMut(f64, &dyn Valuation)) {
        self.samples().for_each(|(at, sample)| visit(at.t, &self.state(&sample)));
    }

    fn for_each_that_tells(
        &self,
        predicates: &[Predicate],
        visit: &mut dyn FnMut(f64, &dyn Valuation),
    ) -> Result<(), EvaluationError> {
        for (at, sample) in self.samples_for(predicates)? {
            visit(at.t, &self.state(&sample));
        }
        Ok(())
    }
}

/// Why a formula cannot be judged on a trajectory.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TemporalError {
    /// There is no sample.
    NoSamples,
    /// The time of a sample is not finite, or less than that of the sample before.
    TimeOutOfOrder {
        /// Which sample, from 0.
        sample: usize,
        /// Its time, in seconds.
        time: f64,
    },
    /// A predicate has no margin in the state of a sample.
    Evaluation {
        /// The time of the sample, in seconds.
        time: f64,
        /// Why.
        error: EvaluationError,
    },
    /// A margin goes from finite to infinite, or from one infinity to the other, without a jump:
    /// nothing says what it is in between.
    UnboundedFlow {
        /// What has the margin.
        predicate: Predicate,
        /// The time of the sample before, in seconds.
        from: f64,
        /// The time of the sample after, in seconds.
        to: f64,
    },
}

impl fmt::Display for TemporalError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSamples => {
                write!(formatter, "the trajectory has no samples; it needs at least one")
            }
            Self::TimeOutOfOrder { sample, time } => {
                write!(formatter, "sample {sample} is at {time} s: times must be finite and ")?;
                write!(formatter, "not decrease")
            }
            Self::Evaluation { time, error } => write!(formatter, "at {time} s: {error}"),
            Self::UnboundedFlow { predicate, from, to } => {
                write!(formatter, "the margin of `{predicate}` between {from} s and {to} s ")?;
                write!(formatter, "cannot be interpolated: it is infinite at one end only")
            }
        }
    }
}

impl Error for TemporalError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Evaluation { error, .. } => Some(error),
            _ => None,
        }
    }
}

/// The verdicts of some predicates without connectives at the samples of a trajectory.
pub(super) struct Recording {
    instants: Vec<HybridTime>,
    literals: Vec<Literal>,
}

/// A predicate and its verdicts, one for each instant.
struct Literal {
    predicate: Predicate,
    verdicts: Vec<Verdict>,
}

/// What the values of a signal are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reading {
    /// The margin of each predicate.
    Margin,
    /// 1 where the predicate holds, −1 where it does not.
    Truth,
}

impl Recording {
    /// Evaluates `predicates` at every sample.
    pub fn new(
        predicates: &[Predicate],
        samples: &(impl Samples + ?Sized),
    ) -> Result<Recording, TemporalError> {
        let literal =
            |predicate: &Predicate| Literal { predicate: predicate.clone(), verdicts: vec![] };
        let literals = predicates.iter().map(literal).collect();
        let mut recording = Recording { instants: Vec::new(), literals };
        let mut outcome = Ok(());
        let told = samples.for_each_that_tells(predicates, &mut |t, state| {
            if outcome.is_ok() {
                outcome = recording.record(t, state);
            }
        });
        told.map_err(|error| TemporalError::Evaluation { time: 0.0, error })?;
        outcome?;
        if recording.instants.is_empty() { Err(TemporalError::NoSamples) } else { Ok(recording) }
    }

    fn record(&mut self, t: f64, state: &dyn Valuation) -> Result<(), TemporalError> {
        let instant = match self.instants.last() {
            _ if !t.is_finite() => None,
            None => Some(HybridTime { t, j: 0 }),
            Some(last) if t > last.t => Some(HybridTime { t, j: last.j }),
            Some(last) if t == last.t => Some(last.after_jump()),
            Some(_) => None,
        };
        let sample = self.instants.len();
        let instant = instant.ok_or(TemporalError::TimeOutOfOrder { sample, time: t })?;
        for literal in &mut self.literals {
            let verdict = literal
                .predicate
                .evaluate(state)
                .map_err(|error| TemporalError::Evaluation { time: t, error })?;
            let before = self.instants.last().zip(literal.verdicts.last());
            if let Some((from, before)) = before.filter(|(from, _)| from.t < t) {
                let unbounded = before.margin.is_infinite() || verdict.margin.is_infinite();
                if unbounded && before.margin != verdict.margin {
                    let predicate = literal.predicate.clone();
                    return Err(TemporalError::UnboundedFlow { predicate, from: from.t, to: t });
                }
            }
            literal.verdicts.push(verdict);
        }
        self.instants.push(instant);
        Ok(())
    }

    /// The seconds from the first sample to the last.
    pub fn duration(&self) -> f64 {
        self.end().t - self.instants[0].t
    }

    /// The predicate at place `literal`.
    pub fn predicate(&self, literal: usize) -> &Predicate {
        &self.literals[literal].predicate
    }

    /// The margin of the predicate at place `literal` at the instant `at`.
    pub fn margin(&self, literal: usize, at: HybridTime) -> f64 {
        let verdicts = &self.literals[literal].verdicts;
        let last = self.instants.partition_point(|instant| *instant <= at).saturating_sub(1);
        let (from, to) =
            (self.instants[last], self.instants.get(last + 1).map_or(at, |next| *next));
        let start = verdicts[last].margin;
        let end = verdicts.get(last + 1).map_or(start, |verdict| verdict.margin);
        Flow { start, end, origin: None }.at((from.t, to.t), at.t).margin
    }

    /// The value `margin` at all times.
    pub fn constant(&self, margin: f64) -> Signal {
        let mut signal = Signal::new();
        let value = Value::given(margin);
        let flow = Some(Flow::constant(value));
        signal.push(Knot { t: self.instants[0].t, value, flow });
        signal
    }

    /// The predicate at place `literal` over time, which is `beyond` after the last sample.
    pub fn signal(&self, literal: usize, reading: Reading, beyond: f64) -> Signal {
        let on_the_boundary = holds_on_the_boundary(&self.literals[literal].predicate);
        let verdicts = &self.literals[literal].verdicts;
        let mut signal = Signal::new();
        for (position, (instant, verdict)) in self.instants.iter().zip(verdicts).enumerate() {
            let origin = |time| Some(Origin { literal, jumps: instant.j, time });
            let margin = match reading {
                Reading::Margin => verdict.margin,
                Reading::Truth => truth(verdict.holds),
            };
            let value = Value { margin, origin: origin(Time::Fixed(instant.t)) };
            let Some((next, after)) =
                self.instants.get(position + 1).zip(verdicts.get(position + 1))
            else {
                let flow = Some(Flow::constant(Value::given(beyond)));
                signal.push(Knot { t: instant.t, value, flow });
                break;
            };
            if next.t == instant.t {
                signal.push(Knot { t: instant.t, value, flow: None });
                continue;
            }
            let origin = origin(Time::Moving(0.0));
            let flow = Flow { start: verdict.margin, end: after.margin, origin };
            match reading {
                Reading::Margin => signal.push(Knot { t: instant.t, value, flow: Some(flow) }),
                Reading::Truth => {
                    push_truth(&mut signal, value, (instant.t, next.t), flow, on_the_boundary);
                }
            }
        }
        signal
    }

    fn end(&self) -> HybridTime {
        self.instants[self.instants.len() - 1]
    }
}

fn truth(holds: bool) -> f64 {
    if holds { 1.0 } else { -1.0 }
}

/// Whether the predicate holds where its margin is 0.
fn holds_on_the_boundary(predicate: &Predicate) -> bool {
    match predicate {
        Predicate::Comparison(Comparison { relation, .. }) => {
            matches!(relation, Relation::AtMost | Relation::AtLeast)
        }
        _ => true,
    }
}

/// Adds an instant and the truth of a predicate whose margin is `flow` over `span` after it.
fn push_truth(signal: &mut Signal, value: Value, span: Span, flow: Flow, on_the_boundary: bool) {
    let course = |sum: f64| {
        let holds = if sum == 0.0 { on_the_boundary } else { sum > 0.0 };
        Some(Flow { start: truth(holds), end: truth(holds), origin: flow.origin })
    };
    let zero = Flow::constant(Value::given(0.0));
    match crossing(span, &flow, &zero) {
        None => signal.push(Knot { t: span.0, value, flow: course(flow.start + flow.end) }),
        Some(t) => {
            signal.push(Knot { t: span.0, value, flow: course(flow.start) });
            let origin = flow.at(span, t).origin;
            let value = Value { margin: truth(on_the_boundary), origin };
            signal.push(Knot { t, value, flow: course(flow.end) });
        }
    }
}
