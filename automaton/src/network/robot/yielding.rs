//! Making way: a parked robot steps aside for a mover that cannot pass.
//!
//! Exchanging duties does not help where two robots stand beside the mouth of a corridor and
//! neither can turn in while the other is there. A mover that has been stuck for a while says
//! where it wants to go; a parked robot in its way moves aside, never farther than δ from the
//! place of its post, and comes back when no mover is near. While the primary team advances, a robot that follows it
//! steps aside for those ahead of it, too: it stands in a bend, say, and the leader has to turn round there.

use pleach_continuous::geometry::Segment;
use pleach_continuous::{Point, Vector};

use super::Robot;
use super::hearing::Neighbour;

/// Control periods without progress after which a mover asks for way.
const ASKING: u32 = 16;
/// How far ahead, in ρ, a mover asks for way.
const WAY_AHEAD: f64 = 4.0;
/// A robot this many ρ from the way of a mover lets it pass.
const PASSING: f64 = 2.2;
/// Robots within this many ρ of a mover do not settle: they would close the way again.
const SETTLING_DISTANCE: f64 = 4.0;
/// Places considered when stepping aside: directions, and how many paces, each of this many ρ.
const DIRECTIONS: u32 = 16;
const PACES: u32 = 6;
const PACE: f64 = 0.5;
/// A place is better only if it is farther from the way by this share of ρ.
const WORTH_A_STEP: f64 = 0.1;

impl Robot {
    /// Where this robot wants to go next, if it has been stuck for a while. One that steps aside and
    /// cannot asks in turn.
    pub(super) fn way_asked_for(&self) -> Option<Point> {
        let is_on_its_way = !self.is_parked() || self.way_to_clear().is_some();
        self.negotiation
            .navigation()
            .waypoint()
            .filter(|_| is_on_its_way && self.body.still_periods() >= ASKING)
    }

    /// Whether a mover is so near that this robot should not settle now. One that is stuck may be
    /// waiting for just that.
    pub(super) fn is_near_mover(&self) -> bool {
        self.neighbours.iter().any(|neighbour| {
            !neighbour.is_access_point()
                && !neighbour.beacon.parked
                && neighbour.beacon.way.is_none()
                && neighbour.distance <= SETTLING_DISTANCE * self.clearance()
        })
    }

    /// The place to step aside to, if a mover nearby asks for way.
    pub(super) fn place_aside(&self) -> Option<Point> {
        let asking = self.way_to_clear()?;
        let held = self.duty.station().filter(|station| !station.post.is_primary());
        let centre = held.map_or(self.body.position(), |station| station.reference);
        let leash = self.site.settings.leash_radius().max((self.body.position() - centre).norm());
        let room = |place: Point| asking.distance(place).min(PASSING * self.clearance());
        // It does not pass the mover: there may be no room for both.
        let is_away = |step: Vector| step.dot(&(asking.from - self.body.position())) <= 0.0;
        let leads_away_on_the_leash = |place: Point| {
            let way = self.site.free_space.geodesic(self.body.position(), place)?;
            let first = self.next_corner(&way)? - self.body.position();
            let on_leash = |corner: &Point| (corner - centre).norm() <= leash;
            Some(is_away(first) && way.waypoints.iter().all(on_leash))
        };
        let mut best = (room(self.body.position()) + WORTH_A_STEP * self.clearance(), None);
        for pace in 1..=PACES {
            for direction in 0..DIRECTIONS {
                let angle = std::f64::consts::TAU * f64::from(direction) / f64::from(DIRECTIONS);
                let step = Vector::new(angle.cos(), angle.sin()) * PACE * f64::from(pace);
                let place = self.body.position() + step * self.clearance();
                if room(place) > best.0
                    && self.site.free_space.contains(place)
                    && leads_away_on_the_leash(place).unwrap_or(false)
                {
                    best = (room(place), Some(place));
                }
            }
        }
        best.1
    }

    /// The stretch ahead of a mover that asks for way, if this robot stands in it.
    pub(super) fn way_to_clear(&self) -> Option<Segment> {
        self.neighbours.iter().find_map(|mover| {
            let way = self.way_of(mover)?;
            let is_in_the_way = way.distance(self.body.position()) < PASSING * self.clearance();
            (is_in_the_way && self.makes_way_for(mover, &way)).then_some(way)
        })
    }

    /// Whether the mover may ask this robot for way: of the primary team, one that goes on past it asks those that
    /// follow.
    fn makes_way_for(&self, mover: &Neighbour, way: &Segment) -> bool {
        let goes_past = way.vector().dot(&(self.body.position() - way.from)) > 0.0;
        !self.duty.is_primary() || (goes_past && self.is_behind_in_team(mover))
    }

    /// The stretch ahead of a mover that asks for way.
    fn way_of(&self, mover: &Neighbour) -> Option<Segment> {
        let target = mover.beacon.way?;
        let from = mover.position();
        let ahead = target - from;
        let share = (WAY_AHEAD * self.clearance() / ahead.norm()).min(1.0);
        Some(Segment::new(from, from + ahead * share))
    }
}
