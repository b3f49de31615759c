//! Where robots may walk, prepared once more for what certificates say of places and links.

use pleach_automaton::network::record::Snapshot;
use pleach_automaton::network::scenario::ValidScenario;
use pleach_continuous::Point;
use pleach_continuous::geometry::{FreeSpace, Segment};

use crate::network::limits::Limits;

/// The free space of robots that go by what they know.
pub(super) struct Ground<'a> {
    limits: &'a Limits,
    space: FreeSpace,
    /// The pieces of it in which robots start, ascending.
    pieces: Vec<usize>,
}

impl<'a> Ground<'a> {
    /// The ground of a mission; none if robots have no place to stand.
    pub(super) fn of(scenario: &ValidScenario, limits: &'a Limits) -> Option<Self> {
        let clearance = limits.settings().planning_clearance();
        let space = FreeSpace::new(limits.workspace(), clearance).ok()?;
        let starts = scenario.robot.iter().map(|robot| space.nearest(robot.position.into()));
        let mut pieces: Vec<usize> = starts.filter_map(|start| space.region(start)).collect();
        pieces.sort_unstable();
        pieces.dedup();
        Some(Ground { limits, space, pieces })
    }

    /// Whether a way leads to a place from where a robot started.
    pub(super) fn is_reached(&self, place: Point) -> bool {
        self.space.region(place).is_some_and(|piece| self.pieces.binary_search(&piece).is_ok())
    }

    /// The place nearest to a point of all that robots can come to: it lies on the outline of their pieces,
    /// unless it is the point itself.
    pub(super) fn nearest_reached(&self, point: Point) -> Option<Point> {
        if self.space.nearest(point) == point && self.is_reached(point) {
            return Some(point);
        }
        let edges = self.space.outline().iter().flat_map(|ring| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).map(|(&from, &to)| Segment::new(from, to).nearest(point))
        });
        let mut places: Vec<Point> = edges.collect();
        places.sort_by(|one, other| (one - point).norm().total_cmp(&(other - point).norm()));
        places.into_iter().find(|&place| self.is_reached(place))
    }

    /// The place nearest to a point where a robot could stand, whether or not a way leads there.
    pub(super) fn nearest(&self, point: Point) -> Point {
        self.space.nearest(point)
    }

    /// By how much places and lengths may differ that are computed alike: what the free space is computed to.
    pub(super) fn tolerance(&self) -> f64 {
        10.0 * self.space.tolerance()
    }

    /// How far a link between nodes has to reach so that a robot can walk from one to the other.
    pub(super) fn length(&self, one: usize, other: usize, snapshot: &Snapshot) -> f64 {
        self.space.link_reach(self.place(one, snapshot), self.place(other, snapshot))
    }

    /// How many links of this length lead from a node to the place nearest to a task where a robot could stand.
    pub(super) fn links_to(&self, task: Point, node: usize, snapshot: &Snapshot, link: f64) -> u32 {
        let (from, to) = (self.place(node, snapshot), self.space.nearest(task));
        self.space.geodesic(from, to).map_or(u32::MAX, |way| way.links(from, link, 0.0))
    }

    /// The length of the shortest way from one of these places to the place from which a task is serviced.
    pub(super) fn way_between(&self, roots: &[Point], task: Point) -> f64 {
        let to = self.nearest_reached(task).unwrap_or_else(|| self.space.nearest(task));
        let ways = roots.iter().map(|&from| self.space.distance(self.space.nearest(from), to));
        ways.fold(f64::INFINITY, f64::min)
    }

    fn place(&self, node: usize, snapshot: &Snapshot) -> Point {
        let robots = snapshot.positions.len();
        let place = match node.checked_sub(robots) {
            None => snapshot.positions[node],
            Some(access_point) => self.limits.access_points()[access_point],
        };
        match self.space.contains(place) {
            true => place,
            false => self.space.nearest(place),
        }
    }
}
