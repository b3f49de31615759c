//! Line segments: distances, and the exact test whether a path crosses an edge.

use serde::{Deserialize, Serialize};

use crate::{Point, Vector};

/// The straight line between two points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Where it starts.
    pub from: Point,
    /// Where it ends.
    pub to: Point,
}

impl Segment {
    /// The segment between two points.
    pub fn new(from: Point, to: Point) -> Segment {
        Segment { from, to }
    }

    /// A place: the segment of length zero.
    pub fn still(place: Point) -> Segment {
        Segment { from: place, to: place }
    }

    /// The first half.
    pub fn halved(&self) -> Segment {
        Segment { from: self.from, to: nalgebra::center(&self.from, &self.to) }
    }

    /// The point at a share of the way, 0 at the start and 1 at the end.
    pub fn at(&self, share: f64) -> Point {
        self.from + self.vector() * share
    }

    /// The displacement from start to end.
    pub fn vector(&self) -> Vector {
        self.to - self.from
    }

    /// The distance between the ends.
    pub fn length(&self) -> f64 {
        self.vector().norm()
    }

    /// The unit vector a quarter turn to the left of the direction; zero for a single point.
    pub fn left_normal(&self) -> Vector {
        let along = self.vector();
        let length = along.norm();
        if length == 0.0 { Vector::zeros() } else { Vector::new(-along.y, along.x) / length }
    }

    /// The point of the segment nearest to `point`.
    pub fn nearest(&self, point: Point) -> Point {
        let along = self.vector();
        let fraction = along.dot(&(point - self.from)) / along.norm_squared();
        if fraction >= 1.0 {
            self.to
        } else if fraction > 0.0 {
            self.from + along * fraction
        } else {
            self.from // also for a segment that is a single point, where the fraction is not a number
        }
    }

    /// Distance to the nearest point of the segment.
    pub fn distance(&self, point: Point) -> f64 {
        (point - self.nearest(point)).norm()
    }

    /// A pair of closest points: the first on this segment, the second on `other`.
    pub(super) fn closest(&self, other: &Segment) -> (Point, Point) {
        if let Some(common) = self.crossing_point(other) {
            return (common, common);
        }
        let pairs = [
            (self.nearest(other.from), other.from),
            (self.nearest(other.to), other.to),
            (self.from, other.nearest(self.from)),
            (self.to, other.nearest(self.to)),
        ];
        let gap = |pair: &(Point, Point)| (pair.1 - pair.0).norm_squared();
        pairs
            .into_iter()
            .fold(pairs[0], |best, pair| if gap(&pair) < gap(&best) { pair } else { best })
    }

    /// Distance between the two segments; 0 if they meet.
    pub fn distance_to(&self, other: &Segment) -> f64 {
        let (here, there) = self.closest(other);
        (there - here).norm()
    }

    /// Whether `path` passes from one side of this edge to the other. Exact, and the same for both
    /// directions of the path.
    ///
    /// Points on the line of the edge count as left of it, and ends of the edge on the line of the
    /// path as below it. Where a path runs exactly through a corner, it therefore crosses one of
    /// the two edges there if these lie on different sides of it, and both or none if they lie on
    /// the same side (a path that grazes a corner may count as crossing).
    pub(super) fn is_crossed_by(&self, path: &Segment) -> bool {
        let starts_left = side(self.from, self.to, path.from) >= 0.0;
        let ends_left = side(self.from, self.to, path.to) >= 0.0;
        if starts_left == ends_left {
            return false;
        }
        let runs_right = (path.from.x, path.from.y) <= (path.to.x, path.to.y);
        let (left, right) = if runs_right { (path.from, path.to) } else { (path.to, path.from) };
        (side(left, right, self.from) > 0.0) != (side(left, right, self.to) > 0.0)
    }

    /// Whether the two segments have a point in common. Exact.
    pub(super) fn meets(&self, other: &Segment) -> bool {
        let sides = |line: &Segment, cut: &Segment| {
            (side(line.from, line.to, cut.from), side(line.from, line.to, cut.to))
        };
        let (a, b) = sides(self, other);
        let (c, d) = sides(other, self);
        if a == 0.0 && b == 0.0 && c == 0.0 && d == 0.0 {
            return self.boxes_overlap(other);
        }
        opposite_or_on(a, b) && opposite_or_on(c, d)
    }

    /// Where the segments cross, if each has ends strictly on both sides of the other.
    pub(super) fn crossing_point(&self, other: &Segment) -> Option<Point> {
        let (a, b) = (side(self.from, self.to, other.from), side(self.from, self.to, other.to));
        let (c, d) = (side(other.from, other.to, self.from), side(other.from, other.to, self.to));
        let crosses = are_opposite(a, b) && are_opposite(c, d);
        crosses.then(|| self.from + self.vector() * (c / (c - d)))
    }

