//! Isolating the first instant at which something begins to hold on a piece of a curve.
//!
//! A span of time is enclosed; what the enclosure says of the condition decides what becomes of it:
//!
//! | the condition in the span | then |
//! | --- | --- |
//! | holds nowhere | the span is done |
//! | changes at most once | the verdicts at its ends tell whether it begins to hold, and narrowing where |
//! | may change several times | the span is halved, and its earlier half comes first |
//! | cannot be told, for rounding | the margin is climbed; if it does not reach zero, the span is in [`Doubt`] |
//!
//! So no span is passed over without a proof or a doubt on record. A margin that passes zero does so
//! with a rate other than zero at nearly every level; there the spans that matter soon become
//! monotone. Halving ends only where a margin touches zero to within its rounding error.

use pleach_guards::{Course, Enclosure, Verdict};
use thiserror::Error;

use super::Curve;
use super::bend::Bend;
use super::event::{EventSearch, Onset, first_instant};
use super::piece::Piece;
use super::root::{Sample, narrow};

/// A condition on states that can be followed over time.
pub trait Watch {
    /// Why it can have no verdict in a state.
    type Error;

    /// The verdict in a state.
    ///
    /// # Errors
    ///
    /// Whatever keeps it from having one.
    fn verdict(&mut self, state: &[f64]) -> Result<Verdict, Self::Error>;

    /// What is known of it during a span of twice `half_width` seconds, with every component of
    /// the state enclosed.
    fn course(&mut self, states: &[Enclosure], half_width: f64) -> Course;

    /// The same with the piece at hand on which the span goes from one time to another: what can be
    /// known of it where the enclosures of the components alone leave it open.
    fn course_on(
        &mut self,
        _piece: &Piece,
        _span: [f64; 2],
        states: &[Enclosure],
        half_width: f64,
    ) -> Course {
        self.course(states, half_width)
    }
}

/// What was found on a piece.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Finding<E> {
    /// Where the condition begins to hold, or why the search ended without an answer.
    pub onset: Result<Option<Onset>, Lost<E>>,
    /// Spans up to there in which it may hold for all that is known, in order.
    pub doubts: Vec<Doubt>,
}

/// A span of time in which nothing was found and nothing is proven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doubt {
    /// Where it begins, in seconds since the start of the flow.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Why.
    pub why: Uncertainty,
}

/// Why a span of time is in doubt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Uncertainty {
    /// The margin comes as close to zero as rounding, or the error of the solution, lets one see.
    Touch,
    /// A named function decides, which was looked at only here and there.
    Function,
}

/// Why a search ended without an answer.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum Lost<E> {
    /// The condition has no verdict.
    #[error("{error}")]
    Undefined {
        /// An instant at which it has one, in seconds since the start of the flow.
        after: f64,
        /// A later one at which it has none.
        at: f64,
        /// Why.
        error: E,
    },
    /// More spans than allowed had to be looked at.
    #[error("more spans of time had to be examined than allowed, up to {at} s")]
    Endless {
        /// How far the search came, in seconds since the start of the flow.
        at: f64,
    },
}

/// The first instant of `piece` in [`from`, `to`] at which the condition holds.
///
/// If it holds at `from`, that is the answer. What is found holds at `time` and does not hold at
/// `before`, which is earlier by no more than the resolution. `budget` is the number of spans that
/// may be looked at; it is used up.
pub fn isolate<W: Watch + ?Sized>(
    piece: &Piece,
    from: f64,
    to: f64,
    search: &EventSearch,
    watch: &mut W,
    budget: &mut u64,
) -> Finding<W::Error> {
    let mut isolation = Isolation {
        piece,
        search,
        watch,
        state: vec![0.0; piece.dimension()],
        last: None,
        doubts: Vec::new(),
    };
    let onset = isolation.run(from, to, budget);
    if let Ok(Some(Onset { time, .. })) = onset
        && time > from
        && !isolation.is_passed(time)
    {
        let from = isolation.doubts.last().map_or(from, |last| last.to.max(from)).min(time);
        isolation.doubts.push(Doubt { from, to: time, why: Uncertainty::Touch });
    }
    Finding { onset, doubts: isolation.doubts }
}

/// Spans of this part of what is searched that are still open are looked at more closely.
const NARROW: f64 = 0.1;
/// How often to halve the surroundings of a peak.
const HALVINGS: u32 = 26;

struct Isolation<'a, W: ?Sized> {
    piece: &'a Piece,
    search: &'a EventSearch,
    watch: &'a mut W,
    state: Vec<f64>,
    /// The latest look, at which the condition did not hold.
    last: Option<Sample>,
    doubts: Vec<Doubt>,
}

