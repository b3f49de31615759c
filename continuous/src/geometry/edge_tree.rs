//! A tree of boxes over edges: the questions that are asked of outlines with thousands of edges.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::{Bvh, BvhNode};

use super::Segment;
use super::segment::side;
use crate::{Point, Vector};

/// Relative rounding error that the test of a box against a path allows for: more than its dozen
/// operations can sum up to.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Edges under a hierarchy of bounding boxes.
#[derive(Debug, Clone)]
pub(super) struct EdgeTree {
    edges: Vec<Segment>,
    /// The box around all edges, if there are any.
    around: Option<Bounds>,
    boxes: Bvh<f64, 2>,
}

impl EdgeTree {
    /// Coordinates are finite, and small enough for their squares.
    pub(super) fn new(edges: impl IntoIterator<Item = Segment>) -> EdgeTree {
        let edges: Vec<Segment> = edges.into_iter().collect();
        let mut leaves: Vec<Bounds> = edges.iter().map(Bounds::of).collect();
        let around = leaves.iter().copied().reduce(Bounds::union);
        let boxes = Bvh::build(&mut leaves);
        EdgeTree { edges, around, boxes }
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
        self.around.is_some_and(|around| around.holds(point))
    }

    /// Visits every edge that a ray from `point` to the right crosses, by its index. Exact, but for
    /// points on an edge, which may be visited or not.
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

    /// The nearest edge, by its index, and its point nearest to `point`.
    pub(super) fn nearest(&self, point: Point) -> Option<(usize, Point)> {
        let (_, index) = self.least(
            |bounds| bounds.distance_squared(point),
            |edge| (edge.nearest(point) - point).norm_squared(),
        )?;
        Some((index, self.edges[index].nearest(point)))
    }

    /// Distance from `path` to the nearest edge; 0 if they meet, infinite without edges.
    pub(super) fn distance_to_segment(&self, path: &Segment) -> f64 {
        let around = Bounds::of(path);
        let nearest = self.least(|bounds| bounds.gap(&around), |edge| edge.distance_to(path));
        nearest.map_or(f64::INFINITY, |(distance, _)| distance)
    }

    /// Whether `path` meets an edge or comes closer to one than `distance`.
    pub(super) fn is_near(&self, path: &Segment, distance: f64) -> bool {
        let around = Bounds::of(path);
        self.any(
            |bounds| bounds.gap(&around) <= distance,
            |_, edge| {
                let apart = edge.distance_to(path);
                apart < distance || apart == 0.0
            },
        )
    }

    /// Visits every edge with a point within `radius` of `center`, with its index.
    pub(super) fn for_each_near(
        &self,
        center: Point,
        radius: f64,
        mut visit: impl FnMut(usize, &Segment),
    ) {
        self.any(
            |bounds| bounds.distance_squared(center) <= radius * radius,
            |index, edge| {
                if edge.distance(center) <= radius {
                    visit(index, edge);
                }
                false
            },
        );
    }

    /// Visits every edge whose box meets that of `segment`, with its index.
    pub(super) fn for_each_overlapping(
        &self,
        segment: &Segment,
        mut visit: impl FnMut(usize, &Segment),
    ) {
        let around = Bounds::of(segment);
        self.any(
            |bounds| !bounds.is_apart_from(&around),
            |index, edge| {
                visit(index, edge);
                false
            },
        );
    }

    /// The least cost of an edge, with the first edge that has it, by its index. The cost of a box is no more than that
    /// of any edge in it, up to rounding; by as much another edge may cost less.
    fn least(
        &self,
        of_box: impl Fn(&Bounds) -> f64,
        of_edge: impl Fn(&Segment) -> f64,
    ) -> Option<(f64, usize)> {
        let mut least = None;
        if !self.edges.is_empty() {
            self.lower(&mut least, 0, &of_box, &of_edge);
        }
        least
    }

