//! Events: the first instant at which a predicate holds.

use pleach_guards::Verdict;
use thiserror::Error;

use super::Curve;
use super::bend::Bend;
use super::root::{Sample, narrow};

/// How closely to look for an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventSearch {
    resolution: f64,
    looks: u32,
}

/// Looks per time scale. A step of an [`Integrator`](super::Integrator) at ordinary tolerances is
/// a fraction of a radian of the flow's fastest motion, and half a turn of a linear flow has one
/// peak: eight looks show both well, also through guards that are products or powers of the state.
/// Each costs an evaluation of the curve, less than one stage of a step, and one of the guard.
const LOOKS: u32 = 8;

impl Default for EventSearch {
    /// As fine as floating-point numbers allow, with 8 looks per time scale of the curve.
    ///
    /// The last digits cost little: where the margin is smooth, two or three evaluations more.
    fn default() -> Self {
        EventSearch { resolution: 0.0, looks: LOOKS }
    }
}

impl EventSearch {
    /// A search that locates events to `resolution` seconds and looks at the curve `looks` times
    /// per [time scale](Curve::time_scale).
    ///
    /// A resolution below the spacing of the floating-point numbers means that spacing.
    ///
    /// # Errors
    ///
    /// [`InvalidSearch`] unless 0 ≤ `resolution` < ∞ and `looks` ≥ 2: a peak shows only between
    /// two neighbours.
    pub fn new(resolution: f64, looks: u32) -> Result<Self, InvalidSearch> {
        if !(resolution >= 0.0 && resolution.is_finite()) {
            return Err(InvalidSearch::Resolution { resolution });
        }
        if looks < 2 {
            return Err(InvalidSearch::Looks { looks });
        }
        Ok(EventSearch { resolution, looks })
    }

    /// How often a curve is looked at per [time scale](Curve::time_scale).
    pub fn looks(&self) -> u32 {
        self.looks
    }

    /// The width, in seconds, at which a bracket between these instants is narrow enough. It is
    /// positive, also at time 0.
    pub fn tolerance(&self, from: f64, to: f64) -> f64 {
        let spacings = SPACINGS * f64::EPSILON * from.abs().max(to.abs());
        self.resolution.max(spacings).max(f64::MIN_POSITIVE)
    }
}

/// The narrowest bracket, in spacings of the floating-point numbers at the look that ended it: two,
/// so that there is always a number in between to look at.
const SPACINGS: f64 = 2.0;

/// How often to halve the surroundings of a peak: to 10⁻⁸ of the distance of two looks, where a
/// parabola is flat within rounding.
const HALVINGS: u32 = 26;

/// Why a search cannot be made.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InvalidSearch {
    /// The resolution is negative, infinite or NaN.
    #[error("the resolution of an event search, {resolution} s, is not a finite number ≥ 0")]
    Resolution {
        /// What was given, in seconds.
        resolution: f64,
    },
    /// There are too few looks to see a peak.
    #[error("an event search looks at a curve at least twice per time scale, not {looks} times")]
    Looks {
        /// What was given.
        looks: u32,
    },
}

/// Where a predicate begins to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onset {
    /// An instant at which it does not hold yet, less than the resolution before.
    pub before: f64,
    /// The instant, in seconds since the start of the flow: it holds in the curve's state there.
    pub time: f64,
}

