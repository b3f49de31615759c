//! Flows ẋ = A x + v with v(t) in a set V at every instant, bounded in directions.
//!
//! For a direction ℓ the reachable states satisfy
//!
//! ```text
//! ℓ · x(t) ≤ ρ(e^{Aᵀt} ℓ, X₀) + ∫₀ᵗ ρ(e^{Aᵀs} ℓ, V) ds,     ρ(ℓ, X) = max {ℓ · x : x ∈ X},
//! ```
//!
//! with equality for the best choice of v (Le Guernic and Girard 2010,
//! [doi:10.1016/j.nahs.2009.03.002](https://doi.org/10.1016/j.nahs.2009.03.002)). Sets are never
//! propagated, directions are, so that nothing wraps. Over a step of h seconds e^{Aᵀτ} ℓ differs from
//! the straight line between its ends by at most h²/8 times the largest |e^{Aᵀτ} Aᵀ² ℓ|, and since ρ
//! is convex in ℓ, the values at the ends and this difference bound what is between.
//!
//! The directions e^{Aᵀkh} ℓ are computed with the powers e^{Ah·2ʲ}, one for each binary digit of k: so
//! the rounding of k steps passes through log₂ k products and not through k.

mod inputs;

use pleach_guards::Interval;

use super::exponential::exponential;
use super::rounding::plus_up;
use super::set::StateSet;
use super::vector::{IntervalMatrix, dot};
use super::zonotope::Zonotope;

/// The flow ẋ = A x + v with v(t) ∈ V.
#[derive(Clone, Debug, PartialEq)]
pub struct AffineFlow {
    matrix: IntervalMatrix,
    inputs: Zonotope,
}

impl AffineFlow {
    /// The flow of this square matrix and this set of inputs.
    pub fn new(matrix: IntervalMatrix, inputs: Zonotope) -> Self {
        AffineFlow { matrix, inputs }
    }

    /// A.
    pub fn matrix(&self) -> &IntervalMatrix {
        &self.matrix
    }

    /// V.
    pub fn inputs(&self) -> &Zonotope {
        &self.inputs
    }
}

/// A flow cut into steps of one length, ready to carry directions.
#[derive(Clone, Debug)]
pub(super) struct Steps<'a> {
    flow: &'a AffineFlow,
    start: &'a StateSet,
    /// In seconds.
    length: f64,
    /// Transposes of e^{Ah·2ʲ}.
    powers: Vec<IntervalMatrix>,
    /// The transpose of A² e^{Aτ} for τ from 0 to h.
    curvature: IntervalMatrix,
    input_box: Vec<Interval>,
}

impl<'a> Steps<'a> {
    /// The flow from `start` in steps of `length` > 0 seconds.
    pub(super) fn new(flow: &'a AffineFlow, start: &'a StateSet, length: f64) -> Self {
        let matrix = &flow.matrix;
        let step = Interval::point(length);
        let within = Interval::new(0.0, length).unwrap_or(Interval::WHOLE);
        let during = exponential(&matrix.map(|entry| entry * within));
        let curvature = matrix.times(matrix).times(&during).transposed();
        let power = exponential(&matrix.map(|entry| entry * step)).transposed();
        let input_box = flow.inputs.hull();
        Steps { flow, start, length, powers: vec![power], curvature, input_box }
    }

    /// Prepares for `count` steps.
    pub(super) fn reserve(&mut self, count: usize) {
        while 1usize << self.powers.len() <= count {
            let last = &self.powers[self.powers.len() - 1];
            self.powers.push(last.times(last));
        }
    }

    /// Begins to carry a direction.
    pub(super) fn track(&self, direction: &[f64]) -> Track {
        let direction: Vec<Interval> =
            direction.iter().map(|entry| Interval::point(*entry)).collect();
        Track {
            taken: 0,
            by_digit: Vec::new(),
            state_bound: self.start.support(&direction),
            input_bound: self.flow.inputs.support(&direction),
            first: direction.clone(),
            direction,
            added: 0.0,
        }
    }

    /// Carries a direction over the next step; [`reserve`](Self::reserve) has prepared for it.
    pub(super) fn advance(&self, track: &mut Track) -> StepBounds {
        let length = Interval::point(self.length);
        let curve = self.curvature.apply(&track.direction);
        // What the direction differs from a straight line by, is −τ (h − τ)/2 times the curve.
        let eighth = length * length / Interval::point(8.0);
        let bend = |sides: &[Interval]| (-dot(&curve, sides)).upper().max(0.0);
        let state_bend = (eighth * Interval::point(bend(self.start.hull()))).upper();
        let input_bend = Interval::point(bend(&self.input_box));
        let input_bend = eighth * length * Interval::point(2.0) / Interval::point(3.0) * input_bend;

        let before = track.value();
        let (first_input, added) = (track.input_bound, track.added);
        self.carry(track);
        track.state_bound = self.start.support(&track.direction);
        track.input_bound = self.flow.inputs.support(&track.direction);
        let both = Interval::point(first_input) + Interval::point(track.input_bound);
        let gained = length * both / Interval::point(2.0) + input_bend;
        track.added = plus_up(added, gained.upper());
        let after = track.value();
        let sag = Interval::point(first_input) - Interval::point(track.input_bound);
        let sag = (length * sag / Interval::point(8.0)).upper().max(0.0);
        let between = Interval::point(before.max(after))
            + Interval::point(state_bend)
            + Interval::point(sag)
            + Interval::point(input_bend.upper());
        StepBounds { during: between.upper(), after }
    }

