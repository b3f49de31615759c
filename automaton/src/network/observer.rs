//! What observers see: snapshots of the whole network, put together from the robots' states.
//!
//! No robot reads any of this.

use pleach_discrete::network::{NodeId, Phase, PostKind};

use super::beacon::Notice;
use super::composition::{Network, RobotNode};
use super::record::{MissionEvent, PostView, RobotSnapshot, Route, Snapshot};
use super::robot::RobotView;
use crate::located::Place as _;
use crate::node::{Node, Traffic};

impl<M, N: RobotNode> Network<M, N> {
    /// The observers' view of this instant, just before the robots move.
    pub fn snapshot(&self) -> Snapshot {
        let overview = self.overview();
        let robots = || overview.robots.iter().copied();
        Snapshot {
            step: self.step,
            time: self.step as f64 * self.site.settings.period,
            positions: self.nodes.nodes()[..robots().count()].iter().map(Node::body).collect(),
            roles: robots().map(RobotView::role).collect(),
            phase: overview.phase(),
            active: overview.active(),
            active_team: overview.active_team(),
            primary_team: overview.primary_team(),
            path: overview.path(),
            residuals: robots().map(RobotView::residual).collect(),
            multipliers: robots().map(RobotView::multiplier).collect(),
            routes: overview.routes(),
            tree: overview.tree(),
            task: overview.task(),
            serviced: overview.serviced(),
            posts: overview.posts(),
            robots: robots().map(|robot| self.robot_snapshot(robot)).collect(),
        }
    }

    fn robot_snapshot(&self, robot: RobotView<'_>) -> RobotSnapshot {
        let Traffic { sent, heard } = self.nodes.traffic(robot.id());
        RobotSnapshot {
            activity: robot.duty().location(),
            exchange: robot.exchange(),
            phase: robot.phase(),
            target: robot.goal(),
            sent,
            heard,
        }
    }

    /// What has happened in this control period, in order. A robot reports what it knows; the
    /// members of its team are the observers' knowledge.
    pub fn events(&self) -> Vec<MissionEvent> {
        let mut events = self.events.clone();
        for event in &mut events {
            if let MissionEvent::Stationary { team, .. }
            | MissionEvent::JoinedPrimary { team, .. } = event
            {
                *team = self.primary_team();
            }
        }
        events
    }

    /// The primary team 𝒫 from p₁ to the leader, or the leader alone before it is released.
    pub fn primary_team(&self) -> Vec<NodeId> {
        self.overview().primary_team()
    }

    fn overview(&self) -> Overview<'_> {
        Overview { robots: self.robots() }
    }
}

/// All robots side by side, as only observers see them.
struct Overview<'a> {
    robots: Vec<RobotView<'a>>,
}

impl Overview<'_> {
    /// The active team, and the robots that settle on their posts.
    fn active(&self) -> Vec<NodeId> {
        let team = self.active_team();
        (0..self.robots.len())
            .filter(|id| team.contains(id) || self.robots[*id].is_active())
            .collect()
    }

    /// Where the mission stands for the robot that knows the newest notice.
    fn phase(&self) -> Phase {
        self.newest().map_or(Phase::Idle, RobotView::phase)
    }

    fn newest(&self) -> Option<RobotView<'_>> {
        self.robots.iter().copied().max_by_key(|robot| (robot.notice_id(), robot.subgroups_done()))
    }

    fn task(&self) -> Option<usize> {
        let robot = self.newest()?;
        match robot.notice() {
            Notice::Quiet | Notice::Serviced { .. } => None,
            Notice::Task { task, .. } => Some(*task),
            Notice::Ended { task, .. } => *task,
            _ => robot.current_task(),
        }
    }

    fn primary_team(&self) -> Vec<NodeId> {
        let member =
            |robot: RobotView<'_>| robot.duty().post().filter(|post| post.is_primary()).copied();
        let Some(leader) = self.robots.iter().position(|robot| robot.leads()) else {
            return Vec::new();
        };
        let mut team = vec![leader];
        let mut ahead = member(self.robots[leader]);
        while let Some(post) = ahead {
            let follows = PostKind::Primary { follows: Some(post.id) };
            let next = (0..self.robots.len()).find(|&id| {
                !team.contains(&id)
                    && member(self.robots[id]).is_some_and(|other| other.kind == follows)
            });
            team.extend(next);
            ahead = next.and_then(|id| member(self.robots[id]));
        }
        team.reverse();
        team
    }

    fn active_team(&self) -> Vec<NodeId> {
        match self.phase() {
            Phase::Advance => self.primary_team(),
            Phase::Shift => {
                let active = self.newest().and_then(RobotView::active_subgroup);
                let places = active.map_or(0..0, |subgroup| subgroup.places());
                let mut members: Vec<(usize, NodeId)> = (0..self.robots.len())
                    .filter_map(|id| Some((self.robots[id].duty().place()?, id)))
                    .filter(|(place, _)| places.contains(place))
                    .collect();
                members.sort_unstable();
                members.into_iter().map(|(_, id)| id).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The robots that wait on Σ or are on their way along it, by place.
    fn path(&self) -> Vec<NodeId> {
        let mut places: Vec<(usize, NodeId)> = (0..self.robots.len())
            .filter_map(|id| Some((self.robots[id].duty().place()?, id)))
            .collect();
        places.sort_unstable();
        places.into_iter().map(|(_, id)| id).collect()
    }

    fn routes(&self) -> Vec<Route> {
        let of = |(from, robot): (NodeId, RobotView<'_>)| -> Vec<Route> {
            robot
                .routes()
                .map(|link| Route {
                    from,
                    to: link.to,
                    share: link.share,
                    reliability: link.reliability,
                })
                .collect()
        };
        self.robots.iter().copied().enumerate().flat_map(of).collect()
    }

    fn tree(&self) -> Vec<(NodeId, NodeId)> {
        let edge = |(id, robot): (NodeId, RobotView<'_>)| Some((id, robot.tree_parent()?));
        self.robots.iter().copied().enumerate().filter_map(edge).collect()
    }

    fn serviced(&self) -> Vec<(usize, NodeId)> {
        let mut serviced: Vec<(usize, NodeId)> = self
            .robots
            .iter()
            .copied()
            .enumerate()
            .filter_map(|(id, robot)| Some((robot.duty().post()?.task?, id)))
            .collect();
        serviced.sort_unstable();
        serviced.dedup_by_key(|(task, _)| *task);
        serviced
    }

    fn posts(&self) -> Vec<PostView> {
        self.robots
            .iter()
            .enumerate()
            .filter_map(|(holder, robot)| {
                let station = robot.duty().station().filter(|station| station.post.is_fixed())?;
                let children = self.robots.iter().copied().filter(|child| {
                    child.duty().post().is_some_and(|held| {
                        held.is_child_of(station.post.id) && !held.is_redundant()
                    })
                });
                Some(PostView {
                    reference: station.reference,
                    holder,
                    task: station.post.task,
                    junction: children.count() > 1,
                })
            })
            .collect()
    }
}
