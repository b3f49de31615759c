//! What a predicate does along a trajectory: at successive instants its verdict, and between any two
//! of them bounds on its margin and whether it holds.
//!
//! The margin is enclosed over spans of the flow, as the margins of guards are. A span is told where the
//! margin rises or falls throughout it, where it stays apart from zero and is known as exactly as
//! rounding allows, or where halving the span would not tell more; elsewhere it is halved.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use pleach_continuous::flow::{Curve, Piece};
use pleach_guards::{
    CompiledPredicate, Course, Enclosure, EvaluationError, Interval, Predicate, Substitution,
    Tracker, Truth, Verdict,
};
use thiserror::Error;

use super::{HybridTime, Strand, Stretch, Trajectory};

/// What a predicate does along a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct Account {
    /// In the order of hybrid time, from the start of the run to its end; of every phase at least its
    /// first instant and its last.
    pub looks: Vec<Look>,
    /// Spans of time in which it is not known whether the predicate holds, or in which it was looked at
    /// here and there only.
    pub gaps: Vec<Gap>,
}

/// What a predicate says at an instant, and after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// When.
    pub at: HybridTime,
    /// The margin.
    pub margin: f64,
    /// Whether the predicate holds; undecided where rounding hides it.
    pub truth: Truth,
    /// What it does until the next look; nothing before a jump and at the end.
    pub then: Option<Passage>,
}

/// What a predicate does between two instants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Whether it holds.
    pub truth: Truth,
    /// Bounds on the margin.
    pub range: Interval,
    /// Bounds on its rate, per second; the whole line where it may jump.
    pub rate: Interval,
}

/// A span of time in which something is not known of a predicate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Where it begins, in seconds.
    pub from: f64,
    /// Where it ends, in seconds.
    pub to: f64,
    /// Whether the predicate is a function, which was looked at here and there; otherwise its margin
    /// is zero within rounding or the error of the solution, or too many spans would have to be
    /// examined.
    pub is_function: bool,
}

/// A predicate has no verdict.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("at {t} s: {error}")]
pub struct Unevaluated {
    /// When, in seconds.
    pub t: f64,
    /// Why.
    pub error: EvaluationError,
}

/// Into how many parts a span between two samples is divided.
const PARTS: u32 = 4;
/// How often spans may be halved in all to see where the predicate holds, beside what each part may.
const DECIDING: u64 = 1 << 18;
/// How often in all to bound the margin as exactly as rounding allows, beside what each part may.
const SHARPENING: u64 = 1 << 18;
/// How often spans of each part may be halved, for either purpose.
const AT_LEAST: u64 = 32;
/// How often spans of one part may be halved to bound the margin.
const AT_MOST: u64 = 256;
/// By what part of its magnitude a margin may differ from what is told of it.
const NEGLIGIBLE: f64 = 8.0 * f64::EPSILON;

impl Trajectory {
    /// What a predicate does along the trajectory, with a look also at `instants`.
    ///
    /// Its margin is followed through the whole of every piece of the flow by enclosures; none is
    /// skipped. What cannot be decided is told as a [`Gap`].
    ///
    /// ```
    /// # use pleach_automaton::{coordinates, Automaton};
    /// # use pleach_discrete::vocabulary;
    /// # vocabulary! {
    /// #     enum Lamp: Location { Lit = "lit" }
    /// #     enum Timer: Event { Elapsed = "elapsed" }
    /// # }
    /// # coordinates! { struct Clock { clock } }
    /// # let Clock { clock } = Clock::coordinates();
    /// # let lamp = Automaton::<Lamp, Timer, Clock>::starting_in(Lamp::Lit)
    /// #     .initially(Clock { clock: 0.0 })
    /// #     .flow(Lamp::Lit, clock.rate(1.0))
    /// #     .build()?;
    /// use pleach_guards::Truth;
    ///
    /// let trajectory = lamp.run(2.0)?;
    /// let instant = (&clock - 0.7).abs().at_most(1e-9);
    /// let account = trajectory.account(&instant, &[])?;
    /// let held = account.looks.iter().filter(|look| look.truth == Truth::Always);
    /// let held: Vec<f64> = held.map(|look| look.at.t).collect();
    /// assert!(!held.is_empty() && held.iter().all(|t| (t - 0.7).abs() < 1.1e-9));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Unevaluated`] where the predicate has no verdict.
    pub fn account(&self, predicate: &Predicate, instants: &[f64]) -> Result<Account, Unevaluated> {
        let unknown = |error| Unevaluated { t: 0.0, error };
        let mut follower = match self.signals.is_empty() {
            true => Follower::new(self, predicate),
            false => {
                let formulas = Substitution::new(self.signals.iter().cloned());
                Follower::new(self, &predicate.substitute(&formulas))
            }
        }
        .map_err(unknown)?;
        for phase in 0..=self.jumps.len() {
            follower.follow(phase, instants)?;
        }
        Ok(follower.account)
    }
}

