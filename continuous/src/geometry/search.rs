//! Search for one shortest path, with obstacles that are not part of the free space.

use std::collections::BinaryHeap;
use std::f64::consts::PI;

use super::ranked::Ranked;
use super::{Disc, FreeSpace, Geodesic, Segment};
use crate::{Point, Vector};

/// Sides of the polygon that a path walks around a disc.
const SIDES: usize = 8;

/// Relative depth to which a path may enter a disc: sides of the polygon around it are tangent, and
/// rounding must not close them.
const GRAZE: f64 = 1e-6;

/// The start and the goal come before the corners among the nodes of a search.
const START: usize = 0;
const GOAL: usize = 1;
const FIRST_CORNER: usize = 2;

/// Ways up to these multiples of the straight one are sought first, over the few corners that can be on them.
const NEARLY_STRAIGHT: [f64; 3] = [1.05, 1.3, 2.0];

/// That many corners are few.
const FEW: usize = 64;

/// A shortest path from `from` to `to`, both in the free space, around every one of `discs`, whose
/// rims are replaced by polygons; `None` if there is none.
///
/// The search is A\* (<https://doi.org/10.1109/TSSC.1968.300136>) with the straight distance to the
/// goal as bound. Whether two nodes see each other is tested only when the step between them is
/// the most promising one left, so that most pairs are never tested. Most paths are hardly longer than
/// the straight line: they are found without a look at corners farther away.
pub(super) fn shortest_path(
    space: &FreeSpace,
    from: Point,
    to: Point,
    discs: &[Disc],
) -> Option<Geodesic> {
    let straight = (to - from).norm();
    let nearby =
        NEARLY_STRAIGHT.iter().map(|share| Nearby::on_ways(space, from, to, share * straight));
    let mut searches = nearby
        .take_while(|nearby| nearby.corners.len() <= FEW)
        .map(Some)
        .chain([None])
        .map(|nearby| Search::new(space, from, to, discs, nearby));
    let (search, waypoints) =
        searches.find_map(|search| search.run().map(|waypoints| (search, waypoints)))?;
    Some(space.departure(from, waypoints, |path| search.is_passable(path)))
}

/// Whether `path` keeps out of every disc.
pub(super) fn avoids(path: &Segment, discs: &[Disc]) -> bool {
    discs.iter().all(|disc| disc.gap(path) >= -GRAZE * disc.radius)
}

struct Search<'a> {
    space: &'a FreeSpace,
    discs: &'a [Disc],
    /// Start, goal, corners of the free space, corners of the polygons around the discs.
    nodes: Vec<Point>,
    /// The corners of the free space among them, if not all.
    nearby: Option<Nearby>,
    /// The first node beyond the corners of the free space.
    first_rim: usize,
}

/// The corners of the free space that can be on ways up to a length.
struct Nearby {
    longest: f64,
    /// Their numbers, ascending.
    corners: Vec<usize>,
}

impl Nearby {
    fn on_ways(space: &FreeSpace, from: Point, to: Point, longest: f64) -> Nearby {
        Nearby { longest, corners: space.corners_on_ways(from, to, longest) }
    }
}

/// The step from one node to another, as it waits for its turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Step {
    to: usize,
    from: usize,
}

