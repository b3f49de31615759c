//! Who takes part: the newest roll, and where robots were that are not received any more.
//!
//! A robot that is cut off cannot know in which period it was received last, but that this was not before its newest roll was
//! called. So it stores each place where it has been since.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::NodeId;

use crate::network::access_point::PATIENCE;
use crate::network::roll::{Absent, Roll, Sightings, Wreck};

/// A roll that is called this many control periods after a robot was received last says whether it takes part: the
/// first access point misses it after its patience, and reports of it may be as old when they arrive.
const TOLD_AFTER: u32 = 2 * PATIENCE;

/// What a robot knows of those that take part, and of those that do not.
#[derive(Clone, Debug, Default)]
pub(super) struct Membership {
    /// The newest roll.
    roll: Roll,
    /// Where robots were that are not received any more, or that others have reported.
    out_of_sight: Sightings,
    /// Robots that are not received any more although they were well in range, until a roll says whether
    /// they take part.
    missing: Sightings,
    /// The control period in which the robot has joined a mission under way; 0 if it has begun with the others.
    joined_in: u32,
    /// The bodies of those that do not take part.
    wrecks: Arc<Vec<Wreck>>,
    /// Where the robot has set off since its roll was called, each with the control period.
    trail: Vec<(u32, Point)>,
}

impl Membership {
    /// That of a robot that begins again, and keeps the newest roll.
    pub(super) fn begun_again(self) -> Self {
        Membership { roll: self.roll, ..Membership::default() }
    }

    /// The robot joins a mission under way.
    pub(super) const fn join_in(&mut self, period: u32) {
        self.joined_in = period;
    }

    /// A roll is received; returns whether other robots are absent now.
    #[inline]
    pub(super) fn receive_roll(&mut self, roll: &Roll) -> bool {
        let called = self.roll.called;
        let differs = self.roll.merge(roll);
        let newest = self.roll.called;
        if newest > called {
            self.trail.retain(|&(period, _)| period >= newest);
            self.missing.retain(|lost| lost.heard_in.saturating_add(TOLD_AFTER) > newest);
        }
        differs
    }

    /// The first access point calls the roll.
    pub(super) fn call_roll(&mut self, period: u32, absent: Absent) {
        if *self.roll.absent != absent {
            self.roll.absent = Arc::new(absent);
        }
        self.roll.called = period;
    }

    /// The newest roll.
    pub(super) const fn roll(&self) -> &Roll {
        &self.roll
    }

    /// Whether all robots take part, and no bodies lie about.
    pub(super) fn is_complete(&self) -> bool {
        self.roll.absent.is_empty() && self.wrecks.is_empty()
    }

    /// Whether a robot does not take part.
    pub(super) fn is_absent(&self, robot: NodeId) -> bool {
        self.roll.absent.contains(robot)
    }

    /// Whether a robot is called gone.
    pub(super) fn is_gone(&self, robot: NodeId) -> bool {
        self.roll.calls_gone(robot)
    }

    /// Whether the robot has begun later than others, and so does not know where robots are that it does not receive.
    pub(super) const fn is_late_comer(&self) -> bool {
        self.joined_in > 0
    }

    /// Whether all are known that do not take part: a robot that has begun later than others receives their
    /// names with a roll that is called long enough afterwards.
    pub(super) const fn knows_who_is_absent(&self) -> bool {
        !self.is_late_comer() || self.joined_in.saturating_add(TOLD_AFTER) <= self.roll.called
    }

    /// A robot was seen, by this one or by another.
    pub(super) fn note(&mut self, seen: Wreck) {
        self.out_of_sight.note(seen);
    }

    /// A robot that was well in range is not received: it may be on its way.
    pub(super) fn miss(&mut self, lost: Wreck) {
        self.missing.note(lost);
    }

    /// A robot is received that was out of sight.
    pub(super) fn find(&mut self, robot: NodeId) {
        self.missing.retain(|lost| lost.robot != robot);
    }

    /// The robots that may be on their way.
    pub(super) fn missing(&self) -> impl Iterator<Item = Wreck> {
        self.missing.iter()
    }

    /// The bodies of those that do not take part.
    pub(super) const fn wrecks(&self) -> &Arc<Vec<Wreck>> {
        &self.wrecks
    }

