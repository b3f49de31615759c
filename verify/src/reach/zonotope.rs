//! Zonotopes: sums of segments.

use pleach_guards::Interval;

use super::vector::{IntervalMatrix, dot_numbers, magnitude, radius, sum_up};

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
        let mut slack: Vec<f64> = center.iter().map(|entry| radius(*entry)).collect();
        for generator in generators {
            for (slack, entry) in slack.iter_mut().zip(generator) {
                *slack = (*slack + radius(*entry)).next_up();
            }
        }
        let middles = |entries: &[Interval]| entries.iter().map(Interval::midpoint).collect();
        let generators = generators.iter().map(|generator| middles(generator)).collect();
        Zonotope { center: middles(center), generators, slack }
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
        let boxed = direction.iter().zip(&self.slack);
        let boxed = boxed.map(|(entry, slack)| (magnitude(*entry) * slack).next_up());
        (center + sum_up(spread.chain(boxed))).next_up()
    }

    /// The smallest box around it.
    pub fn hull(&self) -> Vec<Interval> {
        let side = |axis: usize| {
            let spread = self.generators.iter().map(|generator| generator[axis].abs());
            let half = sum_up(spread.chain([self.slack[axis]]));
            Interval::point(self.center[axis]) + super::vector::around_zero(half)
        };
        (0..self.dimension()).map(side).collect()
    }

    /// Every M x + b for matrices M in `matrix` and offsets b in `offset`.
    #[must_use]
    pub fn mapped(&self, matrix: &IntervalMatrix, offset: &[Interval]) -> Self {
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
    pub fn push(&mut self, generator: &[Interval]) {
        for (slack, entry) in self.slack.iter_mut().zip(generator) {
            *slack = (*slack + radius(*entry)).next_up();
        }
        self.generators.push(generator.iter().map(Interval::midpoint).collect());
    }

    /// Adds a box with these half widths.
    pub fn widen(&mut self, half_widths: &[f64]) {
        for (slack, half_width) in self.slack.iter_mut().zip(half_widths) {
            *slack = (*slack + half_width).next_up();
        }
    }

    /// The Minkowski sum.
    #[must_use]
    pub fn plus(&self, other: &Zonotope) -> Self {
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
