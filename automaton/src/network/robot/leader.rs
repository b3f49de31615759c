//! The election of a leader (Algorithm 1, Remark 5.3).

use pleach_continuous::Point;
use pleach_discrete::network::{Bid, Election, NodeId, Phase, Post};

use super::Robot;
use super::mission::{Effects, MissionEffect};
use crate::network::beacon::{Announced, Announcement, Notice};
use crate::network::mission::{Advance, LeaderElection};
use crate::network::record::{MissionEvent, Outcome};

/// Distances in bids are compared in units of this share of the full range l: finer differences
/// are ties, which go to the higher index.
const BID_RESOLUTION: f64 = 1e-6;
/// A replacer stands this many ρ beside the robot that it relieves.
const BESIDE: f64 = 2.1;

/// The ranks of bids, the lowest first.
enum Rank {
    /// The robot cannot reach the task: robots that have stopped block every way.
    Obstructed,
    /// It could not be relieved of the task that it services.
    Irreplaceable,
    /// It can leave its post.
    Free,
}

/// A task is announced: the robot places a bid for it (Remark 5.3).
pub(super) fn begin_election<A>(
    _: &A,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<LeaderElection> {
    let Notice::Task(announcement) = robot.notice() else { return None };
    effects.extend([
        MissionEffect::Restart,
        MissionEffect::Learn((robot.notice_id(), announcement.clone())),
        MissionEffect::Elect(Election::new(robot.notice_id()), None),
        MissionEffect::Agree(None),
    ]);
    Some(LeaderElection)
}

/// The robots that it hears go by an announcement that it has not received, because it has begun
/// or restarted since. If it is one of those that elected by it, or Σ leads over it, it has forgotten what became of
/// that.
pub(super) fn learn<A>(_: &A, robot: &Robot, effects: &mut Effects) -> Option<()> {
    let announced = robot.newer_announcement()?.clone();
    let is_on_path = match robot.notice() {
        Notice::Path(path) => path.hops.iter().any(|hop| hop.robot == robot.id),
        _ => false,
    };
    let has_forgotten = announced.1.roster.contains(robot.id) || is_on_path;
    effects.push(MissionEffect::Learn(announced));
    effects.extend(has_forgotten.then_some(MissionEffect::Forgotten));
    Some(())
}

/// Every token is known: the winner leads, at once or after it has been released.
pub(super) fn conclude(_: &LeaderElection, robot: &Robot, effects: &mut Effects) -> Advance {
    effects.extend(robot.learns_who_leads());
    if robot.winner() == Some(robot.id) {
        let conflict = robot.duty.is_bound();
        if let Some(task) = robot.current_task() {
            let event = MissionEvent::LeaderElected { task, robot: robot.id, conflict };
            effects.push(MissionEffect::Report(event));
        }
        if !conflict {
            effects.push(MissionEffect::Issue(Notice::Advance { joined: None }));
        }
    } else if let Some(notice) = robot.gives_up_without_bid() {
        effects.push(MissionEffect::Issue(notice));
    }
    Advance { path: None, in_vain: false }
}

/// Nothing depends on the post of the leader any more: it leaves it, and leads.
pub(super) fn lead_on(advance: &Advance, _: &Robot, effects: &mut Effects) -> Advance {
    effects.push(MissionEffect::Issue(Notice::Advance { joined: None }));
    advance.clone()
}

/// Of bids that are alike otherwise, that in the tree of the first access point is the best.
const fn economy_in_tree(root: usize) -> i64 {
    -(root as i64)
}

/// The access point in whose tree the bidder is.
const fn tree_of(bid: Bid) -> usize {
    bid.economy.unsigned_abs() as usize
}

impl Robot {
    /// Places its token in the election of a leader, with a bid if it competes. A robot that knows no way to
    /// an access point looks for one first.
    pub(super) fn answer_announcement(&mut self) {
        let id = self.notice_id();
        let is_open = self.ballot.is_of(id) && !self.ballot.has_token(self.id);
        let has_time = !self.ballot.has_waited_for(2 * self.longest_wait());
        let way = self.lineage().filter(|_| !self.is_orphan());
        if !is_open || way.is_none() && has_time {
            return;
        }
        let bid = self.announcement().zip(way).and_then(|(announcement, way)| {
            let root = way.root();
            let competes =
                announcement.roster.contains(self.id) && announcement.eligible.contains(root);
            competes.then(|| self.leader_bid(announcement, root)).flatten()
        });
        self.ballot.place(self.id, bid);
    }

    /// The nearer to the task along the geodesic, the better; ties go to the tree of the first access point. None if
    /// the task is out of reach. Where robots that have stopped block the way, others come first. As a last resort
    /// also none if its post cannot move.
    pub(super) fn leader_bid(&self, announcement: &Announcement, root: usize) -> Option<Bid> {
        let task = announcement.position;
        let target = self.site.place_to_service(task, self.body.position());
        let gap = (target - task).norm();
        let open_way = self.open_way(self.body.position(), target);
        let distance = open_way.unwrap_or_else(|| self.site.distance(self.body.position(), target));
        let unit = BID_RESOLUTION * self.site.usual.build;
        let within_reach = gap <= self.site.settings.leash_radius() && distance.is_finite();
        let may_come = announcement.last_resort.is_none() || self.could_move_post_to(task);
        if !within_reach || !may_come {
            return None;
        }
        let rank = if open_way.is_none() {
            Rank::Obstructed
        } else if self.could_be_relieved() {
            Rank::Free
        } else {
            Rank::Irreplaceable
        };
        let merit = -(distance / unit).round() as i64;
        Some(Bid { rank: rank as u8, merit, economy: economy_in_tree(root) })
    }

    /// Whether another robot beside this one could service its task as well, so that it can be
    /// relieved of it: not where the task lies so deep in a wall that only one comes near enough.
    fn could_be_relieved(&self) -> bool {
        let task = self.duty.post().and_then(|post| self.task_at(post));
        task.is_none_or(|place| {
            let away = (self.body.position() - place).norm();
            away.hypot(BESIDE * self.clearance()) <= self.site.settings.arrival_radius()
        })
    }

    /// The notice that robots are too few, if it has announced the task as a last resort and no robot has bid.
    fn gives_up_without_bid(&self) -> Option<Notice> {
        let (id, announcement) = self.mission.notices().announced()?;
        let is_without_bid = id.issuer == self.id && self.winner().is_none();
        let reason = announcement.last_resort.clone().filter(|_| is_without_bid)?;
        let task = Some(announcement.task);
        Some(Notice::Ended { outcome: Outcome::InsufficientRobots, reason, task })
    }

    /// Whether the leader takes its post along, as no robot is left that could relieve it.
    pub(super) fn takes_post_along(&self) -> bool {
        self.announcement().is_some_and(|announcement| announcement.last_resort.is_some())
    }

    /// Where a task is, if it has been announced by now.
    pub(super) fn task_position(&self, task: usize) -> Option<Point> {
        self.announcement()?.position_of(task)
    }

    /// Where the task is that is serviced from a post, if one is and has been announced by now.
    pub(super) fn task_at(&self, post: &Post) -> Option<Point> {
        self.task_position(post.task?)
    }

    /// The newest announcement by which robots go that it hears, if it does not go by it yet. Their notices come
    /// first: by these it gives up a task that has been announced again without it.
    pub(super) fn newer_announcement(&self) -> Option<&Announced> {
        let own = self.mission.notices().announcement_id();
        let own_notice = self.notice_id();
        let newer = self.neighbours.iter().filter_map(|known| {
            let announced = known.beacon.announced.as_ref()?;
            let id = announced.0;
            let is_newer = Some(id) > own
                && id.epoch() >= self.mission.epoch()
                && !known.beacon.bulletin.id().is_newer_than(own_notice);
            is_newer.then_some(announced)
        });
        newer.max_by_key(|(id, _)| *id)
    }

    /// The effect of leaving the election of a leader: the robot records the tree of the best bid that it knows. It may
    /// hear what the leader does next before it knows every token; that of the leader comes no later.
    pub(super) fn learns_who_leads(&self) -> Option<MissionEffect> {
        let is_electing = self.phase() == Phase::LeaderElection;
        is_electing.then(|| MissionEffect::LedFrom(self.root_of_winner()))
    }

    /// The access point in whose tree the winner of the leader election is that this robot takes part in; none where
    /// there is one access point.
    fn root_of_winner(&self) -> Option<usize> {
        let best = self.ballot.best().filter(|_| self.site.access_points.len() > 1);
        best.map(|(bid, _)| tree_of(bid))
    }

    /// The winner of the election that this robot takes part in, as far as it knows.
    pub(super) fn winner(&self) -> Option<NodeId> {
        self.ballot.best().map(|(_, robot)| robot)
    }
}
