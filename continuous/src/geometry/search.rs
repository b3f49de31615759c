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

/// A shortest path from `from` to `to`, both in the free space, around every one of `discs`, whose
/// rims are replaced by polygons; `None` if there is none.
///
/// The search is A\* (<https://doi.org/10.1109/TSSC.1968.300136>) with the straight distance to the
/// goal as bound. Whether two nodes see each other is tested only when the step between them is
/// the most promising one left, so that most pairs are never tested.
pub(super) fn shortest_path(
    space: &FreeSpace,
    from: Point,
    to: Point,
    discs: &[Disc],
) -> Option<Geodesic> {
    let search = Search::new(space, from, to, discs);
    let waypoints = search.run()?;
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
    /// The first node beyond the corners of the free space.
    first_rim: usize,
}

/// The step from one node to another, as it waits for its turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Step {
    to: usize,
    from: usize,
}

impl<'a> Search<'a> {
    fn new(space: &'a FreeSpace, from: Point, to: Point, discs: &'a [Disc]) -> Search<'a> {
        let mut nodes = vec![from, to];
        nodes.extend(space.corners().iter().map(|corner| corner.at));
        let first_rim = nodes.len();
        let is_usable = |corner: &Point| {
            space.contains(*corner) && avoids(&Segment::new(*corner, *corner), discs)
        };
        nodes.extend(discs.iter().flat_map(|disc| rim(disc, from)).filter(is_usable));
        Search { space, discs, nodes, first_rim }
    }

    /// Waypoints of a shortest path, without the start.
    fn run(&self) -> Option<Vec<Point>> {
        let mut lengths: Vec<Option<f64>> = vec![None; self.nodes.len()];
        let mut previous = vec![START; self.nodes.len()];
        let mut frontier = BinaryHeap::new();
        lengths[START] = Some(0.0);
        self.for_each_step(START, |step| frontier.push(self.ranked(step, 0.0)));
        while let Some(Ranked { item: step, .. }) = frontier.pop() {
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
        if self.is_corner(from) {
            for link in self.space.links(from - FIRST_CORNER) {
                visit(Step { to: link.corner + FIRST_CORNER, from });
            }
        } else {
            (FIRST_CORNER..self.first_rim).for_each(|to| visit(Step { to, from }));
        }
        (self.first_rim..self.nodes.len()).for_each(|to| visit(Step { to, from }));
    }

    fn ranked(&self, step: Step, so_far: f64) -> Ranked<Step> {
        let onwards = (self.nodes[GOAL] - self.nodes[step.to]).norm();
        Ranked { cost: so_far + self.segment(step).length() + onwards, item: step }
    }

    fn is_possible(&self, step: Step) -> bool {
        let path = self.segment(step);
        if self.is_corner(step.from) && self.is_corner(step.to) {
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
