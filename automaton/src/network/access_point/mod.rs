//! Access points: fixed sinks of information that relay messages, wired to each other.
//!
//! An access point passes on what it hears like a robot does. The first of them also serves the
//! user: it announces the tasks one after another, each when the one before is serviced, and says which
//! of them are over.

#[cfg(feature = "abstraction")]
mod abstraction;
mod attendance;
mod hearing;
mod roster;
mod rounds;
mod schedule;
mod service;
mod tasks;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{Agreement, Anchor, Election, Lineage, NodeId};

use super::ballot::Ballot;
use super::beacon::{Announced, Beacon, Bulletin, Notice, Reports};
use super::member::{NodeOutputs, Sense};
use super::membership::Membership;
use super::message::Message;
use super::notices::Notices;
use super::outbox::Outbox;
use super::record::MissionEvent;
use super::robot::{RobotError, RobotFault};
use super::roll::{Roll, Wreck};
use super::scenario::TaskOrder;
use super::service::{Rounds, Serving};
use super::site::Site;
use crate::automaton::TransitionError;
use crate::located::{Holds, Place as _};
use crate::node::{Input, Node};

pub use attendance::AttendanceAutomaton;
pub(super) use attendance::PATIENCE;
use hearing::Neighbours;
use roster::Roster;
pub use rounds::{RoundAct, RoundActs, RoundAutomaton};
use schedule::Schedule;
pub use service::{ServiceAutomaton, ServiceEffect};
use tasks::Tasks;

pub(super) use {
    attendance::attendance_automaton, rounds::round_automaton, service::service_automaton,
};

/// The first task is announced when the roster has not changed for this many rounds: news of two
/// robots whose numbers of links to an access point differ by one arrive two rounds apart.
const ROUNDS_UNTIL_ROSTER_SETTLES: usize = 8;

/// An election takes at most this many times the rounds that a message can travel: redundant
/// robots wait twice that long for the path to the caller before they place their token.
const PATIENCE_WITH_ELECTIONS: usize = 4;

/// Two access points at most this share of 2 d_build apart let a robot change over from one to
/// the other without losing both.
const CHANGEOVER_SHARE: f64 = 0.98;

/// An access point.
#[derive(Clone, Debug)]
pub struct AccessPoint {
    number: usize,
    /// What it has from the beginning.
    site: Arc<Site>,
    /// Where it is in its control period.
    schedule: Schedule,
    /// The nodes that it receives.
    neighbours: Neighbours,
    /// Whether anything has changed that it processes at the end of a round.
    has_news: bool,
    /// The newest roll, and where robots were.
    membership: Membership,
    /// Which robots take part.
    roster: Roster,
    /// What it has received of the mission.
    notices: Notices,
    /// The election and the agreement that it passes on.
    ballot: Ballot,
    /// The access points that the way to the robot that calls crosses, from this one on.
    crossing: Vec<usize>,
    /// The tasks, and where it is in their service.
    tasks: Tasks,
    /// What it sends of itself.
    outbox: Outbox,
}

impl AccessPoint {
    /// Access point `number` of the site.
    pub fn new(number: usize, site: Arc<Site>) -> Self {
        let mut point = AccessPoint {
            number,
            schedule: Schedule::due(site.settings.period),
            neighbours: Neighbours::default(),
            has_news: true,
            membership: Membership::default(),
            roster: Roster::default(),
            notices: Notices::default(),
            ballot: Ballot::default(),
            crossing: Vec::new(),
            tasks: Tasks::default(),
            outbox: Outbox::default(),
            site,
        };
        point.notices.wait_for(point.site.rounds_across(0));
        if point.is_first() {
            point.keep_attendance();
        }
        point
    }

    /// Its number among the access points.
    pub const fn number(&self) -> usize {
        self.number
    }

    /// Whether it is the one that calls the rolls.
    const fn is_first(&self) -> bool {
        self.number == 0
    }

    fn id(&self) -> NodeId {
        self.site.robots + self.number
    }

    fn position(&self) -> Point {
        self.site.access_points[self.number]
    }

    /// Sends its neighbours and, over the wire, the other access points its public state and the roll: in as many rounds
    /// of a period as robots do, counted again when something in it has changed, or a newer roll is received.
    fn tell_beacon(&mut self, outputs: &mut NodeOutputs) {
        let (beacon, _) = self.outbox.renew_beacon(self.public_state());
        if self.outbox.takes_beacon() {
            let (period, roll) = (self.schedule.period(), self.membership.roll().clone());
            outputs.broadcast(Message::Beacon { period, roll, confirmed: Some(period), beacon });
        }
    }

