//! A tree of boxes over edges, for queries on outlines with thousands of edges.
//!
//! parry provides the hierarchy of boxes. Boxes only rule edges out: an edge in a box that remains is decided by its own
//! exact test or by its own distance, so that every answer is the one of a scan over all edges, whatever the hierarchy.

use std::cell::Cell;

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::Vector as Corner;
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode, TraversalAction};

use super::Segment;
use super::segment::side;
use crate::{Point, Vector};

/// Relative rounding error that the tests of boxes allow for: more than the dozen operations of such a test, or of the
/// distance to an edge, can sum up to.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Edges under a hierarchy of bounding boxes.
#[derive(Debug, Clone)]
pub(super) struct EdgeTree {
    edges: Vec<Segment>,
    boxes: Bvh,
}

impl EdgeTree {
    /// Coordinates are finite, and small enough for their squares.
    pub(super) fn new(edges: impl IntoIterator<Item = Segment>) -> EdgeTree {
        let edges: Vec<Segment> = edges.into_iter().collect();
        let leaves = edges.iter().map(|edge| Bounds::of(edge).into()).enumerate();
        let boxes = Bvh::from_iter(BvhBuildStrategy::Binned, leaves);
        EdgeTree { edges, boxes }
    }

    pub(super) fn edges(&self) -> &[Segment] {
        &self.edges
    }

    /// Whether `path` passes from one side of some edge to the other.
    pub(super) fn is_crossed_by(&self, path: &Segment) -> bool {
        let probe = Probe::new(path);
        self.any(|bounds| bounds.meets(&probe), |_, edge| edge.is_crossed_by(path))
    }

    /// Whether `point` lies inside the rings that the edges form (even-odd rule). Exact, but for
    /// points on an edge either answer may come.
    pub(super) fn encloses(&self, point: Point) -> bool {
        let mut inside = false;
        if self.surrounds(point) {
            self.for_each_right_of(point, |_| inside = !inside);
        }
        inside
    }

    /// Whether `point` lies in the box around all edges.
    pub(super) fn surrounds(&self, point: Point) -> bool {
        self.around().holds(point)
    }

    /// Visits every edge that a ray from `point` to the right crosses, by its index, in no particular order. Exact, but
    /// for points on an edge, which may be visited or not.
    pub(super) fn for_each_right_of(&self, point: Point, mut visit: impl FnMut(usize)) {
        self.any(
            |bounds| {
                bounds.low.y <= point.y && point.y <= bounds.high.y && point.x <= bounds.high.x
            },
            |index, edge| {
                let rises = edge.to.y > point.y;
                if (edge.from.y > point.y) != rises
                    && (side(edge.from, edge.to, point) > 0.0) == rises
                {
                    visit(index);
                }
                false
            },
        );
    }

    /// Distance from `point` to the nearest edge; infinite without edges.
    pub(super) fn distance(&self, point: Point) -> f64 {
        self.nearest(point).map_or(f64::INFINITY, |(_, nearest)| (nearest - point).norm())
    }

    /// The nearest edge, by its index, and its point nearest to `point`. Of several, the first.
    pub(super) fn nearest(&self, point: Point) -> Option<(usize, Point)> {
        let around = self.widened(Bounds::at(point));
        let (_, index) = self.least(
            |bounds| bounds.gap_squared(&around),
            |edge| (edge.nearest(point) - point).norm_squared(),
        )?;
        Some((index, self.edges[index].nearest(point)))
    }

    /// Distance from `path` to the nearest edge; 0 if they meet, infinite without edges.
    pub(super) fn distance_to_segment(&self, path: &Segment) -> f64 {
        let around = self.widened(Bounds::of(path));
        let nearest =
            self.least(|bounds| bounds.gap_squared(&around).sqrt(), |edge| edge.distance_to(path));
        nearest.map_or(f64::INFINITY, |(distance, _)| distance)
    }

