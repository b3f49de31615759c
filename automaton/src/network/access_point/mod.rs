//! Access points: fixed sinks of information that relay messages, wired to each other.
//!
//! An access point passes on what it hears like a robot does. The first of them also serves the
//! user: it announces the tasks one after another, each when the one before is serviced, and says which
//! of them are over.

#[cfg(feature = "abstraction")]
mod abstraction;
mod attendance;
mod hearing;
mod rounds;
mod service;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{Agreement, Anchor, Election, IdSet, Lineage, NodeId};

use super::beacon::{Announced, Beacon, Bulletin, CallRoute, LastBeacon, Notice, Reports};
use super::member::{NodeOutputs, Sense};
use super::message::Message;
use super::order::Order;
use super::record::{MissionEvent, Outcome};
use super::robot::{PATIENCE_WITH_UNUSED_POSTS, RobotError, RobotFault};
use super::roll::{Roll, Sightings, Wreck};
use super::scenario::TaskOrder;
use super::service::{Gathering, Resting, Rounds, Serving};
use super::shared::{Shared, merge_election, renew};
use super::site::Site;
use crate::automaton::TransitionError;
use crate::located::{Current, Place as _};
use crate::node::{Input, Node};

pub(super) use attendance::PATIENCE;
pub use attendance::{ATTENDANCE_GLOSSARY, AttendanceAutomaton, attendance_automaton};
use attendance::{Attendee, TaskRecord};
use hearing::Heard;
pub use rounds::{RoundAct, RoundActs, RoundAutomaton, round_automaton};
pub use service::{ACCESS_POINT_GLOSSARY, ServiceAutomaton, ServiceEffect, service_automaton};

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
    site: Arc<Site>,
    position: Point,
    /// The nodes in range, by their numbers.
    heard: Vec<Heard>,
    /// Where among them the next beacon is expected.
    heard_up_to: usize,
    /// Whether what it hears, or anything else of which it makes something once a round, has changed since it did.
    has_news: bool,
    /// Where each robot was when it was last heard, or heard of.
    sightings: Sightings,
    /// Where robots that do not take part were heard last, here or by the nodes that are heard.
    wrecks: Arc<Vec<Wreck>>,
    bulletin: Bulletin,
    /// The newest bulletin that it has heard and not taken up.
    newest: Option<Bulletin>,
    /// The newest announcement that it knows.
    announced: Option<Announced>,
    /// The robots that have elected by it, or are on Σ, and have restarted since.
    forgetful: Arc<IdSet>,
    /// The robots that take part and do not elect by it: they have joined, or come back, since.
    joiners: IdSet,
    election: Option<Arc<Election>>,
    election_rounds: usize,
    agreement: Option<Agreement>,
    route: Option<CallRoute>,
    crossing: Vec<usize>,
    /// Whether a team has found no robot that can be recruited.
    stretched: bool,
    /// For how many rounds news may be under way, as far as it has heard.
    longest_wait: usize,
    /// The robots that are attached here, to be told to other access points if there are any.
    attached: Arc<IdSet>,
    /// Robots that are heard here and know no way to an access point, for the others likewise.
    strays: Arc<IdSet>,
    /// The robots that take part, attached here or to other access points: where no attendance is kept,
    /// those that are heard of.
    roster: Arc<IdSet>,
    /// The robots that are attached to an access point.
    connected: Arc<IdSet>,
    /// What it knows of each robot, if it [keeps attendance](Self::keeps_attendance).
    attendees: Vec<Attendee>,
    /// The newest roll.
    roll: Roll,
    settled_rounds: usize,
    /// What it knows of each task that has been serviced, also of those that are over by now.
    known_tasks: BTreeMap<usize, TaskRecord>,
    /// The tasks that are serviced by robots attached here.
    serves: Arc<IdSet>,
    /// The tasks that are over.
    closed: Arc<IdSet>,
    /// The tasks that no robot could service, in this order, and how each of them ended.
    given_up: Vec<(usize, Outcome)>,
    /// The control period in which it has closed a task last that had been announced.
    closed_in: Option<u32>,
    /// The control period in which the task was announced last.
    announced_in: u32,
    /// The control period in which it has heard that the task is given up for lack of robots.
    given_up_in: Option<u32>,
    /// What the user has asked for.
    requested: Option<Order>,
    /// Its state in the service of the tasks, and its stage in the control period.
    service: Current<Serving>,
    rounds: Current<Rounds>,
    /// The remaining acts of the row that was taken last.
    acts: RoundActs,
    is_new: bool,
    /// Another node has begun the next control period.
    is_behind: bool,
    clock: f64,
    /// How many control periods have begun.
    period: u32,
    last_beacon: LastBeacon,
    log: Vec<MissionEvent>,
}

