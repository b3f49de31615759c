//! Which way a robot goes: round obstacles, parked robots, and with its link (Definition 4.1).

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_continuous::geometry::Segment;
use pleach_continuous::geometry::{Destination, Disc, FreeSpace, Geodesic};
use pleach_discrete::network::PostKind;

use super::Robot;
use super::links::TreeLink;
use super::motion::ROUNDING;

/// Parked robots are kept at this many ρ when there is a way round.
pub(super) const KEEP_OUT: f64 = 2.1;
/// Bodies that rest are kept at this many ρ: gaps between them through which a robot can just pass stay open, since
/// a body makes no way and takes part in no exchange.
const KEEP_OUT_OF_BODIES: f64 = 2.01;
/// A way round parked robots is taken if it is longer by at most this many ρ; otherwise the robot
/// goes straight on and exchanges duties with the robot in its way.
const DETOUR_ALLOWANCE: f64 = 8.0;
/// A way as good as another but for this many ρ is kept: robots do not alternate between two sides.
const HYSTERESIS: f64 = 1.0;
/// A waypoint this many ρ away is as good as reached: no reason to keep to it.
const NEARBY: f64 = 0.1;
/// Control periods without progress after which a robot does not keep to its way any more.
const PATIENCE_WITH_WAYS: u32 = 3;

impl Robot {
    /// a₁ of the way to the goal: of the geodesic, round wrecks and bodies that rest, and round parked robots
    /// where that is a short way round, unless its link holds it back on that side of an obstacle.
    pub(super) fn first_waypoint(&mut self, goal: Point) -> Option<Point> {
        let site = Arc::clone(&self.site);
        let free_space: &FreeSpace = &site.free_space;
        self.negotiation.navigation_mut().head_for(goal, free_space);
        let direct = free_space
            .geodesic_to(self.body.position(), self.negotiation.navigation().destination()?)?;
        let keep_out = KEEP_OUT * self.clearance();
        let wrecks = self.keep_out_discs(keep_out);
        let bodies = self.discs_of_bodies(KEEP_OUT_OF_BODIES * self.clearance());
        let fixed: Vec<Disc> = wrecks.chain(bodies).collect();
        let parked: Vec<Disc> = self
            .neighbours
            .iter()
            .filter(|neighbour| !neighbour.is_access_point() && neighbour.beacon.parked)
            .map(|n| Disc { center: n.position(), radius: keep_out })
            .chain(fixed.iter().copied())
            .collect();
        let path = self.way_around(self.body.position(), direct, &fixed, &parked);
        let way = self.way_of_link(&path, &parked);
        self.negotiation.navigation_mut().follow_link(way.is_some());
        if let Some(way) = way {
            return Some(self.next_corner(&way).unwrap_or(goal));
        }
        let corner = self.next_corner(&path).unwrap_or(goal);
        match self
            .negotiation
            .navigation()
            .waypoint()
            .filter(|&kept| kept != corner && self.may_keep(kept))
        {
            Some(kept) => {
                let onward =
                    free_space.geodesic_to(kept, self.negotiation.navigation().destination()?)?;
                let length = (kept - self.body.position()).norm()
                    + self.way_around(kept, onward, &fixed, &parked).length;
                let margin = HYSTERESIS * self.clearance();
                Some(if length <= path.length + margin { kept } else { corner })
            }
            None => Some(corner),
        }
    }

    /// The way from this place to the goal, which leads there `direct`, round what does not move, and round parked robots
    /// as well where that is short: those take part in an exchange of duties, a wreck or a body in none.
    fn way_around(
        &self,
        from: Point,
        direct: Geodesic,
        fixed: &[Disc],
        parked: &[Disc],
    ) -> Geodesic {
        let space = &self.site.free_space;
        let Some(goal) = self.negotiation.navigation().destination().map(Destination::goal) else {
            return direct;
        };
        let direct = match fixed.is_empty() {
            true => direct,
            false => space.detour(from, goal, fixed).unwrap_or(direct),
        };
        let most = direct.length + DETOUR_ALLOWANCE * self.clearance();
        let is_taken =
            |round: &Geodesic| round.length <= most && self.may_change_over_along(from, round);
        space.detour(from, goal, parked).filter(is_taken).unwrap_or(direct)
    }

    /// The length of the shortest way between two places around robots that have stopped; none if they close it.
    pub(super) fn open_way(&self, from: Point, to: Point) -> Option<f64> {
        let stopped: Vec<Disc> = self.keep_out_discs(KEEP_OUT * self.clearance()).collect();
        self.site.distance_around(from, to, &stopped)
    }

