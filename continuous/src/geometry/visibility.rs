//! The visibility graph: which corners of the free space see each other.
//!
//! A shortest path bends only at reflex corners, and each of its segments is tangent to the
//! obstacle at both ends: only such *taut* links are kept.

use std::sync::OnceLock;

use super::edge_tree::{Bounds, EdgeTree};
use super::segment::{are_alike, side};
use super::triangulation::{Seen, Sight, Triangulation};
use super::{Neighbours, Segment};
use crate::{Point, Vector};

/// By how much, relatively, directions that are left out miss the tolerance, and corners the longest way: more
/// than rounding.
const ROUNDING: f64 = 1e-6;

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

/// What a corner sees in taut directions.
#[derive(Debug, Clone)]
struct Outlook {
    links: Vec<Link>,
    /// A box around all of it; none if it may be everywhere.
    around: Option<Bounds>,
}

/// The reflex corners of the free space, and the taut links between those that see each other.
///
/// Links are found when somebody asks for them first, corner by corner: in a large hall of pillars
/// there are millions, and most are never needed. So is the triangulation.
#[derive(Debug, Clone)]
pub(super) struct VisibilityGraph {
    corners: Vec<Corner>,
    /// The corners by where they are.
    places: Neighbours,
    outlooks: Vec<OnceLock<Outlook>>,
    /// The walls, with the corners as places; `None` if there is nothing to triangulate.
    triangulation: OnceLock<Option<Triangulation>>,
    tolerance: f64,
}

impl VisibilityGraph {
    /// The graph of the corners of `rings` (the set on their left). Links count as taut up to `tolerance`.
    ///
    /// Other functions take the walls between which corners see each other, always the same: the edges
    /// of a slightly larger set.
    pub(super) fn new(rings: &[Vec<Point>], tolerance: f64) -> VisibilityGraph {
        let corners: Vec<Corner> = rings.iter().flat_map(|ring| reflex_corners(ring)).collect();
        let places: Vec<Point> = corners.iter().map(|corner| corner.at).collect();
        let outlooks = vec![OnceLock::new(); corners.len()];
        let places = Neighbours::new(&places, 0.0);
        VisibilityGraph { corners, places, outlooks, triangulation: OnceLock::new(), tolerance }
    }

    /// The links of a corner, in ascending order of the other one.
    pub(super) fn links(&self, corner: usize, walls: &EdgeTree) -> &[Link] {
        &self.outlooks[corner].get_or_init(|| self.look_from_corner(corner, walls)).links
    }

    fn look_from_corner(&self, index: usize, walls: &EdgeTree) -> Outlook {
        let skips = |right: Vector, left: Vector| {
            self.corners[index].is_between(right, left, self.tolerance)
        };
        let link_to = |Seen { place, may_touch }: Seen| {
            let path = self.path(index, place);
            let is_link = self.may_link(index, place) && !(may_touch && walls.is_crossed_by(&path));
            is_link.then(|| Link { corner: place, length: path.length() })
        };
        let Sight { places, around } = match self.triangulation(walls) {
            Some(triangulation) => triangulation.seen_from_place(index, skips),
            None => Sight { places: self.all_corners(), around: None },
        };
        // Wider than what rounding takes from tiny coordinates.
        let around = around.map(|around| around.widened(self.tolerance));
        Outlook { links: places.into_iter().filter_map(link_to).collect(), around }
    }

    fn triangulation(&self, walls: &EdgeTree) -> Option<&Triangulation> {
        let places = || self.corners.iter().map(|corner| corner.at).collect::<Vec<Point>>();
        let triangulate = || Triangulation::new(walls.edges(), &places());
        self.triangulation.get_or_init(triangulate).as_ref()
    }

    fn path(&self, one: usize, other: usize) -> Segment {
        Segment::new(self.corners[one].at, self.corners[other].at)
    }

    /// Whether a straight way between two corners is taut, if there is one.
    pub(super) fn may_link(&self, one: usize, other: usize) -> bool {
        let path = self.path(one, other);
        let is_touched = |corner: usize| self.corners[corner].is_touched_by(&path, self.tolerance);
        one != other && is_touched(one) && is_touched(other)
    }

    /// Whether there may be a straight way between a corner and a place that is taut at the corner. What the corner
    /// sees tells, too, if that has been found. A place at the corner has no direction to tell from.
    pub(super) fn may_touch(&self, index: usize, place: Point) -> bool {
        let around = self.outlooks[index].get().and_then(|outlook| outlook.around);
        let corner = &self.corners[index];
        let path = Segment::new(place, corner.at);
        around.is_none_or(|around| around.holds(place))
            && (path.length() <= self.tolerance || corner.is_touched_by(&path, self.tolerance))
    }

    /// The corners over which ways between two points up to a length can lead, ascending.
    pub(super) fn corners_on_ways(&self, from: Point, to: Point, longest: f64) -> Vec<usize> {
        let longest = longest * (1.0 + ROUNDING);
        let mut found = Vec::new();
        self.places.for_each_within(nalgebra::center(&from, &to), longest / 2.0, |corner, _| {
            let at = self.corners[corner].at;
            if (at - from).norm() + (to - at).norm() <= longest {
                found.push(corner);
            }
        });
        found.sort_unstable();
        found
    }

    /// Corners that are seen from a point near a wall, ascending, and perhaps more.
    pub(super) fn seen_from(&self, point: Point, wall: usize, walls: &EdgeTree) -> Vec<Seen> {
        let seen = self.triangulation(walls).and_then(|it| it.seen_from(point, wall));
        seen.unwrap_or_else(|| self.all_corners())
    }

