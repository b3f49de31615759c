//! The roster: which robots take part as far as an access point has received, and which of them are attached.

use std::sync::Arc;

use pleach_discrete::network::{Attendance, IdSet, NodeId};

use super::attendance::{AttendanceAutomaton, Attendee};
use crate::automaton::TransitionError;
use crate::network::beacon::Reports;
use crate::network::roll::{Absent, Roll};
use crate::network::shared::renew;

/// Which robots take part.
#[derive(Clone, Debug, Default)]
pub(super) struct Roster {
    /// The attendance of each robot, if it is kept: by the access point that calls the rolls, or serves the user.
    attendees: Option<Vec<Attendee>>,
    /// The robots that take part, attached here or to other access points: where no attendance is kept, those that are
    /// reported.
    present: Arc<IdSet>,
    /// The robots that are attached to an access point.
    connected: Arc<IdSet>,
    /// For how many rounds the robots that take part, and which of them are connected, have stayed the same.
    settled_rounds: usize,
    /// The robots that take part and do not elect by the newest announcement: they have joined, or come back, since.
    joiners: IdSet,
    /// What other access points receive, if there are others: the robots that are attached here, those that are received
    /// here and know no way to an access point, and the tasks that all of them service.
    reports: [Arc<IdSet>; 3],
}

impl Roster {
    /// Attendance is kept from now on, of those that are reported at present.
    pub(super) fn keep(&mut self, robots: usize, validity: u32) {
        let Roster { attendees, present, .. } = self;
        attendees.get_or_insert_with(|| {
            let new = |robot| match present.contains(robot) {
                true => Attendee::attached(validity),
                false => Attendee::new(validity),
            };
            (0..robots).map(new).collect()
        });
    }

    /// Whether attendance is kept.
    pub(super) const fn is_kept(&self) -> bool {
        self.attendees.is_some()
    }

