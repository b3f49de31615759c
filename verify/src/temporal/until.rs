//! The signal of φ 𝒰 ψ.
//!
//! At an instant τ it is the largest, over the instants τ′ of the window, of the smaller of ψ at
//! τ′ and of the infimum of φ from τ until just before τ′. A bounded until follows from the
//! unbounded one (Donzé, Ferrère and Maler 2013,
//! [doi:10.1007/978-3-642-39799-8_19](https://doi.org/10.1007/978-3-642-39799-8_19)):
//!
//! - φ 𝒰\[a, ∞) ψ, for a > 0, is: φ up to just before a seconds from now, and there φ 𝒰 ψ;
//! - φ 𝒰\[a, b] ψ is φ 𝒰\[a, ∞) ψ and ◇\[a, b] ψ.
//!
//! The unbounded one is computed from the end to the start, one piece at a time.

use super::formula::Window;
use super::pointwise::{Pair, crossing, lowest, paired};
use super::signal::{Flow, Knot, Signal, Span, Value};
use super::sliding::{Reach, infimum};

/// φ 𝒰 ψ over `window`.
pub(super) fn until(window: Window, safe: &Signal, goal: &Signal) -> Signal {
    let mut result = unbounded(safe, goal);
    if window.start() > 0.0 {
        let before = Reach { start: 0.0, end: window.start(), end_included: false };
        result = infimum(safe, before).minimum(&result.seen_before(window.start()));
    }
    if window.end() < f64::INFINITY {
        result = result.minimum(&supremum(goal.clone(), window));
    }
    result
}

/// The supremum of the signal over `window`.
pub(super) fn supremum(signal: Signal, window: Window) -> Signal {
    let reach = Reach { start: window.start(), end: window.end(), end_included: true };
    infimum(&signal.opposite(), reach).opposite()
}

/// φ 𝒰 ψ over all that comes.
fn unbounded(safe: &Signal, goal: &Signal) -> Signal {
    let pairs: Vec<Pair> = paired(safe, goal).flat_map(split_where_crossing).collect();
    // The last instant first.
    let mut knots: Vec<Knot> = Vec::with_capacity(pairs.len());
    // What can be had from the next instant on; after the last flow there is none.
    let mut next = Value::given(f64::NEG_INFINITY);
    for pair in pairs.iter().rev() {
        let mut flow = None;
        let mut onward = next;
        if let Some((span, [safe, goal])) = pair.flows {
            for (t, piece) in course(span, safe, goal, next).into_iter().rev() {
                if t > pair.t {
                    knots.push(Knot { t, value: piece.first(t), flow: Some(piece) });
                } else {
                    flow = Some(piece);
                    onward = safe.first(t).lower(piece.first(t));
                }
            }
        }
        next = pair.values.1.higher(pair.values.0.lower(onward));
        knots.push(Knot { t: pair.t, value: next, flow });
    }
    let mut result = Signal::new();
    knots.into_iter().rev().for_each(|knot| result.push(knot));
    result
}

/// φ 𝒰 ψ over the open interval `span`, in which φ and ψ do not cross and after which it is
/// `next`: ψ now; or the infimum of φ over the rest, with the better of ψ at its end and `next`.
fn course(span: Span, safe: Flow, goal: Flow, next: Value) -> Vec<(f64, Flow)> {
    let rest = if safe.end > safe.start { safe } else { Flow::constant(safe.last(span.1)) };
    let later = Flow::constant(goal.last(span.1).higher(next));
    let mut course = Vec::new();
    for (part, piece) in lowest(span, &[rest, later]) {
        let now = goal.part(span, part);
        let highest = lowest(part, &[now.opposite(), piece.opposite()]);
        course.extend(highest.into_iter().map(|(part, flow)| (part.0, flow.opposite())));
    }
    course
}

/// The pair, in two if its flows cross.
fn split_where_crossing(pair: Pair) -> impl Iterator<Item = Pair> {
    let Some((span, [one, other])) = pair.flows else {
        return vec![pair].into_iter();
    };
    let Some(t) = crossing(span, &one, &other) else {
        return vec![pair].into_iter();
    };
    let part = |part: Span| Some((part, [one.part(span, part), other.part(span, part)]));
    let first = Pair { flows: part((span.0, t)), ..pair };
    let values = (one.at(span, t), other.at(span, t));
    vec![first, Pair { t, values, flows: part((t, span.1)) }].into_iter()
}