/// A predicate that is followed along a trajectory.
struct Follower<'a> {
    trajectory: &'a Trajectory,
    /// Those that the predicate reads.
    strands: Vec<&'a Strand>,
    predicate: CompiledPredicate,
    tracker: Tracker,
    /// The places of the variables among those of the strands: 0, 1, 2, …
    slots: Vec<usize>,
    /// How often spans may still be halved.
    deciding: u64,
    sharpening: u64,
    account: Account,
}

/// A span of time of a phase in which no piece of the flow ends.
struct Part<'a> {
    phase: [HybridTime; 2],
    /// By strand.
    courses: Vec<(&'a Stretch, Option<&'a Piece>)>,
    /// The margin, if it is a polynomial of variables of one strand.
    margin: Option<Piece>,
}

/// A span of time, and what is known of the margin in it.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    from: f64,
    to: f64,
    course: Course,
    margin: Enclosure,
}

impl<'a> Follower<'a> {
    fn new(trajectory: &'a Trajectory, predicate: &Predicate) -> Result<Self, EvaluationError> {
        let read = predicate.variables();
        let is_read = |slot: &usize| read.contains(&*trajectory.variables[*slot]);
        let strands: Vec<&Strand> =
            trajectory.strands.iter().filter(|strand| strand.slots.iter().any(is_read)).collect();
        let slots = strands.iter().flat_map(|strand| &strand.slots);
        let names: Vec<&str> = slots.map(|&slot| &*trajectory.variables[slot]).collect();
        Ok(Follower {
            trajectory,
            predicate: predicate.compile(&names)?,
            tracker: predicate.track(&names)?,
            slots: (0..names.len()).collect(),
            strands,
            deciding: DECIDING,
            sharpening: SHARPENING,
            account: Account { looks: Vec::new(), gaps: Vec::new() },
        })
    }

    /// Follows the predicate from a jump to the next.
    fn follow(&mut self, phase: usize, instants: &[f64]) -> Result<(), Unevaluated> {
        let phase = self.trajectory.ends_of(phase);
        let [from, to] = phase;
        let first = self.verdict(from)?;
        self.account.looks.push(Look {
            at: from,
            margin: first.margin,
            truth: truth(first.holds),
            then: None,
        });
        if to.t <= from.t {
            return Ok(());
        }
        let mut breaks = vec![from.t, to.t];
        for stretch in self.strands.iter().flat_map(|strand| strand.during(from, to)) {
            stretch.instants(from.t, to.t, &mut breaks);
        }
        breaks.extend(instants.iter().filter(|t| from.t < **t && **t < to.t));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        for pair in breaks.windows(2) {
            let part = self.part(phase, pair[0] + 0.5 * (pair[1] - pair[0]));
            let width = (pair[1] - pair[0]) / f64::from(PARTS);
            let inner = (1..PARTS).map(|number| pair[0] + width * f64::from(number));
            for end in inner.chain([pair[1]]) {
                self.follow_part(&part, end)?;
            }
        }
        Ok(())
    }