impl<'a> Search<'a> {
    fn new(
        space: &'a FreeSpace,
        from: Point,
        to: Point,
        discs: &'a [Disc],
        nearby: Option<Nearby>,
    ) -> Search<'a> {
        let mut nodes = vec![from, to];
        let corners = space.corners();
        match &nearby {
            Some(nearby) => nodes.extend(nearby.corners.iter().map(|&corner| corners[corner].at)),
            None => nodes.extend(corners.iter().map(|corner| corner.at)),
        }
        let first_rim = nodes.len();
        let is_usable = |corner: &Point| {
            space.contains(*corner) && avoids(&Segment::new(*corner, *corner), discs)
        };
        nodes.extend(discs.iter().flat_map(|disc| rim(disc, from)).filter(is_usable));
        Search { space, discs, nodes, nearby, first_rim }
    }

    /// Waypoints of a shortest path, without the start; none if there is none, or none of the length up to
    /// which corners are at hand. Steps on ways up to that length have their turns in the same order as if all
    /// corners were.
    fn run(&self) -> Option<Vec<Point>> {
        let mut lengths: Vec<Option<f64>> = vec![None; self.nodes.len()];
        let mut previous = vec![START; self.nodes.len()];
        let mut frontier = BinaryHeap::new();
        lengths[START] = Some(0.0);
        self.for_each_step(START, |step| frontier.push(self.ranked(step, 0.0)));
        let longest = self.nearby.as_ref().map_or(f64::INFINITY, |nearby| nearby.longest);
        while let Some(Ranked { cost, item: step }) = frontier.pop() {
            if cost > longest {
                return None;
            }
            let Some(so_far) = lengths[step.from] else { continue };
            if lengths[step.to].is_some() || !self.is_possible(step) {
                continue;
            }
            let length = so_far + self.segment(step).length();
            lengths[step.to] = Some(length);
            previous[step.to] = step.from;
            if step.to == GOAL {
                return Some(self.waypoints(&previous));
            }
            self.for_each_step(step.to, |next| {
                if lengths[next.to].is_none() {
                    frontier.push(self.ranked(next, length));
                }
            });
        }
        None
    }

    /// Visits the steps that a path may take from a node: along the links of the graph between
    /// corners of the free space, and to everything else.
    fn for_each_step(&self, from: usize, mut visit: impl FnMut(Step)) {
        visit(Step { to: GOAL, from });
        match &self.nearby {
            _ if !self.is_corner(from) => {
                (FIRST_CORNER..self.first_rim).for_each(|to| visit(Step { to, from }));
            }
            Some(Nearby { corners, .. }) => {
                let own = corners[from - FIRST_CORNER];
                let others = (FIRST_CORNER..).zip(corners);
                others
                    .filter(|&(_, &other)| self.space.may_link(own, other))
                    .for_each(|(to, _)| visit(Step { to, from }));
            }
            None => {
                let links = self.space.links(from - FIRST_CORNER).iter();
                links.for_each(|link| visit(Step { to: link.corner + FIRST_CORNER, from }));
            }
        }
        (self.first_rim..self.nodes.len()).for_each(|to| visit(Step { to, from }));
    }

    fn ranked(&self, step: Step, so_far: f64) -> Ranked<Step> {
        let onwards = (self.nodes[GOAL] - self.nodes[step.to]).norm();
        Ranked { cost: so_far + self.segment(step).length() + onwards, item: step }
    }

    fn is_possible(&self, step: Step) -> bool {
        let path = self.segment(step);
        let is_link = self.is_corner(step.from) && self.is_corner(step.to);
        if is_link && self.nearby.is_none() {
            avoids(&path, self.discs)
        } else {
            self.is_passable(&path)
        }
    }

    fn is_passable(&self, path: &Segment) -> bool {
        avoids(path, self.discs) && self.space.is_clear(path)
    }

    fn is_corner(&self, node: usize) -> bool {
        (FIRST_CORNER..self.first_rim).contains(&node)
    }

    fn segment(&self, step: Step) -> Segment {
        Segment::new(self.nodes[step.from], self.nodes[step.to])
    }

    fn waypoints(&self, previous: &[usize]) -> Vec<Point> {
        let mut waypoints = Vec::new();
        let mut at = GOAL;
        while at != START {
            waypoints.push(self.nodes[at]);
            at = previous[at];
        }
        waypoints.reverse();
        waypoints
    }
}

/// Corners of the regular polygon about a disc, turned so that one of its sides faces `from`: where that lies
/// at the disc, the ways round both sides begin there.
fn rim(disc: &Disc, from: Point) -> impl Iterator<Item = Point> {
    let Disc { center, radius } = *disc;
    let ahead = from - center;
    let (facing, half) = (ahead.y.atan2(ahead.x), PI / SIDES as f64);
    (0..SIDES).map(move |corner| {
        let angle = facing + (2 * corner + 1) as f64 * half;
        center + Vector::new(angle.cos(), angle.sin()) * (radius / half.cos())
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that panics has failed
mod tests {
    use super::*;
    use crate::geometry::Workspace;

    /// A hall of five by five square pillars, where many ways are equally long.
    fn hall() -> FreeSpace {
        let square = |x: f64, y: f64, width: f64| {
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                .map(|(a, b)| Point::new(x + a * width, y + b * width))
                .to_vec()
        };
        let pillars = (0..25).map(|index| square(f64::from(index % 5), f64::from(index / 5), 0.5));
        let workspace = Workspace::new(square(-0.5, -0.5, 5.5), pillars.collect()).unwrap();
        FreeSpace::new(&workspace, 0.1).unwrap()
    }

    #[test]
    fn paths_over_the_corners_nearby_are_those_over_all() {
        let space = hall();
        let aisles = (0..5).flat_map(|x| (0..5).map(move |y| (f64::from(x), f64::from(y))));
        let places: Vec<Point> =
            aisles.map(|(x, y)| Point::new(x - 0.25, y + 0.23 - 0.1 * x)).collect();
        let disc = Disc { center: places[12], radius: 0.05 };
        for discs in [&[][..], &[disc]] {
            for (from, to) in
                places.iter().flat_map(|from| places.iter().map(move |to| (*from, *to)))
            {
                let search = Search::new(&space, from, to, discs, None);
                let over_all = search.run().map(|waypoints| {
                    space.departure(from, waypoints, |path| search.is_passable(path))
                });
                assert_eq!(shortest_path(&space, from, to, discs), over_all, "{from} to {to}");
            }
        }
    }
}
