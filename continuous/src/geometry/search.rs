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

/// Ways up to this multiple of the straight one are looked at first, and then ones that are longer by this factor.
const NEARLY_STRAIGHT: f64 = 1.05;
const GROWTH: f64 = 1.5;

/// Corners nearby are looked at one by one if they are no more than this, nor than one in this many of all corners.
const FEW_NEARBY: usize = 64;
const SHARE: usize = 16;

/// Up to this many corners are all looked at.
const FEW_CORNERS: usize = 32;

/// A shortest path from `from` to `to`, both in the free space, around every one of `discs`, whose
/// rims are replaced by polygons; `None` if there is none. The straight way between them is not open.
///
/// The search is A\* (<https://doi.org/10.1109/TSSC.1968.300136>) with the straight distance to the
/// goal as bound. Whether two nodes see each other is tested only when the step between them is
/// the most promising one left, so that most pairs are never tested. Most paths are hardly longer than
/// the straight line: corners farther away are looked at only when no shorter way is left.
///
/// Without discs every corner of a shortest path is touched, by links and by the steps from the start and to
/// the goal: others are not looked at, where [both ends allow it](FreeSpace::keep_paths_taut). Paths bend at corners of
/// the planning set and may cut through the sight set, so that a path that is left out can be shorter by a few τ. Where
/// nothing is found, all corners are looked at.
pub(super) fn shortest_path(
    space: &FreeSpace,
    from: Point,
    to: Point,
    discs: &[Disc],
) -> Option<Geodesic> {
    // Beside a disc a shortest path may bend where no obstacle is.
    let may_be_taut = discs.is_empty() && space.keep_paths_taut(from, to);
    let search = |ends_are_taut: bool| {
        let mut search = Search::new(space, from, to, discs, ends_are_taut);
        search.look_up_to(NEARLY_STRAIGHT * (to - from).norm());
        search.run()
    };
    let taut = may_be_taut.then(|| search(true)).flatten();
    let waypoints = taut.or_else(|| search(false))?;
    let is_passable = |path: &Segment| avoids(path, discs) && space.is_clear(path);
    Some(space.departure(from, waypoints, is_passable))
}

/// Whether `path` keeps out of every disc.
pub(super) fn avoids(path: &Segment, discs: &[Disc]) -> bool {
    discs.iter().all(|disc| disc.gap(path) >= -GRAZE * disc.radius)
}

/// The nodes of a search are its start, its goal, the corners of the free space and those of the polygons around
/// the discs.
struct Search<'a> {
    space: &'a FreeSpace,
    discs: &'a [Disc],
    ends: [Point; 2],
    rims: Vec<Point>,
    /// Whether ways between an end and a corner are looked at only if they are taut at the corner.
    ends_are_taut: bool,
    /// The length up to which ways are looked at.
    longest: f64,
    /// The corners over which ways up to that length can lead, ascending.
    nearby: Vec<usize>,
    /// The steps that wait for their turn.
    frontier: BinaryHeap<Ranked<Step>>,
    /// The length of the shortest way to each node that has been reached, and the node before.
    reached: Vec<Option<(f64, usize)>>,
    /// The least cost of the steps to each node that have been queued and are possible for certain.
    least: Vec<f64>,
    /// The nodes that have been reached whose steps to corners are in the frontier up to the longest ways only.
    unfinished: Vec<usize>,
}

/// The step from one node to another, as it waits for its turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Step {
    to: usize,
    from: usize,
    /// Whether nothing of the free space is in the way: it is a link between corners.
    is_link: bool,
}

