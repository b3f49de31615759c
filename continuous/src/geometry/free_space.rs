//! The free space W_f: where the centre of a robot may be (Sec. IV-A and Appendix A).
//!
//! # What Algorithm 6 becomes here
//!
//! Algorithm 6 takes from W one strip along each edge and ends it at the half-planes of the
//! adjacent edges. At a reflex vertex these cuts are degenerate (the end of a strip is collinear
//! with what the previous strip left behind), and read with the boundary of W instead of the
//! updated one they leave reflex corners no clearance at all. Here a strip is the rectangle on its
//! edge, and every reflex vertex gets a cap: a polygon circumscribed about the disc around it,
//! between the two strips. As the points of ∂W nearest to anything lie in edges or at reflex
//! vertices, strips and caps together cover every point that is too near.

use thiserror::Error;

use super::edge_tree::EdgeTree;
use super::erosion::{Region, erode};
use super::triangulation::Seen;
use super::visibility::{Corner, Link, VisibilityGraph};
use super::workspace::{COORDINATE_LIMIT, edges_of};
use super::{Segment, Workspace};
use crate::Point;

/// The tolerance τ as a fraction of the extent of the workspace: how much farther than ρ from ∂W
/// robots are sent. Large against rounding (1e-16), small against anything that a robot would
/// notice.
const RELATIVE_TOLERANCE: f64 = 1e-6;

/// The fractions that may be asked for: rounding takes what is smaller.
const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-12..=1e-3;

/// As a fraction of τ: the deviation from a straight line below which a vertex of the outline is
/// left out. Small, so that the sight set stays around the planning set.
const NEGLIGIBLE: f64 = 1e-3;

/// The reach of re-entry as a fraction of ρ + τ, unless another one is asked for.
const REACH: f64 = 0.5;

/// The points of a workspace that keep a clearance ρ from its boundary, ready for questions about
/// sight and shortest paths. See [the two nested sets](super#two-nested-sets).
///
/// An inner approximation: all its points have clearance ≥ ρ, which is checked on construction,
/// and every point with clearance ≥ 1.2 (ρ + τ) belongs to it, except beside reflex vertices that
/// turn by 67° to 100°, where a mitred corner reaches up to 1.56 (ρ + τ).
#[derive(Debug, Clone)]
pub struct FreeSpace {
    clearance: f64,
    tolerance: f64,
    pub(super) reach: f64,
    planning: Outline,
    sight: Outline,
    /// Whether no passage of the sight set is closed in the planning set.
    has_all_passages: bool,
    graph: VisibilityGraph,
}

/// Why there is no free space.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FreeSpaceError {
    /// The clearance is not a length.
    #[error("the clearance is {clearance}; it must be a finite length, 0 or more")]
    InvalidClearance {
        /// The clearance asked for.
        clearance: f64,
    },
    /// The tolerance is too small or too large a part of the workspace.
    #[error(
        "the tolerance is {fraction} of the extent; it must be at least {} and at most {}",
        TOLERANCES.start(), TOLERANCES.end()
    )]
    InvalidTolerance {
        /// The fraction asked for.
        fraction: f64,
    },
    /// No room for a robot anywhere.
    #[error(
        "no point of the workspace, whose extent is {extent}, keeps a clearance of {clearance} \
         from the boundary; choose a smaller clearance"
    )]
    Empty {
        /// The clearance asked for.
        clearance: f64,
        /// The larger side of the box around the workspace.
        extent: f64,
    },
    /// The reach of re-entry is no length, or leads back through walls.
    #[error(
        "the reach of re-entry is {reach}; it must be a length of 0 or more, less than {limit}, the \
         clearance that planned positions keep"
    )]
    InvalidReach {
        /// The reach asked for.
        reach: f64,
        /// ρ + τ.
        limit: f64,
    },
    /// The outline that was computed does not keep the clearance: coordinates so large, or details
    /// so small, that rounding exceeds the tolerance.
    #[error(
        "near ({}, {}) the free space cannot be computed to within {tolerance:e}; move the \
         workspace closer to the origin, or remove details of that size from it", at.x, at.y
    )]
    Uncertified {
        /// A point of the outline that fails.
        at: Point,
        /// The tolerance τ that rounding exceeds.
        tolerance: f64,
    },
}

