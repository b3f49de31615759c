//! What a node has received of the mission: the newest notice, the newest announcement, and what goes with them.

use std::sync::Arc;

use pleach_discrete::network::{IdSet, NodeId, NoticeId};

use super::beacon::{Announced, Announcement, Beacon, Bulletin, Notice};
use super::shared::Shared;
use super::site::Site;

/// The mission as far as a robot or an access point has received.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Notices {
    bulletin: Bulletin,
    announced: Option<Announced>,
    /// The robots that have elected by this announcement, or are on Σ, and have restarted since.
    forgetful: Arc<IdSet>,
    /// The tasks that are over.
    closed: Arc<IdSet>,
    /// Whether a team has found no robot that can be recruited, so that links may be as long as they ever are.
    is_stretched: bool,
    /// For how many rounds news may be under way.
    longest_wait: usize,
}

impl Default for Notices {
    /// Those of a node that has received nothing.
    fn default() -> Self {
        Notices {
            bulletin: Bulletin::first(Shared::new(Notice::Quiet)),
            announced: None,
            forgetful: Arc::default(),
            closed: Arc::default(),
            is_stretched: false,
            longest_wait: 0,
        }
    }
}

impl Notices {
    /// Merges what a neighbour knows, except its bulletin and its announcement.
    pub(super) fn merge(&mut self, beacon: &Beacon, site: &Site) {
        self.longest_wait = site.longer_wait(self.longest_wait, beacon.longest_wait);
        self.is_stretched |= beacon.stretched;
        beacon.tell_forgetful(self.announced.as_ref(), &mut self.forgetful);
        beacon.tell_closed(&mut self.closed);
    }

    /// The newest notice is the newer one of two.
    pub(super) fn merge_bulletin(&mut self, received: &Bulletin) {
        self.bulletin.merge(received);
    }

    /// The newest notice, with its identity.
    pub(super) const fn bulletin(&self) -> &Bulletin {
        &self.bulletin
    }

    /// The newest notice is this.
    pub(super) fn take_up(&mut self, bulletin: Bulletin) {
        self.bulletin = bulletin;
    }

    /// The node issues the next notice.
    pub(super) fn issue(&mut self, issuer: NodeId, notice: Notice) {
        self.bulletin = self.bulletin.next(issuer, Shared::new(notice));
    }

    /// The announcement that the node follows, with its identity.
    pub(super) const fn announced(&self) -> Option<&Announced> {
        self.announced.as_ref()
    }

    /// The announcement that the node follows.
    pub(super) fn announcement(&self) -> Option<&Announcement> {
        self.announced.as_ref().map(|(_, announcement)| &**announcement)
    }

    /// The identity of that announcement.
    pub(super) fn announcement_id(&self) -> Option<NoticeId> {
        self.announced.as_ref().map(|&(id, _)| id)
    }

    /// The node follows this announcement from now on.
    pub(super) fn learn(&mut self, announced: Announced) {
        (self.announced, self.forgetful) = (Some(announced), Arc::default());
    }

    /// The robots that have elected by the announcement and restarted since.
    pub(super) const fn forgetful(&self) -> &Arc<IdSet> {
        &self.forgetful
    }

    /// The robot has lost its state in the election by the announcement that it follows.
    pub(super) fn forget_election(&mut self, robot: NodeId) {
        self.forgetful = Arc::new(IdSet::singleton(robot));
    }

    /// The tasks that are over.
    pub(super) const fn closed(&self) -> &Arc<IdSet> {
        &self.closed
    }

    /// A task is over.
    pub(super) fn close(&mut self, task: usize) {
        Arc::make_mut(&mut self.closed).insert(task);
    }

    /// Whether links of the tree may be as long as they ever are.
    pub(super) const fn is_stretched(&self) -> bool {
        self.is_stretched
    }

    /// From now on links of the tree may be as long as they ever are.
    pub(super) const fn stretch(&mut self) {
        self.is_stretched = true;
    }

    /// For how many rounds news may be under way.
    pub(super) const fn longest_wait(&self) -> usize {
        self.longest_wait
    }

    /// News may be under way for this many rounds.
    pub(super) const fn wait_for(&mut self, rounds: usize) {
        self.longest_wait = rounds;
    }
}

#[cfg(test)]
impl Notices {
    /// The node follows this announcement, or none.
    pub(super) fn follow(&mut self, announced: Option<Announced>) {
        self.announced = announced;
    }

    /// The node issues a notice that supersedes those that others issue meanwhile.
    pub(super) fn supersede(&mut self, issuer: NodeId, notice: Notice) {
        self.bulletin = self.bulletin.superseding(issuer, Shared::new(notice));
    }

    /// Links may be as long as they ever are, or may not.
    pub(super) const fn set_stretched(&mut self, is_stretched: bool) {
        self.is_stretched = is_stretched;
    }
}

#[cfg(test)]
mod tests {
    use pleach_continuous::Point;

    use super::*;

    fn announced(at: u32) -> Announced {
        let announcement = Announcement {
            task: 0,
            position: Point::origin(),
            before: Arc::from([]),
            roster: Arc::default(),
            eligible: Arc::default(),
            again: false,
            stretched: false,
            last_resort: None,
        };
        (NoticeId::new(at, 1), Shared::new(announcement))
    }

    #[test]
    fn another_announcement_ends_what_was_forgotten() {
        let mut notices = Notices::default();
        notices.learn(announced(1));
        notices.forget_election(4);
        assert!(notices.forgetful().contains(4));
        assert_eq!(notices.announcement_id(), Some(NoticeId::new(1, 1)));
        notices.learn(announced(2));
        assert!(notices.forgetful().is_empty());
    }

    #[test]
    fn a_newer_notice_supersedes_an_older_one() {
        let (mut own, mut other) = (Notices::default(), Notices::default());
        own.issue(3, Notice::Advance { joined: None });
        other.merge_bulletin(own.bulletin());
        assert_eq!(other.bulletin().id(), own.bulletin().id());
        other.issue(3, Notice::Serviced { task: 0 });
        own.merge_bulletin(other.bulletin());
        other.merge_bulletin(&Bulletin::first(Shared::new(Notice::Quiet)));
        assert_eq!(own, other);
    }

    #[test]
    fn a_task_stays_closed() {
        let mut notices = Notices::default();
        notices.close(2);
        notices.close(0);
        assert_eq!(notices.closed().iter().collect::<Vec<_>>(), [0, 2]);
    }
}
