//! A tree of boxes over edges: the questions that are asked of outlines with thousands of edges.

use std::cell::Cell;

use super::Segment;
use super::segment::side;
use crate::Point;

/// Edges below one leaf of the tree: few enough that testing them all is cheaper than descending.
const LEAF_EDGES: usize = 4;

/// Relative rounding error that the test of a box against a path allows for: more than its dozen
/// operations can sum up to.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Edges under a hierarchy of bounding boxes.
#[derive(Debug, Clone)]
pub(super) struct EdgeTree {
    edges: Vec<TaggedEdge>,
    /// In the order of a walk that visits parents before children.
    nodes: Vec<Node>,
}

/// An edge and the index it had in the list that the tree was built from.
#[derive(Debug, Clone, Copy)]
struct TaggedEdge {
    edge: Segment,
    index: usize,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    /// The node that follows when this one, with all below it, is left out.
    next: usize,
    /// Edges of a leaf, as a range; empty for inner nodes.
    first: usize,
    last: usize,
}

impl EdgeTree {
    pub(super) fn new(edges: impl IntoIterator<Item = Segment>) -> EdgeTree {
        let mut edges: Vec<TaggedEdge> =
            edges.into_iter().enumerate().map(|(index, edge)| TaggedEdge { edge, index }).collect();
        let mut nodes = Vec::new();
        grow(&mut edges, 0, &mut nodes);
        EdgeTree { edges, nodes }
    }

    /// Whether `path` passes from one side of some edge to the other.
    pub(super) fn is_crossed_by(&self, path: &Segment) -> bool {
        self.any(|bounds| bounds.meets(path), |_, edge| edge.is_crossed_by(path))
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
        let holds = |bounds: &Bounds| {
            (0..2).all(|axis| bounds.low[axis] <= point[axis] && point[axis] <= bounds.high[axis])
        };
        self.nodes.first().is_some_and(|root| holds(&root.bounds))
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
        // No farther than the nearest in the leaf that seems nearest: so most boxes are left out.
        let bound = self.leaf_near(point).iter().map(|entry| entry.edge.distance_squared(point));
        let best = Cell::new((bound.fold(f64::INFINITY, f64::min).next_up(), None));
        self.any(
            |bounds| bounds.distance_squared(point) < best.get().0,
            |index, edge| {
                let nearest = edge.nearest(point);
                let distance_squared = (nearest - point).norm_squared();
                if distance_squared < best.get().0 {
                    best.set((distance_squared, Some((index, nearest))));
                }
                false
            },
        );
        best.get().1
    }

    /// Distance from `path` to the nearest edge; 0 if they meet, infinite without edges.
    pub(super) fn distance_to_segment(&self, path: &Segment) -> f64 {
        let around = Bounds::of(path);
        let best = Cell::new(f64::INFINITY);
        self.any(
            |bounds| bounds.gap(&around) < best.get(),
            |_, edge| {
                best.set(best.get().min(edge.distance_to(path)));
                best.get() == 0.0
            },
        );
        best.get()
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

    /// Visits every edge with a point within `radius` of `center`.
    pub(super) fn for_each_near(
        &self,
        center: Point,
        radius: f64,
        mut visit: impl FnMut(&Segment),
    ) {
        self.any(
            |bounds| bounds.distance_squared(center) <= radius * radius,
            |_, edge| {
                if edge.distance(center) <= radius {
                    visit(edge);
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
            |bounds| bounds.gap(&around) == 0.0,
            |index, edge| {
                visit(index, edge);
                false
            },
        );
    }

    /// The edges of a leaf near `point`: the one reached by way of the boxes that are nearer.
    fn leaf_near(&self, point: Point) -> &[TaggedEdge] {
        let distance = |node: usize| self.nodes[node].bounds.distance_squared(point);
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if node.last > node.first {
                return &self.edges[node.first..node.last];
            }
            let (one, other) = (at + 1, self.nodes[at + 1].next);
            at = if distance(one) <= distance(other) { one } else { other };
        }
        &[]
    }

    /// Walks the tree below every box that `enter` admits, until `visit` says that an edge settles
    /// the question; tells whether one did.
    fn any(
        &self,
        mut enter: impl FnMut(&Bounds) -> bool,
        mut visit: impl FnMut(usize, &Segment) -> bool,
    ) -> bool {
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if !enter(&node.bounds) {
                at = node.next;
                continue;
            }
            if self.edges[node.first..node.last].iter().any(|entry| visit(entry.index, &entry.edge))
            {
                return true;
            }
            at += 1;
        }
        false
    }
}

/// Appends the tree over `edges`, which begin at `offset` in the whole list, to `nodes`: halves
/// them at the median along the longer side of their box until few are left.
fn grow(edges: &mut [TaggedEdge], offset: usize, nodes: &mut Vec<Node>) {
    let Some(bounds) = edges.iter().map(|entry| Bounds::of(&entry.edge)).reduce(Bounds::joined)
    else {
        return;
    };
    let own = nodes.len();
    let last = if edges.len() <= LEAF_EDGES { offset + edges.len() } else { offset };
    nodes.push(Node { bounds, next: 0, first: offset, last });
    if edges.len() > LEAF_EDGES {
        let axis = usize::from(bounds.high.y - bounds.low.y > bounds.high.x - bounds.low.x);
        let half = edges.len() / 2;
        let middle = |entry: &TaggedEdge| entry.edge.from[axis] + entry.edge.to[axis];
        edges.sort_by(|one, other| middle(one).total_cmp(&middle(other)));
        let (low, high) = edges.split_at_mut(half);
        grow(low, offset, nodes);
        grow(high, offset + half, nodes);
    }
    nodes[own].next = nodes.len();
}

/// A box with sides along the axes.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    low: Point,
    high: Point,
}

impl Bounds {
    fn of(segment: &Segment) -> Bounds {
        Bounds { low: segment.from.inf(&segment.to), high: segment.from.sup(&segment.to) }
    }

    fn joined(self, other: Bounds) -> Bounds {
        Bounds { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    fn distance_squared(&self, point: Point) -> f64 {
        let beyond = |axis: usize| {
            (self.low[axis] - point[axis]).max(point[axis] - self.high[axis]).max(0.0)
        };
        beyond(0).powi(2) + beyond(1).powi(2)
    }

    /// A lower bound of the distance between the boxes: 0 if they overlap.
    fn gap(&self, other: &Bounds) -> f64 {
        let along = |axis: usize| {
            (self.low[axis] - other.high[axis]).max(other.low[axis] - self.high[axis]).max(0.0)
        };
        along(0).hypot(along(1))
    }

    /// Whether the box may meet `path`: false only if a line parallel to an axis or to the path
    /// separates them with room to spare for rounding.
    fn meets(&self, path: &Segment) -> bool {
        if self.gap(&Bounds::of(path)) > 0.0 {
            return false;
        }
        let along = path.vector();
        let half = (self.high - self.low) / 2.0;
        let center = self.low + half - path.from;
        let reach = along.x.abs() * half.y + along.y.abs() * half.x;
        let size = self.low.coords.amax() + self.high.coords.amax() + path.from.coords.amax();
        let rounding = ROUNDING * size * along.amax();
        along.perp(&center).abs() <= reach + rounding
    }
}
