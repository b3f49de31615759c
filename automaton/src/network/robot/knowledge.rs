//! What a robot knows of the mission: its phase, the newest notice, and the announcement that it goes by.

use std::ops::Deref;
use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{IdSet, NodeId, NoticeId};

use super::primary_team::Team;
use crate::located::Current;
use crate::network::beacon::{Announced, Announcement, Beacon, Bulletin, Notice};
use crate::network::mission::{Idle, Mission};
use crate::network::shared::Shared;
use crate::network::site::Site;

/// The mission as one robot knows it.
#[derive(Clone, Debug)]
pub(super) struct Knowledge {
    phase: Current<Mission>,
    bulletin: Bulletin,
    /// The epoch of the notices that the robot goes by.
    epoch: u32,
    announced: Option<Announced>,
    /// The announcement by which the robot has reached its task.
    accomplished: Option<NoticeId>,
    /// The robots that have elected by this announcement and restarted since.
    forgetful: Arc<IdSet>,
    /// Where the leader goes: the point of 𝒲_f nearest to the task announced of those to which a way leads from where
    /// the robot has received it.
    target: Option<Point>,
    /// The access point in whose tree the leader of the team was elected, if there are several.
    led_from: Option<usize>,
    /// Whether a team has found no robot that can be recruited, so that links may be as long as they ever are.
    is_stretched: bool,
    /// For how many rounds news may be under way, as far as the robot has received.
    longest_wait: usize,
    /// The tasks that are over, as far as the robot has received.
    closed: Arc<IdSet>,
    /// What the primary team knows of itself.
    team: Team,
}

impl Deref for Knowledge {
    type Target = Mission;

    fn deref(&self) -> &Mission {
        &self.phase
    }
}

impl Default for Knowledge {
    /// That of a robot which has received nothing.
    fn default() -> Self {
        Knowledge {
            phase: Current::new(Mission::Idle(Idle)),
            bulletin: Bulletin::first(Shared::new(Notice::Quiet)),
            epoch: 0,
            announced: None,
            accomplished: None,
            forgetful: Arc::default(),
            target: None,
            led_from: None,
            is_stretched: false,
            longest_wait: 0,
            closed: Arc::default(),
            team: Team::default(),
        }
    }
}

impl Knowledge {
    pub const fn current(&self) -> &Current<Mission> {
        &self.phase
    }

    pub const fn current_mut(&mut self) -> &mut Current<Mission> {
        &mut self.phase
    }

    /// Merges what a neighbour knows.
    pub fn merge(&mut self, beacon: &Beacon, site: &Site) {
        self.longest_wait = site.longer_wait(self.longest_wait, beacon.longest_wait);
        self.is_stretched |= beacon.stretched;
        self.bulletin.merge(&beacon.bulletin);
        beacon.tell_forgetful(self.announced.as_ref(), &mut self.forgetful);
        beacon.tell_closed(&mut self.closed);
    }

    /// The newest notice, with its identity.
    pub const fn bulletin(&self) -> &Bulletin {
        &self.bulletin
    }

    /// The robot issues the next notice.
    pub fn issue(&mut self, issuer: NodeId, notice: Notice) {
        self.bulletin = self.bulletin.next(issuer, Shared::new(notice));
    }

    /// The epoch of the notices that the robot goes by.
    pub const fn epoch(&self) -> u32 {
        self.epoch
    }

    /// The robot goes by the announcement that the newest notice follows from.
    pub fn keep_up(&mut self) {
        self.epoch = self.bulletin.id().epoch();
    }

    /// The announcement that the robot goes by, with its identity.
    pub const fn announced(&self) -> Option<&Announced> {
        self.announced.as_ref()
    }

    /// The announcement that the robot goes by.
    pub fn announcement(&self) -> Option<&Announcement> {
        self.announced.as_ref().map(|(_, announcement)| &**announcement)
    }

    /// The identity of that announcement.
    pub fn announcement_id(&self) -> Option<NoticeId> {
        self.announced.as_ref().map(|&(id, _)| id)
    }

    /// The robot goes by this announcement from now on; its leader would go to `target`.
    pub fn learn(&mut self, announced: Announced, target: Point) {
        self.epoch = announced.0.epoch();
        self.target = Some(target);
        self.announced = Some(announced);
        self.forgetful = Arc::default();
    }

    /// Where the leader goes.
    pub const fn target(&self) -> Option<Point> {
        self.target
    }

    /// The robot has reached the task of the announcement that it goes by.
    pub fn accomplish(&mut self) {
        self.accomplished = self.announcement_id();
    }

    /// The announcement by which the robot has reached its task.
    pub const fn accomplished(&self) -> Option<NoticeId> {
        self.accomplished
    }

    /// The robots that have elected by the announcement and restarted since.
    pub const fn forgetful(&self) -> &Arc<IdSet> {
        &self.forgetful
    }

    /// The robot has forgotten what became of the election by the announcement that it goes by.
    pub fn forget_election(&mut self, robot: NodeId) {
        self.forgetful = Arc::new(IdSet::singleton(robot));
    }

    /// The access point in whose tree the leader of the team was elected, if there are several.
    pub const fn led_from(&self) -> Option<usize> {
        self.led_from
    }

    /// The leader is of the tree of this access point when it is elected.
    pub const fn is_led_from(&mut self, root: Option<usize>) {
        self.led_from = root;
    }

    /// Whether links of the tree may be as long as they ever are.
    pub const fn is_stretched(&self) -> bool {
        self.is_stretched
    }

    /// From now on links of the tree may be as long as they ever are.
    pub const fn stretch(&mut self) {
        self.is_stretched = true;
    }

    /// For how many rounds news may be under way, as far as the robot has received.
    pub const fn longest_wait(&self) -> usize {
        self.longest_wait
    }

    /// News may be under way for this many rounds.
    pub const fn wait_for(&mut self, rounds: usize) {
        self.longest_wait = rounds;
    }

    /// What the primary team knows of itself.
    pub const fn team(&self) -> &Team {
        &self.team
    }

    /// The primary team is reviewed.
    pub const fn team_mut(&mut self) -> &mut Team {
        &mut self.team
    }

    /// The tasks that are over, as far as the robot has received.
    pub const fn closed(&self) -> &Arc<IdSet> {
        &self.closed
    }
}

#[cfg(test)]
impl Knowledge {
    /// The mission is in this phase.
    pub fn is(&mut self, mission: Mission) {
        *self = Knowledge { phase: Current::new(mission), ..self.clone() };
    }

    /// The newest notice is this.
    pub fn is_told(&mut self, bulletin: Bulletin) {
        self.bulletin = bulletin;
    }

    /// The robot goes by this announcement, or by none.
    pub fn goes_by(&mut self, announced: Option<Announced>) {
        self.announced = announced;
    }

    /// The leader goes there.
    pub const fn leads_to(&mut self, target: Point) {
        self.target = Some(target);
    }

    /// Links may be as long as they ever are, or may not.
    pub const fn stretches(&mut self, is_stretched: bool) {
        self.is_stretched = is_stretched;
    }

    /// The robot has reached its task by this announcement.
    pub const fn has_accomplished(&mut self, announcement: Option<NoticeId>) {
        self.accomplished = announcement;
    }

    /// The robot goes by notices of this epoch.
    pub const fn is_of_epoch(&mut self, epoch: u32) {
        self.epoch = epoch;
    }
}