    /// Another way to the goal than `path`, on which its link leads farther: that by its parent, pulled
    /// taut, if the parent rests and the two ways pass an obstacle on different sides. On each side a robot
    /// gets as far as its link is long; where that is nearer to the goal on the parent's side, the robot
    /// goes back round the obstacle; where robots are `parked` in that way, only if it gains more than a
    /// detour may cost. One that changes over to other parents on its way goes by way of those.
    fn way_of_link(&self, path: &Geodesic, parked: &[Disc]) -> Option<Geodesic> {
        if let Some(crossing) = self.crossing() {
            return self.way_over(crossing, path);
        }
        let link = self.parent_link()?;
        let parent =
            self.neighbour(link.to).filter(|it| it.is_access_point() || it.beacon.parked)?;
        let (space, parent) = (&self.site.free_space, parent.position());
        if path.waypoints.iter().all(|&at| self.site.walk(at, parent) <= link.limit) {
            return None;
        }
        let back = space.geodesic(self.body.position(), parent)?;
        // What is left of a way that the link does not cover.
        let left = |length: f64| (length - link.limit).max(0.0);
        if left(back.length + path.length) == 0.0 {
            return None;
        }
        let onward = space.geodesic_to(parent, self.negotiation.navigation().destination()?)?;
        // A robot that goes by the parent's side already does not turn round where it gains less by that.
        let is_kept = self.keeps_way_of_link();
        let hysteresis = if is_kept { 0.0 } else { HYSTERESIS };
        let least = left(onward.length) + hysteresis * self.clearance();
        if left(back.length + path.length) <= least {
            return None;
        }
        let corners = back.waypoints.iter().rev().skip(1).copied().chain([self.body.position()]);
        let around: Vec<Point> = corners.chain(path.waypoints.iter().copied()).collect();
        let by_path = left(space.taut(parent, &around).length);
        if by_path <= least {
            return None;
        }
        let way = space.taut(self.body.position(), &[back.waypoints, onward.waypoints].concat());
        if self.is_held_by_link_ahead(path, &way) {
            return None;
        }
        let is_obstructed =
            |piece: Segment| parked.iter().any(|disc| piece.distance(disc.center) < disc.radius);
        let allowance = match way.segments(self.body.position()).any(is_obstructed) {
            true if !is_kept => DETOUR_ALLOWANCE,
            _ => hysteresis,
        };
        (by_path > left(onward.length) + allowance * self.clearance()).then_some(way)
    }

    /// Another way to the goal than `path`, where that is out of reach of these access points: by way of that to which
    /// the robot is attached and the next, pulled taut. On the way between those it always reaches one of them.
    fn way_over(&self, crossing: &[usize], path: &Geodesic) -> Option<Geodesic> {
        if !self.keeps_way_of_link() && self.keeps_link_along(crossing, self.body.position(), path)
        {
            return None;
        }
        let (site, space) = (&self.site, &self.site.free_space);
        let passed = crossing.iter().skip(self.index_in_crossing(crossing)).take(2);
        let goal = self.negotiation.navigation().destination()?.goal();
        let mut from = self.body.position();
        let mut corners = Vec::new();
        for to in passed.map(|&access| site.access_points[access]).chain([goal]) {
            corners.extend(space.geodesic(from, to)?.waypoints);
            from = to;
        }
        Some(space.taut(self.body.position(), &corners))
    }

    /// Whether it follows a way that its link requires, and is making progress.
    fn keeps_way_of_link(&self) -> bool {
        self.negotiation.navigation().goes_by_link()
            && self.body.still_periods() < PATIENCE_WITH_WAYS
    }

    /// Whether its link to the robot that it follows, which `path` leads to, would exceed its limit on `way`. It is
    /// longest where both sides of the obstacle are equally long: (path + way) / 2.
    pub(super) fn is_held_by_link_ahead(&self, path: &Geodesic, way: &Geodesic) -> bool {
        let limit = self.link_ahead().map(|link| link.limit);
        limit.is_some_and(|limit| (path.length + way.length) / 2.0 > limit)
    }

    /// Its link to the robot of the primary team that it follows.
    fn link_ahead(&self) -> Option<TreeLink> {
        let PostKind::Primary { follows: Some(ahead) } = self.duty.post()?.kind else {
            return None;
        };
        let ahead = self.holder(ahead)?.id();
        self.tree_links().into_iter().find(|link| link.to == ahead)
    }

    /// Whether the waypoint of the period before can still be used. One that it has almost
    /// reached would stop it: solvers end slightly short of a waypoint.
    fn may_keep(&self, waypoint: Point) -> bool {
        self.body.still_periods() < PATIENCE_WITH_WAYS
            && (waypoint - self.body.position()).norm() > NEARBY * self.clearance()
            && self.site.free_space.sees(self.body.position(), waypoint)
    }

    /// The first waypoint that the robot has not reached. One that has strayed goes where the path leads
    /// once it has re-entered: what keeps it off walls lets it do both at once.
    pub(super) fn next_corner(&self, path: &Geodesic) -> Option<Point> {
        let reached = ROUNDING * self.site.workspace.extent();
        let is_entry = self.has_strayed() && path.waypoints.len() > 1;
        let ahead = path.waypoints.iter().copied().skip(usize::from(is_entry));
        ahead.into_iter().find(|w| (w - self.body.position()).norm() > reached)
    }
}
