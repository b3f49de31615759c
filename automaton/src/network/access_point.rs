//! Access points: fixed sinks of information that relay messages, wired to each other.
//!
//! An access point passes on what it hears like a robot does. The first of them also serves the
//! user: it announces the tasks one after another, each when the one before is serviced.

#[cfg(feature = "abstraction")]
mod abstraction;

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{Agreement, Anchor, Bulletin, Election, IdSet, Lineage, NodeId};

use super::beacon::{Beacon, Notice, Voice};
use super::duty::Hop;
use super::member::Sense;
use super::message::Message;
use super::record::{MissionEvent, Outcome};
use super::robot::RobotError;
use super::shared::Shared;
use super::site::Site;
use crate::node::{Input, Node, Outputs};

/// The first task is announced when the roster has not changed for this many rounds: between two
/// robots whose links to an access point differ by one, news of them come two rounds apart.
const ROUNDS_UNTIL_ROSTER_SETTLES: usize = 8;

/// An election takes at most this many times the rounds that news can be under way: redundant
/// robots wait twice that long for the way to the caller before they place their token.
const PATIENCE_WITH_ELECTIONS: usize = 4;

/// An access point.
#[derive(Clone, Debug)]
pub struct AccessPoint {
    number: usize,
    site: Arc<Site>,
    position: Point,
    heard: Vec<Arc<Beacon>>,
    bulletin: Shared<Bulletin<Notice>>,
    announced: Option<(usize, Arc<IdSet>)>,
    election: Option<Election>,
    election_rounds: usize,
    agreement: Option<Agreement>,
    route: Option<(u32, Shared<Vec<Hop>>)>,
    crossing: Vec<usize>,
    roster: Arc<IdSet>,
    settled_rounds: usize,
    /// What the user has asked for.
    requested: Option<Arc<[Point]>>,
    /// Rounds of this control period so far; none while time passes.
    round: Option<usize>,
    is_new: bool,
    clock: f64,
    voice: Voice,
    log: Vec<MissionEvent>,
}

impl AccessPoint {
    /// Access point `number` of the site.
    pub fn new(number: usize, site: Arc<Site>) -> Self {
        let period = site.settings.period;
        AccessPoint {
            number,
            position: site.access_points[number],
            site,
            heard: Vec::new(),
            bulletin: Shared::new(Bulletin::first(Notice::Quiet)),
            announced: None,
            election: None,
            election_rounds: 0,
            agreement: None,
            route: None,
            crossing: Vec::new(),
            roster: Arc::default(),
            settled_rounds: 0,
            requested: None,
            round: None,
            is_new: true,
            clock: period,
            voice: Voice::default(),
            log: Vec::new(),
        }
    }

    /// Its number among the access points.
    pub const fn number(&self) -> usize {
        self.number
    }

    fn id(&self) -> NodeId {
        self.site.robots + self.number
    }

    /// What it tells its neighbours and, over the wire, the other access points: the very same
    /// beacon as before unless something in it has changed.
    fn speak(&mut self) -> Arc<Beacon> {
        let (beacon, _) = self.voice.say(self.public_state());
        beacon
    }

    fn public_state(&self) -> Beacon {
        Beacon {
            sender: self.id(),
            position: self.position,
            bulletin: self.bulletin.clone(),
            election: self.election.clone(),
            agreement: self.agreement.clone(),
            route: self.route.clone(),
            crossing: self.crossing.clone(),
            lineage: Some(Arc::new(Lineage::of_access_point(self.number))),
            parent: None,
            below: Arc::clone(&self.roster),
            duty: None,
            parked: false,
            way: None,
            can_detach: false,
            offer: None,
            offers_made: 0,
            reply: None,
            team: None,
        }
    }

    /// Puts together what it has heard in one round.
    fn think(&mut self) {
        self.hear_word();
        self.find_route();
        self.call_roll();
        self.heard.clear();
    }

    /// The first access point tells the user what there is to know.
    fn tell_user(&self, outputs: &mut Outputs<Message, MissionEvent>) {
        if self.number == 0 {
            let user = self.site.robots + self.site.access_points.len();
            outputs.send(user, Message::News(self.bulletin.clone()));
        }
    }