    /// Whether `path` meets an edge or comes closer to one than `distance`.
    pub(super) fn is_near(&self, path: &Segment, distance: f64) -> bool {
        let around = self.widened(Bounds::of(path));
        self.any(
            |bounds| bounds.gap_squared(&around) <= distance * distance,
            |_, edge| {
                let apart = edge.distance_to(path);
                apart < distance || apart == 0.0
            },
        )
    }

    /// The edges with a point within `radius` of `center`, with their indices, ascending.
    pub(super) fn near(&self, center: Point, radius: f64) -> Vec<(usize, &Segment)> {
        let around = self.widened(Bounds::at(center));
        self.all(
            |bounds| bounds.gap_squared(&around) <= radius * radius,
            |edge| edge.distance(center) <= radius,
        )
    }

    /// The edges whose boxes meet the box of `segment`, with their indices, ascending.
    pub(super) fn overlapping(&self, segment: &Segment) -> Vec<(usize, &Segment)> {
        let around = Bounds::of(segment);
        self.all(|bounds| !bounds.is_apart_from(&around), |_| true)
    }

    /// The edges that `is_wanted`, with their indices, ascending. `may_hold` admits every box around any of them.
    fn all(
        &self,
        may_hold: impl Fn(&Bounds) -> bool,
        is_wanted: impl Fn(&Segment) -> bool,
    ) -> Vec<(usize, &Segment)> {
        let mut wanted = Vec::new();
        self.any(may_hold, |index, edge| {
            if is_wanted(edge) {
                wanted.push((index, edge));
            }
            false
        });
        wanted.sort_unstable_by_key(|&(index, _)| index);
        wanted
    }

    /// Visits edges in boxes that `may_hold` admits, in no particular order, until `is_wanted` holds for one; returns
    /// whether it did.
    fn any<'tree>(
        &'tree self,
        may_hold: impl Fn(&Bounds) -> bool,
        mut is_wanted: impl FnMut(usize, &'tree Segment) -> bool,
    ) -> bool {
        let mut found = false;
        self.boxes.traverse(|node| {
            if !may_hold(&node.into()) {
                return TraversalAction::Prune;
            }
            if let Some(index) = node.leaf_data() {
                found = is_wanted(index as usize, &self.edges[index as usize]);
            }
            if found { TraversalAction::EarlyExit } else { TraversalAction::Continue }
        });
        found
    }

    /// The least cost of an edge, with the first edge that has it, by its index. A box costs no more than any edge in it.
    /// What is not a number is never the least.
    fn least(
        &self,
        of_box: impl Fn(&Bounds) -> f64,
        of_edge: impl Fn(&Segment) -> f64,
    ) -> Option<(f64, usize)> {
        let least = Cell::new(None);
        let below = |node: &BvhNode, _| of_box(&node.into());
        let try_edge = |index: u32, _| {
            let index = index as usize;
            let cost = of_edge(&self.edges[index]);
            if !cost.is_nan() && least.get().is_none_or(|least| (cost, index) < least) {
                least.set(Some((cost, index)));
            }
            // parry enters boxes that cost less: with this, also those that cost as much, for an earlier edge.
            Some(cost.next_up())
        };
        self.boxes.find_best(f64::INFINITY, below, try_edge);
        least.get()
    }

    /// The box around all edges. Without edges, it is apart from every other.
    fn around(&self) -> Bounds {
        self.boxes.root_aabb().into()
    }

    /// A box widened by so much that no rounding error puts an edge nearer to its inside than the edge's box to it.
    fn widened(&self, bounds: Bounds) -> Bounds {
        bounds.widened(ROUNDING * (self.around().largest() + bounds.largest()))
    }
}

/// A box with sides along the axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: Point,
    high: Point,
}

impl From<&BvhNode> for Bounds {
    fn from(node: &BvhNode) -> Bounds {
        node.aabb().into()
    }
}

