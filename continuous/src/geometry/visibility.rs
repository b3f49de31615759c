//! The visibility graph: which corners of the free space see each other.
//!
//! A shortest path bends only at reflex corners, and each of its segments is tangent to the
//! obstacle at both ends: only such *taut* links are kept.

use super::Segment;
use super::edge_tree::EdgeTree;
use super::segment::side;
use crate::Point;

/// A reflex vertex of the planning outline, around which shortest paths bend.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) at: Point,
    before: Point,
    after: Point,
}

/// A straight way to another corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    pub(super) corner: usize,
    pub(super) length: f64,
}

/// The reflex corners of the free space, and the taut links between those that see each other.
#[derive(Debug, Clone)]
pub(super) struct VisibilityGraph {
    corners: Vec<Corner>,
    links: Vec<Vec<Link>>,
}

impl VisibilityGraph {
    /// The graph of the corners of `rings` (the set on their left) that see each other between the
    /// edges of `walls`, a slightly larger set. Links count as taut up to `tolerance`.
    pub(super) fn new(rings: &[Vec<Point>], walls: &EdgeTree, tolerance: f64) -> VisibilityGraph {
        let corners: Vec<Corner> = rings.iter().flat_map(|ring| reflex_corners(ring)).collect();
        let mut links = vec![Vec::new(); corners.len()];
        for (index, corner) in corners.iter().enumerate() {
            for (other_index, other) in corners.iter().enumerate().take(index) {
                let path = Segment::new(corner.at, other.at);
                if corner.is_touched_by(&path, tolerance)
                    && other.is_touched_by(&path, tolerance)
                    && !walls.is_crossed_by(&path)
                {
                    let length = path.length();
                    links[index].push(Link { corner: other_index, length });
                    links[other_index].push(Link { corner: index, length });
                }
            }
        }
        VisibilityGraph { corners, links }
    }

    pub(super) fn corners(&self) -> &[Corner] {
        &self.corners
    }

    pub(super) fn links(&self, corner: usize) -> &[Link] {
        &self.links[corner]
    }
}

impl Corner {
    /// Whether the line of `path`, which ends at this corner, leaves the obstacle here on one
    /// side, or enters it by no more than `tolerance`.
    fn is_touched_by(&self, path: &Segment, tolerance: f64) -> bool {
        let normal = path.left_normal();
        let before = normal.dot(&(self.before - self.at));
        let after = normal.dot(&(self.after - self.at));
        before.min(after) >= -tolerance || before.max(after) <= tolerance
    }
}

fn reflex_corners(ring: &[Point]) -> impl Iterator<Item = Corner> {
    let count = ring.len();
    (0..count)
        .map(move |index| Corner {
            at: ring[index],
            before: ring[(index + count - 1) % count],
            after: ring[(index + 1) % count],
        })
        .filter(|corner| side(corner.before, corner.at, corner.after) < 0.0)
}