    /// A control period has a fixed number of rounds, the first one as many as the robots take.
    fn rounds_of_this_period(&self) -> usize {
        let in_a_period = self.site.settings.rounds_per_period;
        if self.is_new { in_a_period.max(self.site.rounds_there_and_back()) } else { in_a_period }
    }

    fn hear_word(&mut self) {
        let newest = self.heard.iter().map(|b| &b.bulletin).max_by_key(|b| b.sequence());
        if let Some(newest) = newest
            && newest.sequence() > self.bulletin.sequence()
        {
            self.take_up(newest.clone());
        }
        for beacon in &self.heard {
            if let (Some(own), Some(heard)) = (&mut self.election, &beacon.election) {
                own.merge(heard);
            }
            if let (Some(own), Some(heard)) = (&mut self.agreement, &beacon.agreement) {
                own.merge(heard);
            }
        }
    }

    fn take_up(&mut self, bulletin: Shared<Bulletin<Notice>>) {
        let number = bulletin.sequence();
        if let Notice::Task { task, roster, .. } = bulletin.notice() {
            self.announced = Some((*task, Arc::clone(roster)));
        }
        match bulletin.notice() {
            Notice::Task { .. } | Notice::Call { .. } => {
                self.election = Some(Election::new(number));
                self.election_rounds = 0;
                self.route = None;
                self.crossing.clear();
            }
            Notice::Path(_) => self.agreement = Some(Agreement::new(number)),
            _ => {}
        }
        self.bulletin = bulletin;
    }

    /// The way to the robot that calls: through a robot that is attached here, or through another
    /// access point so near that a robot can change over from one to the other.
    fn find_route(&mut self) {
        let number = self.bulletin.sequence();
        if !matches!(self.bulletin.notice(), Notice::Call { .. }) || self.route.is_some() {
            return;
        }
        let own = Anchor::Access(self.number);
        for beacon in &self.heard {
            let Some((_, onward)) = beacon.route.as_ref().filter(|(at, _)| *at == number) else {
                continue;
            };
            let is_child = beacon
                .duty
                .as_ref()
                .is_some_and(|duty| duty.post().is_some_and(|post| post.parent == Some(own)));
            let changeover = beacon.duty.is_none() && self.is_within_changeover(beacon.position);
            if is_child || changeover {
                self.route = Some((number, onward.clone()));
                self.crossing = vec![self.number];
                self.crossing.extend(&beacon.crossing);
                return;
            }
        }
    }

    fn is_within_changeover(&self, other: Point) -> bool {
        self.site.distance(self.position, other) <= 2.0 * CHANGEOVER_SHARE * self.site.build_length
    }

    /// Which robots are attached to the access points.
    fn call_roll(&mut self) {
        let own = Anchor::Access(self.number);
        let mut roster = IdSet::new();
        for beacon in &self.heard {
            let counts = match &beacon.duty {
                None => true,
                Some(duty) => duty.post().is_some_and(|post| post.parent == Some(own)),
            };
            if counts {
                roster.merge(&beacon.below);
            }
        }
        let settled = self.roster.includes(&roster) && roster.includes(&self.roster);
        self.settled_rounds = if settled { self.settled_rounds + 1 } else { 0 };
        if !settled {
            // What another access point told may be older than what this one has heard itself.
            roster.merge(&self.roster);
            self.roster = Arc::new(roster);
        }
    }

    /// Announces the next of the user's tasks when the one before is serviced, and says when the
    /// mission has ended.
    fn serve(&mut self) {
        let Some(tasks) = self.requested.clone() else { return };
        let next = match self.bulletin.notice() {
            Notice::Quiet if self.settled_rounds < ROUNDS_UNTIL_ROSTER_SETTLES => return,
            Notice::Quiet => 0,
            Notice::Serviced { task } => task + 1,
            Notice::Task { .. } | Notice::Call { .. } => return self.supervise_election(),
            _ => return,
        };
        let notice = match tasks.get(next) {
            Some(_) if self.roster.is_empty() => Notice::Ended {
                outcome: Outcome::InsufficientRobots,
                reason: "no robot is connected to an access point".into(),
                task: Some(next),
            },
            Some(&position) => {
                self.log.push(MissionEvent::TaskAnnounced { task: next });
                Notice::Task {
                    task: next,
                    position,
                    roster: Arc::clone(&self.roster),
                    eligible: Arc::new((0..self.site.access_points.len()).collect()),
                }
            }
            None => Notice::Ended {
                outcome: Outcome::Serviced,
                reason: format!("all {next} tasks are serviced").into(),
                task: None,
            },
        };
        self.issue(notice);
    }