    fn public_state(&self) -> Beacon {
        let [below, strays, serves] = self.roster.reports().clone();
        Beacon {
            bulletin: self.notices.bulletin().clone(),
            announced: self.notices.announced().cloned(),
            forgetful: Arc::clone(self.notices.forgetful()),
            election: self.ballot.election().cloned(),
            agreement: self.ballot.agreement().cloned(),
            route: self.ballot.route().cloned(),
            crossing: self.crossing.clone(),
            lineage: Some(Arc::new(Lineage::of_access_point(self.number))),
            below,
            strays,
            serves,
            closed: Arc::clone(self.notices.closed()),
            stretched: self.notices.is_stretched(),
            longest_wait: self.notices.longest_wait(),
            wrecks: Arc::clone(self.membership.wrecks()),
            ..Beacon::silent(self.id(), self.position())
        }
    }

    /// At the end of a round, processes what it has received if that contains news. Where nothing has changed, it
    /// only counts another round in which the roster stays the same.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    fn process_news(&mut self) -> Result<(), TransitionError> {
        if std::mem::take(&mut self.has_news) {
            return self.deliberate();
        }
        self.roster.pass_round();
        self.locate_wrecks();
        #[cfg(feature = "abstraction")]
        debug_assert!(self.overlooks_nothing(), "access point {} overlooks something", self.number);
        Ok(())
    }

    /// Processes what it has received, whether or not it contains news.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    fn deliberate(&mut self) -> Result<(), TransitionError> {
        self.receive_notices()?;
        self.find_route();
        self.survey_robots();
        self.locate_wrecks();
        Ok(())
    }

    /// Where robots that do not take part were received last, here or by the nodes that are received.
    fn locate_wrecks(&mut self) {
        let reported = self.neighbours.beacons().flat_map(|beacon| beacon.wrecks.iter().copied());
        self.membership.locate_wrecks(reported, |robot| self.site.start_of(robot));
    }

    /// The first access point sends the user the newest notice.
    fn tell_user(&self, outputs: &mut NodeOutputs) {
        if self.is_first() {
            outputs.send(self.site.user(), Message::News(self.notices.bulletin().clone()));
        }
    }

    fn receive_notices(&mut self) -> Result<(), TransitionError> {
        self.receive_announcements();
        let mut newest = self.notices.bulletin().clone();
        let receive = |has_news, beacon: &Beacon| newest.merge(&beacon.bulletin) || has_news;
        if self.neighbours.beacons().fold(false, receive) {
            // What it does not take up now it receives again.
            self.has_news = true;
            self.tasks.offer(Some(newest));
            if self.hears_want() {
                self.tasks.report_failure_in(self.schedule.period());
            }
            self.jump()?;
            self.tasks.offer(None);
        }
        self.neighbours.beacons().for_each(|beacon| self.ballot.merge(beacon));
        Ok(())
    }

    fn receive_announcements(&mut self) {
        let received = self.neighbours.beacons().filter_map(|beacon| beacon.announced.as_ref());
        if let Some(newest) = received.max_by_key(|&&(id, _)| id).cloned() {
            self.learn(newest);
        }
        self.neighbours.beacons().for_each(|beacon| self.notices.merge(beacon, &self.site));
    }

    /// Takes over an announcement that is newer than its own.
    fn learn(&mut self, announced: Announced) {
        let known = self.notices.announcement_id();
        if known.is_none_or(|known| announced.0.is_newer_than(known)) {
            self.notices.learn(announced);
            self.roster.forget_joiners();
        }
    }

    /// Takes a row of the service, if one is enabled.
    fn jump(&mut self) -> Result<(), TransitionError> {
        let site = Arc::clone(&self.site);
        site.automata.service.step_in_place::<Serving>(self)?;
        Ok(())
    }

    fn take_up(&mut self, bulletin: Bulletin) {
        let id = bulletin.id();
        // The way to the caller is that of the newest notice.
        self.ballot.set_route(None);
        self.crossing.clear();
        match &**bulletin.notice() {
            Notice::Task(announcement) => {
                self.learn((id, announcement.clone()));
                self.tasks.announce_in(self.schedule.period());
                self.ballot.begin(Election::new(id), None);
            }
            Notice::Call { .. } => self.ballot.begin(Election::new(id), None),
            Notice::Path(_) => self.ballot.agree(Some(Agreement::new(id))),
            &Notice::Serviced { task } => {
                self.expect_serviced(task);
                self.tasks.begin_service(task);
            }
            &Notice::Withdrawn { task } => {
                self.expect_serviced(task);
                self.close(task);
            }
            Notice::Quiet | Notice::Advance { .. } | Notice::Ended { .. } => {}
        }
        self.notices.take_up(bulletin);
    }

    /// Where tasks are announced in the order of the file, those before this one have been serviced, or are closed.
    fn expect_serviced(&mut self, task: usize) {
        if self.site.settings.order == TaskOrder::File {
            self.tasks.expect_before(task);
        }
    }

    /// A task is over: from now on its robots receive that.
    fn close(&mut self, task: usize) {
        self.notices.close(task);
        let is_pursued = self.notices.announcement().is_some_and(|it| task == it.task);
        if is_pursued || self.tasks.record(task).is_some() {
            self.tasks.close_in(self.schedule.period());
        }
    }

    /// Whether a task has ended so late that its robots were not redundant yet when it announced its own task.
    fn has_freed(&self) -> bool {
        self.tasks.has_freed(self.notices.longest_wait())
    }

    /// Whether it waits for them to become redundant, and for the robots of a team that has given up.
    fn awaits_retirements(&self) -> bool {
        self.tasks.awaits_retirements(self.notices.longest_wait(), self.schedule.period())
    }

    /// The way to the robot that calls: through a robot that is attached here, or through another
    /// access point so near that a robot can change over from one to the other.
    fn find_route(&mut self) {
        let id = self.notices.bulletin().id();
        if !matches!(self.notice(), Notice::Call { .. }) || self.ballot.route().is_some() {
            return;
        }
        let own = Anchor::Access(self.number);
        for beacon in self.neighbours.beacons() {
            let Some((_, onward)) = beacon.route.as_ref().filter(|(call, _)| *call == id) else {
                continue;
            };
            let changeover = beacon.duty.is_none() && self.is_within_changeover(beacon.position);
            if beacon.is_attached_to(own) || changeover {
                self.crossing = vec![self.number];
                self.crossing.extend(&beacon.crossing);
                self.ballot.set_route(Some((id, onward.clone())));
                return;
            }
        }
    }

    fn is_within_changeover(&self, other: Point) -> bool {
        let reach = CHANGEOVER_SHARE * self.site.lengths(self.notices.is_stretched()).build;
        self.site.are_within_changeover(self.position(), other, reach)
    }

    /// Which robots are attached here, and which take part.
    fn survey_robots(&mut self) {
        let own = Anchor::Access(self.number);
        let mut here = Reports::default();
        for beacon in self.neighbours.beacons().filter(|beacon| beacon.duty.is_some()) {
            here.take_in(beacon, beacon.is_attached_to(own), self.id(), true);
        }
        self.update_roster(here.clone());
        if self.site.access_points.len() > 1 {
            self.roster.report(here);
        }
    }

    /// Which robots are attached to the access points, of which these are attached here, and which are received. One that
    /// knows no way to an access point, on its way along Σ or with a parent that has failed, is not missed as long as it is
    /// received.
    fn update_roster(&mut self, mut reports: Reports) {
        for beacon in self.neighbours.beacons().filter(|beacon| beacon.duty.is_none()) {
            reports.take_in_branch(beacon);
        }
        if self.roster.is_kept() {
            self.roster.attend(&reports);
            reports.serves.iter().for_each(|task| self.tasks.attend(task));
        }
        self.roster.update(reports.below);
    }

    /// For how many rounds nothing changes where robots have gathered. One that is received and knows no way to an
    /// access point may have found a parent by then.
    fn rounds_until_gathered(&self) -> usize {
        match self.roster.is_connected() {
            true => ROUNDS_UNTIL_ROSTER_SETTLES,
            false => ROUNDS_UNTIL_ROSTER_SETTLES.max(self.patience_with_searches()),
        }
    }

    /// Once a round: serves the user, if it has requested tasks.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    fn serve(&mut self) -> Result<(), TransitionError> {
        if self.tasks.requested().is_some()
            && self.announced().is_some()
            && self.tasks.is_electing()
        {
            self.ballot.pass_round();
        }
        self.jump()
    }

    /// Attendance is kept from now on.
    fn keep_attendance(&mut self) {
        self.roster.keep(self.site.robots, self.site.roll_validity());
    }

    /// Once a control period: who is missed, where that has to be known, and, at the first access point, the next roll.
    fn call_roll(&mut self) -> Result<(), TransitionError> {
        if !self.roster.is_kept() {
            return Ok(());
        }
        self.has_news = true;
        self.roster.review(&self.site.automata.attendance)?;
        self.tasks.pass_period();
        if let Some(announcement) = self.notices.announcement() {
            self.roster.note_joiners(&announcement.roster);
        }
        if self.is_first() {
            self.membership.call_roll(self.schedule.period(), self.roster.absent());
        }
        Ok(())
    }

    fn hear(&mut self, from: NodeId, message: &Message, outputs: &mut NodeOutputs) {
        match message {
            Message::Beacon { period, roll, beacon, .. } => self.hear_beacon(*period, roll, beacon),
            Message::Request(order) => {
                self.tasks.request(order);
                self.keep_attendance();
                self.has_news = true;
            }
            &Message::Proposal { period, segment, witness } if period == self.schedule.period() => {
                self.membership.note(Wreck::setting_off(from, segment, period));
                if witness == Some(self.id()) {
                    outputs.send(from, Message::Consent { period });
                }
            }
            Message::Multiplier { .. }
            | Message::Flow(_)
            | Message::Demand(_)
            | Message::Shortage
            | Message::AskFlow(_)
            | Message::GrantFlow(_)
            | Message::Probe(_)
            | Message::Proposal { .. }
            | Message::Objection { .. }
            | Message::Consent { .. }
            | Message::News(_) => {}
        }
    }

    /// Takes in a message with a beacon. Of one that has been late since an earlier control period only the roll counts.
    fn hear_beacon(&mut self, period: u32, roll: &Roll, beacon: &Arc<Beacon>) {
        let is_later = roll.called > self.membership.roll().called;
        self.membership.receive_roll(roll);
        if is_later {
            self.outbox.send_beacon_again();
        }
        // No node but the first access point calls rolls: it has begun again since.
        if is_later && (self.schedule.is_new() || self.is_first()) {
            let now = self.schedule.period().max(period);
            self.roster.recall(roll, roll.is_valid(now, self.site.roll_validity()));
            self.has_news = true;
        }
        if period < self.schedule.period() {
            return;
        }
        if period > self.schedule.period() {
            self.schedule.receive_later_period(period);
            self.outbox.send_beacon_again();
        }
        self.has_news |= self.neighbours.receive(beacon);
        if beacon.duty.is_some() {
            self.membership.note(Wreck::heard(beacon.sender, beacon.position, period));
            beacon.sightings(period).for_each(|seen| self.membership.note(seen));
        }
    }

    /// After the first rounds all nodes in range have sent: those that were silent are out of range.
    fn forget_silent(&mut self) {
        if self.schedule.have_all_sent() {
            self.has_news |= self.neighbours.forget_silent();
        }
    }

    /// The newest notice on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        self.notices.bulletin().notice()
    }
}

impl Node for AccessPoint {
    type Message = Message;
    type Sense = Sense;
    type Report = MissionEvent;
    type Body = Point;
    type Error = RobotError;

    fn step(
        &mut self,
        input: Input<'_, Message, Sense>,
        outputs: &mut NodeOutputs,
    ) -> Result<(), RobotError> {
        match input {
            Input::Heard { from, message } => self.hear(from, message, outputs),
            Input::Tick { .. } => self.tick(outputs)?,
            Input::Sensed(_) => {}
        }
        self.outbox.send_reports(outputs);
        Ok(())
    }

    fn time_to_tick(&self) -> Option<f64> {
        Some(self.schedule.time_to_tick(self.site.settings.period))
    }

    fn flow(&mut self, duration: f64) {
        let site = Arc::clone(&self.site);
        site.automata.rounds.flow_in_place::<Rounds>(self, duration);
    }

    fn check_invariant(&self) -> Result<(), RobotError> {
        let holds = self
            .site
            .automata
            .rounds
            .check_invariant(Holds::<Rounds>::current(self).location(), self);
        holds.map_err(|source| RobotFault::Invariant { node: self.id(), source }.into())
    }

    fn body(&self) -> Point {
        self.position()
    }
}
