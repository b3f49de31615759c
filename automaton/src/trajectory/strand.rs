//! What the variables of a group went through, as the solutions of their flows.

use pleach_continuous::flow::{Curve, Piece};
use serde::{Deserialize, Serialize};

use crate::moment::Moment;
use crate::time::HybridTime;

/// The course of the variables of a group of components.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Strand {
    /// The variables by their numbers, ascending.
    pub(crate) slots: Vec<usize>,
    /// The components by their numbers, ascending.
    pub(crate) components: Vec<usize>,
    /// In order; the first begins at (0, 0), each of the others with a jump of the group or where
    /// its flow was planned anew.
    pub(crate) stretches: Vec<Stretch>,
}

/// A flow of a group from one of its jumps to the next. Its pieces are in seconds since its start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Stretch {
    pub(crate) begin: HybridTime,
    /// When it begins, exactly.
    pub(crate) since: Moment,
    /// When it ends.
    pub(crate) until: f64,
    /// The state at its beginning.
    pub(crate) first: Vec<f64>,
    /// None if no time passes.
    pub(crate) pieces: Vec<Piece>,
    /// The state at its end.
    pub(crate) last: Vec<f64>,
}

/// A polynomial of a higher degree than this is sampled inside, so that cubics through the samples
/// agree with it to the width of a line. Steps of an integration are short anyway.
const SMOOTH: usize = 5;
/// How many samples are taken of such a polynomial.
const SAMPLES: u32 = 8;

impl Stretch {
    /// A stretch of no duration.
    pub(crate) fn at(begin: HybridTime, since: Moment, first: Vec<f64>) -> Self {
        let last = first.clone();
        Stretch { begin, since, until: begin.t, first, pieces: Vec::new(), last }
    }

    /// The seconds from its start to `t`.
    pub(crate) fn local(&self, t: f64) -> f64 {
        (Moment::from(t) - self.since).seconds()
    }

    /// The values at `t`.
    pub(crate) fn values(&self, t: f64, values: &mut Vec<f64>) {
        values.clear();
        if t <= self.begin.t {
            return values.extend(&self.first);
        }
        match self.piece(t) {
            Some(piece) if t < self.until => {
                values.resize(self.first.len(), 0.0);
                piece.state_at(self.local(t), values);
            }
            _ => values.extend(&self.last),
        }
    }

    /// The rates at `t`, per second.
    pub(crate) fn rates(&self, t: f64, rates: &mut Vec<f64>) {
        rates.clear();
        let Some(piece) = self.piece(t) else {
            return rates.resize(self.first.len(), 0.0);
        };
        let time = self.local(t).clamp(piece.start(), piece.end());
        rates.extend((0..piece.dimension()).map(|component| piece.rate(component, time)));
    }

    /// The piece of the flow at `t`.
    pub(crate) fn piece(&self, t: f64) -> Option<&Piece> {
        let time = self.local(t);
        let number = self.pieces.partition_point(|piece| piece.end() <= time);
        self.pieces.get(number).or(self.pieces.last())
    }

    /// The instants between `from` and `to` at which it should be looked at.
    pub(crate) fn instants(&self, from: f64, to: f64, instants: &mut Vec<f64>) {
        let first = self.pieces.partition_point(|piece| piece.end() <= self.local(from));
        for piece in &self.pieces[first.min(self.pieces.len())..] {
            let at = |time: f64| (self.since + Moment::from(time)).seconds();
            if at(piece.start()) >= to {
                break;
            }
            let parts = if piece.degree() > SMOOTH { SAMPLES } else { 1 };
            let length = piece.end() - piece.start();
            let inner = (0..parts)
                .map(|part| at(piece.start() + length * f64::from(part) / f64::from(parts)));
            instants.extend(inner.filter(|t| from < *t && *t < to));
        }
    }
}

impl Strand {
    /// The stretch at a hybrid time that is not before the run.
    pub(crate) fn stretch(&self, at: HybridTime) -> &Stretch {
        let begun = self.stretches.partition_point(|stretch| stretch.begin <= at);
        &self.stretches[begun.saturating_sub(1)]
    }

    /// The stretches that last into the time from `from` to `to`.
    pub(crate) fn during(&self, from: HybridTime, to: HybridTime) -> &[Stretch] {
        let first = self.stretches.partition_point(|stretch| stretch.begin <= from);
        let last = self.stretches.partition_point(|stretch| stretch.begin <= to);
        &self.stretches[first.saturating_sub(1)..last]
    }

    pub(crate) fn is_consistent(&self, variables: usize, components: usize) -> bool {
        let width = self.slots.len();
        let fits = |stretch: &Stretch| {
            let whole = |piece: &Piece| piece.is_consistent() && piece.dimension() == width;
            stretch.first.len() == width
                && stretch.last.len() == width
                && stretch.pieces.iter().all(whole)
        };
        let exist = |numbers: &[usize], all: usize| numbers.iter().all(|number| *number < all);
        !self.stretches.is_empty()
            && self.stretches.is_sorted_by(|one, next| one.begin <= next.begin)
            && self.stretches.iter().all(fits)
            && exist(&self.slots, variables)
            && exist(&self.components, components)
    }
}
