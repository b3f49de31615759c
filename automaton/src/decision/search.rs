//! Branch and prune: boxes are halved until a sample of one satisfies a predicate, interval
//! arithmetic shows that none of its states does, or they are too small to go on.

use std::collections::VecDeque;

use pleach_guards::{Interval, Predicate, Ranges, Truth};

use super::{Proof, Question};

/// How a search ends.
pub(super) enum Found {
    /// The question holds at this point.
    Witness(Vec<f64>),
    /// No box was left.
    Nothing(Proof),
    /// This box was left, and perhaps others.
    Left(Vec<Interval>),
}

/// Looks in the whole region of the question, where only states count in which `necessary` holds.
///
/// The boxes are taken in the order in which they arise, so that the whole region is searched
/// coarsely before a part of it is searched finely.
pub(super) fn search(question: &Question<'_>, necessary: &Predicate) -> Found {
    let mut boxes = VecDeque::from([question.ranges.clone()]);
    let mut smallest = None;
    for taken in 0.. {
        let Some(sides) = boxes.pop_front() else {
            return match smallest {
                Some(left) => Found::Left(left),
                None => Found::Nothing(Proof::Intervals { boxes: taken }),
            };
        };
        if taken >= question.effort.boxes {
            return Found::Left(sides);
        }
        let truth = necessary.truth(&Sides { variables: &question.variables, sides: &sides });
        // A predicate without a verdict anywhere in the box does not hold in it either.
        let Ok(Truth::Always | Truth::Undecided) = truth else { continue };
        if let Some(witness) = samples(&sides).find(|sample| question.holds_at(sample)) {
            return Found::Witness(witness);
        }
        // What is unknown in a box where all that is known holds stays so in its halves.
        let opaque = truth == Ok(Truth::Always) && question.has_functions();
        match widest(&sides, &question.ranges, question.effort.resolution) {
            Some(axis) if !opaque => boxes.extend(halved(&sides, axis)),
            _ => smallest = smallest.or(Some(sides)),
        }
    }
    Found::Left(question.ranges.clone())
}

/// The axis along which a box is longest in proportion to the region, or `None` if all its sides
/// are below the resolution or can be halved no more.
fn widest(sides: &[Interval], region: &[Interval], resolution: f64) -> Option<usize> {
    let length = |axis: usize| relative_width(&sides[axis], &region[axis]);
    (0..sides.len())
        .filter(|axis| {
            let middle = sides[*axis].midpoint();
            let divisible = sides[*axis].lower() < middle && middle < sides[*axis].upper();
            divisible && length(*axis) > resolution
        })
        .max_by(|a, b| length(*a).total_cmp(&length(*b)).then(b.cmp(a)))
}

/// The width of a side in proportion to that of the region, or to its own magnitude, at least 1,
/// where the region is not bounded.
pub(super) fn relative_width(side: &Interval, region: &Interval) -> f64 {
    if side.width() == 0.0 {
        0.0
    } else if region.width().is_finite() {
        side.width() / region.width()
    } else {
        side.width() / side.midpoint().abs().max(1.0)
    }
}

fn halved(sides: &[Interval], axis: usize) -> [Vec<Interval>; 2] {
    sides[axis].halves().map(|half| {
        let mut sides = sides.to_vec();
        sides[axis] = half;
        sides
    })
}

/// The midpoint of a box, and its corners if there are few of them.
fn samples(sides: &[Interval]) -> impl Iterator<Item = Vec<f64>> {
    /// Two to this power are the corners sampled.
    const CORNER_AXES: usize = 4;

    let corners = if sides.len() <= CORNER_AXES { 1usize << sides.len() } else { 0 };
    let corner = |corner: usize| {
        let end = move |(axis, side): (usize, &Interval)| {
            let end = if corner >> axis & 1 == 0 { side.lower() } else { side.upper() };
            if end.is_finite() { end } else { side.midpoint() }
        };
        sides.iter().enumerate().map(end).collect()
    };
    let middle = sides.iter().map(Interval::midpoint).collect();
    std::iter::once(middle).chain((0..corners).map(corner))
}

/// A box under the names of its variables.
struct Sides<'a> {
    variables: &'a [&'a str],
    sides: &'a [Interval],
}

impl Ranges for Sides<'_> {
    fn range(&self, variable: &str) -> Option<Interval> {
        let axis = self.variables.iter().position(|name| *name == variable)?;
        self.sides.get(axis).copied()
    }
}
