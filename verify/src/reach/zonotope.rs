//! Zonotopes: sums of segments.

use pleach_guards::Interval;

use super::rounding::{plus_up, sum_up};
use super::vector::{IntervalMatrix, around_zero, dot, dot_numbers, magnitude, radius};

/// The points c + Σ ξᵢ gᵢ + s with ξᵢ from −1 to 1 and s in a box around 0.
///
/// What rounding adds goes into the box, so that the set holds every exact result.
#[derive(Clone, Debug, PartialEq)]
pub struct Zonotope {
    center: Vec<f64>,
    generators: Vec<Vec<f64>>,
    /// The half widths of the box.
    slack: Vec<f64>,
}

impl Zonotope {
    /// A box.
    pub fn from_box(sides: &[Interval]) -> Self {
        let center: Vec<f64> = sides.iter().map(Interval::midpoint).collect();
        let slack = vec![0.0; sides.len()];
        let generators = sides.iter().enumerate().filter_map(|(axis, side)| {
            let half = radius(*side);
            let mut generator = vec![0.0; sides.len()];
            generator[axis] = half;
            (half > 0.0).then_some(generator)
        });
        Zonotope { generators: generators.collect(), center, slack }
    }

    /// All c + Σ ξᵢ gᵢ with c in `center` and gᵢ in `generators`.
    pub fn from_intervals(center: &[Interval], generators: &[Vec<Interval>]) -> Self {
        let mut zonotope = Zonotope {
            center: center.iter().map(Interval::midpoint).collect(),
            generators: Vec::with_capacity(generators.len()),
            slack: center.iter().map(|entry| radius(*entry)).collect(),
        };
        generators.iter().for_each(|generator| zonotope.push(generator));
        zonotope
    }

    /// How many coordinates points have.
    pub fn dimension(&self) -> usize {
        self.center.len()
    }

    /// The center.
    pub fn center(&self) -> &[f64] {
        &self.center
    }

    /// The generators.
    pub fn generators(&self) -> &[Vec<f64>] {
        &self.generators
    }

    /// The half widths of the box that is added.
    pub fn slack(&self) -> &[f64] {
        &self.slack
    }

    /// At least the largest ℓ · x for points x of the set and directions ℓ in `direction`.
    pub fn support(&self, direction: &[Interval]) -> f64 {
        let center = dot_numbers(direction, &self.center).upper();
        let generators = self.generators.iter();
        let spread = generators.map(|generator| magnitude(dot_numbers(direction, generator)));
        let slack: Vec<Interval> = self.slack.iter().map(|half| around_zero(*half)).collect();
        plus_up(plus_up(center, sum_up(spread)), dot(direction, &slack).upper())
    }

    /// The smallest box around it.
    pub fn hull(&self) -> Vec<Interval> {
        let side = |axis: usize| {
            let spread = self.generators.iter().map(|generator| generator[axis].abs());
            let half = sum_up(spread.chain([self.slack[axis]]));
            Interval::point(self.center[axis]) + around_zero(half)
        };
        (0..self.dimension()).map(side).collect()
    }

    /// Every M x + b for matrices M in `matrix` and offsets b in `offset`.
    #[must_use]
    pub(super) fn mapped(&self, matrix: &IntervalMatrix, offset: &[Interval]) -> Self {
        let center = matrix.apply_to_numbers(&self.center);
        let center: Vec<Interval> = center.iter().zip(offset).map(|(a, b)| *a + *b).collect();
        let generators: Vec<Vec<Interval>> =
            self.generators.iter().map(|generator| matrix.apply_to_numbers(generator)).collect();
        let mut mapped = Zonotope::from_intervals(&center, &generators);
        // A box becomes a parallelotope, with an edge for each axis.
        for (axis, slack) in self.slack.iter().enumerate().filter(|(_, slack)| **slack > 0.0) {
            let column: Vec<Interval> = (0..matrix.rows())
                .map(|row| matrix[(row, axis)] * Interval::point(*slack))
                .collect();
            mapped.push(&column);
        }
        mapped
    }

    /// Adds a generator.
    pub(super) fn push(&mut self, generator: &[Interval]) {
        let radii: Vec<f64> = generator.iter().map(|entry| radius(*entry)).collect();
        self.widen(&radii);
        self.generators.push(generator.iter().map(Interval::midpoint).collect());
    }

    /// Adds a box with these half widths.
    pub(super) fn widen(&mut self, half_widths: &[f64]) {
        for (slack, half_width) in self.slack.iter_mut().zip(half_widths) {
            *slack = plus_up(*slack, *half_width);
        }
    }

    /// The Minkowski sum.
    #[must_use]
    pub(super) fn plus(&self, other: &Zonotope) -> Self {
        let centers = self.center.iter().zip(&other.center);
        let centers: Vec<Interval> =
            centers.map(|(a, b)| Interval::point(*a) + Interval::point(*b)).collect();
        let mut sum = Zonotope::from_intervals(&centers, &[]);
        sum.generators = self.generators.iter().chain(&other.generators).cloned().collect();
        sum.widen(&self.slack);
        sum.widen(&other.slack);
        sum
    }

