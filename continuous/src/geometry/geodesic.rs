//! Shortest paths in the free space (Definition 4.1).

use std::collections::BinaryHeap;

use super::ranked::Ranked;
use super::reentry::with_ends;
use super::search::shortest_path;
use super::{FreeSpace, Segment};
use crate::Point;

/// A shortest path in the free space: straight lines between reflex vertices (15).
///
/// With holes there can be several of equal length; which of them is returned is deterministic
/// but arbitrary.
#[derive(Debug, Clone, PartialEq)]
pub struct Geodesic {
    /// Length of the path.
    pub length: f64,
    /// Where the path goes from its start: the vertices a₁, …, a_m, and last the goal. Never empty.
    pub waypoints: Vec<Point>,
}

impl Geodesic {
    /// The path from `start` through `waypoints`.
    pub(super) fn new(start: Point, waypoints: Vec<Point>) -> Geodesic {
        let length = segments(start, &waypoints).map(|segment| segment.length()).sum();
        Geodesic { length, waypoints }
    }

    /// How far a link has to reach for a robot to walk this path, which begins at `start`, from either end of the link to
    /// the other and never be farther than that from where it goes or comes from: the largest distance of a point of
    /// the path to one of its ends. At least their distance, and at most the length of the path.
    pub fn reach(&self, start: Point) -> f64 {
        let goal = self.waypoints.last().copied().unwrap_or(start);
        // The distance to a point is convex along a segment, and so largest at a waypoint.
        let reaches = self.waypoints.iter().map(|&at| (at - start).norm().max((at - goal).norm()));
        reaches.fold(0.0, f64::max)
    }

    /// The largest distance of a point of this path, which begins at `start`, to the nearer one of its ends: how far two
    /// nodes there have to reach for a robot that walks the path to be in reach of one of them all along.
    pub fn gap(&self, start: Point) -> f64 {
        let goal = self.waypoints.last().copied().unwrap_or(start);
        let nearer = |at: Point| (at - start).norm().min((at - goal).norm());
        // Along a segment it is largest at an end or where both distances are the same.
        let middle = (start - goal).norm_squared() / 2.0;
        let gap = |segment: Segment| {
            let (offset, slope) =
                ((segment.from - goal).dot(&(start - goal)), segment.vector().dot(&(start - goal)));
            let level = ((middle - offset) / slope).clamp(0.0, 1.0);
            let level = if level.is_nan() { segment.from } else { segment.at(level) };
            nearer(segment.from).max(nearer(segment.to)).max(nearer(level))
        };
        self.segments(start).map(gap).fold(0.0, f64::max)
    }

    /// How many links lead along this path, which begins at `start`, to within `rest` of its end, where each is taken as
    /// long as it may be: up to where the path leaves the disc of radius `longest` around the beginning of the link.
    pub fn links(&self, start: Point, longest: f64, rest: f64) -> u32 {
        let (mut from, mut path) = (start, self.without_end(start, rest));
        let mut links = 0;
        while path.length > 0.0 && links < MOST_LINKS {
            (from, path) = path.after(from, path.covered(from, longest));
            links += 1;
        }
        links
    }

    /// The path without its last piece of this length; no longer than its start where it is shorter.
    fn without_end(&self, start: Point, rest: f64) -> Geodesic {
        let kept = (self.length - rest).max(0.0);
        let mut walked = 0.0;
        let mut waypoints = Vec::with_capacity(self.waypoints.len());
        for segment in self.segments(start) {
            let length = segment.length();
            if walked + length >= kept {
                waypoints.push(segment.at(share(kept - walked, length)));
                break;
            }
            walked += length;
            waypoints.push(segment.to);
        }
        Geodesic::new(start, waypoints)
    }

    /// How much of the path is within `longest` of its start, up to where it leaves that disc first.
    fn covered(&self, start: Point, longest: f64) -> f64 {
        let mut walked = 0.0;
        for segment in self.segments(start) {
            match exit_of_disc(&segment, start, longest) {
                Some(at) => return walked + at * segment.length(),
                None => walked += segment.length(),
            }
        }
        self.length
    }

