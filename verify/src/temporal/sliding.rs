//! The infimum of a signal over a window that slides along it.
//!
//! Between the times at which an end of the window meets a knot, the window holds a fixed set of
//! knots and whole flows, and a part of one flow at either end. The infimum is then the lowest of
//! three: a constant, and the two flows seen through the ends of the window. The constant comes
//! from a monotone queue (Lemire 2006, [arXiv:cs/0610046](https://arxiv.org/abs/cs/0610046)), so
//! that the whole takes time linear in the number of knots, as in Donzé, Ferrère and Maler 2013,
//! [doi:10.1007/978-3-642-39799-8_19](https://doi.org/10.1007/978-3-642-39799-8_19).

use std::collections::VecDeque;
use std::ops::Range;

use super::signal::{Flow, Knot, Signal, Span, Value};

/// Which times a sliding window holds, in seconds from its instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub start: f64,
    /// At least `start`, possibly ∞.
    pub end: f64,
    /// Whether the window holds also the instants at its end.
    pub end_included: bool,
}

/// The infimum over the window at every instant. A window that starts at once holds of the
/// instants of the same time only those that come no earlier.
pub(super) fn infimum(signal: &Signal, reach: Reach) -> Signal {
    let mut now = signal.start();
    let (left, right) = (signal.passed(reach.start, now), signal.passed(reach.end, now));
    let mut sweep = Sweep { signal, reach, queue: Queue::new(signal), left, right };
    let mut result = Signal::new();
    loop {
        let (mut instants, upcoming) = (sweep.instants(now), sweep.cross(now));
        let last = instants.pop();
        for value in instants {
            result.push(Knot { t: now, value, flow: None });
        }
        let span = (now, upcoming);
        result.push_lowest(last.unwrap_or(NOTHING), span, &sweep.flows(span));
        if upcoming == f64::INFINITY {
            return result;
        }
        now = upcoming;
    }
}

/// The infimum over a window that holds nothing.
const NOTHING: Value = Value { margin: f64::INFINITY, origin: None };

/// A window on its way along a signal.
struct Sweep<'a> {
    signal: &'a Signal,
    reach: Reach,
    queue: Queue<'a>,
    /// The first knot that the left end of the window has not yet passed.
    left: usize,
    /// The first knot that the right end of the window has not yet passed.
    right: usize,
}

impl Sweep<'_> {
    /// The infima at the instants of time `now`: one, or one for each knot there.
    fn instants(&mut self, now: f64) -> Vec<Value> {
        let at_left = self.signal.met(self.left, self.reach.start, now);
        let at_right = self.signal.met(self.right, self.reach.end, now);
        let mut at_ends = NOTHING;
        let end = if self.reach.end == f64::INFINITY {
            after_all(self.signal)
        } else if at_right.is_empty() {
            at_ends =
                at_ends.lower(self.signal.seen(self.right, self.reach.end, (now, now)).first(now));
            after_flow_start(self.right)
        } else if self.reach.end_included {
            after_knot(at_right.end)
        } else {
            before_knot(at_right.start)
        };
        if at_left.is_empty() {
            let at_start = self.signal.seen(self.left, self.reach.start, (now, now)).first(now);
            let inside = self.queue.lowest(after_flow_start(self.left)..end);
            return vec![at_start.lower(at_ends).lower(inside)];
        }
        let starts =
            if self.reach.start == 0.0 { at_left } else { at_left.start..at_left.start + 1 };
        starts.map(|knot| self.queue.lowest(before_knot(knot)..end).lower(at_ends)).collect()
    }

    /// Moves both ends past the knots they meet at `now`, and tells when they meet the next.
    fn cross(&mut self, now: f64) -> f64 {
        self.left = self.signal.met(self.left, self.reach.start, now).end;
        self.right = self.signal.met(self.right, self.reach.end, now).end;
        let left = self.signal.meets(self.left, self.reach.start, now);
        left.min(self.signal.meets(self.right, self.reach.end, now))
    }

    /// What the infimum over `span` is the lowest of, until an end of the window meets a knot.
    fn flows(&mut self, span: Span) -> Vec<Flow> {
        let mut flows = vec![self.signal.seen(self.left, self.reach.start, span)];
        let mut end = after_all(self.signal);
        if self.reach.end < f64::INFINITY {
            flows.push(self.signal.seen(self.right, self.reach.end, span));
            end = after_flow_start(self.right);
        }
        let inside = self.queue.lowest(after_flow_start(self.left)..end);
        flows.push(Flow::constant(inside));
        flows
    }
}

// The queue counts three parts to a knot: its value, and the limits of the flow after it at the
// start and at the end. These name the places between parts.

/// Before the value of the knot.
fn before_knot(knot: usize) -> usize {
    3 * knot
}

/// After the value of the last knot before `next`.
fn after_knot(next: usize) -> usize {
    (3 * next).saturating_sub(2)
}

/// In the flow before the knot `next`.
fn after_flow_start(next: usize) -> usize {
    (3 * next).saturating_sub(1)
}

/// After everything.
fn after_all(signal: &Signal) -> usize {
    3 * signal.knots().len()
}

/// The lowest of a range of parts, whose ends may only move forward.
struct Queue<'a> {
    signal: &'a Signal,
    /// The parts seen that no later part undercuts, in order: the place, and the value, which
    /// does not decrease. The first that is still in the range is the lowest.
    candidates: VecDeque<(usize, Value)>,
    /// The first part not yet seen.
    next: usize,
}

impl<'a> Queue<'a> {
    fn new(signal: &'a Signal) -> Self {
        Queue { signal, candidates: VecDeque::new(), next: 0 }
    }

    /// The lowest part in `range`, the earliest if there are several; ∞ if it is empty.
    fn lowest(&mut self, range: Range<usize>) -> Value {
        while self.next < range.end {
            let value = self.part(self.next);
            while self.candidates.back().is_some_and(|(_, last)| last.margin > value.margin) {
                self.candidates.pop_back();
            }
            self.candidates.push_back((self.next, value));
            self.next += 1;
        }
        while self.candidates.front().is_some_and(|(place, _)| *place < range.start) {
            self.candidates.pop_front();
        }
        self.candidates.front().map_or(NOTHING, |(_, value)| *value)
    }

    fn part(&self, place: usize) -> Value {
        let knot = &self.signal.knots()[place / 3];
        match (place % 3, knot.flow) {
            (0, _) => knot.value,
            (_, None) => NOTHING,
            (1, Some(flow)) => flow.first(knot.t),
            (_, Some(flow)) => flow.last(self.signal.span(place / 3).1),
        }
    }
}