impl FreeSpace {
    /// The free space of `workspace` for robots that keep `clearance` (ρ, a length) from its
    /// boundary; 0 is allowed.
    ///
    /// # Errors
    ///
    /// If the clearance is not a length, if no place keeps it, or if rounding spoils the result.
    pub fn new(workspace: &Workspace, clearance: f64) -> Result<FreeSpace, FreeSpaceError> {
        FreeSpace::with_tolerance(workspace, clearance, RELATIVE_TOLERANCE)
    }

    /// As [`FreeSpace::new`], with the tolerance τ as a fraction of the extent of the workspace
    /// instead of a millionth: between 1e-12 and 1e-3.
    ///
    /// A shortest path is longer than the one that keeps ρ alone, or shorter, by at most a few τ
    /// for each of its corners. With 1e-12, geodesics are exact to about 1e-11 of the extent for
    /// each corner. That is for computing; robots, whose places are rounded, are better off with
    /// room between the two nested sets.
    ///
    /// # Errors
    ///
    /// As [`FreeSpace::new`], and if the fraction is out of its range.
    pub fn with_tolerance(
        workspace: &Workspace,
        clearance: f64,
        fraction: f64,
    ) -> Result<FreeSpace, FreeSpaceError> {
        if !(clearance.is_finite() && clearance >= 0.0) {
            return Err(FreeSpaceError::InvalidClearance { clearance });
        }
        if !TOLERANCES.contains(&fraction) {
            return Err(FreeSpaceError::InvalidTolerance { fraction });
        }
        let extent = workspace.extent();
        if clearance > extent {
            return Err(FreeSpaceError::Empty { clearance, extent });
        }
        let tolerance = fraction * extent;
        let outline =
            |slack: f64| Outline::new(erode(workspace, clearance + slack, NEGLIGIBLE * tolerance));
        let (planning, sight) = (outline(tolerance), outline(tolerance / 2.0));
        if planning.rings.is_empty() {
            return Err(FreeSpaceError::Empty { clearance, extent });
        }
        let graph = VisibilityGraph::new(&planning.rings, tolerance);
        let reach = REACH * (clearance + tolerance);
        let has_all_passages = planning.has_all_passages_of(&sight);
        let free_space =
            FreeSpace { clearance, tolerance, reach, planning, sight, has_all_passages, graph };
        free_space.certify(workspace)?;
        Ok(free_space)
    }

    /// The clearance ρ that every point of the free space keeps from the boundary, a length.
    pub fn clearance(&self) -> f64 {
        self.clearance
    }

    /// The tolerance τ, a length: planned positions keep ρ + τ from the boundary.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Outline of the planning set, for drawings: outer rings counter-clockwise, holes clockwise.
    pub fn outline(&self) -> &[Vec<Point>] {
        &self.planning.rings
    }

    /// Whether a robot at `point` keeps the clearance: membership in the sight set.
    pub fn contains(&self, point: Point) -> bool {
        self.sight.tree.encloses(point)
    }

    /// The point of the planning set nearest to `point`; the point itself if it lies there.
    ///
    /// Coordinates beyond the limit of a [`Workspace`] count as that limit. A point with a
    /// coordinate that is not a number has no nearest one and is returned as it is.
    pub fn nearest(&self, point: Point) -> Point {
        if self.planning.tree.encloses(point) {
            return point;
        }
        let point = point.map(|coordinate| coordinate.clamp(-COORDINATE_LIMIT, COORDINATE_LIMIT));
        self.planning.tree.nearest(point).map_or(point, |(_, nearest)| nearest)
    }

    /// The point of the planning set nearest to `point` of all to which a way leads from `from`, or, if that lies
    /// outside, from the point of the planning set nearest to it, also beyond the reach of re-entry; none if a
    /// coordinate of `from` is not a number.
    pub fn nearest_reached(&self, point: Point, from: Point) -> Option<Point> {
        let piece = self.region(if self.contains(from) { from } else { self.nearest(from) })?;
        let is_reached = |place: &Point| self.region(*place) == Some(piece);
        let nearest = self.nearest(point);
        if is_reached(&nearest) {
            return Some(nearest);
        }
        let mut feet: Vec<Point> = self.planning.edges().map(|edge| edge.nearest(point)).collect();
        feet.sort_by(|one, other| (one - point).norm().total_cmp(&(other - point).norm()));
        feet.into_iter().find(is_reached)
    }

