//! Piecewise-linear signals over hybrid time.
//!
//! A signal is a list of *knots* in the order of hybrid time. A knot is an instant with its value;
//! after it comes either a *flow*, linear over the open interval up to the next knot, or, where
//! the next knot has the same time, a jump. The ends of a flow are limits, which need not be the
//! values of the knots beside it: the infimum over a sliding window is discontinuous also where
//! the trajectory does not jump. After the last knot a constant flow goes on for ever.
//!
//! At an instant of the trajectory with m states, a signal has m knots, or one or none that stands
//! for all of them; at all other times it has at most one.

use std::ops::Range;

/// Where a value comes from: the predicate and the instant whose margin it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Origin {
    /// The predicate, by its place in the list of literals of the formula.
    pub literal: usize,
    /// Jumps of the trajectory before that instant.
    pub jumps: u32,
    /// When.
    pub time: Time,
}

/// The time of an origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Time {
    /// At this time, in seconds.
    Fixed(f64),
    /// This many seconds later than the time of the value.
    Moving(f64),
}

/// The value of a signal at an instant, or its limit there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Value {
    pub margin: f64,
    /// `None` for what no state decides, such as what lies beyond the end of the trajectory.
    pub origin: Option<Origin>,
}

/// A linear course over an open interval of time. Its ends are finite or the same infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flow {
    /// The limit at the left end.
    pub start: f64,
    /// The limit at the right end.
    pub end: f64,
    pub origin: Option<Origin>,
}

/// An instant, and what comes after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Knot {
    pub t: f64,
    pub value: Value,
    /// Up to the next knot; `None` where that knot has the same time.
    pub flow: Option<Flow>,
}

/// A piecewise-linear function of hybrid time, from its first knot for ever.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Signal {
    knots: Vec<Knot>,
}

/// An open interval of time, in seconds; its right end may be ∞.
pub(super) type Span = (f64, f64);

impl Value {
    /// A value that no state decides.
    pub(super) fn given(margin: f64) -> Value {
        Value { margin, origin: None }
    }

    /// The smaller value; of equal ones, this one.
    pub(super) fn lower(self, other: Value) -> Value {
        if other.margin < self.margin { other } else { self }
    }

    /// The larger value; of equal ones, this one.
    pub(super) fn higher(self, other: Value) -> Value {
        if other.margin > self.margin { other } else { self }
    }

    fn opposite(self) -> Value {
        Value { margin: -self.margin, ..self }
    }
}

impl Flow {
    pub(super) fn constant(value: Value) -> Flow {
        Flow { start: value.margin, end: value.margin, origin: value.origin }
    }

    fn is_constant(&self) -> bool {
        self.start == self.end
    }

    /// Whether the origin is the same at all times.
    fn stays(&self) -> bool {
        !self.origin.is_some_and(|origin| matches!(origin.time, Time::Moving(_)))
    }

    pub(super) fn opposite(self) -> Flow {
        Flow { start: -self.start, end: -self.end, ..self }
    }

    /// The limit at the left end, which is at `t`.
    pub(super) fn first(&self, t: f64) -> Value {
        self.limit(self.start, t)
    }

    /// The limit at the right end, which is at `t`.
    pub(super) fn last(&self, t: f64) -> Value {
        self.limit(self.end, t)
    }

    /// The value at `t` of this flow over `span`; outside of it, that of the nearer end.
    pub(super) fn at(&self, span: Span, t: f64) -> Value {
        self.limit(self.margin_at(span, t), t)
    }

    /// The part over `part` of this flow over `span`.
    pub(super) fn part(&self, span: Span, part: Span) -> Flow {
        let start = self.margin_at(span, part.0);
        Flow { start, end: self.margin_at(span, part.1), ..*self }
    }

    /// This flow as seen `lead` seconds before.
    fn seen_before(self, lead: f64) -> Flow {
        let origin = self.origin.map(|origin| match origin.time {
            Time::Moving(ahead) => Origin { time: Time::Moving(ahead + lead), ..origin },
            Time::Fixed(_) => origin,
        });
        Flow { origin, ..self }
    }

    fn margin_at(&self, span: Span, t: f64) -> f64 {
        if t <= span.0 || self.is_constant() {
            self.start
        } else if t >= span.1 {
            self.end
        } else {
            self.start + (self.end - self.start) * ((t - span.0) / (span.1 - span.0))
        }
    }

    fn limit(&self, margin: f64, t: f64) -> Value {
        let origin = self.origin.map(|origin| match origin.time {
            Time::Moving(ahead) => Origin { time: Time::Fixed(t + ahead), ..origin },
            Time::Fixed(_) => origin,
        });
        Value { margin, origin }
    }
}

