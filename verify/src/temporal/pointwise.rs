//! The minimum and the maximum of two signals at every instant, and signals side by side.

use super::signal::{Flow, Knot, Signal, Span, Value};

impl Signal {
    /// Adds an instant and, over `span` after it, the lowest of `flows`.
    pub(super) fn push_lowest(&mut self, value: Value, span: Span, flows: &[Flow]) {
        let mut value = Some(value);
        for ((t, _), flow) in lowest(span, flows) {
            // Where two flows cross, the value is their common limit.
            let value = value.take().unwrap_or_else(|| flow.first(t));
            self.push(Knot { t, value, flow: Some(flow) });
        }
    }

    /// The smaller of the two values at every instant.
    pub(super) fn minimum(&self, other: &Signal) -> Signal {
        let mut minimum = Signal::new();
        for pair in paired(self, other) {
            let value = pair.values.0.lower(pair.values.1);
            match pair.flows {
                Some((span, flows)) => minimum.push_lowest(value, span, &flows),
                None => minimum.push(Knot { t: pair.t, value, flow: None }),
            }
        }
        minimum
    }

    /// The larger of the two values at every instant.
    pub(super) fn maximum(self, other: Signal) -> Signal {
        self.opposite().minimum(&other.opposite()).opposite()
    }
}

/// The lowest of `flows` over `span`, in successive pieces; there is at least one.
pub(super) fn lowest(span: Span, flows: &[Flow]) -> Vec<(Span, Flow)> {
    let mut bounds = vec![span.0];
    for (position, flow) in flows.iter().enumerate() {
        bounds.extend(flows[..position].iter().filter_map(|other| crossing(span, flow, other)));
    }
    bounds.sort_by(f64::total_cmp);
    bounds.dedup();
    bounds.push(span.1);
    let piece = |bound: &[f64]| {
        let part = (bound[0], bound[1]);
        // Flows do not cross inside of a part: the sum of its ends tells which is lower; unless they cross between
        // two adjacent times, where its limits are those of different flows.
        let flows = flows.iter().map(|flow| flow.part(span, part));
        let limits =
            |lowest: [f64; 2], flow: Flow| [lowest[0].min(flow.start), lowest[1].min(flow.end)];
        let [start, end] = flows.clone().fold([f64::INFINITY; 2], limits);
        let lowest =
            flows.min_by(|one, other| (one.start + one.end).total_cmp(&(other.start + other.end)));
        lowest.map(|flow| (part, Flow { start, end, ..flow }))
    };
    bounds.windows(2).filter_map(piece).collect()
}

/// When two flows cross strictly inside of `span`.
pub(super) fn crossing(span: Span, one: &Flow, other: &Flow) -> Option<f64> {
    let (before, after) = (one.start - other.start, one.end - other.end);
    let crosses = (before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0);
    let t = span.0 + (span.1 - span.0) * (before / (before - after));
    (crosses && span.0 < t && t < span.1).then_some(t)
}

/// Two signals at one instant, and after it.
pub(super) struct Pair {
    pub t: f64,
    pub values: (Value, Value),
    /// The flows after it with their interval; `None` before a jump.
    pub flows: Option<(Span, [Flow; 2])>,
}

/// Two signals side by side, at the instants at which either has a knot.
pub(super) fn paired<'a>(one: &'a Signal, other: &'a Signal) -> impl Iterator<Item = Pair> + 'a {
    let mut readers = (Reader::new(one), Reader::new(other));
    std::iter::from_fn(move || {
        let t = readers.0.upcoming().min(readers.1.upcoming());
        if t == f64::INFINITY {
            return None;
        }
        let here = (readers.0.advance_to(t), readers.1.advance_to(t));
        let count = here.0.len().max(here.1.len());
        let span = (t, readers.0.upcoming().min(readers.1.upcoming()));
        let flows = [readers.0.flow(span), readers.1.flow(span)];
        Some((0..count).map(move |place| Pair {
            t,
            values: (here.0.value(place), here.1.value(place)),
            flows: (place + 1 == count).then_some((span, flows)),
        }))
    })
    .flatten()
}

/// A place in a signal that moves forward.
struct Reader<'a> {
    signal: &'a Signal,
    /// The first knot not yet passed.
    next: usize,
}

/// The values of a signal at one time: of its knots there, or of the flow that goes through.
enum Here<'a> {
    Knots(&'a [Knot]),
    Flow(Value),
}

impl<'a> Reader<'a> {
    fn new(signal: &'a Signal) -> Self {
        Reader { signal, next: 0 }
    }

    fn upcoming(&self) -> f64 {
        self.signal.knots().get(self.next).map_or(f64::INFINITY, |knot| knot.t)
    }

    /// Moves past the knots at `t`, which is at most [`upcoming`](Self::upcoming).
    fn advance_to(&mut self, t: f64) -> Here<'a> {
        let rest = &self.signal.knots()[self.next..];
        let count = rest.iter().take_while(|knot| knot.t == t).count();
        if count == 0 {
            return Here::Flow(self.flow((t, t)).first(t));
        }
        self.next += count;
        Here::Knots(&rest[..count])
    }

    /// The part over `span` of the flow after the last knot that has been passed.
    fn flow(&self, span: Span) -> Flow {
        self.signal.seen(self.next, 0.0, span)
    }
}

impl Here<'_> {
    fn len(&self) -> usize {
        match self {
            Here::Knots(knots) => knots.len(),
            Here::Flow(_) => 1,
        }
    }

    /// The value at the instant `place`; a single value stands for all.
    fn value(&self, place: usize) -> Value {
        match self {
            Here::Knots(knots) => knots[place.min(knots.len() - 1)].value,
            Here::Flow(value) => *value,
        }
    }
}
