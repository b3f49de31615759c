//! The election of a leader (Algorithm 1, Remark 5.3).

use std::sync::Arc;

use pleach_discrete::network::{Bid, Election, NodeId};

use super::super::beacon::Notice;
use super::super::mission::{Advance, LeaderElection};
use super::super::record::MissionEvent;
use super::mission::{Effects, MissionEffect};
use super::{Robot, TaskNotice};

/// Distances in bids are compared in units of this share of the full range l: finer differences
/// are ties, which go to the higher index.
const BID_RESOLUTION: f64 = 1e-6;
/// A replacer stands this many ρ beside the robot that it relieves.
const BESIDE: f64 = 2.1;

/// A task is announced: the robot places a bid for it (Remark 5.3).
pub(super) fn place_bid<A>(_: &A, robot: &Robot, effects: &mut Effects) -> Option<LeaderElection> {
    let Notice::Task { task, position, roster, eligible } = robot.notice() else {
        return None;
    };
    let target = robot.site.free_space.nearest(*position);
    let task = TaskNotice { number: *task, position: *position, target };
    let competes = roster.contains(robot.id)
        && robot.lineage().is_some_and(|lineage| eligible.contains(lineage.root()));
    let bid = competes.then(|| robot.leader_bid(&task)).flatten();
    let mut election = Election::new(robot.notice_id());
    election.place(robot.id, bid);
    effects.extend([
        MissionEffect::Restart,
        MissionEffect::Learn(task, Arc::clone(roster), Arc::clone(eligible)),
        MissionEffect::Elect(election, bid, None),
        MissionEffect::Agree(None),
    ]);
    Some(LeaderElection)
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
    fn leader_bid(&self, task: &TaskNotice) -> Option<Bid> {
        let gap = (task.target - task.position).norm();
        let distance = self.site.distance(self.position, task.target);
        let unit = BID_RESOLUTION * self.site.build_length;
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

    /// The winner of the election that this robot takes part in, as far as it knows.
    pub(super) fn winner(&self) -> Option<NodeId> {
        self.election.as_ref()?.best().map(|(_, robot)| robot)
    }
}