/// Sums and differences of a time and the bounds of windows agree to within this many parts of the
/// larger of the two: some roundings of 2⁻⁵³ each.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl Knot {
    /// How many seconds the knot lies after what is `ahead` seconds after `now`: 0 where only
    /// rounding tells the two apart.
    fn lead(&self, ahead: f64, now: f64) -> f64 {
        let lead = (self.t - ahead) - now;
        if lead.abs() <= ROUNDING * ahead.max(self.t.abs()) { 0.0 } else { lead }
    }
}

impl Signal {
    pub(super) fn new() -> Signal {
        Signal { knots: Vec::new() }
    }

    pub(super) fn knots(&self) -> &[Knot] {
        &self.knots
    }

    /// The interval of the flow after the knot at `position`.
    pub(super) fn span(&self, position: usize) -> Span {
        let end = self.knots.get(position + 1).map_or(f64::INFINITY, |knot| knot.t);
        (self.knots[position].t, end)
    }

    /// The time of the first knot.
    pub(super) fn start(&self) -> f64 {
        self.knots.first().map_or(0.0, |knot| knot.t)
    }

    /// How many knots are less than `ahead` seconds after `now`.
    pub(super) fn passed(&self, ahead: f64, now: f64) -> usize {
        self.knots.partition_point(|knot| knot.lead(ahead, now) < 0.0)
    }

    /// When, from `now` on, the knot `next` is `ahead` seconds ahead; never, if there is none. One that rounding alone
    /// has brought together with the last one is met at the same time.
    pub(super) fn meets(&self, next: usize, ahead: f64, now: f64) -> f64 {
        match self.knots.get(next) {
            Some(knot) if ahead < f64::INFINITY => (knot.t - ahead).max(now),
            _ => f64::INFINITY,
        }
    }

    /// The knot `next` and those of the same time, if they are `ahead` seconds ahead at `now`. Rounding may put `now`
    /// beside them; knots that rounding does not bring together are met one after the other.
    pub(super) fn met(&self, next: usize, ahead: f64, now: f64) -> Range<usize> {
        let rest = &self.knots[next..];
        let is_met = |knot: &&Knot| knot.lead(ahead, now) == 0.0;
        let time = rest.first().filter(is_met).map(|knot| knot.t - ahead);
        let count = rest.iter().take_while(|knot| Some(knot.t - ahead) == time).count();
        next..next + count
    }

    /// The flow before the knot `next`, as seen over `span` from `ahead` seconds before.
    pub(super) fn seen(&self, next: usize, ahead: f64, span: Span) -> Flow {
        let last = next.saturating_sub(1);
        let knot = &self.knots[last];
        let flow = knot.flow.unwrap_or_else(|| Flow::constant(knot.value));
        let part = (span.0 + ahead, span.1 + ahead);
        flow.part(self.span(last), part).seen_before(ahead)
    }

    /// The signal as seen from `ahead` seconds before; of several instants of one time, the first.
    pub(super) fn seen_before(&self, ahead: f64) -> Signal {
        let mut result = Signal::new();
        let mut now = self.start();
        let mut next = self.passed(ahead, now);
        loop {
            let met = self.met(next, ahead, now);
            let value = match self.knots.get(met.start) {
                Some(knot) if !met.is_empty() => knot.value,
                _ => self.seen(next, ahead, (now, now)).first(now),
            };
            next = met.end;
            let upcoming = self.meets(next, ahead, now);
            let flow = self.seen(next, ahead, (now, upcoming));
            result.push(Knot { t: now, value, flow: Some(flow) });
            if upcoming == f64::INFINITY {
                return result;
            }
            now = upcoming;
        }
    }

    /// Adds a knot, unless a constant flow goes through it and may keep its origin.
    pub(super) fn push(&mut self, knot: Knot) {
        let before = self.knots.last().and_then(|last| last.flow);
        let goes_through = before.zip(knot.flow).is_some_and(|(before, after)| {
            let level = |flow: Flow| flow.is_constant() && flow.start == knot.value.margin;
            level(before) && level(after) && (before.stays() || before.origin == after.origin)
        });
        if !goes_through {
            self.knots.push(knot);
        }
    }

    /// The signal with all signs turned.
    pub(super) fn opposite(mut self) -> Signal {
        for knot in &mut self.knots {
            knot.value = knot.value.opposite();
            knot.flow = knot.flow.map(Flow::opposite);
        }
        self
    }
}
