//! Whether a message can have been sent by a node of a site.
//!
//! A message that is [read](super) is well formed. Its numbers may still name nodes, tasks and places that do not
//! exist, or be so large that counters overflow. Nodes in one program never say such things; a process asks
//! before it hands a message on.

use pleach_discrete::network::{Anchor, Election, IdSet, NoticeId, Post};

use super::{FlowGrant, Message};
use crate::network::beacon::{Announced, Announcement, Beacon, Notice};
use crate::network::duty::{Duty, Hop};
use crate::network::roll::Roll;
use crate::network::scenario::MOST_PERIODS;
use crate::network::site::Site;

/// Tasks have numbers below this.
const MOST_TASKS: usize = 1 << 16;
/// Numbers of notices and offers are below this.
const LARGEST_COUNT: u32 = 1 << 31;
/// By how many control periods the clocks of two nodes may be apart.
const PERIODS_APART: u32 = 2;

impl Message {
    /// Whether a node of this site can have sent the message: nodes, access points, tasks and places exist, and
    /// control periods and counts are not absurd.
    pub fn is_possible(&self, site: &Site) -> bool {
        let bounds = Bounds { robots: site.robots, access_points: site.access_points.len() };
        bounds.admit(self)
    }
}

/// How many nodes exist.
pub(super) struct Bounds {
    pub robots: usize,
    pub access_points: usize,
}

impl Bounds {
    pub(super) fn admit(&self, message: &Message) -> bool {
        match message {
            Message::Beacon { period, roll, confirmed, beacon } => {
                let latest = period.saturating_add(PERIODS_APART);
                is_period(*period)
                    && self.has_roll(roll, latest)
                    && confirmed.is_none_or(|confirmed| confirmed <= latest)
                    && self.has_beacon(beacon)
            }
            Message::Multiplier { parent, .. } => parent.is_none_or(|it| self.has_node(it)),
            Message::Proposal { period, witness, .. } => {
                is_period(*period) && witness.is_none_or(|it| self.has_node(it))
            }
            Message::Objection { period } | Message::Consent { period } => is_period(*period),
            Message::AskFlow(request) => is_period(request.number.period),
            Message::GrantFlow(grant) => {
                let FlowGrant { number, until, part, .. } = grant;
                is_period(number.period)
                    && is_period(*until)
                    && part.is_none_or(|part| is_period(part.until))
            }
            Message::Probe(probe) => {
                (1..=self.robots).contains(&probe.robots.len())
                    && probe.flow >= 0.0
                    && probe.robots.iter().all(|&robot| self.has_robot(robot))
            }
            Message::Request(order) => order.tasks.len() <= MOST_TASKS,
            Message::News(bulletin) => self.has_bulletin(bulletin.id(), bulletin.notice()),
            Message::Flow(_) | Message::Demand(_) | Message::Shortage => true,
        }
    }

    const fn has_robot(&self, robot: usize) -> bool {
        robot < self.robots
    }

    const fn has_access_point(&self, number: usize) -> bool {
        number < self.access_points
    }

    /// Robots, then access points, then the user.
    const fn has_node(&self, node: usize) -> bool {
        node <= self.robots + self.access_points
    }

    fn has_robots(&self, robots: &IdSet) -> bool {
        are_below(self.robots, robots)
    }

    fn has_access_points(&self, numbers: &[usize]) -> bool {
        numbers.iter().all(|&number| self.has_access_point(number))
    }

    fn has_roll(&self, roll: &Roll, latest: u32) -> bool {
        roll.called <= latest
            && self.has_robots(&roll.absent.suspended)
            && self.has_robots(&roll.absent.gone)
    }

    fn has_notice_id(&self, id: NoticeId) -> bool {
        id.number < LARGEST_COUNT && self.has_node(id.issuer)
    }