impl<'a> Search<'a> {
    fn new(
        space: &'a FreeSpace,
        from: Point,
        to: Point,
        discs: &'a [Disc],
        ends_are_taut: bool,
    ) -> Search<'a> {
        let is_usable = |corner: &Point| {
            space.contains(*corner) && avoids(&Segment::new(*corner, *corner), discs)
        };
        let around = discs.iter().flat_map(|disc| rim(disc, from));
        let rims: Vec<Point> =
            around.chain(narrow_passages(space, discs)).filter(is_usable).collect();
        let nodes = FIRST_CORNER + space.corners().len() + rims.len();
        Search {
            space,
            discs,
            ends: [from, to],
            rims,
            ends_are_taut,
            longest: 0.0,
            nearby: Vec::new(),
            frontier: BinaryHeap::with_capacity(FEW_NEARBY),
            reached: vec![None; nodes],
            least: vec![f64::INFINITY; nodes],
            unfinished: Vec::new(),
        }
    }

    /// Waypoints of a shortest path, without the start.
    fn run(mut self) -> Option<Vec<Point>> {
        self.reached[START] = Some((0.0, START));
        self.look_from(START, 0.0);
        while self.reached[GOAL].is_none() {
            match self.frontier.peek() {
                Some(next) if next.cost > self.longest => self.look_farther(),
                Some(_) => self.take_next_step(),
                None if self.longest < f64::INFINITY => self.look_farther(),
                None => return None,
            }
        }
        Some(self.waypoints())
    }

    /// Takes the most promising step, if there is a way.
    fn take_next_step(&mut self) {
        let Some(Ranked { item: step, .. }) = self.frontier.pop() else { return };
        let Some((so_far, _)) = self.reached[step.from] else { return };
        if self.reached[step.to].is_none() && self.is_possible(step) {
            let length = so_far + self.segment(step).length();
            self.reached[step.to] = Some((length, step.from));
            if step.to != GOAL {
                self.look_from(step.to, length);
            }
        }
    }

    /// The shortest way to a node is known, and so long. What may come next joins the frontier.
    fn look_from(&mut self, node: usize, length: f64) {
        for to in self.first_rim()..self.reached.len() {
            self.consider(Step { to, from: node, is_link: false });
        }
        if node != START && self.may_touch(node, GOAL) {
            self.consider(Step { to: GOAL, from: node, is_link: false });
        }
        if self.is_corner(node) && !self.has_few_nearby() {
            self.consider_links(node, length);
        } else {
            self.unfinished.push(node);
            self.consider_nearby(node, f64::NEG_INFINITY);
        }
    }

    fn consider(&mut self, step: Step) {
        if self.reached[step.to].is_none() {
            self.frontier.push(Ranked { cost: self.cost(step), item: step });
        }
    }

    /// Considers the links of a corner, to which the shortest way is this long. Without discs all are possible: of
    /// those to the same corner only the cheapest counts.
    fn consider_links(&mut self, node: usize, so_far: f64) {
        let space = self.space;
        for link in space.links(node - FIRST_CORNER) {
            let to = link.corner + FIRST_CORNER;
            if self.reached[to].is_none() {
                let cost = so_far + link.length + self.onwards(to);
                if cost <= self.least[to] {
                    if self.discs.is_empty() {
                        self.least[to] = cost;
                    }
                    self.frontier
                        .push(Ranked { cost, item: Step { to, from: node, is_link: true } });
                }
            }
        }
    }

    /// Considers the steps from a node to corners nearby, on ways longer than those that have been looked at.
    fn consider_nearby(&mut self, node: usize, shorter: f64) {
        for at in 0..self.nearby.len() {
            let corner = self.nearby[at];
            let step = Step { to: corner + FIRST_CORNER, from: node, is_link: false };
            if self.reached[step.to].is_some() {
                continue;
            }
            let cost = self.cost(step);
            if shorter < cost && cost <= self.longest && self.may_be_taut(node, corner) {
                self.frontier.push(Ranked { cost, item: step });
            }
        }
    }

    /// Whether shortest paths may go from a node straight to a corner.
    fn may_be_taut(&self, node: usize, corner: usize) -> bool {
        match node {
            _ if self.is_corner(node) => self.space.may_link(node - FIRST_CORNER, corner),
            START => self.may_touch(corner + FIRST_CORNER, START),
            _ => true,
        }
    }

    /// Whether shortest paths may go straight between a node and an end.
    fn may_touch(&self, node: usize, end: usize) -> bool {
        !(self.ends_are_taut && self.is_corner(node))
            || self.space.may_touch(node - FIRST_CORNER, self.at(end))
    }

    /// Whether steps to the corners nearby are looked at one by one. Links, which the free space finds when they are
    /// asked for first and keeps, lead to corners everywhere.
    fn has_few_nearby(&self) -> bool {
        self.nearby.len() <= FEW_NEARBY.min(self.space.corners().len() / SHARE)
    }

    /// No way is left of the length up to which ways are looked at.
    fn look_farther(&mut self) {
        let shorter = self.longest;
        let longer = GROWTH * shorter;
        self.look_up_to(if longer > shorter { longer } else { f64::INFINITY });
        for node in self.unfinished.clone() {
            self.consider_nearby(node, shorter);
        }
    }

    /// Looks at ways up to this length, or at all where there are few corners or most are nearby.
    fn look_up_to(&mut self, length: f64) {
        let [from, to] = self.ends;
        let corners = self.space.corners().len();
        let nearby = (corners > FEW_CORNERS).then(|| self.space.corners_on_ways(from, to, length));
        (self.longest, self.nearby) = match nearby {
            Some(nearby) if nearby.len() < corners / 2 => (length, nearby),
            _ => (f64::INFINITY, (0..corners).collect()),
        };
    }

    /// The length of the way that takes this step and goes straight on to the goal, if it can.
    fn cost(&self, step: Step) -> f64 {
        let so_far = self.reached[step.from].map_or(0.0, |(length, _)| length);
        so_far + self.segment(step).length() + self.onwards(step.to)
    }

    /// The distance from a node to the goal.
    fn onwards(&self, node: usize) -> f64 {
        (self.at(GOAL) - self.at(node)).norm()
    }

    fn is_possible(&self, step: Step) -> bool {
        let path = self.segment(step);
        avoids(&path, self.discs) && (step.is_link || self.space.is_clear(&path))
    }

    fn is_corner(&self, node: usize) -> bool {
        (FIRST_CORNER..self.first_rim()).contains(&node)
    }

    fn first_rim(&self) -> usize {
        FIRST_CORNER + self.space.corners().len()
    }

    fn at(&self, node: usize) -> Point {
        match node {
            START | GOAL => self.ends[node],
            _ if self.is_corner(node) => self.space.corners()[node - FIRST_CORNER].at,
            _ => self.rims[node - self.first_rim()],
        }
    }

    fn segment(&self, step: Step) -> Segment {
        Segment::new(self.at(step.from), self.at(step.to))
    }

    fn waypoints(&self) -> Vec<Point> {
        let mut waypoints = Vec::new();
        let mut node = GOAL;
        while let Some((_, previous)) = self.reached[node].filter(|_| node != START) {
            waypoints.push(self.at(node));
            node = previous;
        }
        waypoints.reverse();
        waypoints
    }
}

