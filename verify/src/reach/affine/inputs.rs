//! What inputs add to a state in the course of time, as a zonotope.
//!
//! The sum ∫ e^{As} v(s) ds, with v(s) = c + Σ ξᵢ(s) gᵢ and each ξᵢ(s) from −1 to 1 at every instant, is
//! cut into pieces of h seconds. On a piece e^{As} g differs from the straight line between its values γ
//! and γ′ at the ends by at most h²/8 times the largest |A² e^{As} g|. In a direction ℓ the straight line
//! adds at most
//!
//! ```text
//! ∫ |ℓ · ((1 − s/h) γ + s/h γ′)| ds ≤ h/2 (|ℓ · γ| + |ℓ · γ′|),     s from 0 to h:
//! ```
//!
//! so h/2 γ and h/2 γ′ are generators, and what the straight line is off by, h³/12 times that largest
//! value, goes into the box.

use pleach_guards::Interval;

use super::AffineFlow;
use crate::reach::exponential::exponential;
use crate::reach::vector::{IntervalMatrix, around_zero, magnitude};
use crate::reach::zonotope::Zonotope;

/// How many pieces there are at least, and at most.
const PIECES: (usize, usize) = (16, 256);

impl AffineFlow {
    /// Every x(τ) that begins in `start`, for durations τ in `duration`, which are not negative.
    #[must_use]
    pub(crate) fn after(
        &self,
        start: &Zonotope,
        duration: Interval,
        generators: usize,
    ) -> Zonotope {
        let moved = exponential(&self.matrix.map(|entry| entry * duration));
        let nothing = vec![Interval::point(0.0); start.dimension()];
        let added = self.added(duration, generators);
        start.mapped(&moved, &nothing).plus(&added).reduced(generators)
    }

    /// What inputs add; as long as there are few of them, with about half as many generators as asked.
    fn added(&self, duration: Interval, generators: usize) -> Zonotope {
        let ways = self.ways();
        let pieces = (generators / (2 * ways.len().max(1))).clamp(PIECES.0, PIECES.1);
        let pieces = Pieces::new(&self.matrix, duration, pieces);
        let center = pieces.sum(self.inputs.center());
        let off = pieces.off(self.inputs.center()).into_iter().map(around_zero);
        let center: Vec<Interval> = center.into_iter().zip(off).map(|(a, b)| a + b).collect();
        let mut added = Zonotope::from_intervals(&center, &[]);
        for way in &ways {
            pieces.ends(way).for_each(|generator| added.push(&generator));
            added.widen(&pieces.off(way));
        }
        added
    }

    /// The generators of the inputs; the box has one for each axis.
    fn ways(&self) -> Vec<Vec<f64>> {
        let sides = self.inputs.slack().iter().enumerate().filter(|(_, slack)| **slack > 0.0);
        let sides = sides.map(|(axis, slack)| {
            let mut way = vec![0.0; self.inputs.dimension()];
            way[axis] = *slack;
            way
        });
        self.inputs.generators().iter().cloned().chain(sides).collect()
    }
}

/// A duration that is cut into pieces of one length.
struct Pieces {
    /// In seconds.
    length: Interval,
    /// e^{As} where pieces begin and end.
    powers: Vec<IntervalMatrix>,
    /// A² e^{As} for s within the first piece.
    curvature: IntervalMatrix,
}

impl Pieces {
    fn new(matrix: &IntervalMatrix, duration: Interval, count: usize) -> Self {
        let length = duration / Interval::point(count as f64);
        let during = length.hull(Interval::point(0.0));
        let over = |time: Interval| exponential(&matrix.map(|entry| entry * time));
        let mut powers = vec![IntervalMatrix::identity(matrix.rows()), over(length)];
        for number in 2..=count {
            // Products of few factors are rounded few times.
            let half = number / 2;
            powers.push(powers[half].times(&powers[number - half]));
        }
        Pieces { length, powers, curvature: matrix.times(matrix).times(&over(during)) }
    }

    /// The vector where pieces begin and end, times the length of what is around.
    fn ends(&self, vector: &[f64]) -> impl Iterator<Item = Vec<Interval>> {
        let last = self.powers.len() - 1;
        self.powers.iter().enumerate().map(move |(number, power)| {
            let share = if number == 0 || number == last { 0.5 } else { 1.0 };
            let length = self.length * Interval::point(share);
            power.apply_to_numbers(vector).into_iter().map(|entry| entry * length).collect()
        })
    }

