//! The election of a leader (Algorithm 1, Remark 5.3).

use pleach_continuous::Point;
use pleach_discrete::network::{Bid, Election, NodeId};

use super::super::beacon::{Announced, Notice};
use super::super::mission::{Advance, LeaderElection};
use super::super::record::MissionEvent;
use super::Robot;
use super::mission::{Effects, MissionEffect};

/// Distances in bids are compared in units of this share of the full range l: finer differences
/// are ties, which go to the higher index.
const BID_RESOLUTION: f64 = 1e-6;
/// A replacer stands this many ρ beside the robot that it relieves.
const BESIDE: f64 = 2.1;

/// A task is announced: the robot places a bid for it (Remark 5.3).
pub(super) fn place_bid<A>(_: &A, robot: &Robot, effects: &mut Effects) -> Option<LeaderElection> {
    let Notice::Task(announcement) = robot.notice() else { return None };
    let competes = announcement.roster.contains(robot.id)
        && robot.lineage().is_some_and(|way| announcement.eligible.contains(way.root()));
    let bid = competes.then(|| robot.leader_bid(announcement.position)).flatten();
    let mut election = Election::new(robot.notice_id());
    election.place(robot.id, bid);
    effects.extend([
        MissionEffect::Restart,
        MissionEffect::Learn((robot.notice_id(), announcement.clone())),
        MissionEffect::Elect(election, bid, None),
        MissionEffect::Agree(None),
    ]);
    Some(LeaderElection)
}

/// The robots that it hears go by an announcement that it has not received, because it has begun
/// or restarted since.
pub(super) fn learn<A: Clone>(phase: &A, robot: &Robot, effects: &mut Effects) -> Option<A> {
    effects.push(MissionEffect::Learn(robot.newer_announcement()?.clone()));
    Some(phase.clone())
}

/// Every token is known: the winner leads, at once or after it has been released.
pub(super) fn conclude(_: &LeaderElection, robot: &Robot, effects: &mut Effects) -> Advance {
    if robot.winner() == Some(robot.id) {
        let conflict = robot.duty.is_bound();
        if let Some(task) = robot.current_task() {
            let event = MissionEvent::LeaderElected { task, robot: robot.id, conflict };
            effects.push(MissionEffect::Report(event));
        }
        if !conflict {
            effects.push(MissionEffect::Issue(Notice::Advance { joined: None }));
        }
    }
    Advance { path: None }
}

impl Robot {
    /// The nearer to the task along the geodesic, the better; none if the task is out of reach.
    fn leader_bid(&self, task: Point) -> Option<Bid> {
        let target = self.site.free_space.nearest(task);
        let gap = (target - task).norm();
        let distance = self.site.distance(self.position, target);
        let unit = BID_RESOLUTION * self.site.usual.build;
        let within_reach = gap <= self.site.settings.leash_radius() && distance.is_finite();
        within_reach.then(|| Bid {
            rank: if self.could_be_relieved() { 1 } else { 0 },
            merit: -(distance / unit).round() as i64,
            economy: 0,
        })
    }

    /// Whether another robot beside this one could service its task as well, so that it can be
    /// relieved of it: not where the task lies so deep in a wall that only one comes near enough.
    fn could_be_relieved(&self) -> bool {
        let task = self.duty.post().and_then(|post| post.task);
        task.and_then(|task| self.task_position(task)).is_none_or(|place| {
            let away = (self.position - place).norm();
            away.hypot(BESIDE * self.clearance()) <= self.site.settings.arrival_radius()
        })
    }

    /// The newest announcement by which robots go that it hears, if it does not go by it yet.
    pub(super) fn newer_announcement(&self) -> Option<&Announced> {
        let heard = self.neighbours.iter().filter_map(|known| known.beacon.announced.as_ref());
        let own = self.announced.as_ref().map(|(id, _)| *id);
        let is_newer = |(id, _): &&Announced| Some(*id) > own && id.epoch() >= self.epoch;
        heard.filter(is_newer).max_by_key(|(id, _)| *id)
    }

    /// The winner of the election that this robot takes part in, as far as it knows.
    pub(super) fn winner(&self) -> Option<NodeId> {
        self.election.as_ref()?.best().map(|(_, robot)| robot)
    }
}