    /// The rest of the path after this length, with where it begins.
    fn after(&self, start: Point, length: f64) -> (Point, Geodesic) {
        let mut walked = 0.0;
        for (index, segment) in self.segments(start).enumerate() {
            let end = walked + segment.length();
            if end > length {
                let from = segment.at(share(length - walked, segment.length()));
                return (from, Geodesic::new(from, self.waypoints[index..].to_vec()));
            }
            walked = end;
        }
        let end = self.waypoints.last().copied().unwrap_or(start);
        (end, Geodesic::new(end, vec![end]))
    }

    /// The segments of the path, which begins at `start`.
    pub fn segments(&self, start: Point) -> impl Iterator<Item = Segment> {
        segments(start, &self.waypoints)
    }
}

/// More links than any path takes.
const MOST_LINKS: u32 = 1_000_000;

fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { (part / whole).clamp(0.0, 1.0) } else { 0.0 }
}

/// Where, as a share, a segment that begins in the disc leaves it.
fn exit_of_disc(segment: &Segment, center: Point, radius: f64) -> Option<f64> {
    if (segment.to - center).norm() <= radius {
        return None;
    }
    let (along, offset) = (segment.vector(), segment.from - center);
    let (square, half) = (along.norm_squared(), along.dot(&offset));
    let root = (half * half - square * (offset.norm_squared() - radius * radius)).max(0.0).sqrt();
    Some(((root - half) / square).clamp(0.0, 1.0))
}

fn segments(start: Point, waypoints: &[Point]) -> impl Iterator<Item = Segment> {
    let starts = std::iter::once(start).chain(waypoints.iter().copied());
    starts.zip(waypoints).map(|(from, to)| Segment::new(from, *to))
}

/// A goal with everything about it computed once: the way from every corner of one free space.
/// Made by [`FreeSpace::destination`], used with [`FreeSpace::geodesic_to`] of the same free space.
#[derive(Debug, Clone)]
pub struct Destination {
    goal: Point,
    /// The free point from which the goal is reached: the goal itself, or the point nearest to it;
    /// `None` if no way leads to it.
    exit: Option<Point>,
    ways: Vec<Way>,
}

/// The way from a corner to the goal.
#[derive(Debug, Clone, Copy)]
struct Way {
    /// Length of the shortest path; infinite if there is none.
    length: f64,
    /// The corner that follows on it; `None` if the goal does.
    next: Option<usize>,
}

impl Destination {
    /// The goal.
    pub fn goal(&self) -> Point {
        self.goal
    }

    fn waypoints_from(&self, corner: usize, exit: Point, space: &FreeSpace) -> Vec<Point> {
        let corners = space.corners();
        let chain = std::iter::successors(Some(corner), |&at| self.ways[at].next);
        chain.filter_map(|at| corners.get(at)).map(|corner| corner.at).chain([exit]).collect()
    }
}

impl FreeSpace {
    /// A shortest path from `from` to `to`, `None` if there is none.
    ///
    /// From and to points outside the free space the path leads over their
    /// [entry](FreeSpace::entry), the nearest free point; `None` if they are farther out than the
    /// reach of re-entry.
    pub fn geodesic(&self, from: Point, to: Point) -> Option<Geodesic> {
        let (entry, exit) = (self.entry(from)?, self.entry(to)?);
        let path = self.geodesic_inside(entry, exit)?;
        Some(with_ends(path, (from, entry), (exit, to)))
    }

    fn geodesic_inside(&self, from: Point, to: Point) -> Option<Geodesic> {
        if self.is_clear(&Segment::new(from, to)) {
            return Some(Geodesic::new(from, vec![to]));
        }
        shortest_path(self, from, to, &[])
    }

    /// Length of a shortest path from `from` to `to`; infinite if there is none.
    pub fn distance(&self, from: Point, to: Point) -> f64 {
        self.geodesic(from, to).map_or(f64::INFINITY, |path| path.length)
    }

