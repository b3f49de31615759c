//! The election of a leader (Algorithm 1, Remark 5.3).

use std::sync::Arc;

use pleach_discrete::network::{Bid, Election, NodeId};

use super::super::beacon::Notice;
use super::super::record::MissionEvent;
use super::{Robot, TaskNotice};

/// Distances in bids are compared in units of this share of the full range l: finer differences
/// are ties, which go to the higher index.
const BID_RESOLUTION: f64 = 1e-6;
/// A replacer stands this many ρ beside the robot that it relieves.
const BESIDE: f64 = 2.1;

impl Robot {
    /// A task is announced: place a bid for it (Remark 5.3).
    pub fn begin_leader_election(&mut self) {
        self.subgroups.clear();
        self.still_periods = 0;
        self.path = None;
        self.agreement = None;
        self.route = None;
        let bulletin = self.bulletin.clone();
        let Notice::Task { task, position, roster, eligible } = bulletin.notice() else { return };
        let (task, position) = (*task, *position);
        self.roster = Arc::clone(roster);
        self.eligible = Arc::clone(eligible);
        let target = self.site.free_space.nearest(position);
        if self.tasks.last().is_none_or(|known| known.number != task) {
            self.tasks.push(TaskNotice { number: task, position, target });
        }
        let competes =
            self.lineage.as_ref().is_some_and(|lineage| self.eligible.contains(lineage.root()));
        let mut election = Election::new(self.bulletin.sequence());
        self.bid = competes.then(|| self.leader_bid()).flatten();
        election.place(self.id, self.bid);
        self.election = Some(election);
    }

    /// The nearer to the task along the geodesic, the better; none if the task is out of reach.
    fn leader_bid(&self) -> Option<Bid> {
        let task = self.tasks.last()?;
        let gap = (task.target - task.position).norm();
        let distance = self.site.distance(self.position, task.target);
        let unit = BID_RESOLUTION * self.site.build_length;
        let within_reach = gap <= self.site.settings.service_radius && distance.is_finite();
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
            away.hypot(BESIDE * self.clearance()) <= self.site.settings.service_radius
        })
    }

    /// Every token is known: the winner leads, at once or after it has been released.
    pub fn conclude_leader_election(&mut self) {
        if self.winner() != Some(self.id) {
            return;
        }
        let conflict = self.duty.is_bound();
        if let Some(task) = self.tasks.last().map(|task| task.number) {
            self.report(MissionEvent::LeaderElected { task, robot: self.id, conflict });
        }
        if !conflict {
            self.issue(Notice::Advance { joined: None });
        }
    }

    /// Who won the election that this robot takes part in, as far as it knows.
    pub(super) fn winner(&self) -> Option<NodeId> {
        self.election.as_ref()?.best().map(|(_, robot)| robot)
    }
}
