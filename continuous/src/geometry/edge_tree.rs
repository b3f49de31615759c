//! A tree of boxes over edges: the questions that are asked of outlines with thousands of edges.

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhLeafCost, BvhNode, TraversalAction};

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
    boxes: Bvh,
}

impl EdgeTree {
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
        !self.edges.is_empty() && Bounds::from(self.boxes.root_aabb()).holds(point)
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
        let nearest = self.best(
            |bounds| bounds.distance_squared(point),
            |edge| {
                let nearest = edge.nearest(point);
                ((nearest - point).norm_squared(), nearest)
            },
        );
        nearest.map(|(index, (_, nearest))| (index, nearest))
    }

    /// Distance from `path` to the nearest edge; 0 if they meet, infinite without edges.
    pub(super) fn distance_to_segment(&self, path: &Segment) -> f64 {
        let around = Bounds::of(path);
        let nearest = self.best(|bounds| bounds.gap(&around), |edge| edge.distance_to(path));
        nearest.map_or(f64::INFINITY, |(_, distance)| distance)
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

    /// The edge of least cost, by its index, with its cost; that of a box is no more than the cost
    /// of any edge in it.
    fn best<C: BvhLeafCost>(
        &self,
        of_box: impl Fn(&Bounds) -> f64,
        of_edge: impl Fn(&Segment) -> C,
    ) -> Option<(usize, C)> {
        let best = self.boxes.find_best(
            f64::MAX,
            |node, _| of_box(&node.into()),
            |leaf, _| Some(of_edge(&self.edges[leaf as usize])),
        );
        best.map(|(leaf, cost)| (leaf as usize, cost))
    }

    /// Visits the edges below every box that `enter` admits, until `visit` says that one settles
    /// the question; tells whether one did.
    fn any(
        &self,
        mut enter: impl FnMut(&Bounds) -> bool,
        mut visit: impl FnMut(usize, &Segment) -> bool,
    ) -> bool {
        let mut is_settled = false;
        self.boxes.traverse(|node| {
            if !enter(&node.into()) {
                return TraversalAction::Prune;
            }
            is_settled = node.leaf_data().is_some_and(|leaf| {
                let index = leaf as usize;
                visit(index, &self.edges[index])
            });
            if is_settled { TraversalAction::EarlyExit } else { TraversalAction::Continue }
        });
        is_settled
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
        let corner = |corner: Point| parry2d_f64::math::Vector::new(corner.x, corner.y);
        Aabb::new(corner(low), corner(high))
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
        points.map(alone).reduce(|one, other| Bounds {
            low: one.low.inf(&other.low),
            high: one.high.sup(&other.high),
        })
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
}
