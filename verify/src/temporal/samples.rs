//! Trajectories as the formulas see them: states at successive instants.

use std::error::Error;
use std::fmt;

use pleach_automaton::trajectory::{Account, Look, Passage, Unevaluated};
use pleach_automaton::{HybridTime, Trajectory};
use pleach_guards::{Comparison, EvaluationError, Interval, Predicate, Relation, Truth, Valuation};

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

    /// What a predicate does along the trajectory, with a look also at `instants`, where more is known
    /// of it than at samples; otherwise its margin is taken to be linear between them.
    ///
    /// # Errors
    ///
    /// [`Unevaluated`] where the predicate has no verdict.
    fn account(
        &self,
        _predicate: &Predicate,
        _instants: &[f64],
    ) -> Result<Option<Account>, Unevaluated> {
        Ok(None)
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

/// The samples of every phase. Formulas are judged by what is known of all instants.
impl Samples for Trajectory {
    fn for_each(&self, visit: &mut dyn FnMut(f64, &dyn Valuation)) {
        self.samples().for_each(|(at, sample)| visit(at.t, &self.state(&sample)));
    }

    fn account(
        &self,
        predicate: &Predicate,
        instants: &[f64],
    ) -> Result<Option<Account>, Unevaluated> {
        Trajectory::account(self, predicate, instants).map(Some)
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

impl From<Unevaluated> for TemporalError {
    fn from(fault: Unevaluated) -> Self {
        TemporalError::Evaluation { time: fault.t, error: fault.error }
    }
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

/// What some predicates without connectives do along a trajectory.
pub(super) struct Recording {
    first: HybridTime,
    last: HybridTime,
    literals: Vec<Literal>,
}

/// A predicate, and what it does.
struct Literal {
    predicate: Predicate,
    account: Account,
}

/// What the values of a signal are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reading {
    /// The margin of each predicate.
    Margin,
    /// 1 where the predicate holds, −1 where it does not.
    Truth,
}

/// What is not known of a predicate: the one that makes its margin least, or that which makes it most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// It holds nowhere, and after the end its margin is −∞.
    Worst,
    /// It holds everywhere, and after the end its margin is ∞.
    Best,
}

impl Side {
    /// That which is worst for a formula is best for its negation.
    pub(super) fn opposite(self) -> Side {
        match self {
            Side::Worst => Side::Best,
            Side::Best => Side::Worst,
        }
    }

    fn beyond(self) -> f64 {
        match self {
            Side::Worst => f64::NEG_INFINITY,
            Side::Best => f64::INFINITY,
        }
    }
}

impl Recording {
    /// Follows `predicates` along a trajectory, looking also at `instants`.
    pub(super) fn new(
        predicates: &[Predicate],
        samples: &(impl Samples + ?Sized),
        instants: &[f64],
    ) -> Result<Recording, TemporalError> {
        let mut literals = Vec::with_capacity(predicates.len());
        let mut ends: Option<[HybridTime; 2]> = None;
        for predicate in predicates {
            let known = samples.account(predicate, instants);
            let account = match known? {
                Some(account) => account,
                None => linear_account(predicate, samples)?,
            };
            let looks = &account.looks;
            ends =
                ends.or(looks.first().zip(looks.last()).map(|(first, last)| [first.at, last.at]));
            literals.push(Literal { predicate: predicate.clone(), account });
        }
        let [first, last] = match ends {
            Some(ends) => ends,
            None => ends_of(samples)?,
        };
        Ok(Recording { first, last, literals })
    }

    /// The seconds from the first instant to the last.
    pub(super) fn duration(&self) -> f64 {
        self.last.t - self.first.t
    }

    /// The predicates with what they do.
    pub(super) fn accounts(&self) -> impl Iterator<Item = (&Predicate, &Account)> {
        self.literals.iter().map(|literal| (&literal.predicate, &literal.account))
    }

    /// The predicate at place `literal`.
    pub(super) fn predicate(&self, literal: usize) -> &Predicate {
        &self.literals[literal].predicate
    }

    /// The instant of the phase after `jumps` jumps that is nearest to a time, which rounding may have put beside the
    /// phase, and the margin of the predicate at place `literal` there.
    pub(super) fn margin(&self, literal: usize, jumps: u32, t: f64) -> (HybridTime, f64) {
        let looks = &self.literals[literal].account.looks;
        let phase = looks.partition_point(|look| look.at.j < jumps)
            ..looks.partition_point(|look| look.at.j <= jumps);
        let phase = if phase.is_empty() { looks } else { &looks[phase] };
        let after = phase.partition_point(|look| look.at.t <= t);
        let (from, to) = (phase[after.saturating_sub(1)], phase[after.min(phase.len() - 1)]);
        let t = t.clamp(phase[0].at.t, phase[phase.len() - 1].at.t);
        let flow = Flow { start: from.margin, end: to.margin, origin: None };
        let margin = flow.at((from.at.t, to.at.t), t).margin;
        (HybridTime { t, j: from.at.j }, margin)
    }

    /// The value `margin` at all times.
    pub(super) fn constant(&self, margin: f64) -> Signal {
        let mut signal = Signal::new();
        let value = Value::given(margin);
        let flow = Some(Flow::constant(value));
        signal.push(Knot { t: self.first.t, value, flow });
        signal
    }

    /// The predicate at place `literal` over time.
    pub(super) fn signal(&self, literal: usize, reading: Reading, side: Side) -> Signal {
        let looks = &self.literals[literal].account.looks;
        let mut signal = Signal::new();
        for (position, look) in looks.iter().enumerate() {
            let origin = |time| Some(Origin { literal, jumps: look.at.j, time });
            let margin = match reading {
                Reading::Margin => look.margin,
                Reading::Truth => truth(look.truth, side),
            };
            let t = look.at.t;
            let value = Value { margin, origin: origin(Time::Fixed(t)) };
            let Some(next) = looks.get(position + 1) else {
                let flow = Some(Flow::constant(Value::given(side.beyond())));
                signal.push(Knot { t, value, flow });
                break;
            };
            let Some(passage) = &look.then else {
                signal.push(Knot { t, value, flow: None });
                continue;
            };
            let origin = origin(Time::Moving(0.0));
            match reading {
                Reading::Margin => {
                    let margins = [look.margin, next.margin];
                    let bound = bound(passage, (t, next.at.t), margins, side);
                    let mut value = Some(value);
                    for (t, [start, end]) in bound {
                        let flow = Flow { start, end, origin };
                        let value = value.take().unwrap_or_else(|| flow.first(t));
                        signal.push(Knot { t, value, flow: Some(flow) });
                    }
                }
                Reading::Truth => {
                    let truth = truth(passage.truth, side);
                    let flow = Some(Flow { start: truth, end: truth, origin });
                    signal.push(Knot { t, value, flow });
                }
            }
        }
        signal
    }
}

fn truth(truth: Truth, side: Side) -> f64 {
    match (truth, side) {
        (Truth::Always, _) | (Truth::Undecided, Side::Best) => 1.0,
        (Truth::Never, _) | (Truth::Undecided, Side::Worst) => -1.0,
    }
}

/// The highest or lowest lines below or above a margin, of which values at the ends of a span, a range
/// and a range of its rate are known: in order, when each begins and its values at its ends.
fn bound(passage: &Passage, span: Span, margins: [f64; 2], side: Side) -> Vec<(f64, [f64; 2])> {
    match side {
        Side::Worst => lower_bound(passage.range.lower(), passage.rate, span, margins),
        Side::Best => {
            let margins = margins.map(|margin| -margin);
            let mut lines = lower_bound(-passage.range.upper(), -passage.rate, span, margins);
            lines.iter_mut().for_each(|(_, ends)| *ends = ends.map(|end| -end));
            lines
        }
    }
}

fn lower_bound(least: f64, rate: Interval, span: Span, margins: [f64; 2]) -> Vec<(f64, [f64; 2])> {
    let [first, last] = margins;
    let (fall, rise, width) = (rate.lower(), rate.upper(), span.1 - span.0);
    if first == last && least >= first || fall == rise {
        return vec![(span.0, margins)];
    }
    if ![first, last, fall, rise].iter().all(|number| number.is_finite()) {
        return vec![(span.0, [least; 2])];
    }
    // Down from the first margin as fast as can be, and up to the last.
    let turn = (first - last + rise * width) / (rise - fall);
    let bottom = first + fall * turn;
    let turns = if bottom >= least {
        vec![(turn, bottom.min(first.max(last)))]
    } else {
        vec![((least - first) / fall, least), (width - (last - least) / rise, least)]
    };
    if turns.iter().any(|(after, _)| after.is_nan()) {
        return vec![(span.0, [least; 2])];
    }
    // A turn so soon after the beginning, or before the end, that rounding puts it there is the limit there.
    let (mut points, mut end) = (vec![(span.0, first)], last);
    for (after, value) in turns {
        let t = span.0 + after;
        match points.last_mut() {
            Some((before, lowest)) if t <= *before => *lowest = value.min(*lowest),
            _ if t >= span.1 => end = value.min(end),
            _ => points.push((t, value)),
        }
    }
    let ends = points.iter().skip(1).map(|(_, value)| *value).chain([end]);
    points.iter().zip(ends).map(|((t, start), end)| (*t, [*start, end])).collect()
}

/// The account of a predicate whose margin is linear between samples.
fn linear_account(
    predicate: &Predicate,
    samples: &(impl Samples + ?Sized),
) -> Result<Account, TemporalError> {
    let on_the_boundary =
        if holds_on_the_boundary(predicate) { Truth::Always } else { Truth::Never };
    let mut looks: Vec<Look> = Vec::new();
    let mut clock = Clock::default();
    let mut outcome = Ok(());
    let mut record = |t: f64, state: &dyn Valuation| {
        let at = clock.tick(t)?;
        let verdict = predicate
            .evaluate(state)
            .map_err(|error| TemporalError::Evaluation { time: t, error })?;
        let look = Look { at, margin: verdict.margin, truth: known(verdict.holds), then: None };
        if let Some(from) = looks.last().copied().filter(|last| last.at.t < t) {
            let unbounded = from.margin.is_infinite() || look.margin.is_infinite();
            if unbounded && from.margin != look.margin {
                let predicate = predicate.clone();
                return Err(TemporalError::UnboundedFlow { predicate, from: from.at.t, to: t });
            }
            let flow = Flow { start: from.margin, end: look.margin, origin: None };
            let course = |sum: f64| if sum == 0.0 { on_the_boundary } else { known(sum > 0.0) };
            let change = if unbounded { 0.0 } else { look.margin - from.margin };
            let passage = |sum: f64| Passage {
                truth: course(sum),
                range: Interval::point(from.margin).hull(Interval::point(look.margin)),
                rate: Interval::point(change / (t - from.at.t)),
            };
            let zero = Flow::constant(Value::given(0.0));
            let then = match crossing((from.at.t, t), &flow, &zero) {
                None => passage(flow.start + flow.end),
                Some(zero) => {
                    let then = Some(passage(flow.end));
                    let at = HybridTime { t: zero, ..from.at };
                    looks.push(Look { at, margin: 0.0, truth: on_the_boundary, then });
                    passage(flow.start)
                }
            };
            let place = looks.iter().rposition(|one| one.at == from.at);
            if let Some(place) = place {
                looks[place].then = Some(then);
            }
        }
        looks.push(look);
        Ok(())
    };
    samples.for_each(&mut |t, state| {
        if outcome.is_ok() {
            outcome = record(t, state);
        }
    });
    outcome?;
    if looks.is_empty() {
        Err(TemporalError::NoSamples)
    } else {
        Ok(Account { looks, gaps: vec![] })
    }
}

/// The first instant and the last of a trajectory.
fn ends_of(samples: &(impl Samples + ?Sized)) -> Result<[HybridTime; 2], TemporalError> {
    let (mut clock, mut first, mut outcome) = (Clock::default(), None, Ok(()));
    samples.for_each(&mut |t, _| {
        if outcome.is_ok() {
            outcome = clock.tick(t).map(|at| {
                first.get_or_insert(at);
            });
        }
    });
    outcome?;
    first.zip(clock.last).map(|(first, last)| [first, last]).ok_or(TemporalError::NoSamples)
}

/// Gives samples their hybrid times.
#[derive(Default)]
struct Clock {
    last: Option<HybridTime>,
    count: usize,
}

impl Clock {
    fn tick(&mut self, t: f64) -> Result<HybridTime, TemporalError> {
        let at = match self.last {
            _ if !t.is_finite() => None,
            None => Some(HybridTime { t, j: 0 }),
            Some(last) if t > last.t => Some(HybridTime { t, j: last.j }),
            Some(last) if t == last.t => Some(last.after_jump()),
            Some(_) => None,
        };
        let at = at.ok_or(TemporalError::TimeOutOfOrder { sample: self.count, time: t })?;
        (self.last, self.count) = (Some(at), self.count + 1);
        Ok(at)
    }
}

fn known(holds: bool) -> Truth {
    if holds { Truth::Always } else { Truth::Never }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A margin that rises by 2 in no time may do so right before the end, or right after the beginning.
    #[test]
    fn turns_that_round_to_the_ends_bound_the_margin() {
        let interval = |lower, upper| Interval::new(lower, upper).expect("it is not empty");
        let passage = Passage {
            truth: Truth::Undecided,
            range: interval(-1.0, 1.0),
            rate: interval(0.0, 1e18),
        };
        let lines = |side| bound(&passage, (0.25, 0.5), [-1.0, 1.0], side);
        assert_eq!(lines(Side::Worst), [(0.25, [-1.0, -1.0])]);
        assert_eq!(lines(Side::Best), [(0.25, [1.0, 1.0])]);
    }
}