    /// The integral of the straight lines.
    fn sum(&self, vector: &[f64]) -> Vec<Interval> {
        let nothing = vec![Interval::point(0.0); vector.len()];
        self.ends(vector).fold(nothing, |sum, end| {
            sum.into_iter().zip(end).map(|(sum, entry)| sum + entry).collect()
        })
    }

    /// What the straight lines are off by, at most, all pieces together.
    fn off(&self, vector: &[f64]) -> Vec<f64> {
        let cube = self.length * self.length * self.length / Interval::point(12.0);
        let mut off = vec![Interval::point(0.0); vector.len()];
        for power in &self.powers[..self.powers.len() - 1] {
            let curve = self.curvature.apply(&power.apply_to_numbers(vector));
            for (off, entry) in off.iter_mut().zip(curve) {
                *off = *off + Interval::point(magnitude(entry)) * cube;
            }
        }
        off.into_iter().map(|off| off.upper()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::exact::{fraction, holds, points};

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).expect("in order")
    }

    /// A set that moves by an input for an uncertain time.
    #[test]
    fn sets_after_a_duration_hold_every_end() {
        let flow =
            AffineFlow::new(IntervalMatrix::zero(1, 1), Zonotope::from_box(&[over(-0.7, 0.3)]));
        let start = Zonotope::from_box(&points(&[1.0]));
        let after = flow.after(&start, over(0.1, 0.9), 8).hull()[0];
        assert!(fraction(after.lower()) <= fraction(1.0) - fraction(0.7) * fraction(0.9));
        assert!(fraction(after.upper()) >= fraction(1.0) + fraction(0.3) * fraction(0.9));
    }

    /// ẋ = x + v comes from 0 to (eᵗ − 1) v: of inputs in a segment and in a box.
    #[test]
    fn what_inputs_add_grows_with_the_flow() {
        let mut matrix = IntervalMatrix::zero(1, 1);
        matrix[(0, 0)] = Interval::point(1.0);
        let mut inputs = Zonotope::from_box(&points(&[2.0]));
        inputs.widen(&[1.0]);
        let flow = AffineFlow::new(matrix, inputs);
        let start = Zonotope::from_box(&points(&[0.0]));
        let after = flow.after(&start, Interval::point(1.0), 8).hull()[0];
        let exact = 1f64.exp_m1();
        assert!(after.lower() <= exact && 3.0 * exact <= after.upper(), "{after}");
        assert!(after.width() <= 2.01 * exact, "{after}");
    }

    /// From rest, ẋ₁ = x₂ and ẋ₂ = v with v from −1 to 1 reach t²/2 and t, and x₁ − t x₂/2 reaches t²/4:
    /// there the best input changes its sign on the way.
    #[test]
    fn inputs_that_change_their_sign_on_the_way_are_covered() {
        let mut matrix = IntervalMatrix::zero(2, 2);
        matrix[(0, 1)] = Interval::point(1.0);
        let flow =
            AffineFlow::new(matrix, Zonotope::from_box(&[points(&[0.0])[0], over(-1.0, 1.0)]));
        let start = Zonotope::from_box(&points(&[0.0; 2]));
        let after = flow.after(&start, Interval::point(2.0), 64);
        for (direction, exact) in [([1.0, 0.0], 2.0), ([0.0, 1.0], 2.0), ([1.0, -1.0], 1.0)] {
            let found = after.support(&points(&direction));
            assert!((exact..1.01 * exact).contains(&found), "{direction:?}: {found}");
        }
    }

    /// ẋ₁ = x₂ + v₁, ẋ₂ = x₃ + v₂, ẋ₃ = v₃ with v = (0, 1/2, −1): what comes to x₁ is s/2 − s²/2, above
    /// its straight lines, and 1/12 after a second.
    #[test]
    fn what_straight_lines_are_off_by_counts() {
        let mut matrix = IntervalMatrix::zero(3, 3);
        matrix[(0, 1)] = Interval::point(1.0);
        matrix[(1, 2)] = Interval::point(1.0);
        let (nothing, way) = (points(&[0.0; 3]), points(&[0.0, 0.5, -1.0]));
        let exact = fraction(12.0).recip();
        let after = |inputs: Zonotope| {
            let flow = AffineFlow::new(matrix.clone(), inputs);
            flow.after(&Zonotope::from_box(&nothing), Interval::point(1.0), 8).hull()[0]
        };
        let one = after(Zonotope::from_box(&way));
        assert!(holds(one, &exact) && one.width() < 1e-3, "{one}");
        let all = after(Zonotope::from_intervals(&nothing, &[way]));
        assert!(holds(all, &exact) && all.width() < 0.168, "{all}");
    }
}
