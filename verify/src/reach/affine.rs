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

use pleach_guards::Interval;

use super::exponential::exponential;
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

    /// Every x(τ) that begins in `start`, for durations τ in `duration`, which are not negative.
    ///
    /// What the inputs add is doubled from a small step: the states after 2 s seconds are those after
    /// s seconds, moved on by s, and what the inputs add in the second half.
    #[must_use]
    pub fn after(&self, start: &Zonotope, duration: Interval, generators: usize) -> Zonotope {
        let doublings = 12;
        let step = duration * Interval::point(0.5f64.powi(doublings));
        let mut moved = exponential(&self.matrix.map(|entry| entry * step));
        let mut added = self.added(step);
        let nothing = vec![Interval::point(0.0); start.dimension()];
        for _ in 0..doublings {
            added = added.plus(&added.mapped(&moved, &nothing)).reduced(generators);
            moved = moved.times(&moved);
        }
        start.mapped(&moved, &nothing).plus(&added).reduced(generators)
    }

    /// What inputs add during a short step: ∫ e^{As} v(s) ds.
    fn added(&self, step: Interval) -> Zonotope {
        let from_zero = Interval::new(0.0, step.upper().max(0.0)).unwrap_or(Interval::WHOLE);
        let over = exponential(&self.matrix.map(|entry| entry * from_zero));
        let mean = |vector: &[f64]| -> Vec<Interval> {
            over.apply_to_numbers(vector).into_iter().map(|entry| entry * step).collect()
        };
        let center = mean(self.inputs.center());
        let generators: Vec<Vec<Interval>> =
            self.inputs.generators().iter().map(|generator| mean(generator)).collect();
        let mut added = Zonotope::from_intervals(&center, &generators);
        for (axis, slack) in
            self.inputs.slack().iter().enumerate().filter(|(_, slack)| **slack > 0.0)
        {
            let mut unit = vec![0.0; self.inputs.dimension()];
            unit[axis] = *slack;
            added.push(&mean(&unit));
        }
        added
    }
}

/// A flow cut into steps of one length, ready to carry directions.
#[derive(Clone, Debug)]
pub struct Steps<'a> {
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
    pub fn new(flow: &'a AffineFlow, start: &'a StateSet, length: f64) -> Self {
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
    pub fn reserve(&mut self, count: usize) {
        while 1usize << self.powers.len() <= count {
            let last = &self.powers[self.powers.len() - 1];
            self.powers.push(last.times(last));
        }
    }

    /// Begins to carry a direction.
    pub fn track(&self, direction: &[f64]) -> Track {
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
    pub fn advance(&self, track: &mut Track) -> StepBounds {
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
        track.added = (Interval::point(added) + gained).upper();
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
pub struct Track {
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
    pub fn value(&self) -> f64 {
        (self.state_bound + self.added).next_up()
    }
}

/// Bounds on ℓ · x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepBounds {
    /// At every instant of the step, its ends included.
    pub during: f64,
    /// At its end.
    pub after: f64,
}