    fn part(&self, phase: [HybridTime; 2], t: f64) -> Part<'a> {
        let at = HybridTime { t, ..phase[0] }.min(phase[1]);
        let stretches = self.strands.iter().map(|strand| strand.stretch(at));
        let courses: Vec<(&Stretch, Option<&Piece>)> =
            stretches.map(|stretch| (stretch, stretch.piece(t))).collect();
        let margin = match (&courses[..], self.tracker.comparisons()) {
            ([(_, Some(piece))], [comparison]) => comparison
                .in_ring(&mut |place| Some(piece.polynomial(place)))
                .map(|margin| piece.composed(&margin)),
            _ => None,
        };
        Part { phase, courses, margin }
    }

    /// Follows the predicate from the last look to the end of a part.
    fn follow_part(&mut self, part: &Part<'_>, end: f64) -> Result<(), Unevaluated> {
        let Some(from) = self.account.looks.last().map(|look| look.at.t) else { return Ok(()) };
        if end <= from {
            return Ok(());
        }
        if self.tracker.is_opaque() {
            return self.tell_function(part, end);
        }
        let (mut open, mut told) = (BinaryHeap::new(), Vec::new());
        let mut examined = vec![self.enclose(part, from, end)];
        let (mut decided, mut sharpened) = (0, 0);
        loop {
            for leaf in examined.drain(..) {
                match Open::of(leaf) {
                    Some(one) => open.push(one),
                    None => told.push(leaf),
                }
            }
            let Some(Open { leaf, middle, is_undecided, .. }) = open.pop() else { break };
            let (count, rest, most) = if is_undecided {
                (&mut decided, &mut self.deciding, u64::MAX)
            } else {
                (&mut sharpened, &mut self.sharpening, AT_MOST)
            };
            if *count >= most || *count >= AT_LEAST && *rest == 0 {
                told.extend(std::iter::once(leaf).chain(open.drain().map(|open| open.leaf)));
                break;
            }
            if *count >= AT_LEAST {
                *rest -= 1;
            }
            *count += 1;
            examined.push(self.enclose(part, leaf.from, middle));
            examined.push(self.enclose(part, middle, leaf.to));
        }
        told.sort_by(|one, other| one.from.total_cmp(&other.from));
        told.dedup_by(|next, one| one.takes_in(next));
        told.iter().try_for_each(|leaf| self.tell(part, leaf))
    }

    /// What is known of the margin from one instant to another.
    fn enclose(&self, part: &Part<'_>, from: f64, to: f64) -> Leaf {
        let (mut states, mut own) = (Vec::with_capacity(self.slots.len()), Vec::new());
        let mut half_width: f64 = 0.5 * (to - from);
        for (stretch, piece) in &part.courses {
            let Some(piece) = piece else {
                states.extend(stretch.last.iter().map(|value| Enclosure::constant(*value)));
                continue;
            };
            let (from, to) = (stretch.local(from), stretch.local(to));
            half_width = half_width.max(0.5 * (to - from));
            piece.enclose(from, to, &mut own);
            states.append(&mut own);
        }
        let half_width = half_width * (1.0 + 4.0 * f64::EPSILON);
        let [comparison] = self.tracker.comparisons() else {
            return Leaf { from, to, course: Course::Opaque, margin: Enclosure::UNKNOWN };
        };
        let (course, margin) = comparison.follow(&states, &self.slots, half_width);
        let leaf = Leaf { from, to, course, margin };
        match (&part.margin, part.courses.first()) {
            (Some(piece), Some((stretch, _))) if Open::of(leaf).is_some() => {
                piece.enclose(stretch.local(from), stretch.local(to), &mut own);
                let margin = own.first().map_or(margin, |as_whole| margin.intersection(as_whole));
                Leaf { course: comparison.course_of(&margin), margin, ..leaf }
            }
            _ => leaf,
        }
    }

    fn verdict(&self, at: HybridTime) -> Result<Verdict, Unevaluated> {
        let (mut values, mut own) = (Vec::with_capacity(self.slots.len()), Vec::new());
        for strand in &self.strands {
            strand.stretch(at).values(at.t, &mut own);
            values.append(&mut own);
        }
        self.predicate.evaluate(&values).map_err(|error| Unevaluated { t: at.t, error })
    }

    /// The look at an instant of a part. A state at a jump is what the run has recorded; of others it
    /// may be undecided, within the error of the solution, whether the predicate holds.
    fn look(&self, part: &Part<'_>, t: f64) -> Result<Look, Unevaluated> {
        let [from, to] = part.phase;
        let at = HybridTime { t, ..from };
        let verdict = self.verdict(at)?;
        let is_recorded = t == from.t || t == to.t && (to.j as usize) < self.trajectory.jumps.len();
        let is_certain = is_recorded || self.is_certain(part, t);
        let truth = if is_certain { truth(verdict.holds) } else { Truth::Undecided };
        Ok(Look { at, margin: verdict.margin, truth, then: None })
    }

    /// Whether the verdict is the same in all states that the error of the solution allows.
    fn is_certain(&self, part: &Part<'_>, t: f64) -> bool {
        let has_error =
            |piece: &Piece| (0..piece.dimension()).any(|component| piece.error(component) > 0.0);
        let has_error = part.courses.iter().filter_map(|(_, piece)| *piece).any(has_error);
        if self.tracker.is_opaque() || !has_error {
            return true;
        }
        let (mut states, mut own) = (Vec::with_capacity(self.slots.len()), Vec::new());
        for (stretch, piece) in &part.courses {
            stretch.values(t, &mut own);
            states.extend(own.iter().enumerate().map(|(component, value)| {
                let error = piece.map_or(0.0, |piece| piece.error(component));
                let range = if error > 0.0 {
                    let ends = [(value - error).next_down(), (value + error).next_up()];
                    Interval::new(ends[0], ends[1]).unwrap_or(Interval::WHOLE)
                } else {
                    Interval::point(*value)
                };
                Enclosure { middle: range, range, rate: Interval::point(0.0) }
            }));
        }
        let course = self.tracker.course(&states, &self.slots, 0.0, 0.0, &|_| None);
        matches!(course, Course::Always | Course::Never)
    }

    /// Tells what is known of a span after the last look.
    fn tell(&mut self, part: &Part<'_>, leaf: &Leaf) -> Result<(), Unevaluated> {
        let end = self.look(part, leaf.to)?;
        let start = self.account.looks.last().map_or(end.truth, |look| look.truth);
        let (before, after) = match leaf.course {
            Course::Always => return self.pass(leaf, Truth::Always, end),
            Course::Never => return self.pass(leaf, Truth::Never, end),
            Course::Rising | Course::FaintlyRising => (Truth::Never, Truth::Always),
            Course::Falling | Course::FaintlyFalling => (Truth::Always, Truth::Never),
            // Between neighbouring numbers nothing is seen.
            Course::Open if leaf.middle().is_none() => return self.pass(leaf, start, end),
            Course::Open | Course::Blurred | Course::Opaque => {
                return self.pass(leaf, Truth::Undecided, end);
            }
        };
        let ends = [leaf.from, leaf.to];
        if end.truth == before {
            self.pass(leaf, before, end)
        } else if start == after {
            self.pass(leaf, after, end)
        } else if start == before && end.truth == after {
            let is_before = |t: f64| Ok(truth(self.verdict_in(part, t)?.holds) == before);
            let [last, first] = change(ends, is_before)?;
            let (last, first) = (self.look(part, last)?, self.look(part, first)?);
            self.pass(leaf, before, Look { truth: before, ..last })?;
            self.pass(leaf, before, Look { truth: after, ..first })?;
            self.pass(leaf, after, end)
        } else if start == before {
            let [last, _] = change(ends, |t| Ok(self.look(part, t)?.truth == before))?;
            let last = self.look(part, last)?;
            self.pass(leaf, before, last)?;
            self.pass(leaf, Truth::Undecided, end)
        } else if end.truth == after {
            let [_, first] = change(ends, |t| Ok(self.look(part, t)?.truth != after))?;
            let first = self.look(part, first)?;
            self.pass(leaf, Truth::Undecided, first)?;
            self.pass(leaf, after, end)
        } else {
            self.pass(leaf, Truth::Undecided, end)
        }
    }

    /// Tells of a function from the last look on: it is taken to change at most once.
    fn tell_function(&mut self, part: &Part<'_>, to: f64) -> Result<(), Unevaluated> {
        let end = self.look(part, to)?;
        let Some(start) = self.account.looks.last().copied() else { return Ok(()) };
        let from = start.at.t;
        let range = Interval::point(start.margin).hull(Interval::point(end.margin));
        let rate = Interval::point((end.margin - start.margin) / (to - from));
        let margin = Enclosure { middle: range, range, rate };
        let leaf = Leaf { from, to, course: Course::Opaque, margin };
        if start.truth != end.truth {
            let is_before = |t: f64| Ok(truth(self.verdict_in(part, t)?.holds) == start.truth);
            let [last, first] = change([from, to], is_before)?;
            let (last, first) = (self.look(part, last)?, self.look(part, first)?);
            self.pass(&leaf, start.truth, last)?;
            self.pass(&leaf, start.truth, first)?;
        }
        self.gap(Gap { from, to, is_function: true });
        self.pass(&leaf, end.truth, end)
    }

    fn verdict_in(&self, part: &Part<'_>, t: f64) -> Result<Verdict, Unevaluated> {
        self.verdict(HybridTime { t, ..part.phase[0] })
    }

    /// Tells what is known from the last look to the next.
    fn pass(&mut self, leaf: &Leaf, truth: Truth, end: Look) -> Result<(), Unevaluated> {
        let Some(last) = self.account.looks.last_mut().filter(|last| last.at.t < end.at.t) else {
            return Ok(());
        };
        let ends = Interval::point(last.margin).hull(Interval::point(end.margin));
        let range = if leaf.is_monotone() { ends } else { leaf.margin.range.hull(ends) };
        last.then = Some(Passage { truth, range, rate: leaf.margin.rate });
        let from = last.at.t;
        self.account.looks.push(end);
        if truth == Truth::Undecided {
            self.gap(Gap { from, to: end.at.t, is_function: false });
        }
        Ok(())
    }

    /// Takes note of a gap, together with one of the same kind just before it.
    fn gap(&mut self, gap: Gap) {
        match self.account.gaps.last_mut() {
            Some(last) if last.to == gap.from && last.is_function == gap.is_function => {
                last.to = gap.to;
            }
            _ => self.account.gaps.push(gap),
        }
    }
}

