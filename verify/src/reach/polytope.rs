//! Polytopes in template directions, and linear programs over them that check their own answer.

mod simplex;

use std::sync::Arc;

use pleach_guards::Interval;

use super::vector::{dot_numbers, magnitude};
use simplex::Simplex;

/// Directions in which sets are bounded.
///
/// The first 2 n of them, in n dimensions, are e₁, −e₁, e₂, …, so that every set has a bounding box.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    dimension: usize,
    directions: Vec<Vec<f64>>,
}

impl Template {
    /// The directions of a box.
    pub fn boxes(dimension: usize) -> Self {
        let unit = |axis: usize, sign: f64| {
            let mut direction = vec![0.0; dimension];
            direction[axis] = sign;
            direction
        };
        let directions = (0..dimension).flat_map(|axis| [unit(axis, 1.0), unit(axis, -1.0)]);
        Template { dimension, directions: directions.collect() }
    }

    /// Those of a box and ±eᵢ ± eⱼ for each pair of coordinates.
    pub fn octagons(dimension: usize) -> Self {
        let mut template = Template::boxes(dimension);
        for one in 0..dimension {
            for other in one + 1..dimension {
                for (first, second) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                    let mut direction = vec![0.0; dimension];
                    (direction[one], direction[other]) = (first, second);
                    template.add(direction);
                }
            }
        }
        template
    }

    /// Adds a direction, unless it is there or zero; says where it is.
    pub fn add(&mut self, direction: Vec<f64>) -> Option<usize> {
        if direction.iter().all(|entry| *entry == 0.0) || !direction.iter().all(|e| e.is_finite()) {
            return None;
        }
        let known = self.directions.iter().position(|known| *known == direction);
        Some(known.unwrap_or_else(|| {
            self.directions.push(direction);
            self.directions.len() - 1
        }))
    }

    /// Adds a direction and its opposite.
    pub fn add_both(&mut self, direction: &[f64]) {
        self.add(direction.to_vec());
        self.add(direction.iter().map(|entry| -entry).collect());
    }

    /// How many coordinates the directions have.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The directions.
    pub fn directions(&self) -> &[Vec<f64>] {
        &self.directions
    }

    /// Where this direction is.
    pub(super) fn position(&self, direction: &[f64]) -> Option<usize> {
        self.directions.iter().position(|known| known == direction)
    }
}

/// The points x with d · x ≤ b for each direction d of a template and its bound b.
#[derive(Clone, Debug, PartialEq)]
pub struct Polytope {
    template: Arc<Template>,
    bounds: Vec<f64>,
}

/// What a linear program has shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// No point exceeds this.
    AtMost(f64),
    /// There are no points.
    Empty,
}

impl Polytope {
    /// The polytope with these bounds, one for each direction.
    pub fn new(template: Arc<Template>, bounds: Vec<f64>) -> Self {
        Polytope { template, bounds }
    }

    /// A box, bounded in all directions of a template.
    pub fn around(template: Template, sides: &[Interval]) -> Self {
        let bounds =
            template.directions.iter().map(|direction| over_box(direction, sides)).collect();
        Polytope { template: Arc::new(template), bounds }
    }

    /// The directions.
    pub fn template(&self) -> &Arc<Template> {
        &self.template
    }

    /// The bounds, one for each direction.
    pub fn bounds(&self) -> &[f64] {
        &self.bounds
    }

    /// The bound in a direction of the template.
    pub fn bound(&self, direction: &[f64]) -> Option<f64> {
        self.template.position(direction).map(|place| self.bounds[place])
    }

    /// The box that the first directions bound; `None` if it has no points.
    pub fn hull(&self) -> Option<Vec<Interval>> {
        let side =
            |axis: usize| Interval::new(-self.bounds[2 * axis + 1], self.bounds[2 * axis]).ok();
        (0..self.template.dimension()).map(side).collect()
    }

    /// Bounds direction number `place` by `bound`, if that is less.
    pub fn cut(&mut self, place: usize, bound: f64) {
        self.bounds[place] = self.bounds[place].min(bound);
    }