    /// A zonotope around it with at most `count` generators: those that are nearest to boxes go into
    /// the box (Girard 2005, [doi:10.1007/978-3-540-31954-2_19](https://doi.org/10.1007/978-3-540-31954-2_19)).
    #[must_use]
    pub fn reduced(mut self, count: usize) -> Self {
        if self.generators.len() <= count {
            return self;
        }
        let key = |generator: &[f64]| {
            let (sum, most) = generator.iter().fold((0.0, 0.0f64), |(sum, most), entry| {
                (sum + entry.abs(), most.max(entry.abs()))
            });
            sum - most
        };
        self.generators.sort_by(|one, other| key(other).total_cmp(&key(one)));
        for generator in self.generators.split_off(count) {
            let magnitudes: Vec<f64> = generator.iter().map(|entry| entry.abs()).collect();
            self.widen(&magnitudes);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::exact::{FAINT, fraction, holds, points};

    fn over(lower: f64, upper: f64) -> Interval {
        Interval::new(lower, upper).expect("in order")
    }

    /// Numbers that are seen together only: 1 and twice half a unit in its last place.
    #[test]
    fn hulls_are_rounded_outward() {
        let half = f64::EPSILON / 2.0;
        let generators = [1.0, half, half].map(|generator| points(&[generator]));
        let side = Zonotope::from_intervals(&points(&[0.0]), &generators).hull()[0];
        let exact = fraction(1.0) + fraction(2.0 * half);
        assert!(holds(side, &exact) && holds(side, &-exact));
        let side = Zonotope::from_intervals(&points(&[1.0]), &[points(&[FAINT])]).hull()[0];
        assert!(holds(side, &(fraction(1.0) + fraction(FAINT))));
        assert!(holds(side, &(fraction(1.0) - fraction(FAINT))));
    }

    /// Of one dimension: from where to where it reaches at least, in fractions.
    fn reaches(zonotope: &Zonotope, lower: f64, upper: f64) -> bool {
        let spread = zonotope.generators().iter().map(|generator| fraction(generator[0].abs()));
        let half = spread.fold(fraction(zonotope.slack()[0]), |sum, term| sum + term);
        let center = fraction(zonotope.center()[0]);
        center.clone() - &half <= fraction(lower) && fraction(upper) <= center + half
    }

    #[test]
    fn boxes_and_uncertain_centers_are_covered() {
        for (lower, upper) in [(-FAINT, 1.0), (-1.0, FAINT), (0.1, 0.3)] {
            assert!(reaches(&Zonotope::from_box(&[over(lower, upper)]), lower, upper));
            assert!(reaches(&Zonotope::from_intervals(&[over(lower, upper)], &[]), lower, upper));
        }
    }

    /// 1 and 2⁻⁶⁰ add up to what is no number.
    #[test]
    fn what_is_added_to_the_box_is_rounded_up() {
        let mut zonotope = Zonotope::from_box(&points(&[0.0]));
        zonotope.widen(&[1.0]);
        zonotope.widen(&[FAINT]);
        assert!(fraction(zonotope.slack()[0]) >= fraction(1.0) + fraction(FAINT));

        let mut zonotope = Zonotope::from_box(&points(&[0.0]));
        zonotope.push(&[over(1.0, 3.0)]);
        assert_eq!((zonotope.generators()[0][0], zonotope.slack()[0]), (2.0, 1.0));
    }

    #[test]
    fn sums_hold_the_sums_of_points() {
        let one = Zonotope::from_intervals(&points(&[1.0]), &[points(&[0.5])]);
        let other = Zonotope::from_intervals(&[over(FAINT, 3.0 * FAINT)], &[]);
        let sum = one.plus(&other);
        let half = fraction(0.5) + fraction(sum.slack()[0]);
        let exact = fraction(1.5) + fraction(3.0 * FAINT);
        assert!(fraction(sum.center()[0]) + &half >= exact);
        assert!(fraction(sum.center()[0]) - half <= fraction(0.5) + fraction(FAINT));
        // The boxes of both are in that of the sum.
        let boxed = |half: f64| Zonotope::from_intervals(&[over(-half, half)], &[]);
        assert!(reaches(&boxed(1.0).plus(&boxed(2.0)), -3.0, 3.0));
    }

    #[test]
    fn images_hold_the_images_of_points() {
        let mut matrix = IntervalMatrix::zero(1, 1);
        matrix[(0, 0)] = Interval::point(0.1);
        let mut zonotope = Zonotope::from_intervals(&points(&[0.7]), &[points(&[0.3])]);
        zonotope.widen(&[1.1]);
        let image = zonotope.mapped(&matrix, &points(&[0.9]));
        let gain = fraction(0.1);
        let center = gain.clone() * fraction(0.7) + fraction(0.9);
        let spread = gain * (fraction(0.3) + fraction(1.1));
        assert!(holds(image.hull()[0], &(center.clone() + &spread)));
        assert!(holds(image.hull()[0], &(center - spread)));
    }

    /// The bound in a direction holds the center, every generator and the box.
    #[test]
    fn supports_hold_every_part() {
        let mut zonotope = Zonotope::from_intervals(&points(&[0.7]), &[points(&[0.3])]);
        zonotope.widen(&[1.1]);
        let exact = fraction(0.1) * (fraction(0.7) + fraction(0.3) + fraction(1.1));
        assert!(fraction(zonotope.support(&points(&[0.1]))) >= exact);
        let reduced = zonotope.reduced(0);
        assert!(fraction(reduced.support(&points(&[0.1]))) >= exact);
    }
}