    fn all_corners(&self) -> Vec<Seen> {
        (0..self.corners.len()).map(|place| Seen { place, may_touch: true }).collect()
    }

    pub(super) fn corners(&self) -> &[Corner] {
        &self.corners
    }
}

impl Corner {
    /// Whether the obstacle lies on the inner side of a path that bends here: where it comes from and
    /// where it goes to lie outside of the obstacle, which then lies wholly on one side.
    pub(super) fn lies_between(&self, from: Point, to: Point) -> bool {
        let (before, after) = (self.before - self.at, self.after - self.at);
        // As long as the edges are: a length of 1 would be lost beside large coordinates.
        let reach = before.norm().max(after.norm());
        let into = self.at + (before.normalize() + after.normalize()) * reach;
        let turn = side(from, self.at, to);
        are_alike(turn, side(from, self.at, into)) && are_alike(turn, side(self.at, to, into))
    }

    /// Whether the line of `path`, which ends at this corner, leaves the obstacle here on one
    /// side, or enters it by no more than `tolerance`.
    fn is_touched_by(&self, path: &Segment, tolerance: f64) -> bool {
        let normal = path.left_normal();
        let before = normal.dot(&(self.before - self.at));
        let after = normal.dot(&(self.after - self.at));
        before.min(after) >= -tolerance || before.max(after) <= tolerance
    }

    /// Whether all directions from `right` to `left` lead into the obstacle here, or away from its
    /// inside, by more than `tolerance`: for none of them is the corner touched.
    ///
    /// The obstacle's edges then lie on different sides of both limits, the same edge on the left
    /// of both; how far they reach to that side is a concave function of the direction.
    fn is_between(&self, right: Vector, left: Vector, tolerance: f64) -> bool {
        let least = tolerance * (1.0 + ROUNDING);
        let (before, after) = (self.before - self.at, self.after - self.at);
        let lie_apart = |on_left: &Vector, on_right: &Vector| {
            [right, left].iter().all(|direction| {
                let reach = least * direction.norm();
                direction.perp(on_left) > reach && direction.perp(on_right) < -reach
            })
        };
        lie_apart(&before, &after) || lie_apart(&after, &before)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{FreeSpace, Workspace};

    #[test]
    fn ways_into_an_obstacle_do_not_touch_its_corner() {
        let corner = Corner {
            at: Point::origin(),
            before: Point::new(1.0, 1.0),
            after: Point::new(1.0, -1.0),
        };
        let is_between =
            |right, left| corner.is_between(Vector::from(right), Vector::from(left), 0.01);
        assert!(is_between([1.0, -0.5], [1.0, 0.5]), "into the obstacle");
        assert!(is_between([-1.0, 0.5], [-1.0, -0.5]), "away from its inside");
        assert!(!is_between([1.0, 0.5], [0.5, 1.0]), "one leads in, and one past");
        assert!(!is_between([0.5, 1.0], [-0.5, 1.0]), "both lead past");
    }

    /// A hall with square pillars, each turned by its number times `turn`, and free places between.
    fn hall(pillars: usize, turn: f64) -> (FreeSpace, Vec<Point>) {
        let side = (pillars as f64).sqrt().ceil();
        let middle = |index: usize| {
            Point::new((index as f64 % side).floor() + 0.5, (index as f64 / side).floor() + 0.5)
        };
        let square = |center: Point, turn: f64, radius: f64| -> Vec<Point> {
            let angle = |corner: i32| (f64::from(corner) + turn) * std::f64::consts::FRAC_PI_2;
            let corner = |at: i32| center + Vector::new(angle(at).cos(), angle(at).sin()) * radius;
            (0..4).map(corner).collect()
        };
        let center = Point::new(side / 2.0, side / 2.0);
        let boundary = square(center, 0.5, side);
        let holes = (0..pillars).map(|index| square(middle(index), 0.5 + turn * index as f64, 0.3));
        let workspace = Workspace::new(boundary, holes.collect()).unwrap();
        let places = (0..pillars).map(|index| middle(index) + Vector::new(0.0, 0.5)).collect();
        (FreeSpace::new(&workspace, 0.05).unwrap(), places)
    }

    /// Corners in rows see each other along the rows, past all between: everything is on the edge
    /// of being hidden.
    #[test]
    fn links_and_sight_are_those_of_trying_every_pair() {
        for turn in [0.0, 0.25, 0.03, 0.5] {
            let (space, places) = hall(20, turn);
            let (corners, tolerance) = (space.corners(), space.tolerance());
            let is_taut = |path: &Segment, one: usize, other: usize| {
                [one, other].iter().all(|&end| corners[end].is_touched_by(path, tolerance))
            };
            for (index, corner) in corners.iter().enumerate() {
                let tried: Vec<usize> = (0..corners.len())
                    .filter(|&other| {
                        let path = Segment::new(corner.at, corners[other].at);
                        other != index && is_taut(&path, index, other) && space.is_clear(&path)
                    })
                    .collect();
                let found: Vec<usize> = space.links(index).iter().map(|link| link.corner).collect();
                assert_eq!(found, tried, "from corner {index}, turned by {turn}");
            }
            for from in places.into_iter().chain(corners.iter().map(|corner| corner.at)) {
                let found: Vec<usize> =
                    space.corners_seen_from(from).map(|(seen, _)| seen).collect();
                let sees = |&other: &usize| space.is_clear(&Segment::new(from, corners[other].at));
                let tried: Vec<usize> = (0..corners.len()).filter(sees).collect();
                assert_eq!(found, tried, "from {from}, turned by {turn}");
            }
        }
    }
}