    fn has_bulletin(&self, id: NoticeId, notice: &Notice) -> bool {
        self.has_notice_id(id)
            && match notice {
                Notice::Quiet => true,
                Notice::Task(announcement) => self.has_announcement(announcement),
                Notice::Call { caller, .. } => self.has_robot(*caller),
                Notice::Path(path) => self.has_hops(&path.hops),
                Notice::Advance { .. } => true,
                Notice::Serviced { task } | Notice::Withdrawn { task } => is_task(*task),
                Notice::Ended { task, .. } => task.is_none_or(is_task),
            }
    }

    fn has_announcement(&self, announcement: &Announcement) -> bool {
        is_task(announcement.task)
            && announcement.before.len() <= MOST_TASKS
            && self.has_robots(&announcement.roster)
            && are_below(self.access_points, &announcement.eligible)
    }

    fn has_announced(&self, (id, announcement): &Announced) -> bool {
        self.has_notice_id(*id) && self.has_announcement(announcement)
    }

    fn has_election(&self, election: &Election) -> bool {
        let best = election.best().is_none_or(|(_, robot)| self.has_robot(robot));
        self.has_notice_id(election.id()) && best
    }

    fn has_hops(&self, hops: &[Hop]) -> bool {
        hops.len() <= self.robots
            && hops.iter().all(|hop| {
                self.has_robot(hop.robot)
                    && self.has_post(&hop.post)
                    && self.has_access_points(&hop.crossing)
            })
    }

    fn has_post(&self, post: &Post) -> bool {
        let parent = match post.parent {
            Some(Anchor::Access(number)) => self.has_access_point(number),
            Some(Anchor::Post(_)) | None => true,
        };
        parent && post.task.is_none_or(is_task)
    }

    fn has_duty(&self, duty: &Duty) -> bool {
        duty.post().is_none_or(|post| self.has_post(post))
            && duty.place().is_none_or(|place| place < self.robots)
    }

    fn has_beacon(&self, beacon: &Beacon) -> bool {
        let offer = beacon.offer.as_ref();
        let reply = beacon.reply.as_ref();
        self.has_node(beacon.sender)
            && self.has_bulletin(beacon.bulletin.id(), beacon.bulletin.notice())
            && beacon.announced.as_ref().is_none_or(|it| self.has_announced(it))
            && self.has_robots(&beacon.forgetful)
            && beacon.election.as_ref().is_none_or(|it| self.has_election(it))
            && beacon.agreement.as_ref().is_none_or(|it| self.has_notice_id(it.id()))
            && (beacon.route.as_ref())
                .is_none_or(|(call, hops)| self.has_notice_id(*call) && self.has_hops(hops))
            && self.has_access_points(&beacon.crossing)
            && beacon.lineage.as_ref().is_none_or(|it| self.has_access_point(it.root()))
            && beacon.parent.is_none_or(|it| self.has_node(it))
            && self.has_robots(&beacon.below)
            && self.has_robots(&beacon.strays)
            && are_below(MOST_TASKS, &beacon.serves)
            && are_below(MOST_TASKS, &beacon.closed)
            // Robots have duties, and access points have none.
            && beacon.duty.is_some() == self.has_robot(beacon.sender)
            && beacon.duty.as_ref().is_none_or(|it| self.has_duty(it))
            && offer.is_none_or(|it| self.has_robot(it.to) && self.has_duty(&it.duty))
            && beacon.offers_made < LARGEST_COUNT
            && reply.is_none_or(|it| {
                self.has_robot(it.to) && it.accepted.as_ref().is_none_or(|it| self.has_duty(it))
            })
            && beacon.wrecks.iter().all(|it| self.has_robot(it.robot) && is_period(it.heard_in))
            && beacon.branches.iter().all(|it| self.has_robot(it.robot))
    }
}

fn are_below(bound: usize, numbers: &IdSet) -> bool {
    numbers.iter().all(|number| number < bound)
}

const fn is_period(period: u32) -> bool {
    period <= MOST_PERIODS
}

const fn is_task(task: usize) -> bool {
    task < MOST_TASKS
}