impl<W: Watch + ?Sized> Isolation<'_, W> {
    fn run(
        &mut self,
        from: f64,
        to: f64,
        budget: &mut u64,
    ) -> Result<Option<Onset>, Lost<W::Error>> {
        if self.look(from)?.verdict.holds {
            return Ok(Some(Onset { before: from, time: from }));
        }
        let mut enclosures = Vec::with_capacity(self.state.len());
        let mut spans = vec![(from, to)];
        let narrow = NARROW * (to - from);
        while let Some((from, to)) = spans.pop() {
            *budget = budget.checked_sub(1).ok_or(Lost::Endless { at: from })?;
            self.piece.enclose(from, to, &mut enclosures);
            let half = 0.5 * (to - from) * (1.0 + 4.0 * f64::EPSILON);
            let course = match self.watch.course(&enclosures, half) {
                Course::Open if to - from <= narrow => {
                    self.watch.course_on(self.piece, [from, to], &enclosures, half)
                }
                course => course,
            };
            let found = match course {
                Course::Never => None,
                Course::Falling | Course::FaintlyFalling => self.first_of(&[from])?,
                Course::Rising | Course::FaintlyRising | Course::Always => {
                    self.first_of(&[from, to])?
                }
                Course::Opaque => self.look_around(from, to)?,
                course @ (Course::Open | Course::Blurred) => {
                    let middle = from + 0.5 * (to - from);
                    let is_wide = to - from > self.search.tolerance(from, to);
                    if course == Course::Open && is_wide && from < middle && middle < to {
                        spans.extend([(middle, to), (from, middle)]);
                        None
                    } else {
                        self.settle(from, to)?
                    }
                }
            };
            if found.is_some() {
                return Ok(found);
            }
        }
        Ok(None)
    }

    /// Whether, whatever the error of the curve, the condition surely does not hold at an instant of the
    /// piece before `time`, or surely holds at one after it. Otherwise it may have come to hold at any time,
    /// or never.
    fn is_passed(&mut self, time: f64) -> bool {
        let (first, last) = (self.piece.start(), self.piece.end());
        // Nearer and nearer to where it comes to hold.
        let toward = |end: f64| {
            let away = std::iter::successors(Some(end - time), |away| Some(0.5 * away));
            away.map(move |away| time + away).take_while(move |&at| at != time)
        };
        toward(first).any(|at| matches!(self.course_at(at), Course::Never | Course::Opaque))
            || toward(last).any(|at| self.course_at(at) == Course::Always)
    }

    fn course_at(&mut self, time: f64) -> Course {
        let mut enclosures = Vec::with_capacity(self.state.len());
        self.piece.enclose(time, time, &mut enclosures);
        self.watch.course(&enclosures, 0.0)
    }

    fn look(&mut self, time: f64) -> Result<Sample, Lost<W::Error>> {
        self.piece.state_at(time, &mut self.state);
        let after = self.last.map_or(time, |last| last.time);
        let undefined = |error| Lost::Undefined { after, at: time, error };
        let verdict = self.watch.verdict(&self.state).map_err(undefined)?;
        let sample = Sample { time, verdict };
        if !verdict.holds {
            self.last = Some(sample);
        }
        Ok(sample)
    }

    /// Looks at successive instants until one is found at which the condition holds.
    fn first_of(&mut self, times: &[f64]) -> Result<Option<Onset>, Lost<W::Error>> {
        for &time in times {
            let before = self.last.filter(|last| last.time < time);
            let Some(before) = before else { continue };
            let after = self.look(time)?;
            if after.verdict.holds {
                return self.narrowed(before, after).map(Some);
            }
        }
        Ok(None)
    }

    /// The closer the bracket is to time 0, the closer are the numbers in it.
    fn narrowed(&mut self, before: Sample, after: Sample) -> Result<Onset, Lost<W::Error>> {
        let (mut before, mut after) = (before, after);
        loop {
            let tolerance = self.search.tolerance(before.time, after.time);
            if after.time - before.time <= tolerance {
                return Ok(Onset { before: before.time, time: after.time });
            }
            (before, after) = narrow(before, after, tolerance, |time| self.look(time))?;
        }
    }

    /// What halving cannot settle: the margin is climbed, and if it does not get there, that is
    /// said.
    fn settle(&mut self, from: f64, to: f64) -> Result<Option<Onset>, Lost<W::Error>> {
        let middle = from + 0.5 * (to - from);
        let found = self.first_of(&[from, middle, to])?;
        if found.is_some() {
            return Ok(found);
        }
        let found = self.climb(from, middle, to)?;
        if found.is_none() {
            self.doubt(Doubt { from, to, why: Uncertainty::Touch });
        }
        Ok(found)
    }

    fn climb(&mut self, from: f64, middle: f64, to: f64) -> Result<Option<Onset>, Lost<W::Error>> {
        let mut path = Vec::with_capacity(6);
        for time in [from, middle, to] {
            path.push(self.look(time)?);
        }
        for _ in 0..HALVINGS {
            let bend = Bend::around_highest(&path);
            if !bend.may_reach_zero() {
                break;
            }
            path = Vec::from(bend.samples);
            for time in bend.next_looks() {
                let place = path.partition_point(|known| known.time < time);
                if path.get(place).is_none_or(|known| known.time == time) {
                    continue;
                }
                let sample = self.look(time)?;
                if sample.verdict.holds {
                    let before = path[place.saturating_sub(1)];
                    return self.narrowed(before, sample).map(Some);
                }
                path.insert(place, sample);
            }
        }
        self.look(to)?;
        Ok(None)
    }

    /// A condition of which nothing is known is looked at several times.
    fn look_around(&mut self, from: f64, to: f64) -> Result<Option<Onset>, Lost<W::Error>> {
        let span = self.piece.clone().within(from, to);
        let watch = &mut *self.watch;
        let mut verdict = |state: &[f64]| watch.verdict(state);
        let found = first_instant(&span, from, to, self.search, &mut verdict);
        let onset = found.map_err(|error| Lost::Undefined { after: from, at: to, error })?;
        self.doubt(Doubt {
            from,
            to: onset.map_or(to, |onset| onset.time),
            why: Uncertainty::Function,
        });
        if onset.is_none() {
            self.look(to)?;
        }
        Ok(onset)
    }

    /// Takes note of a doubt, together with one of the same kind just before it.
    fn doubt(&mut self, doubt: Doubt) {
        match self.doubts.last_mut() {
            Some(last) if last.to == doubt.from && last.why == doubt.why => last.to = doubt.to,
            _ => self.doubts.push(doubt),
        }
    }
}