    /// The smallest polytope of the template around this one and another.
    pub(super) fn join(&mut self, other: &Polytope) {
        for (bound, another) in self.bounds.iter_mut().zip(&other.bounds) {
            *bound = bound.max(*another);
        }
    }

    /// What is in this polytope and in another of the same template.
    #[must_use]
    pub fn intersection(mut self, other: &Polytope) -> Self {
        for (bound, another) in self.bounds.iter_mut().zip(&other.bounds) {
            *bound = bound.min(*another);
        }
        self
    }

    /// Whether opposite bounds contradict each other: then there are no points.
    pub fn is_seen_empty(&self) -> bool {
        (0..self.template.dimension())
            .any(|axis| self.bounds[2 * axis] < -self.bounds[2 * axis + 1])
    }

    /// Whether a point is in it, up to rounding.
    pub fn contains_point(&self, point: &[f64]) -> bool {
        let inside = |(direction, bound): (&Vec<f64>, &f64)| {
            direction.iter().zip(point).map(|(d, x)| d * x).sum::<f64>() <= *bound
        };
        self.template.directions.iter().zip(&self.bounds).all(inside)
    }

    /// The bounds made as small as the others allow; `None` if there are no points.
    #[must_use]
    pub fn tightened(&self) -> Option<Polytope> {
        if self.is_seen_empty() {
            return None;
        }
        let mut tightened = self.clone();
        for (place, direction) in self.template.directions.iter().enumerate() {
            let direction: Vec<Interval> = direction.iter().map(|d| Interval::point(*d)).collect();
            match tightened.support(&direction) {
                Bound::AtMost(bound) => tightened.cut(place, bound),
                Bound::Empty => return None,
            }
        }
        (!tightened.is_seen_empty()).then_some(tightened)
    }

    /// At least the largest ℓ · x for points x and directions ℓ in `direction`.
    ///
    /// By duality every combination y ≥ 0 of the template's directions with Σ yᵢ dᵢ = ℓ bounds ℓ · x
    /// by Σ yᵢ bᵢ. The simplex method in floating-point numbers looks for the best y; the bound is
    /// then computed in intervals, with ℓ − Σ yᵢ dᵢ bounded over the box.
    pub fn support(&self, direction: &[Interval]) -> Bound {
        let Some(sides) = self.hull() else { return Bound::Empty };
        let middle: Vec<f64> = direction.iter().map(Interval::midpoint).collect();
        let mut simplex = Simplex::new(self, &middle);
        let is_bounded = simplex.run();
        if !is_bounded {
            let ray = simplex.ray.clone();
            let nothing = vec![Interval::point(0.0); direction.len()];
            if self.certified(&nothing, &ray, &sides) < 0.0 {
                return Bound::Empty;
            }
        }
        Bound::AtMost(self.certified(direction, &simplex.multipliers(), &sides))
    }

    /// The bound on ℓ · x that these multipliers prove.
    fn certified(
        &self,
        direction: &[Interval],
        multipliers: &[(usize, f64)],
        sides: &[Interval],
    ) -> f64 {
        let mut rest = direction.to_vec();
        let mut bound = Interval::point(0.0);
        for &(place, multiplier) in multipliers.iter().filter(|(_, multiplier)| *multiplier > 0.0) {
            let multiplier = Interval::point(multiplier);
            bound = bound + multiplier * Interval::point(self.bounds[place]);
            for (rest, entry) in rest.iter_mut().zip(&self.template.directions[place]) {
                if *entry != 0.0 {
                    *rest = *rest - multiplier * Interval::point(*entry);
                }
            }
        }
        let left = rest.iter().zip(sides).filter(|(rest, _)| magnitude(**rest) > 0.0);
        let left = left.map(|(rest, side)| *rest * *side);
        left.fold(bound, |sum, term| sum + term).upper()
    }
}