    /// Where the bodies are of those that do not take part, from what has been seen before, and now.
    pub(super) fn locate_wrecks(
        &mut self,
        seen: impl Iterator<Item = Wreck>,
        start_of: impl Fn(NodeId) -> Option<Point>,
    ) {
        let Membership { roll, out_of_sight, wrecks, .. } = self;
        roll.absent.locate(wrecks, out_of_sight.iter().chain(seen), start_of);
    }

    /// The robot sets off from a place.
    pub(super) fn set_off(&mut self, period: u32, place: Point) {
        match self.trail.last_mut() {
            Some((last, known)) if *known == place => *last = period,
            _ => self.trail.push((period, place)),
        }
    }

    /// Where the robot has set off since its roll was called.
    pub(super) fn trail(&self) -> impl Iterator<Item = Point> {
        self.trail.iter().map(|&(_, place)| place)
    }
}

#[cfg(feature = "abstraction")]
impl Membership {
    /// The period of the roll is numbered anew.
    pub(super) fn renumber(&mut self, number: impl FnOnce(u32) -> u32) {
        self.roll.called = number(self.roll.called);
    }

    /// The robots that have been seen out of sight, or whose bodies lie about.
    pub(super) fn seen(&self) -> impl Iterator<Item = NodeId> {
        let seen = self.out_of_sight.iter().chain(self.wrecks.iter().copied());
        seen.map(|wreck| wreck.robot)
    }
}

#[cfg(test)]
impl Membership {
    /// The newest roll is this.
    pub(super) fn is_told(&mut self, roll: Roll) {
        self.roll = roll;
    }

    /// The newest roll is called in this period.
    pub(super) fn is_called_in(&mut self, period: u32) {
        self.roll.called = period;
    }

    /// The newest roll names these as absent.
    pub(super) fn lacks(&mut self, absent: Absent) {
        self.roll.absent = Arc::new(absent);
    }

    /// These bodies lie about.
    pub(super) fn finds(&mut self, wrecks: Vec<Wreck>) {
        self.wrecks = Arc::new(wrecks);
    }

    /// The robots that have been noted.
    pub(super) fn noted(&self) -> Vec<Wreck> {
        self.out_of_sight.iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use pleach_discrete::network::IdSet;

    use super::*;

    fn at(x: f64) -> Point {
        Point::new(x, 0.0)
    }

    fn roll(called: u32, gone: &[NodeId]) -> Roll {
        let gone: IdSet = gone.iter().copied().collect();
        Roll { called, absent: Arc::new(Absent { gone, ..Absent::default() }) }
    }

    #[test]
    fn a_newer_roll_ends_the_trail_and_what_it_explains() {
        let mut membership = Membership::default();
        membership.set_off(23, at(0.0));
        membership.set_off(24, at(0.0));
        membership.set_off(25, at(0.1));
        membership.miss(Wreck::heard(1, at(1.0), 25 - TOLD_AFTER));
        membership.miss(Wreck::heard(2, at(2.0), 25));
        assert!(!membership.receive_roll(&roll(25, &[])), "nobody else is absent");
        assert_eq!(
            membership.trail().collect::<Vec<_>>(),
            [at(0.1)],
            "24 is the last of its place"
        );
        assert_eq!(membership.missing().map(|lost| lost.robot).collect::<Vec<_>>(), [2]);
        assert!(!membership.receive_roll(&roll(24, &[1])), "it is older");
        membership.find(2);
        assert_eq!(membership.missing().count(), 0);
    }

    #[test]
    fn a_robot_that_joins_late_knows_who_is_absent_by_a_later_roll() {
        let mut membership = Membership::default();
        assert!(membership.knows_who_is_absent());
        membership.join_in(9);
        membership.receive_roll(&roll(8 + TOLD_AFTER, &[]));
        assert!(!membership.knows_who_is_absent());
        membership.receive_roll(&roll(9 + TOLD_AFTER, &[]));
        assert!(membership.knows_who_is_absent());
    }

    #[test]
    fn a_body_lies_where_it_was_seen_last() {
        let mut membership = Membership::default();
        assert!(membership.is_complete());
        assert!(membership.receive_roll(&roll(1, &[7])));
        membership.note(Wreck::heard(7, at(1.0), 3));
        membership.locate_wrecks([Wreck::heard(7, at(2.0), 2)].into_iter(), |_| None);
        assert_eq!(**membership.wrecks(), [Wreck::heard(7, at(1.0), 3)]);
        assert!(membership.is_gone(7) && membership.is_absent(7) && !membership.is_complete());
    }
}