    /// The next direction from an earlier one, by the power for the lowest binary digit.
    fn carry(&self, track: &mut Track) {
        track.taken += 1;
        let digit = track.taken.trailing_zeros() as usize;
        let earlier = track.taken & (track.taken - 1);
        let from = match earlier {
            0 => &track.first,
            _ => &track.by_digit[earlier.trailing_zeros() as usize],
        };
        track.direction = self.powers[digit].apply(from);
        track.by_digit.resize(track.by_digit.len().max(digit + 1), Vec::new());
        track.by_digit[digit].clone_from(&track.direction);
    }
}

/// A direction on its way.
#[derive(Clone, Debug)]
pub(super) struct Track {
    taken: usize,
    first: Vec<Interval>,
    direction: Vec<Interval>,
    /// The last direction whose step number ends with this binary digit.
    by_digit: Vec<Vec<Interval>>,
    state_bound: f64,
    input_bound: f64,
    /// What inputs have added so far, at most.
    added: f64,
}

impl Track {
    /// At least ℓ · x now.
    pub(super) fn value(&self) -> f64 {
        plus_up(self.state_bound, self.added)
    }
}

/// Bounds on ℓ · x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StepBounds {
    /// At every instant of the step, its ends included.
    pub during: f64,
    /// At its end.
    pub after: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::exact::{FAINT, fraction, points};

    /// ẋ₁ = x₂ + v₁, ẋ₂ = x₃ + v₂, ẋ₃ = v₃: solutions are polynomials in time.
    fn chain(inputs: [f64; 3]) -> AffineFlow {
        let mut matrix = IntervalMatrix::zero(3, 3);
        matrix[(0, 1)] = Interval::point(1.0);
        matrix[(1, 2)] = Interval::point(1.0);
        AffineFlow::new(matrix, Zonotope::from_box(&points(&inputs)))
    }

    /// The bounds on x₁ in the first step, which lasts a second.
    fn first_step(start: [f64; 3], inputs: [f64; 3]) -> StepBounds {
        let (flow, start) = (chain(inputs), StateSet::from_box(points(&start)));
        let mut steps = Steps::new(&flow, &start, 1.0);
        steps.reserve(1);
        steps.advance(&mut steps.track(&[1.0, 0.0, 0.0]))
    }

    #[test]
    fn what_inputs_add_is_rounded_up() {
        let (flow, start) = (chain([0.0; 3]), StateSet::from_box(points(&[0.0; 3])));
        let track = Steps::new(&flow, &start, 1.0).track(&[1.0, 0.0, 0.0]);
        let track = Track { state_bound: 1.0, added: FAINT, ..track };
        assert!(fraction(track.value()) >= fraction(1.0) + fraction(FAINT));
        // What is added in a step comes to what was added before.
        let flow = chain([FAINT, 0.0, 0.0]);
        let mut steps = Steps::new(&flow, &start, 1.0);
        steps.reserve(1);
        let mut track = Track { added: 1.0, ..steps.track(&[1.0, 0.0, 0.0]) };
        steps.advance(&mut track);
        assert!(fraction(track.added) >= fraction(1.0) + fraction(FAINT));
    }

    /// t/2 − t²/2 is 0 at both ends of the step, and 1/8 in its middle.
    #[test]
    fn states_bend_between_the_ends_of_a_step() {
        let bounds = first_step([0.0, 0.5, -1.0], [0.0; 3]);
        assert!((0.125..0.13).contains(&bounds.during), "{bounds:?}");
        assert!((0.0..1e-12).contains(&bounds.after), "{bounds:?}");
    }

    /// The rate 1/2 − t: what it adds is 0 at both ends of the step, and 1/8 in its middle.
    #[test]
    fn inputs_add_more_on_the_way_than_at_the_ends() {
        let bounds = first_step([0.0; 3], [0.5, -1.0, 0.0]);
        assert!((0.125..0.13).contains(&bounds.during), "{bounds:?}");
        assert!((0.0..1e-12).contains(&bounds.after), "{bounds:?}");
    }

    /// The rate −1/12 + t/2 − t²/2 adds 0 over the whole step, more than its values at the ends say,
    /// and most of it after 0.789 s.
    #[test]
    fn what_inputs_add_bends() {
        let bounds = first_step([0.0; 3], [-1.0 / 12.0, 0.5, -1.0]);
        let added = |t: f64| -t / 12.0 + t * t / 4.0 - t * t * t / 6.0;
        assert!(bounds.during >= added(0.789), "{bounds:?}");
        assert!(bounds.after >= added(1.0), "{bounds:?}");
    }
}