    /// Another control period begins.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub(super) fn review(
        &mut self,
        automaton: &AttendanceAutomaton,
    ) -> Result<(), TransitionError> {
        self.attendees_mut().try_for_each(|attendee| attendee.review(automaton))
    }

    /// Initialises attendance from the roll that is received first after a start. Robots that are absent in it stay
    /// absent; those that have not been received here are suspended, because for how long they have been silent is not
    /// known.
    pub(super) fn recall(&mut self, roll: &Roll, is_valid: bool) {
        for (robot, attendee) in self.attendees_mut().enumerate() {
            attendee.recall(roll.absent.standing_of(robot), is_valid);
        }
    }

    /// Takes in which robots are attached to an access point, and which are received and know no way to one.
    pub(super) fn attend(&mut self, reports: &Reports) {
        let Some(attendees) = &mut self.attendees else { return };
        for robot in reports.below.iter() {
            if let Some(attendee) = attendees.get_mut(robot) {
                attendee.attend();
            }
        }
        for robot in reports.strays.iter() {
            if let Some(attendee) = attendees.get_mut(robot) {
                attendee.stray();
            }
        }
    }

    /// A round is over in which these robots are connected.
    pub(super) fn update(&mut self, connected: IdSet) {
        let present = if self.is_kept() { self.attending() } else { connected.clone() };
        let is_as_connected = |robot| self.connected.contains(robot) == connected.contains(robot);
        let is_same = *self.present == present && present.iter().all(is_as_connected);
        self.settled_rounds = if is_same { self.settled_rounds + 1 } else { 0 };
        renew(&mut self.present, present);
        renew(&mut self.connected, connected);
    }

    /// A round is over in which nothing was received that could change it.
    pub(super) const fn pass_round(&mut self) {
        self.settled_rounds += 1;
    }

    /// For how many rounds it has stayed the same.
    pub(super) const fn settled_rounds(&self) -> usize {
        self.settled_rounds
    }

    /// Robots take part that do not elect by an announcement to `electors`.
    pub(super) fn note_joiners(&mut self, electors: &IdSet) {
        let attending = self.attending();
        self.joiners.extend(attending.iter().filter(|&robot| !electors.contains(robot)));
    }

    /// Another announcement is received.
    pub(super) fn forget_joiners(&mut self) {
        self.joiners = IdSet::default();
    }

    /// The robots that have joined since the newest announcement.
    pub(super) const fn joiners(&self) -> &IdSet {
        &self.joiners
    }

    /// The robots that take part now. The roll may have been called since the roster was made up.
    pub(super) fn present_now(&self) -> Arc<IdSet> {
        match self.is_kept() {
            true => Arc::new(self.attending()),
            false => Arc::clone(&self.present),
        }
    }

    /// The robots that took part when the roster was made up.
    pub(super) const fn present(&self) -> &Arc<IdSet> {
        &self.present
    }

    /// The robots that are attached to an access point.
    pub(super) const fn connected(&self) -> &Arc<IdSet> {
        &self.connected
    }

    /// Whether all robots that take part are attached to an access point.
    pub(super) fn is_connected(&self) -> bool {
        self.connected.includes(&self.present)
    }

    /// Whether robots are not in it that may not have begun yet.
    pub(super) fn awaits_robots(&self) -> bool {
        self.robots_that(Attendee::may_begin).any(|robot| !self.present.contains(robot))
    }

    /// The attendance of a robot, where it is kept.
    pub(super) fn attendee(&self, robot: NodeId) -> Option<&Attendee> {
        self.attendees.as_ref()?.get(robot)
    }

    /// The robots whose attendance is such.
    pub(super) fn robots_that(
        &self,
        are_such: impl Fn(&Attendee) -> bool,
    ) -> impl Iterator<Item = NodeId> {
        let attendees = self.attendees.iter().flatten().enumerate();
        attendees.filter(move |(_, it)| are_such(it)).map(|(robot, _)| robot)
    }

    /// The robots that take part.
    pub(super) fn attending(&self) -> IdSet {
        self.robots_that(Attendee::takes_part).collect()
    }

    /// The robots that have been attached and are gone.
    pub(super) fn gone(&self) -> Vec<NodeId> {
        self.robots_that(|it| it.is_known() && it.is_gone()).collect()
    }

    /// The robots that do not take part.
    pub(super) fn absent_robots(&self) -> impl Iterator<Item = NodeId> {
        self.robots_that(|it| it.location() != Attendance::Present)
    }

    /// The robots that do not take part, for the next roll.
    pub(super) fn absent(&self) -> Absent {
        let are = |such: &[Attendance]| {
            self.robots_that(|it| such.contains(&it.location())).collect::<IdSet>()
        };
        Absent {
            suspended: are(&[Attendance::Suspended, Attendance::Returning]),
            gone: are(&[Attendance::Gone]),
        }
    }

    /// Other access points receive these reports of the robots that are attached here.
    pub(super) fn report(&mut self, here: Reports) {
        let Reports { below, strays, serves } = here;
        self.reports = [below, strays, serves].map(Arc::new);
    }

    /// What other access points receive: the robots that are attached here, those that know no way, and the tasks that
    /// all of them service.
    pub(super) const fn reports(&self) -> &[Arc<IdSet>; 3] {
        &self.reports
    }

    fn attendees_mut(&mut self) -> impl Iterator<Item = &mut Attendee> {
        self.attendees.iter_mut().flatten()
    }
}

#[cfg(feature = "abstraction")]
impl Roster {
    /// What decides on the attendance of each robot from now on, and which robots take part and are connected.
    #[expect(clippy::type_complexity, reason = "it is compared and shown as a whole")]
    pub(super) fn account(&self) -> (Vec<(Attendance, bool, bool, u32, u32)>, &IdSet, &IdSet) {
        let attendees = self.attendees.iter().flatten().map(Attendee::account).collect();
        (attendees, &self.present, &self.connected)
    }

    /// No robot is waited for that has not begun.
    pub(super) fn have_been_awaited(&mut self) {
        self.attendees_mut().for_each(Attendee::has_been_awaited);
    }
}

#[cfg(test)]
impl Roster {
    /// The attendance of a robot is this.
    pub(super) fn stands(&mut self, robot: NodeId, attendee: Attendee) {
        if let Some(known) = self.attendees_mut().nth(robot) {
            *known = attendee;
        }
    }

    /// All robots are attached to an access point.
    pub(super) fn attend_all(&mut self) {
        self.attendees_mut().for_each(Attendee::attend);
    }

    /// These robots are connected.
    pub(super) fn connects(&mut self, robots: IdSet) {
        self.connected = Arc::new(robots);
    }

    /// It has stayed the same for this many rounds.
    pub(super) const fn has_settled(&mut self, rounds: usize) {
        self.settled_rounds = rounds;
    }
}
