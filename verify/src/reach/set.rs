//! Sets of states from which flows begin.

use pleach_guards::Interval;

use super::polytope::{Bound, Polytope, over_box};
use super::vector::dot;
use super::zonotope::Zonotope;

/// A convex set: what lies in all of its descriptions. One of them at least is there.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSet {
    hull: Vec<Interval>,
    zonotope: Option<Zonotope>,
    polytope: Option<Polytope>,
}

impl StateSet {
    /// A box.
    pub fn from_box(sides: Vec<Interval>) -> Self {
        StateSet { hull: sides, zonotope: None, polytope: None }
    }

    /// The boxes that a box is cut into, `counts` of them along each axis (1 where a count is missing);
    /// any other set stays whole.
    pub fn parts(&self, counts: &[usize]) -> Vec<StateSet> {
        if self.zonotope.is_some() || self.polytope.is_some() {
            return vec![self.clone()];
        }
        let mut boxes = vec![Vec::new()];
        for (axis, side) in self.hull.iter().enumerate() {
            let count = counts.get(axis).copied().unwrap_or(1).max(1);
            let place = |number: usize| match number {
                0 => side.lower(),
                _ if number == count => side.upper(),
                _ => side.lower() + number as f64 / count as f64 * side.width(),
            };
            let part =
                |number: usize| Interval::new(place(number), place(number + 1)).unwrap_or(*side);
            let extended = |sides: &Vec<Interval>| {
                let sides = sides.clone();
                (0..count).map(move |number| [&sides[..], &[part(number)]].concat())
            };
            boxes = boxes.iter().flat_map(extended).collect();
        }
        boxes.into_iter().map(StateSet::from_box).collect()
    }

    /// A zonotope.
    pub fn from_zonotope(zonotope: Zonotope) -> Self {
        StateSet { hull: zonotope.hull(), zonotope: Some(zonotope), polytope: None }
    }

    /// A polytope; `None` if it has no points.
    pub fn from_polytope(polytope: Polytope) -> Option<Self> {
        let hull = polytope.hull()?;
        let is_box = polytope.template().directions().len() == 2 * hull.len();
        let polytope = (!is_box).then_some(polytope);
        Some(StateSet { hull, zonotope: None, polytope })
    }

    /// What lies in this set and in a zonotope.
    #[must_use]
    pub(super) fn within(mut self, zonotope: Zonotope) -> Self {
        for (side, other) in self.hull.iter_mut().zip(zonotope.hull()) {
            *side = side.intersection(other).unwrap_or(*side);
        }
        self.zonotope = Some(zonotope);
        self
    }

    /// What lies in this set and in a polytope; `None` if there is nothing.
    #[must_use]
    pub(super) fn cut_to(mut self, polytope: Polytope) -> Option<Self> {
        for (side, other) in self.hull.iter_mut().zip(polytope.hull()?) {
            *side = side.intersection(other)?;
        }
        let is_box = polytope.template().directions().len() == 2 * self.hull.len();
        if !is_box {
            self.polytope = Some(polytope);
        }
        Some(self)
    }

    /// Whether every point of `other` is seen to be in this set.
    pub fn contains(&self, other: &StateSet) -> bool {
        let known = |direction: &[f64]| other.polytope.as_ref()?.bound(direction);
        self.holds_bounds(&other.hull, |direction| {
            known(direction).unwrap_or_else(|| other.support(&points(direction)))
        })
    }

    /// Whether every point of a polytope is seen to be in this set.
    pub(super) fn contains_polytope(&self, other: &Polytope) -> bool {
        let Some(sides) = other.hull() else { return true };
        self.holds_bounds(&sides, |direction| {
            other.bound(direction).unwrap_or_else(|| over_box(direction, &sides))
        })
    }

    /// Whether what is in a box and has these bounds in directions is in this set.
    fn holds_bounds(&self, sides: &[Interval], bound: impl Fn(&[f64]) -> f64) -> bool {
        let in_hull =
            self.hull.iter().zip(sides).all(|(outer, inner)| {
                outer.lower() <= inner.lower() && inner.upper() <= outer.upper()
            });
        let in_polytope = |polytope: &Polytope| {
            let directions = polytope.template().directions().iter();
            directions.zip(polytope.bounds()).all(|(direction, most)| bound(direction) <= *most)
        };
        // No list of bounds is known that says what is in a zonotope.
        self.zonotope.is_none() && in_hull && self.polytope.iter().all(in_polytope)
    }

    /// A point of it; `draw` gives numbers from −1 to 1. `None` if none is found.
    ///
    /// A point that half-spaces cut off is drawn back towards one that they do not.
    pub(super) fn point(&self, draw: &mut impl FnMut() -> f64) -> Option<Vec<f64>> {
        /// How often a point is drawn.
        const DRAWS: usize = 256;
        /// How often the way between two points is halved.
        const HALVINGS: usize = 40;
        let zonotope = self.to_zonotope();
        let mut drawn = || {
            let mut point = zonotope.center().to_vec();
            for generator in zonotope.generators() {
                let share = draw();
                point.iter_mut().zip(generator).for_each(|(entry, g)| *entry += share * g);
            }
            let clamped = |(entry, side): (f64, &Interval)| entry.clamp(side.lower(), side.upper());
            point.into_iter().zip(&self.hull).map(clamped).collect::<Vec<f64>>()
        };
        let is_inside =
            |point: &[f64]| self.polytope.iter().all(|polytope| polytope.contains_point(point));
        let wanted = drawn();
        if is_inside(&wanted) {
            return Some(wanted);
        }
        let mut inside = (0..DRAWS).map(|_| drawn()).find(|point| is_inside(point))?;
        let mut outside = wanted;
        for _ in 0..HALVINGS {
            let middle: Vec<f64> =
                inside.iter().zip(&outside).map(|(one, other)| one.midpoint(*other)).collect();
            if is_inside(&middle) { inside = middle } else { outside = middle }
        }
        Some(inside)
    }

    /// Whether a zonotope is part of the description.
    pub fn has_zonotope(&self) -> bool {
        self.zonotope.is_some()
    }

    /// The polytope that it is cut by, if there is one.
    pub fn polytope(&self) -> Option<&Polytope> {
        self.polytope.as_ref()
    }

    /// A box around it.
    pub fn hull(&self) -> &[Interval] {
        &self.hull
    }

    /// A zonotope around it.
    pub fn to_zonotope(&self) -> Zonotope {
        self.zonotope.clone().unwrap_or_else(|| Zonotope::from_box(&self.hull))
    }

    /// At least the largest ℓ · x for points x and directions ℓ in `direction`; −∞ if it is seen that
    /// there are no points.
    pub fn support(&self, direction: &[Interval]) -> f64 {
        let boxed = dot(direction, &self.hull).upper();
        let by_zonotope = self.zonotope.iter().map(|zonotope| zonotope.support(direction));
        let by_polytope = self.polytope.iter().map(|polytope| match polytope.support(direction) {
            Bound::AtMost(bound) => bound,
            Bound::Empty => f64::NEG_INFINITY,
        });
        by_zonotope.chain(by_polytope).fold(boxed, f64::min)
    }
}

/// A direction as intervals.
fn points(direction: &[f64]) -> Vec<Interval> {
    direction.iter().map(|entry| Interval::point(*entry)).collect()
}