/// Corners of the regular polygon about a disc, turned so that one of its sides faces `from`: where that lies
/// at the disc, the ways round both sides begin there.
fn rim(disc: &Disc, from: Point) -> impl Iterator<Item = Point> {
    let (center, radius) = (disc.center, outer_radius(disc));
    let ahead = from - center;
    let (facing, half) = (ahead.y.atan2(ahead.x), PI / SIDES as f64);
    (0..SIDES).map(move |corner| {
        let angle = facing + (2 * corner + 1) as f64 * half;
        center + Vector::new(angle.cos(), angle.sin()) * radius
    })
}

/// Where ways that are too narrow for the polygons about discs begin and end, beside a wall or another disc: the circle
/// on which the corners of a polygon lie meets the wall, or that about the other disc.
fn narrow_passages(space: &FreeSpace, discs: &[Disc]) -> Vec<Point> {
    let outer = discs.iter().map(|disc| Disc { radius: outer_radius(disc), ..*disc });
    let outer: Vec<Disc> = outer.collect();
    let mut places = Vec::new();
    for (at, circle) in outer.iter().enumerate() {
        for wall in space.planning_walls_near(circle.center, circle.radius) {
            places.extend(circle.crossings(wall));
            // Crossings on both sides of a corner may not see each other.
            places.extend(Some(wall.from).filter(|&corner| circle.contains(corner)));
        }
        places.extend(outer[at + 1..].iter().flat_map(|other| circle.crossings_with(other)));
        places.extend(discs[at + 1..].iter().flat_map(|other| ends_of_gap(&discs[at], other)));
    }
    places
}