    /// Where this edge meets `path`, as shares of the way: at most two, the ends of what they have in common.
    pub(super) fn shares_on(&self, path: &Segment) -> impl Iterator<Item = f64> + use<> {
        let (from, to) = (side(self.from, self.to, path.from), side(self.from, self.to, path.to));
        let along = path.vector();
        let shares = match self.meets(path) {
            false => [None, None],
            true if from == 0.0 && to == 0.0 => [self.from, self.to].map(|end| {
                Some((along.dot(&(end - path.from)) / along.norm_squared()).clamp(0.0, 1.0))
            }),
            true => [Some(from / (from - to)), None],
        };
        shares.into_iter().flatten()
    }

    fn boxes_overlap(&self, other: &Segment) -> bool {
        (0..2).all(|axis| {
            let (a, b) = (self.from[axis], self.to[axis]);
            let (c, d) = (other.from[axis], other.to[axis]);
            a.min(b) <= c.max(d) && c.min(d) <= a.max(b)
        })
    }
}

/// Not by the sign of the product, which for tiny numbers is 0.
fn are_opposite(one: f64, other: f64) -> bool {
    one > 0.0 && other < 0.0 || one < 0.0 && other > 0.0
}

/// As [`are_opposite`].
pub(super) fn are_alike(one: f64, other: f64) -> bool {
    one > 0.0 && other > 0.0 || one < 0.0 && other < 0.0
}

fn opposite_or_on(one: f64, other: f64) -> bool {
    !are_alike(one, other)
}

/// On which side of the line from `from` to `to` the `point` lies: positive on the left, negative
/// on the right, 0 on the line. The sign is exact.
///
/// J. R. Shewchuk, *Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates*, <https://doi.org/10.1007/PL00009321>.
pub(super) fn side(from: Point, to: Point, point: Point) -> f64 {
    let coord = |p: Point| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(from), coord(to), coord(point))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_cross_where_both_have_ends_on_either_side() {
        let segment =
            |a: (f64, f64), b: (f64, f64)| Segment::new(Point::new(a.0, a.1), Point::new(b.0, b.1));
        let flat = segment((0.0, 1.0), (4.0, 1.0));
        let crossing = |b: (f64, f64)| flat.crossing_point(&segment((1.0, 0.0), b));
        assert_eq!(crossing((1.0, 4.0)), Some(Point::new(1.0, 1.0)));
        assert_eq!(crossing((3.0, 2.0)), Some(Point::new(2.0, 1.0)));
        assert_eq!(crossing((1.0, 1.0)), None, "it ends there");
        assert_eq!(crossing((9.0, 2.0)), None, "it passes beside");
    }

    /// Where products of areas are too small for numbers.
    #[test]
    fn tiny_segments_cross_as_well() {
        let scale = (-280.0_f64).exp2();
        let segment = |a: (f64, f64), b: (f64, f64)| {
            Segment::new(Point::new(a.0, a.1) * scale, Point::new(b.0, b.1) * scale)
        };
        let (one, other) = (segment((0.0, 0.0), (2.0, 2.0)), segment((0.0, 2.0), (2.0, 0.0)));
        assert_eq!(one.crossing_point(&other), Some(Point::new(scale, scale)));
        assert_eq!(one.distance_to(&other), 0.0);
    }

    #[test]
    fn an_edge_meets_a_path_at_shares_of_it() {
        let segment =
            |a: (f64, f64), b: (f64, f64)| Segment::new(Point::new(a.0, a.1), Point::new(b.0, b.1));
        let path = segment((1.0, 1.0), (5.0, 1.0));
        for (edge, shares) in [
            (segment((2.0, 0.0), (2.0, 3.0)), vec![0.25]),
            (segment((4.0, 1.0), (2.0, 3.0)), vec![0.75]),
            (segment((5.0, 0.0), (5.0, 1.0)), vec![1.0]),
            (segment((2.0, 1.0), (3.0, 1.0)), vec![0.25, 0.5]),
            (segment((0.0, 1.0), (9.0, 1.0)), vec![0.0, 1.0]),
            (segment((6.0, 1.0), (9.0, 1.0)), vec![]),
            (segment((2.0, 2.0), (2.0, 3.0)), vec![]),
        ] {
            assert_eq!(edge.shares_on(&path).collect::<Vec<_>>(), shares, "{edge:?}");
        }
    }
}