    /// How far a link between these places has to reach so that a robot can [walk](Geodesic::reach) from one to the other;
    /// infinite if no way leads there.
    pub fn link_reach(&self, from: Point, to: Point) -> f64 {
        self.geodesic(from, to).map_or(f64::INFINITY, |path| path.reach(from))
    }

    /// The shortest ways to `goal` from everywhere, for many questions about the same goal.
    /// A goal farther outside the free space than the reach of re-entry is reached from nowhere.
    pub fn destination(&self, goal: Point) -> Destination {
        let unreached = Way { length: f64::INFINITY, next: None };
        let mut ways = vec![unreached; self.corners().len()];
        let exit = self.entry(goal);
        let Some(start) = exit else { return Destination { goal, exit, ways } };
        let mut frontier = BinaryHeap::new();
        for (corner, length) in self.corners_seen_from(start) {
            ways[corner].length = length;
            frontier.push(Ranked { cost: length, item: corner });
        }
        while let Some(Ranked { cost, item: corner }) = frontier.pop() {
            if cost > ways[corner].length {
                continue;
            }
            for link in self.links(corner) {
                let length = cost + link.length;
                if length < ways[link.corner].length {
                    ways[link.corner] = Way { length, next: Some(corner) };
                    frontier.push(Ranked { cost: length, item: link.corner });
                }
            }
        }
        Destination { goal, exit, ways }
    }

    /// A shortest path from `from` to a destination of this free space, `None` if there is none.
    /// Ends outside the free space are treated as by [`geodesic`](Self::geodesic).
    ///
    /// Corners are tried in the order of the length that the path over them would have: the first
    /// one in sight is on a shortest path, and few are tested.
    pub fn geodesic_to(&self, from: Point, destination: &Destination) -> Option<Geodesic> {
        let (entry, exit) = (self.entry(from)?, destination.exit?);
        let path = self.geodesic_to_exit(entry, exit, destination)?;
        Some(with_ends(path, (from, entry), (exit, destination.goal)))
    }

    fn geodesic_to_exit(
        &self,
        from: Point,
        exit: Point,
        destination: &Destination,
    ) -> Option<Geodesic> {
        if self.is_clear(&Segment::new(from, exit)) {
            return Some(Geodesic::new(from, vec![exit]));
        }
        let corners = self.corners();
        let mut candidates: BinaryHeap<Ranked<usize>> = corners
            .iter()
            .zip(&destination.ways)
            .enumerate()
            .filter(|(_, (_, way))| way.length.is_finite())
            .map(|(item, (corner, way))| Ranked {
                cost: (corner.at - from).norm() + way.length,
                item,
            })
            .collect();
        while let Some(Ranked { item: corner, .. }) = candidates.pop() {
            if self.is_clear(&Segment::new(from, corners[corner].at)) {
                let waypoints = destination.waypoints_from(corner, exit, self);
                return Some(self.departure(from, waypoints, |path| self.is_clear(path)));
            }
        }
        None
    }

    /// Length of a shortest path from `from` to a destination; infinite if there is none.
    pub fn distance_to(&self, from: Point, destination: &Destination) -> f64 {
        self.geodesic_to(from, destination).map_or(f64::INFINITY, |path| path.length)
    }

    /// The path from `from` through `waypoints`, without a first waypoint where `from` already is:
    /// a robot at a corner is told where to go next, unless it must still come closer to see it.
    pub(super) fn departure(
        &self,
        from: Point,
        mut waypoints: Vec<Point>,
        passable: impl Fn(&Segment) -> bool,
    ) -> Geodesic {
        while waypoints.len() > 1 {
            let is_here = (waypoints[0] - from).norm() < self.tolerance();
            if !is_here || !passable(&Segment::new(from, waypoints[1])) {
                break;
            }
            waypoints.remove(0);
        }
        Geodesic::new(from, waypoints)
    }
}