/// Where the line through the middle of the gap between two discs, square to that between their centres, meets the
/// circles of their polygons. Of discs of the same size these circles meet there; of others they meet nearer to the
/// smaller disc, and the line there may lead through it.
fn ends_of_gap(one: &Disc, other: &Disc) -> Vec<Point> {
    let (center, apart) = (one.center, other.center - one.center);
    let distance = apart.norm();
    if distance == 0.0 || one.radius == other.radius {
        return Vec::new();
    }
    let along = (distance + one.radius - other.radius) / 2.0;
    let aside = |radius: f64, along: f64| (radius * radius - along * along).sqrt();
    let reaches = [aside(outer_radius(one), along), aside(outer_radius(other), distance - along)];
    let (ahead, left) = (apart / distance, Vector::new(-apart.y, apart.x) / distance);
    // A circle that does not reach the line has a root of a negative number here.
    let reaches = reaches.into_iter().filter(|reach| reach.is_finite());
    let asides = reaches.flat_map(|reach| [reach, -reach]);
    asides.map(|aside| center + ahead * along + left * aside).collect()
}

/// The distance of the corners of the polygon about a disc from its centre.
fn outer_radius(disc: &Disc) -> f64 {
    disc.radius / (PI / SIDES as f64).cos()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that panics has failed
mod tests {
    use super::*;
    use crate::geometry::Workspace;

    /// A hall of nine by nine square pillars, where many ways are equally long.
    fn hall() -> FreeSpace {
        let square = |x: f64, y: f64, width: f64| {
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                .map(|(a, b)| Point::new(x + a * width, y + b * width))
                .to_vec()
        };
        let pillars = (0..81).map(|index| square(f64::from(index % 9), f64::from(index / 9), 0.5));
        let workspace = Workspace::new(square(-0.5, -0.5, 9.5), pillars.collect()).unwrap();
        FreeSpace::new(&workspace, 0.1).unwrap()
    }

    /// Over all in any direction, too.
    #[test]
    fn paths_over_the_corners_nearby_are_those_over_all() {
        let space = hall();
        let aisles = (0..9).flat_map(|x| (0..9).map(move |y| (f64::from(x), f64::from(y))));
        let places: Vec<Point> =
            aisles.map(|(x, y)| Point::new(x - 0.25, y + 0.23 - 0.1 * x)).collect();
        let ends = || places.iter().step_by(3);
        let disc = Disc { center: places[40], radius: 0.05 };
        for discs in [&[][..], &[disc]] {
            for (from, to) in ends().flat_map(|from| ends().map(move |to| (*from, *to))) {
                let straight = Segment::new(from, to);
                if avoids(&straight, discs) && space.is_clear(&straight) {
                    continue;
                }
                let mut search = Search::new(&space, from, to, discs, false);
                search.look_up_to(f64::INFINITY);
                let is_passable = |path: &Segment| avoids(path, discs) && space.is_clear(path);
                let over_all =
                    search.run().map(|waypoints| space.departure(from, waypoints, is_passable));
                assert_eq!(shortest_path(&space, from, to, discs), over_all, "{from} to {to}");
            }
        }
    }
}