    /// Ends the mission if no robot bids for a task, because none can come close to it, or if
    /// robots that took part do not answer any more.
    fn supervise_election(&mut self) {
        let Some((task, roster)) = self.announced.clone() else { return };
        let Some(election) = &self.election else { return };
        self.election_rounds += 1;
        let is_leader_election = matches!(self.bulletin.notice(), Notice::Task { .. });
        let longest = self.longest_wait();
        let (outcome, reason) = if election.is_complete(&roster) {
            if !is_leader_election || election.best().is_some() {
                return;
            }
            let reason = format!(
                "no robot can come within the service radius of task {task}: it lies in a wall, \
                 too near to one, or in a part of the workspace that no robot can enter"
            );
            (Outcome::UnreachableTask, reason)
        } else if self.election_rounds > PATIENCE_WITH_ELECTIONS * longest {
            let missing: Vec<NodeId> =
                roster.iter().filter(|&robot| !election.has_token(robot)).collect();
            let reason = format!(
                "the election for task {task} cannot end: robots {missing:?} do not answer any more"
            );
            (Outcome::Blocked, reason)
        } else {
            return;
        };
        self.issue(Notice::Ended { outcome, reason: reason.into(), task: Some(task) });
    }

    /// No message is longer under way than there are nodes to pass it on.
    fn longest_wait(&self) -> usize {
        self.site.robots + self.site.access_points.len()
    }

    fn issue(&mut self, notice: Notice) {
        self.take_up(Shared::new(self.bulletin.next(notice)));
    }

    /// The newest notice on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        self.bulletin.notice()
    }
}

/// Two access points at most this share of 2 d_build apart let a robot change over from one to
/// the other without losing both.
const CHANGEOVER_SHARE: f64 = 0.98;

impl Node for AccessPoint {
    type Message = Message;
    type Sense = Sense;
    type Report = MissionEvent;
    type Body = Point;
    type Error = RobotError;

    fn step(
        &mut self,
        input: Input<'_, Message, Sense>,
        outputs: &mut Outputs<Message, MissionEvent>,
    ) -> Result<(), RobotError> {
        match input {
            Input::Heard { message: Message::Beacon(beacon), .. } => {
                self.heard.push(Arc::clone(beacon));
            }
            Input::Heard { message: Message::Request(tasks), .. } => {
                self.requested = Some(Arc::clone(tasks));
            }
            Input::Tick => self.tick(outputs),
            Input::Heard { .. } | Input::Sensed(_) => {}
        }
        self.log.drain(..).for_each(|event| outputs.report(event));
        Ok(())
    }

    fn time_to_tick(&self) -> Option<f64> {
        Some(match self.round {
            Some(_) => 0.0,
            None => (self.site.settings.period - self.clock).max(0.0),
        })
    }

    fn flow(&mut self, duration: f64) {
        self.clock += duration;
    }

    fn body(&self) -> Point {
        self.position
    }
}

impl AccessPoint {
    /// It speaks in every round of a control period, and thinks after each.
    fn tick(&mut self, outputs: &mut Outputs<Message, MissionEvent>) {
        let round = match self.round {
            Some(round) => {
                let known = self.bulletin.clone();
                self.think();
                self.serve();
                if self.bulletin != known {
                    self.tell_user(outputs);
                }
                round
            }
            None => {
                self.clock = 0.0;
                self.tell_user(outputs);
                0
            }
        };
        self.round = (round < self.rounds_of_this_period()).then_some(round + 1);
        match self.round {
            Some(_) => outputs.broadcast(Message::Beacon(self.speak())),
            None => self.is_new = false,
        }
    }
}