impl From<Aabb> for Bounds {
    fn from(Aabb { mins, maxs }: Aabb) -> Bounds {
        Bounds { low: Point::new(mins.x, mins.y), high: Point::new(maxs.x, maxs.y) }
    }
}

impl From<Bounds> for Aabb {
    fn from(Bounds { low, high }: Bounds) -> Aabb {
        Aabb { mins: Corner::new(low.x, low.y), maxs: Corner::new(high.x, high.y) }
    }
}

impl Bounds {
    fn of(segment: &Segment) -> Bounds {
        let Segment { from, to } = segment;
        Bounds {
            low: Point::new(from.x.min(to.x), from.y.min(to.y)),
            high: Point::new(from.x.max(to.x), from.y.max(to.y)),
        }
    }

    fn at(point: Point) -> Bounds {
        Bounds { low: point, high: point }
    }

    /// The smallest box around some points.
    pub(super) fn around(points: impl Iterator<Item = Point>) -> Option<Bounds> {
        points.map(Bounds::at).reduce(Bounds::union)
    }

    /// The smallest box around two.
    fn union(self, other: Bounds) -> Bounds {
        Bounds { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// The box with its sides moved outwards.
    pub(super) fn widened(self, by: f64) -> Bounds {
        let by = Vector::new(by, by);
        Bounds { low: self.low - by, high: self.high + by }
    }

    pub(super) fn holds(&self, point: Point) -> bool {
        (0..2).all(|axis| self.low[axis] <= point[axis] && point[axis] <= self.high[axis])
    }

    fn is_apart_from(&self, other: &Bounds) -> bool {
        (0..2).any(|axis| self.low[axis] > other.high[axis] || other.low[axis] > self.high[axis])
    }

    /// The square of the distance between the boxes: 0 if they overlap.
    fn gap_squared(&self, other: &Bounds) -> f64 {
        let along = |axis: usize| {
            (self.low[axis] - other.high[axis]).max(other.low[axis] - self.high[axis]).max(0.0)
        };
        along(0).powi(2) + along(1).powi(2)
    }

    /// The largest magnitude of a coordinate.
    fn largest(&self) -> f64 {
        largest(self.low).max(largest(self.high))
    }

    /// Whether the box may meet a path: false only if a line parallel to an axis or to the path
    /// separates them with room to spare for rounding.
    fn meets(&self, path: &Probe) -> bool {
        if self.is_apart_from(&path.around) {
            return false;
        }
        let half = (self.high - self.low) / 2.0;
        let center = self.low + half - path.from;
        let reach = path.spans.x * half.y + path.spans.y * half.x;
        let size = largest(self.low) + largest(self.high) + path.size;
        let rounding = ROUNDING * size * path.spans.x.max(path.spans.y);
        path.along.perp(&center).abs() <= reach + rounding
    }
}

/// A path, with all that the test whether boxes meet it needs of it.
struct Probe {
    from: Point,
    along: Vector,
    around: Bounds,
    /// The magnitudes of the components of `along`.
    spans: Vector,
    /// The largest magnitude of a coordinate of `from`.
    size: f64,
}

impl Probe {
    fn new(path: &Segment) -> Probe {
        let along = path.vector();
        let spans = along.abs();
        Probe { from: path.from, along, around: Bounds::of(path), spans, size: largest(path.from) }
    }
}

fn largest(point: Point) -> f64 {
    point.x.abs().max(point.y.abs())
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    /// Near the points of a grid far from the origin: many distances are equal, or equal up to rounding.
    fn place() -> impl Strategy<Value = Point> {
        let coordinate = (0..6, 0..3)
            .prop_map(|(cell, aside)| 1e3 + f64::from(cell) / 7.0 + f64::from(aside) * 1e-13);
        (coordinate.clone(), coordinate).prop_map(|(x, y)| Point::new(x, y))
    }

    fn edge() -> impl Strategy<Value = Segment> {
        (place(), place()).prop_map(|(from, to)| Segment::new(from, to))
    }

    fn scan(edges: &[Segment], is_wanted: impl Fn(&Segment) -> bool) -> Vec<(usize, &Segment)> {
        edges.iter().enumerate().filter(|(_, edge)| is_wanted(edge)).collect()
    }

    proptest! {
        #![proptest_config(cases::usually(500))]

        #[test]
        fn edges_are_those_of_a_scan(edges in vec(edge(), 1..40), path in edge(), point in place()) {
            let tree = EdgeTree::new(edges.iter().copied());
            let around = Bounds::of(&path);
            let overlapping = scan(&edges, |edge| !Bounds::of(edge).is_apart_from(&around));
            prop_assert_eq!(tree.overlapping(&path), overlapping);
            let crossed = scan(&edges, |edge| edge.is_crossed_by(&path));
            prop_assert_eq!(tree.is_crossed_by(&path), !crossed.is_empty());
            let radius = edges[0].distance(point);
            prop_assert_eq!(tree.near(point, radius), scan(&edges, |edge| edge.distance(point) <= radius));
        }

        #[test]
        fn distances_are_those_of_a_scan(edges in vec(edge(), 1..40), path in edge(), point in place()) {
            let tree = EdgeTree::new(edges.iter().copied());
            let to_path = edges.iter().map(|edge| edge.distance_to(&path)).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(tree.distance_to_segment(&path), to_path);
            prop_assert_eq!(tree.is_near(&path, to_path), to_path == 0.0);
            prop_assert!(tree.is_near(&path, to_path.next_up()));
            let squared = |edge: &Segment| (edge.nearest(point) - point).norm_squared();
            let nearest = (0..edges.len()).min_by(|&one, &other| squared(&edges[one]).total_cmp(&squared(&edges[other])));
            prop_assert_eq!(tree.nearest(point).map(|(index, _)| index), nearest);
        }
    }

    #[test]
    fn boxes_are_as_far_apart_as_their_nearest_points() {
        let bounds = |low: (f64, f64), high: (f64, f64)| Bounds {
            low: Point::new(low.0, low.1),
            high: Point::new(high.0, high.1),
        };
        let own = bounds((0.0, 0.0), (1.0, 1.0));
        for (other, squared) in [
            (bounds((4.0, 5.0), (6.0, 6.0)), 25.0),
            (bounds((-3.0, 0.5), (-2.0, 0.6)), 4.0),
            (bounds((0.5, 0.5), (2.0, 2.0)), 0.0),
        ] {
            assert_eq!([own.gap_squared(&other), other.gap_squared(&own)], [squared; 2]);
        }
    }

    #[test]
    fn a_tree_without_edges_has_none_near() {
        let tree = EdgeTree::new([]);
        let (origin, away) = (Point::origin(), Point::new(1.0, 1.0));
        assert!(tree.nearest(origin).is_none() && tree.distance(origin).is_infinite());
        assert!(!tree.surrounds(origin) && !tree.is_crossed_by(&Segment::new(origin, away)));
    }

    #[test]
    fn a_single_edge_overlaps_what_meets_its_box() {
        let edge = Segment::new(Point::new(1.0, 0.0), Point::new(1.0, 2.0));
        let tree = EdgeTree::new([edge]);
        assert_eq!(tree.nearest(Point::origin()), Some((0, edge.from)));
        for (reach, expected) in [(0.5, 0), (1.0, 1)] {
            let path = Segment::new(Point::origin(), Point::new(reach, 0.0));
            assert_eq!(tree.overlapping(&path).len(), expected);
        }
    }

    #[test]
    fn of_several_nearest_edges_the_first_counts() {
        let ends = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let corners = ends.map(|(x, y)| Point::new(x, y));
        for shift in 0..4 {
            let corner = |at: usize| corners[(at + shift) % 4];
            let tree = EdgeTree::new((0..4).map(|at| Segment::new(corner(at), corner(at + 1))));
            assert_eq!(tree.nearest(Point::new(0.5, 0.5)).unwrap().0, 0);
        }
    }
}