/// At least the largest d · x over a box; along an axis exactly that.
pub(super) fn over_box(direction: &[f64], sides: &[Interval]) -> f64 {
    let mut entries = direction.iter().zip(sides).filter(|(entry, _)| **entry != 0.0);
    match (entries.next(), entries.next()) {
        (Some((1.0, side)), None) => side.upper(),
        (Some((-1.0, side)), None) => -side.lower(),
        _ => dot_numbers(sides, direction).upper(),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::reach::exact::{fraction, points};

    /// Whole numbers up to a million, over 1024: sums of products of three of them are exact.
    fn short() -> impl Strategy<Value = f64> {
        (-1_000_000i32..1_000_000).prop_map(|number| f64::from(number) / 1024.0)
    }

    proptest! {
        /// At a vertex nothing is to spare: multipliers are off by rounding, and what they leave of the
        /// direction has to count.
        #[test]
        fn bounds_hold_at_vertices(
            normals in proptest::collection::vec(proptest::collection::vec(short(), 3), 3),
            vertex in proptest::collection::vec(short(), 3),
            weights in proptest::collection::vec(0.1..1.0f64, 3),
        ) {
            let along = |direction: &[f64]| direction.iter().zip(&vertex).map(|(d, x)| d * x).sum::<f64>();
            let mut template = Template::boxes(3);
            let tight: Vec<Option<usize>> = normals.iter().map(|n| template.add(n.clone())).collect();
            let bounds = template.directions().iter().enumerate().map(|(place, direction)| {
                along(direction) + if tight.contains(&Some(place)) { 0.0 } else { 1e6 }
            });
            let polytope = Polytope::new(template.clone().into(), bounds.collect());
            let combined: Vec<f64> = (0..3)
                .map(|axis| normals.iter().zip(&weights).map(|(n, weight)| weight * n[axis]).sum())
                .collect();
            let exact = |direction: &[f64]| {
                let terms = direction.iter().zip(&vertex).map(|(d, x)| fraction(*d) * fraction(*x));
                terms.reduce(|sum, term| sum + term).unwrap()
            };
            let Bound::AtMost(bound) = polytope.support(&points(&combined)) else {
                return Err(TestCaseError::fail("it has a vertex"));
            };
            prop_assert!(fraction(bound) >= exact(&combined));
            prop_assert!(fraction(over_box(&combined, &points(&vertex))) >= exact(&combined));
        }
    }

    /// What a multiplier proves is rounded up, and so is what it leaves of a direction.
    #[test]
    fn certificates_are_rounded_up() {
        let three = points(&[3.0]);
        let bound = Polytope::around(Template::boxes(1), &three).certified(
            &points(&[0.7]),
            &[(0, 0.7)],
            &three,
        );
        assert!(fraction(bound) >= fraction(0.7) * fraction(3.0));
        // In direction (0.7, −ℓ), where ℓ is 3 · 0.7 rounded down, (3, 1) is farther than 0.
        let mut template = Template::boxes(2);
        let place = template.add(vec![1.0, -3.0]).expect("it is new");
        let sides = points(&[3.0, 1.0]);
        let mut polytope = Polytope::around(template, &sides);
        polytope.cut(place, 0.0);
        let product = 0.7 * 3.0;
        assert!(fraction(product) < fraction(0.7) * fraction(3.0));
        let bound = polytope.certified(&points(&[0.7, -product]), &[(place, 0.7)], &sides);
        assert!(fraction(bound) >= fraction(0.7) * fraction(3.0) - fraction(product));
    }

    /// Multipliers that are wrong make a bound worse, and never false.
    #[test]
    fn wrong_multipliers_prove_less() {
        let sides = [(0.1, 0.3), (-0.7, 0.9)].map(|(l, u)| Interval::new(l, u).expect("in order"));
        let square = Polytope::around(Template::boxes(2), &sides);
        let direction = points(&[1.1, 0.7]);
        let exact = fraction(1.1) * fraction(0.3) + fraction(0.7) * fraction(0.9);
        for multipliers in [vec![], vec![(0, 1.1)], vec![(0, 2.0), (2, 0.7)], vec![(1, 0.3)]] {
            let bound = square.certified(&direction, &multipliers, &sides);
            assert!(fraction(bound) >= exact, "{multipliers:?}: {bound}");
        }
    }
}