impl AccessPoint {
    /// Access point `number` of the site.
    pub fn new(number: usize, site: Arc<Site>) -> Self {
        let (period, longest_wait) = (site.settings.period, site.rounds_across(0));
        let mut point = AccessPoint {
            number,
            position: site.access_points[number],
            attendees: Vec::new(),
            roll: Roll::default(),
            site,
            heard: Vec::new(),
            heard_up_to: 0,
            has_news: true,
            sightings: Sightings::default(),
            wrecks: Arc::default(),
            bulletin: Bulletin::first(Shared::new(Notice::Quiet)),
            newest: None,
            announced: None,
            forgetful: Arc::default(),
            joiners: IdSet::default(),
            election: None,
            election_rounds: 0,
            agreement: None,
            route: None,
            crossing: Vec::new(),
            stretched: false,
            longest_wait,
            attached: Arc::default(),
            strays: Arc::default(),
            roster: Arc::default(),
            connected: Arc::default(),
            settled_rounds: 0,
            known_tasks: BTreeMap::new(),
            serves: Arc::default(),
            closed: Arc::default(),
            given_up: Vec::new(),
            closed_in: None,
            announced_in: 0,
            given_up_in: None,
            requested: None,
            service: Current::new(Serving::Gathering(Gathering)),
            rounds: Current::new(Rounds::Resting(Resting)),
            acts: &[],
            is_new: true,
            is_behind: false,
            clock: period,
            period: 0,
            last_beacon: LastBeacon::default(),
            log: Vec::new(),
        };
        if point.is_first() {
            point.begin_attendance();
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

    /// Whether it has to know which robots attend: it calls the rolls, or serves the user.
    const fn keeps_attendance(&self) -> bool {
        self.is_first() || self.requested.is_some()
    }

    fn id(&self) -> NodeId {
        self.site.robots + self.number
    }

    /// Tells its neighbours and, over the wire, the other access points its public state and the roll: in as many rounds
    /// of a period as robots do, counted anew when something in it has changed, or a newer roll is known.
    fn tell_beacon(&mut self, outputs: &mut NodeOutputs) {
        let (beacon, _) = self.last_beacon.replace_by(self.public_state());
        if self.last_beacon.tell() {
            let (period, roll) = (self.period, self.roll.clone());
            outputs.broadcast(Message::Beacon { period, roll, confirmed: Some(period), beacon });
        }
    }

    fn public_state(&self) -> Beacon {
        Beacon {
            sender: self.id(),
            position: self.position,
            bulletin: self.bulletin.clone(),
            announced: self.announced.clone(),
            forgetful: Arc::clone(&self.forgetful),
            election: self.election.clone(),
            agreement: self.agreement.clone(),
            route: self.route.clone(),
            crossing: self.crossing.clone(),
            lineage: Some(Arc::new(Lineage::of_access_point(self.number))),
            parent: None,
            below: Arc::clone(&self.attached),
            strays: Arc::clone(&self.strays),
            serves: Arc::clone(&self.serves),
            closed: Arc::clone(&self.closed),
            duty: None,
            parked: false,
            way: None,
            can_detach: false,
            offer: None,
            offers_made: 0,
            reply: None,
            team: None,
            stretched: self.stretched,
            longest_wait: self.longest_wait,
            wrecks: Arc::clone(&self.wrecks),
            branches: Arc::default(),
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
        self.settled_rounds += 1;
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
        self.hear_notices()?;
        self.find_route();
        self.survey_robots();
        self.locate_wrecks();
        Ok(())
    }

    /// Where robots that do not take part were heard last, here or by the nodes that are heard.
    fn locate_wrecks(&mut self) {
        let told = self.heard.iter().flat_map(|heard| heard.beacon.wrecks.iter().copied());
        let seen = self.sightings.iter().chain(told);
        self.roll.absent.locate(&mut self.wrecks, seen, |robot| self.site.start_of(robot));
    }

    /// The first access point sends the user the newest notice.
    fn tell_user(&self, outputs: &mut NodeOutputs) {
        if self.is_first() {
            let user = self.site.nodes();
            outputs.send(user, Message::News(self.bulletin.clone()));
        }
    }

    fn hear_notices(&mut self) -> Result<(), TransitionError> {
        self.hear_announcements();
        let mut newest = self.bulletin.clone();
        let hear = |has_news, beacon: &Beacon| newest.merge(&beacon.bulletin) || has_news;
        if self.beacons().fold(false, hear) {
            // What it does not take up now it hears again.
            (self.newest, self.has_news) = (Some(newest), true);
            if self.hears_want() {
                self.given_up_in.get_or_insert(self.period);
            }
            self.jump()?;
            self.newest = None;
        }
        for Heard { beacon, .. } in &self.heard {
            self.stretched |= beacon.stretched;
            self.longest_wait = self.site.longer_wait(self.longest_wait, beacon.longest_wait);
            if let (Some(own), Some(heard)) = (&mut self.election, &beacon.election) {
                merge_election(own, heard);
            }
            if let (Some(own), Some(heard)) = (&mut self.agreement, &beacon.agreement) {
                own.merge(heard);
            }
        }
        Ok(())
    }

    fn hear_announcements(&mut self) {
        let heard = self.beacons().filter_map(|beacon| beacon.announced.as_ref());
        if let Some(newest) = heard.max_by_key(|&&(id, _)| id).cloned() {
            self.learn(newest);
        }
        for Heard { beacon, .. } in &self.heard {
            beacon.tell_forgetful(self.announced.as_ref(), &mut self.forgetful);
            beacon.tell_closed(&mut self.closed);
        }
    }

    /// Takes over an announcement that is newer than the one that it knows.
    fn learn(&mut self, announced: Announced) {
        if self.announced.as_ref().is_none_or(|(known, _)| announced.0.is_newer_than(*known)) {
            self.announced = Some(announced);
            (self.forgetful, self.joiners) = (Arc::default(), IdSet::default());
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
        self.route = None;
        self.crossing.clear();
        if let Notice::Task(announcement) = &**bulletin.notice() {
            self.learn((id, announcement.clone()));
            (self.announced_in, self.given_up_in) = (self.period, None);
        }
        match **bulletin.notice() {
            Notice::Task(_) | Notice::Call { .. } => {
                self.election = Some(Arc::new(Election::new(id)));
                self.election_rounds = 0;
            }
            Notice::Path(_) => self.agreement = Some(Agreement::new(id)),
            Notice::Serviced { task } => {
                self.expect_serviced(task);
                self.known_tasks.insert(task, TaskRecord::default());
            }
            Notice::Withdrawn { task } => {
                self.expect_serviced(task);
                self.close(task);
            }
            _ => {}
        }
        self.bulletin = bulletin;
    }

    /// Where tasks are announced in the order of the file, those before this one have been serviced, or are closed.
    fn expect_serviced(&mut self, task: usize) {
        if self.site.settings.order == TaskOrder::File {
            (0..task).for_each(|before| {
                self.known_tasks.entry(before).or_default();
            });
        }
    }

    /// A task is over: from now on its robots hear so.
    fn close(&mut self, task: usize) {
        Arc::make_mut(&mut self.closed).insert(task);
        let is_pursued = self.announced.as_ref().is_some_and(|(_, it)| task == it.task);
        if is_pursued || self.known_tasks.contains_key(&task) {
            self.closed_in = Some(self.period);
        }
    }

    /// Whether robots were not redundant when it announced its task that may be now, as a task has ended.
    fn has_freed(&self) -> bool {
        self.closed_in.is_some_and(|closed_in| self.announced_in < self.retired_by(closed_in))
    }

    /// Whether it waits for them to become redundant, and for the robots of a team that has given up.
    fn awaits_retirements(&self) -> bool {
        let ends = self.closed_in.into_iter().chain(self.given_up_in);
        self.has_freed() && ends.max().is_some_and(|end| self.period < self.retired_by(end))
    }

    /// The control period in which robots are redundant that a task has had which ended in this one: the robot at the
    /// end of a branch is first, then the one before it, as each hears of the next.
    fn retired_by(&self, end: u32) -> u32 {
        let depth = (self.longest_wait / 2 + 1) as u32;
        end.saturating_add(depth.saturating_mul(PATIENCE_WITH_UNUSED_POSTS + 2))
    }

    /// The way to the robot that calls: through a robot that is attached here, or through another
    /// access point so near that a robot can change over from one to the other.
    fn find_route(&mut self) {
        let id = self.bulletin.id();
        if !matches!(self.notice(), Notice::Call { .. }) || self.route.is_some() {
            return;
        }
        let own = Anchor::Access(self.number);
        for Heard { beacon, .. } in &self.heard {
            let Some((_, onward)) = beacon.route.as_ref().filter(|(call, _)| *call == id) else {
                continue;
            };
            let is_child = beacon
                .duty
                .as_ref()
                .is_some_and(|duty| duty.post().is_some_and(|post| post.parent == Some(own)));
            let changeover = beacon.duty.is_none() && self.is_within_changeover(beacon.position);
            if is_child || changeover {
                self.route = Some((id, onward.clone()));
                self.crossing = vec![self.number];
                self.crossing.extend(&beacon.crossing);
                return;
            }
        }
    }

    fn is_within_changeover(&self, other: Point) -> bool {
        let reach = CHANGEOVER_SHARE * self.site.lengths(self.stretched).build;
        self.site.are_within_changeover(self.position, other, reach)
    }

    /// Which robots are attached here, and which take part.
    fn survey_robots(&mut self) {
        let own = Anchor::Access(self.number);
        let mut here = Reports::default();
        for beacon in self.beacons() {
            if let Some(duty) = &beacon.duty {
                let is_child = duty.post().is_some_and(|post| post.parent == Some(own));
                here.take_in(beacon, is_child, self.id(), true);
            }
        }
        self.update_roster(here.clone());
        if self.site.access_points.len() > 1 {
            let Reports { below, strays, serves } = here;
            (self.attached, self.strays) = (Arc::new(below), Arc::new(strays));
            self.serves = Arc::new(serves);
        }
    }

    /// Which robots are attached to the access points, of which these are attached here, and which are
    /// heard of. One that knows no way to an access point, on its way along Σ or with a parent that has
    /// failed, is not missed as long as it is heard.
    fn update_roster(&mut self, mut reports: Reports) {
        for beacon in self.beacons().filter(|beacon| beacon.duty.is_none()) {
            reports.take_in_branch(beacon);
        }
        let roster = if self.keeps_attendance() {
            self.attend(&reports);
            self.attending()
        } else {
            reports.below.clone()
        };
        let is_as_connected =
            |robot| self.connected.contains(robot) == reports.below.contains(robot);
        let is_same = *self.roster == roster && roster.iter().all(is_as_connected);
        self.settled_rounds = if is_same { self.settled_rounds + 1 } else { 0 };
        renew(&mut self.roster, roster);
        renew(&mut self.connected, reports.below);
    }

    /// For how many rounds nothing changes where robots have gathered. One that is heard and knows no way to an
    /// access point may have found a parent by then.
    fn rounds_until_gathered(&self) -> usize {
        match self.connected.includes(&self.roster) {
            true => ROUNDS_UNTIL_ROSTER_SETTLES,
            false => ROUNDS_UNTIL_ROSTER_SETTLES.max(self.patience_with_searches()),
        }
    }

    /// Robots and tasks of which these reports tell are heard of.
    fn attend(&mut self, reports: &Reports) {
        for robot in reports.below.iter() {
            if let Some(attendee) = self.attendees.get_mut(robot) {
                attendee.attend();
            }
        }
        for robot in reports.strays.iter() {
            if let Some(attendee) = self.attendees.get_mut(robot) {
                attendee.stray();
            }
        }
        for task in reports.serves.iter() {
            self.known_tasks.entry(task).or_default().silence = 0;
        }
    }

    /// Once a round: serves the user, if it has asked for tasks.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    fn serve(&mut self) -> Result<(), TransitionError> {
        if self.requested.is_some() && self.announced().is_some() && self.is_electing() {
            self.election_rounds += 1;
        }
        self.jump()
    }

    fn is_electing(&self) -> bool {
        matches!(*self.service, Serving::Electing(_))
    }

    /// The newest notice on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        self.bulletin.notice()
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
            Input::Heard { message: Message::Beacon { period, roll, beacon, .. }, .. } => {
                self.hear(*period, roll, beacon);
            }
            Input::Heard { message: Message::Request(order), .. } => {
                let is_old = |known: &Order| order.is_older_than(known);
                if !self.requested.as_ref().is_some_and(is_old) {
                    self.requested = Some(order.clone());
                }
                self.begin_attendance();
                self.has_news = true;
            }
            Input::Heard { from, message: Message::Proposal { period, segment, witness } }
                if *period == self.period =>
            {
                self.sightings.note(Wreck::setting_off(from, *segment, *period));
                if *witness == Some(self.id()) {
                    outputs.send(from, Message::Consent { period: *period });
                }
            }
            Input::Tick { .. } => self.tick(outputs)?,
            Input::Heard { .. } | Input::Sensed(_) => {}
        }
        self.log.drain(..).for_each(|event| outputs.report(event));
        Ok(())
    }

    fn time_to_tick(&self) -> Option<f64> {
        Some(match *self.rounds {
            Rounds::Resting(_) if !self.is_behind => {
                (self.site.settings.period - self.clock).max(0.0)
            }
            _ => 0.0,
        })
    }

    fn flow(&mut self, duration: f64) {
        let site = Arc::clone(&self.site);
        site.automata.rounds.flow_in_place::<Rounds>(self, duration);
    }

    fn check_invariant(&self) -> Result<(), RobotError> {
        let holds = self.site.automata.rounds.check_invariant(self.rounds.location(), self);
        holds.map_err(|source| RobotFault::Invariant { node: self.id(), source }.into())
    }

    fn body(&self) -> Point {
        self.position
    }
}