    /// Takes the least cost below a node, if it is less than the least so far, or as little and of an earlier edge. What
    /// is not a number is never the least.
    fn lower(
        &self,
        least: &mut Option<(f64, usize)>,
        node: usize,
        of_box: &impl Fn(&Bounds) -> f64,
        of_edge: &impl Fn(&Segment) -> f64,
    ) {
        match &self.boxes.nodes[node] {
            BvhNode::Leaf { shape_index: index, .. } => {
                let found = (of_edge(&self.edges[*index]), *index);
                if !found.0.is_nan() && least.is_none_or(|least| found < least) {
                    *least = Some(found);
                }
            }
            BvhNode::Node { child_l_index, child_l_aabb, child_r_index, child_r_aabb, .. } => {
                let mut children = [
                    (of_box(&child_l_aabb.into()), *child_l_index),
                    (of_box(&child_r_aabb.into()), *child_r_index),
                ];
                if children[1].0 < children[0].0 {
                    children.reverse();
                }
                for (cost, child) in children {
                    if least.is_none_or(|(least, _)| cost <= least) {
                        self.lower(least, child, of_box, of_edge);
                    }
                }
            }
        }
    }

    /// Visits the edges below every box that `enter` admits, until `visit` says that one settles
    /// the question; tells whether one did.
    fn any(
        &self,
        mut enter: impl FnMut(&Bounds) -> bool,
        mut visit: impl FnMut(usize, &Segment) -> bool,
    ) -> bool {
        self.around.is_some_and(|around| enter(&around))
            && self.any_below(0, &mut enter, &mut visit)
    }

    /// The same below a node whose box is admitted.
    fn any_below(
        &self,
        node: usize,
        enter: &mut impl FnMut(&Bounds) -> bool,
        visit: &mut impl FnMut(usize, &Segment) -> bool,
    ) -> bool {
        match &self.boxes.nodes[node] {
            BvhNode::Leaf { shape_index: index, .. } => visit(*index, &self.edges[*index]),
            BvhNode::Node { child_l_index, child_l_aabb, child_r_index, child_r_aabb, .. } => {
                enter(&child_l_aabb.into()) && self.any_below(*child_l_index, enter, visit)
                    || enter(&child_r_aabb.into()) && self.any_below(*child_r_index, enter, visit)
            }
        }
    }
}

/// A box with sides along the axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: Point,
    high: Point,
}

impl From<&Aabb<f64, 2>> for Bounds {
    fn from(corners: &Aabb<f64, 2>) -> Bounds {
        Bounds { low: corners.min, high: corners.max }
    }
}

impl Bounded<f64, 2> for Bounds {
    fn aabb(&self) -> Aabb<f64, 2> {
        Aabb::with_bounds(self.low, self.high)
    }
}

impl BHShape<f64, 2> for Bounds {
    // Asked for only where a tree is changed after it is built.
    fn set_bh_node_index(&mut self, _: usize) {}

    fn bh_node_index(&self) -> usize {
        0
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

    /// The smallest box around some points.
    pub(super) fn around(points: impl Iterator<Item = Point>) -> Option<Bounds> {
        let alone = |point| Bounds { low: point, high: point };
        points.map(alone).reduce(Bounds::union)
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

    fn distance_squared(&self, point: Point) -> f64 {
        let beyond = |axis: usize| {
            (self.low[axis] - point[axis]).max(point[axis] - self.high[axis]).max(0.0)
        };
        beyond(0).powi(2) + beyond(1).powi(2)
    }

    fn is_apart_from(&self, other: &Bounds) -> bool {
        (0..2).any(|axis| self.low[axis] > other.high[axis] || other.low[axis] > self.high[axis])
    }

    /// A lower bound of the distance between the boxes: 0 if they overlap.
    fn gap(&self, other: &Bounds) -> f64 {
        let along = |axis: usize| {
            (self.low[axis] - other.high[axis]).max(other.low[axis] - self.high[axis]).max(0.0)
        };
        Vector::new(along(0), along(1)).norm()
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
    use super::*;

    #[test]
    fn boxes_are_as_far_apart_as_their_nearest_points() {
        let bounds = |low: (f64, f64), high: (f64, f64)| Bounds {
            low: Point::new(low.0, low.1),
            high: Point::new(high.0, high.1),
        };
        let own = bounds((0.0, 0.0), (1.0, 1.0));
        for (other, gap) in [
            (bounds((4.0, 5.0), (6.0, 6.0)), 5.0),
            (bounds((-3.0, 0.5), (-2.0, 0.6)), 2.0),
            (bounds((0.5, 0.5), (2.0, 2.0)), 0.0),
        ] {
            assert_eq!((own.gap(&other), other.gap(&own)), (gap, gap));
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
            let mut met = 0;
            let path = Segment::new(Point::origin(), Point::new(reach, 0.0));
            tree.for_each_overlapping(&path, |_, _| met += 1);
            assert_eq!(met, expected);
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