    /// Which connected piece of the free space `point` lies in, `None` if it lies in none.
    /// Robots cannot walk from one piece to another.
    pub fn region(&self, point: Point) -> Option<usize> {
        self.sight.region(point)
    }

    /// Whether a robot can walk straight from one point to the other: the segment between them
    /// lies in the sight set.
    ///
    /// A robot outside, within the reach of re-entry, sees what its [entry](Self::entry) sees, and
    /// places that are not farther out than it is itself; [it never gets farther
    /// out](super::reentry).
    pub fn sees(&self, from: Point, to: Point) -> bool {
        if self.contains(from) {
            return self.sight.tree.surrounds(to) && self.is_clear(&Segment::new(from, to));
        }
        let (Some(entry), Some(exit)) = (self.entry(from), self.entry(to)) else { return false };
        (to - exit).norm() <= (from - entry).norm() && self.is_clear(&Segment::new(entry, exit))
    }

    /// Whether a segment that starts in the sight set stays there.
    pub(super) fn is_clear(&self, path: &Segment) -> bool {
        !self.sight.tree.is_crossed_by(path)
    }

    /// Whether shortest paths between two points touch the corners that they bend at: both points lie in the
    /// planning set, which has all passages of the sight set. For points on the outline either answer may come.
    pub(super) fn keep_paths_taut(&self, from: Point, to: Point) -> bool {
        self.has_all_passages && [from, to].iter().all(|&end| self.planning.tree.encloses(end))
    }

    pub(super) fn corners(&self) -> &[Corner] {
        self.graph.corners()
    }

    /// The corners that shortest paths may go to from a corner.
    pub(super) fn links(&self, corner: usize) -> &[Link] {
        self.graph.links(corner, &self.sight.tree)
    }

    /// Whether shortest paths may go from one of these corners to the other, if they see each other.
    pub(super) fn may_link(&self, one: usize, other: usize) -> bool {
        self.graph.may_link(one, other)
    }

    /// Whether shortest paths may go from a corner to a place, if they see each other and
    /// [touch](Self::keep_paths_taut) corners there.
    pub(super) fn may_touch(&self, corner: usize, place: Point) -> bool {
        self.graph.may_touch(corner, place)
    }

    /// The corners over which ways between two points up to a length can lead, ascending.
    pub(super) fn corners_on_ways(&self, from: Point, to: Point, longest: f64) -> Vec<usize> {
        self.graph.corners_on_ways(from, to, longest)
    }

    /// The corners that a robot at a point of the sight set sees, ascending, with the distances.
    pub(super) fn corners_seen_from(&self, point: Point) -> impl Iterator<Item = (usize, f64)> {
        let seen = self
            .sight
            .tree
            .nearest(point)
            .map(|(wall, _)| self.graph.seen_from(point, wall, &self.sight.tree));
        seen.into_iter().flatten().filter_map(move |Seen { place, may_touch }| {
            let path = Segment::new(point, self.corners()[place].at);
            (!may_touch || self.is_clear(&path)).then(|| (place, path.length()))
        })
    }

    /// The edges of the sight set within `radius` of `center`, in their order.
    pub(super) fn walls_near(&self, center: Point, radius: f64) -> impl Iterator<Item = &Segment> {
        self.sight.tree.near(center, radius).into_iter().map(|(_, edge)| edge)
    }

    /// The edges of the planning set within `radius` of `center`, in their order.
    pub(super) fn planning_walls_near(
        &self,
        center: Point,
        radius: f64,
    ) -> impl Iterator<Item = &Segment> {
        self.planning.tree.near(center, radius).into_iter().map(|(_, edge)| edge)
    }

