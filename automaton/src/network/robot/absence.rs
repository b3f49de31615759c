//! Robots that do not take part: the roll that lets this robot move, and the bodies of those that are
//! suspended or gone.
//!
//! A robot that is gone is not expected to be heard. Others go round the place where any node heard it
//! last. They stay farther from it by the length of the move that it told of then, as no robot moves
//! without a witness, and by one step more; or by two steps in all, where witnesses may have stopped as
//! well. They learn of this place when the robot is suspended, and so before they can come near without
//! having heard it.
//!
//! Every robot tells where those are that are attached to it: if the only one that hears a robot stops,
//! its own neighbours still know where that was.
//! A robot that is cut off stays within two steps of each place where it has been since its newest roll was called
//! ([`membership`](super::membership)).

use pleach_continuous::Point;
use pleach_continuous::geometry::{Disc, HalfPlane};
use pleach_continuous::network::reliability::LinkReliability;

use super::Robot;
use super::hearing::Neighbour;
use super::motion::{MARGIN, ROUNDING};
use crate::network::beacon::{Beacon, Branch};
use crate::network::roll::{Roll, Wreck};
use crate::network::scenario::Settings;

/// A robot that is gone is at most this many steps from where it was heard last, even if its last moves are
/// not known.
const ASTRAY: f64 = 2.0;

impl Robot {
    /// A roll is received.
    #[inline]
    pub(super) fn hear_roll(&mut self, roll: &Roll) {
        if self.membership.receive_roll(roll) {
            self.note_change();
        }
    }

    /// It has begun, and heard who is in range. One that starts well in range, and that it has not heard, may be
    /// on its way.
    pub(super) fn look_around(&mut self) {
        if self.membership.is_late_comer() {
            return;
        }
        for (robot, start) in self.site.starts_well_in_range(self.body.position()) {
            if robot != self.id && self.neighbour(robot).is_none() {
                self.membership.miss(Wreck::heard(robot, start, 0));
            }
        }
    }

    /// Whether it takes part by a roll that is valid.
    pub(super) fn is_called(&self) -> bool {
        let validity = self.site.roll_validity();
        self.membership.roll().lets_move(self.id, self.schedule.period(), validity)
    }

    /// A robot is out of sight: where it was heard last.
    pub(super) fn lose_sight_of(&mut self, lost: &Neighbour) {
        if lost.is_access_point() {
            return;
        }
        self.membership.note(lost.wreck());
        if self.site.is_well_in_range(lost.distance) && !self.membership.is_gone(lost.id()) {
            self.membership.miss(lost.wreck());
        }
    }

    /// Whether a robot that was heard here last may be on its way, and so near by now that the two could come
    /// into contact in this control period.
    pub(super) fn may_meet(&self, lost: &Wreck) -> bool {
        let periods = self.schedule.period().saturating_sub(lost.heard_in);
        self.site.could_meet((lost.place - self.body.position()).norm(), periods)
    }

    /// Where robots that do not take part were heard last, by this robot or by the nodes that it hears.
    pub(super) fn locate_wrecks(&mut self) {
        let silent = self.neighbours.iter().filter(|known| known.is_silent());
        let reported = self.neighbours.iter().flat_map(|known| known.beacon.wrecks.iter().copied());
        let seen = reported.chain(silent.map(Neighbour::wreck));
        self.membership.locate_wrecks(seen, |robot| self.site.start_of(robot));
    }

    /// Where the robots attached to it are. Those that nobody else hears are so known two links away, in case
    /// that it stops as well.
    pub(super) fn locate_branches(&mut self) {
        let present = self.tree_children().filter(|known| known.is_present(self.schedule.period()));
        let places = present.map(|known| Branch { robot: known.id(), place: known.position() });
        let now: Vec<Branch> = places.collect();
        self.tree.locate_branches(now);
    }

    /// A beacon tells of robots that are attached to its sender.
    pub(super) fn note_branches(&mut self, beacon: &Beacon, period: u32) {
        beacon.sightings(period).for_each(|seen| self.membership.note(seen));
    }

    /// How far a robot that is not heard any more may be from where it was heard last.
    fn farthest_astray(&self) -> f64 {
        ASTRAY * self.site.settings.step_radius
    }

    /// How far a robot that does not take part may be from where any node heard it last. It has made no move
    /// that no node knows of. One move may be forgotten, if the node that knew of it has begun again; if another
    /// node does not take part that could have heard it, more of them may be. One that is not gone yet may be cut
    /// off together with such a node, and move on.
    fn astray(&self, wreck: &Wreck) -> f64 {
        let Settings { step_radius: step, clearance, errors, .. } = self.site.settings;
        let farthest = self.farthest_astray();
        let earshot = self.site.radio.range() + farthest + step + clearance;
        let is_near = |place: &Point| (place - wreck.place).norm() <= earshot;
        let lost = self.membership.wrecks().iter().filter(|other| other.robot != wreck.robot);
        let may_lack_witness = !self.membership.is_gone(wreck.robot)
            || lost.map(|other| other.place).any(|place| is_near(&place))
            || self.site.access_points.iter().skip(1).any(is_near);
        // Each of two moves ends off by its error; one is part of the planning clearance.
        errors.motion + if may_lack_witness { farthest } else { farthest.min(wreck.astray + step) }
    }

    /// Where the robot stays, in case that it is not heard any more: near each place where it has been since
    /// its newest roll was called.
    pub(super) fn discs_of_trail(&self) -> impl Iterator<Item = Disc> {
        let astray = self.farthest_astray();
        self.membership.trail().map(move |center| Disc {
            center,
            radius: astray.max((center - self.body.position()).norm()),
        })
    }

    /// Whether it is there; a move that was off may have led it farther.
    pub(super) fn is_near_trail(&self) -> bool {
        let leash = self.farthest_astray() * (1.0 + ROUNDING);
        self.membership.trail().all(|place| (place - self.body.position()).norm() <= leash)
    }

    /// The places of wrecks that are not heard in this control period, and how far they may be from there.
    fn obstacles(&self) -> impl Iterator<Item = (Point, f64)> {
        let is_heard =
            |robot| self.neighbour(robot).is_some_and(|it| it.heard_in == self.schedule.period());
        let unheard = move |wreck: &&Wreck| !is_heard(wreck.robot);
        self.membership
            .wrecks()
            .iter()
            .filter(unheard)
            .map(|wreck| (wreck.place, self.astray(wreck)))
    }

    /// The discs that no way leads through.
    pub(super) fn keep_out_discs(&self, clearance: f64) -> impl Iterator<Item = Disc> {
        self.obstacles().map(move |(center, astray)| Disc { center, radius: clearance + astray })
    }

    /// Where this robot keeps 2ρ from the wrecks that it could meet in a step, wherever they may be astray.
    pub(super) fn sides_of_wrecks(&self) -> impl Iterator<Item = HalfPlane> {
        let Settings { clearance, step_radius: step, errors, .. } = self.site.settings;
        let (kept, own) = (clearance * (1.0 + MARGIN), self.body.position());
        let reach = 2.0 * errors.planning_clearance(kept) + step;
        let near = move |&(place, astray): &(Point, f64)| (place - own).norm() <= reach + astray;
        let sides = move |wreck| errors.half_planes_beside(own, wreck, clearance, kept);
        self.obstacles().filter(near).flat_map(sides)
    }
}