fn truth(holds: bool) -> Truth {
    if holds { Truth::Always } else { Truth::Never }
}

/// The neighbouring numbers between which something ends that is so at the first of two instants and
/// not at the second.
fn change<E>(
    [mut before, mut after]: [f64; 2],
    mut is_before: impl FnMut(f64) -> Result<bool, E>,
) -> Result<[f64; 2], E> {
    loop {
        let middle = before + 0.5 * (after - before);
        if middle <= before || middle >= after {
            return Ok([before, after]);
        }
        if is_before(middle)? { before = middle } else { after = middle }
    }
}

impl Leaf {
    fn is_monotone(&self) -> bool {
        self.margin.rate.lower() >= 0.0 || self.margin.rate.upper() <= 0.0
    }

    /// Whether the margin at its ends, or as it is told, is all that rounding lets one know.
    fn is_sharp(&self) -> bool {
        let range = self.margin.range;
        let size = range.lower().abs().max(range.upper().abs());
        self.is_monotone() || range.width() <= NEGLIGIBLE * size || self.margin.is_blurred()
    }

    /// The number in the middle, unless the ends are neighbours.
    fn middle(&self) -> Option<f64> {
        let middle = self.from + 0.5 * (self.to - self.from);
        (self.from < middle && middle < self.to).then_some(middle)
    }