    /// Checks that both outlines keep the clearance and that the planning set lies within the
    /// sight set. What keeps away from ∂W lies wholly inside or outside W, ring by ring, so one
    /// vertex of each tells. An outline that keeps the clearance encloses no part of ∂W unless it
    /// encloses a whole polygon of it, which is checked by one vertex of each, too.
    fn certify(&self, workspace: &Workspace) -> Result<(), FreeSpaceError> {
        let failed = |at: Point| Err(FreeSpaceError::Uncertified { at, tolerance: self.tolerance });
        for outline in [&self.sight, &self.planning] {
            if let Some(edge) = outline.edges().find(|edge| workspace.is_near(edge, self.clearance))
            {
                return failed(edge.from);
            }
            if let Some(ring) = outline.rings.iter().find(|ring| !workspace.contains(ring[0])) {
                return failed(ring[0]);
            }
        }
        let strays = |edge: &Segment| !self.is_clear(edge);
        if let Some(edge) = self.planning.edges().find(strays) {
            return failed(edge.from);
        }
        let enclosed = |ring: &&Vec<Point>| self.contains(ring[0]);
        let not_enclosed = self.planning.rings.iter().find(|ring| !enclosed(ring));
        match not_enclosed.or_else(|| workspace.polygons().iter().find(enclosed)) {
            Some(ring) => failed(ring[0]),
            None => Ok(()),
        }
    }
}

/// The boundary of a set, with the set on the left.
#[derive(Debug, Clone)]
struct Outline {
    rings: Vec<Vec<Point>>,
    tree: EdgeTree,
    region_of_edge: Vec<usize>,
    /// How many rings each region has.
    rings_of_region: Vec<usize>,
}

impl Outline {
    fn new(regions: Vec<Region>) -> Outline {
        let sizes = regions.iter().map(|rings| rings.iter().map(Vec::len).sum());
        let region_of_edge = sizes
            .enumerate()
            .flat_map(|(region, edges): (usize, usize)| std::iter::repeat_n(region, edges))
            .collect();
        let rings_of_region = regions.iter().map(Vec::len).collect();
        let rings: Vec<Vec<Point>> = regions.into_iter().flatten().collect();
        let tree = EdgeTree::new(rings.iter().flat_map(|ring| edges_of(ring)));
        Outline { rings, tree, region_of_edge, rings_of_region }
    }

    /// The region that a point lies in, `None` if it lies in none.
    fn region(&self, point: Point) -> Option<usize> {
        if !self.tree.encloses(point) {
            return None;
        }
        // From a point inside, nothing lies between it and the nearest edge: that edge bounds its region.
        self.tree.nearest(point).map(|(edge, _)| self.region_of_edge[edge])
    }

    /// Whether this set, which shrinks a larger one, has all passages of it: a passage that closes cuts a
    /// region in two or joins two of its rings.
    fn has_all_passages_of(&self, larger: &Outline) -> bool {
        let mut is_found = vec![false; larger.rings_of_region.len()];
        let mut first = 0;
        self.rings_of_region.iter().all(|&rings| {
            let outer = &self.rings[first];
            first += rings;
            larger.region(outer[0]).is_some_and(|region| {
                let is_second = std::mem::replace(&mut is_found[region], true);
                !is_second && larger.rings_of_region[region] == rings
            })
        })
    }

    fn edges(&self) -> impl Iterator<Item = Segment> {
        self.rings.iter().flat_map(|ring| edges_of(ring))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that panics has failed
mod tests {
    use super::*;

    #[test]
    fn a_door_may_be_closed_in_the_planning_set_alone() {
        let rooms = |door: f64| {
            let top = 2.0 - door;
            let walls = [(0.0, 0.0), (1.9, 0.0), (1.9, top), (2.1, top), (2.1, 0.0), (4.0, 0.0)];
            let boundary = walls.into_iter().chain([(4.0, 2.0), (0.0, 2.0)]);
            let boundary = boundary.map(|(x, y)| Point::new(x, y)).collect();
            let workspace = Workspace::new(boundary, Vec::new()).unwrap();
            FreeSpace::with_tolerance(&workspace, 0.1, 1e-3).unwrap()
        };
        // ρ + τ is 0.104, and ρ + τ/2 is 0.102.
        for (door, has_all_passages) in [(0.203, true), (0.206, false), (0.209, true)] {
            assert_eq!(rooms(door).has_all_passages, has_all_passages, "{door}");
        }
    }
}