/// The first instant of `curve` in [`from`, `to`] at which the predicate holds, if there is one.
///
/// `verdict` judges states of the curve. Its `holds` decides; its margin guides the search, and
/// only makes it fast. If the predicate holds at `from`, the answer is `from`.
///
/// # What is guaranteed
///
/// - The answer is on the side on which the predicate holds: it holds in `state_at(time)`, and does
///   not at `before`, which is earlier by no more than the resolution.
/// - An event is found if the predicate holds at `to`, or at one of the looks, of which there are
///   several per [time scale](Curve::time_scale) of the curve.
/// - Between looks the search climbs every peak of the margin that may reach zero, judged by how
///   much the margin bends there. So a visit between two looks is found if the margin is about
///   parabolic over a few looks, or rises to the peak and falls from it at a steady rate.
///
/// # What is not
///
/// - Visits that are much shorter than the distance of two looks and that the margin beside does
///   not announce, such as those of a predicate whose margin is only a sign.
/// - A peak that touches zero without passing it. Whether it does is decided by rounding.
/// - Two visits between the same looks, of which the later may be found first.
///
/// # Errors
///
/// Those of `verdict`, at once.
pub fn first_instant<C: Curve + ?Sized, E>(
    curve: &C,
    from: f64,
    to: f64,
    search: &EventSearch,
    verdict: &mut dyn FnMut(&[f64]) -> Result<Verdict, E>,
) -> Result<Option<Onset>, E> {
    let mut probe = Probe { curve, verdict, state: vec![0.0; curve.dimension()] };
    let mut last = probe.look(from)?;
    if last.verdict.holds {
        return Ok(Some(Onset { before: from, time: from }));
    }
    let mut earlier = None;
    while last.time < to {
        let next = probe.look(next_look(curve, search, from, to, last.time))?;
        let bracket = if next.verdict.holds {
            Some((last, next))
        } else if let Some(earlier) = earlier {
            probe.climb_peak(Bend { samples: [earlier, last, next] }, from, to)?
        } else {
            None
        };
        if let Some((before, after)) = bracket {
            let tolerance = search.tolerance(last.time, next.time);
            let (before, after) = narrow(before, after, tolerance, |time| probe.look(time))?;
            return Ok(Some(Onset { before: before.time, time: after.time }));
        }
        earlier = Some(last);
        last = next;
    }
    Ok(None)
}

/// When to look next: what remains is divided evenly, so that no look is much nearer than another.
fn next_look(
    curve: &(impl Curve + ?Sized),
    search: &EventSearch,
    from: f64,
    to: f64,
    last: f64,
) -> f64 {
    let spacing = curve.time_scale(last).min(to - from) / f64::from(search.looks);
    let remaining = to - last;
    let looks = (remaining / spacing).round();
    let next = last + remaining / looks;
    if looks > 1.0 && next > last { next } else { to }
}

/// A curve under observation.
struct Probe<'a, C: ?Sized, E> {
    curve: &'a C,
    verdict: &'a mut dyn FnMut(&[f64]) -> Result<Verdict, E>,
    state: Vec<f64>,
}

impl<C: Curve + ?Sized, E> Probe<'_, C, E> {
    fn look(&mut self, time: f64) -> Result<Sample, E> {
        self.curve.state_at(time, &mut self.state);
        Ok(Sample { time, verdict: (self.verdict)(&self.state)? })
    }

    /// Climbs the peak that three successive looks suggest, as long as the margin may reach zero:
    /// an instant at which the predicate holds, and one before it at which it does not.
    ///
    /// The peak is about the middle look, or else at an end of the search; about any other look it
    /// is the peak of other three.
    fn climb_peak(
        &mut self,
        mut bend: Bend,
        from: f64,
        to: f64,
    ) -> Result<Option<(Sample, Sample)>, E> {
        let [first, _, last] = bend.samples;
        if bend.highest() == 0 && first.time > from || bend.highest() == 2 && last.time < to {
            return Ok(None);
        }
        for _ in 0..HALVINGS {
            if !bend.may_reach_zero() {
                break;
            }
            let mut path = Vec::from(bend.samples);
            for time in bend.next_looks() {
                let place = path.partition_point(|known| known.time < time);
                if path[place].time == time {
                    continue;
                }
                let sample = self.look(time)?;
                if sample.verdict.holds {
                    return Ok(Some((path[place - 1], sample)));
                }
                path.insert(place, sample);
            }
            bend = Bend::around_highest(&path);
        }
        Ok(None)
    }
}