    /// Tells of the next as well, if the same is known of it: where halving has told no more.
    fn takes_in(&mut self, next: &Leaf) -> bool {
        let is_same = self.course == next.course && !self.is_monotone() && !next.is_monotone();
        if is_same {
            let Enclosure { range, rate, .. } = next.margin;
            self.to = next.to;
            self.margin.range = self.margin.range.hull(range);
            self.margin.rate = self.margin.rate.hull(rate);
        }
        is_same
    }
}

/// A span of which halving may tell more.
struct Open {
    leaf: Leaf,
    middle: f64,
    is_undecided: bool,
    /// The more of it, the sooner: earlier ones first, or those in which the margin varies more.
    worth: f64,
}

impl Open {
    fn of(leaf: Leaf) -> Option<Open> {
        let middle = leaf.middle()?;
        match leaf.course {
            Course::Open => {
                let worth = -leaf.from;
                Some(Open { leaf, middle, is_undecided: true, worth })
            }
            Course::Blurred | Course::Opaque => None,
            _ if leaf.is_sharp() => None,
            _ => {
                let worth = leaf.margin.range.width();
                Some(Open { leaf, middle, is_undecided: false, worth })
            }
        }
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_worth = self.worth.total_cmp(&other.worth);
        self.is_undecided.cmp(&other.is_undecided).then(by_worth)
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}
