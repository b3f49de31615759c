//! What observers see: snapshots of the whole network, made from the reports of all robots.
//!
//! No robot reads any of this.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{ExchangeStage, IdSet, NodeId, NoticeId, Phase, PostKind, Subgroup};
use serde::{Deserialize, Serialize};

use super::beacon::Notice;
use super::composition::{Network, RobotNode};
use super::duty::Duty;
use super::record::{MissionEvent, PostView, RobotSnapshot, Route, Snapshot};
use super::robot::RobotView;
use super::wire;
use crate::located::Place as _;
use crate::node::Traffic;

/// What observers need to know of one robot just before it moves. In a process of its own, a robot
/// reports it in each control period.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotReport {
    /// x_i.
    #[serde(with = "wire")]
    pub position: Point,
    /// What it does for the network.
    pub duty: Duty,
    /// Where it stands in an exchange of duties.
    pub exchange: ExchangeStage,
    /// Where the mission stands as far as it knows.
    pub phase: Phase,
    /// The identity of the newest notice on the mission that it knows.
    pub notice: NoticeId,
    /// The task of which that notice speaks.
    pub task: Option<usize>,
    /// The tasks that are over, as far as it knows.
    #[serde(with = "wire")]
    pub closed: Arc<IdSet>,
    /// How many subgroups of the path Σ have arrived, as far as it knows.
    pub subgroups_done: usize,
    /// The subgroup that is the active team, while one is: its first place on Σ, and its end.
    pub active_subgroup: Option<(usize, usize)>,
    /// Whether it may move in this control period.
    pub is_active: bool,
    /// c_i.
    #[serde(with = "wire")]
    pub residual: f64,
    /// λ_i.
    #[serde(with = "wire")]
    pub multiplier: f64,
    /// The links that it sends over, each with receiver, T_ij > 0 and R_ij.
    pub routes: Vec<(NodeId, f64, f64)>,
    /// Its parent in the tree.
    pub tree_parent: Option<NodeId>,
    /// Where it goes; none if it stands still.
    #[serde(with = "wire")]
    pub target: Option<Point>,
    /// The messages that it has sent in this control period.
    pub sent: u64,
    /// The messages that it has heard in this control period.
    pub heard: u64,
}

impl RobotReport {
    /// The report of a robot that has sent and heard as many messages, and whose body is here.
    pub fn of(robot: RobotView<'_>, body: Point, traffic: Traffic) -> Self {
        let task = match robot.notice() {
            Notice::Quiet | Notice::Serviced { .. } | Notice::Withdrawn { .. } => None,
            Notice::Task(announcement) => Some(announcement.task),
            Notice::Ended { task, .. } => *task,
            _ => robot.current_task(),
        };
        let routes = robot.routes().map(|link| (link.to, link.share, link.reliability));
        let active = robot.active_subgroup();
        RobotReport {
            position: body,
            duty: *robot.duty(),
            exchange: robot.exchange(),
            phase: robot.phase(),
            notice: robot.notice_id(),
            task,
            closed: Arc::clone(robot.closed()),
            subgroups_done: robot.subgroups_done(),
            active_subgroup: active.map(|Subgroup { first, end }| (first, end)),
            is_active: robot.is_active(),
            residual: robot.residual(),
            multiplier: robot.multiplier(),
            routes: routes.collect(),
            tree_parent: robot.tree_parent(),
            target: robot.goal(),
            sent: traffic.sent,
            heard: traffic.heard,
        }
    }
}

impl Snapshot {
    /// The snapshot of control period `step`, whose periods take `period` seconds, from the reports
    /// of all robots by number, of which these do not run or are not heard.
    pub fn of_reports(
        step: usize,
        period: f64,
        reports: &[RobotReport],
        absent: Vec<NodeId>,
    ) -> Self {
        let overview = Overview { robots: reports, absent: &absent };
        Snapshot {
            step,
            time: step as f64 * period,
            positions: reports.iter().map(|robot| robot.position).collect(),
            roles: reports.iter().map(|robot| robot.duty.role()).collect(),
            phase: overview.phase(),
            active: overview.active(),
            active_team: overview.active_team(),
            primary_team: overview.primary_team(),
            path: overview.path(),
            residuals: reports.iter().map(|robot| robot.residual).collect(),
            multipliers: reports.iter().map(|robot| robot.multiplier).collect(),
            routes: overview.routes(),
            tree: overview.tree(),
            task: overview.newest().and_then(|robot| robot.task),
            serviced: overview.serviced(),
            closed: overview.closed(),
            posts: overview.posts(),
            robots: reports.iter().map(RobotSnapshot::from).collect(),
            absent: Vec::new(),
            fleets: Vec::new(),
        }
        .without(absent)
    }
}

impl From<&RobotReport> for RobotSnapshot {
    fn from(robot: &RobotReport) -> Self {
        RobotSnapshot {
            activity: robot.duty.location(),
            exchange: robot.exchange,
            phase: robot.phase,
            target: robot.target,
            sent: robot.sent,
            heard: robot.heard,
        }
    }
}

/// Completes the events of a control period: a robot reports what it knows, and the members of its
/// team are the observers' knowledge.
pub fn complete_events(events: &mut [MissionEvent], primary_team: &[NodeId]) {
    for event in events {
        if let MissionEvent::Stationary { team, .. } | MissionEvent::JoinedPrimary { team, .. } =
            event
        {
            *team = primary_team.to_vec();
        }
    }
}

impl<M, N: RobotNode> Network<M, N> {
    /// The observers' view of this instant, just before the robots move.
    pub fn snapshot(&self) -> Snapshot {
        let period = self.site.settings.period;
        Snapshot::of_reports(self.step, period, &self.reports(), self.absent())
    }

    /// The robots and access points that do not run.
    fn absent(&self) -> Vec<NodeId> {
        let nodes = self.nodes.nodes().iter().take(self.site.nodes()).enumerate();
        nodes.filter(|(_, node)| !node.is_running()).map(|(id, _)| id).collect()
    }

    /// What observers need to know of each robot, by number.
    fn reports(&self) -> Vec<RobotReport> {
        let of = |robot: RobotView<'_>| {
            let body = self.nodes.nodes()[robot.id()].body();
            RobotReport::of(robot, body, self.nodes.traffic(robot.id()))
        };
        self.robots().into_iter().map(of).collect()
    }

    /// What has happened in this control period, in order.
    pub fn events(&self) -> Vec<MissionEvent> {
        let mut events = self.events.clone();
        if !events.is_empty() {
            complete_events(&mut events, &self.primary_team());
        }
        events
    }

    /// The primary team 𝒫 from p₁ to the leader, or the leader alone before it is released. Robots that do not run are
    /// of no team.
    pub fn primary_team(&self) -> Vec<NodeId> {
        Overview { robots: &self.reports(), absent: &self.absent() }.primary_team()
    }
}

/// All robots side by side, as only observers see them.
struct Overview<'a> {
    robots: &'a [RobotReport],
    /// The nodes that do not run or are not heard, ascending: what their robots did last tells nothing of the mission.
    absent: &'a [NodeId],
}

impl<'a> Overview<'a> {
    fn runs(&self, robot: NodeId) -> bool {
        self.absent.binary_search(&robot).is_err()
    }

    /// The robots that run, by number.
    fn running(&self) -> impl Iterator<Item = (NodeId, &'a RobotReport)> {
        self.robots.iter().enumerate().filter(|(id, _)| self.runs(*id))
    }

    /// The robots that have stopped, or are not heard.
    fn stopped(&self) -> impl Iterator<Item = (NodeId, &'a RobotReport)> {
        self.robots.iter().enumerate().filter(|(id, _)| !self.runs(*id))
    }

    /// The active team, and the robots that settle on their posts.
    fn active(&self) -> Vec<NodeId> {
        let team = self.active_team();
        (0..self.robots.len())
            .filter(|id| team.contains(id) || self.robots[*id].is_active)
            .collect()
    }

    /// Where the mission stands for the robot that runs and knows the newest notice.
    fn phase(&self) -> Phase {
        self.newest().map_or(Phase::Idle, |robot| robot.phase)
    }

    fn newest(&self) -> Option<&'a RobotReport> {
        let robots = self.running().map(|(_, robot)| robot);
        robots.max_by_key(|robot| (robot.notice, robot.subgroups_done))
    }

    fn primary_team(&self) -> Vec<NodeId> {
        let member =
            |robot: &RobotReport| robot.duty.post().filter(|post| post.is_primary()).copied();
        let Some((leader, robot)) = self.running().find(|(_, robot)| robot.duty.leads()) else {
            return Vec::new();
        };
        let mut team = vec![leader];
        let mut ahead = member(robot);
        while let Some(post) = ahead {
            let follows = PostKind::Primary { follows: Some(post.id) };
            // One that has stopped may hold the place of a robot that has taken it over.
            let next = self.running().chain(self.stopped()).find(|(id, robot)| {
                !team.contains(id) && member(robot).is_some_and(|other| other.kind == follows)
            });
            team.extend(next.map(|(id, _)| id));
            ahead = next.and_then(|(_, robot)| member(robot));
        }
        team.retain(|&id| self.runs(id));
        team.reverse();
        team
    }

    fn active_team(&self) -> Vec<NodeId> {
        match self.phase() {
            Phase::Advance => self.primary_team(),
            Phase::Shift => {
                let active = self.newest().and_then(|robot| robot.active_subgroup);
                let places = active.map_or(0..0, |(first, end)| first..end);
                let members = self.places().into_iter().filter(|(place, _)| places.contains(place));
                members.map(|(_, id)| id).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The robots that wait on Σ or are on their way along it, by place.
    fn path(&self) -> Vec<NodeId> {
        self.places().into_iter().map(|(_, id)| id).collect()
    }

    /// The places on Σ with their robots, ascending.
    fn places(&self) -> Vec<(usize, NodeId)> {
        let place = |(id, robot): (NodeId, &RobotReport)| Some((robot.duty.place()?, id));
        let mut places: Vec<_> = self.running().filter_map(place).collect();
        places.sort_unstable();
        places
    }

    fn routes(&self) -> Vec<Route> {
        let of = |(from, robot): (NodeId, &RobotReport)| -> Vec<Route> {
            let route = |&(to, share, reliability): &(NodeId, f64, f64)| Route {
                from,
                to,
                share,
                reliability,
            };
            robot.routes.iter().map(route).collect()
        };
        self.robots.iter().enumerate().flat_map(of).collect()
    }

    fn tree(&self) -> Vec<(NodeId, NodeId)> {
        let edge = |(id, robot): (NodeId, &RobotReport)| Some((id, robot.tree_parent?));
        self.robots.iter().enumerate().filter_map(edge).collect()
    }

    /// The robot of each task. One that has stopped may have had the task of another that has taken it over.
    fn serviced(&self) -> Vec<(usize, NodeId)> {
        let task = |(id, robot): (NodeId, &RobotReport)| Some((robot.duty.post()?.task?, id));
        let mut serviced: Vec<_> = self.running().filter_map(task).collect();
        serviced.sort_unstable();
        serviced.dedup_by_key(|(task, _)| *task);
        serviced
    }

    fn closed(&self) -> Vec<usize> {
        let mut closed = IdSet::new();
        for robot in self.robots {
            closed.merge(&robot.closed);
        }
        closed.iter().collect()
    }

    fn posts(&self) -> Vec<PostView> {
        self.robots
            .iter()
            .enumerate()
            .filter_map(|(holder, robot)| {
                let station = robot.duty.station().filter(|station| station.post.is_fixed())?;
                let attached = || {
                    let held = self.robots.iter().filter_map(|child| child.duty.post());
                    held.filter(|held| held.is_child_of(station.post.id) && !held.is_redundant())
                };
                // The primary team is one branch, also while a member of it has yet to attach to the
                // newcomer.
                let fixed = attached().filter(|held| held.is_fixed()).count();
                let branches = fixed + usize::from(attached().any(|held| held.is_primary()));
                Some(PostView {
                    reference: station.reference,
                    holder,
                    task: station.post.task,
                    junction: branches > 1,
                })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use pleach_discrete::network::{Post, PostId};

    use super::super::duty::{Following, Held, Leading, Station};
    use super::*;

    /// A member of a primary team on a post, one that leads or one that follows.
    fn member(post: u32, follows: Option<u32>, notice: u32, phase: Phase) -> RobotReport {
        let kind = PostKind::Primary { follows: follows.map(PostId) };
        let post = Post { kind, ..Post::redundant(PostId(post)) };
        let held = Held { station: Station { post, reference: Point::origin() }, left: None };
        RobotReport {
            position: Point::origin(),
            duty: match follows {
                None => Duty::Leading(Leading(held)),
                Some(_) => Duty::Following(Following(held)),
            },
            exchange: ExchangeStage::Free,
            phase,
            notice: NoticeId::new(notice, 0),
            task: Some(0),
            closed: Arc::default(),
            subgroups_done: 0,
            active_subgroup: None,
            is_active: true,
            residual: 0.0,
            multiplier: 0.0,
            routes: Vec::new(),
            tree_parent: None,
            target: None,
            sent: 0,
            heard: 0,
        }
    }

    fn seen(reports: &[RobotReport], absent: &[NodeId]) -> Snapshot {
        Snapshot::of_reports(7, 1.0, reports, absent.to_vec())
    }

    /// Robot 0 has stopped while it led; robot 2 is elected in its place, and robot 1 follows it.
    #[test]
    fn a_robot_that_has_stopped_leads_no_team() {
        let stopped = member(30, None, 2, Phase::Advance);
        let elected = member(40, None, 5, Phase::Advance);
        let reports = [stopped, member(41, Some(40), 5, Phase::Advance), elected];
        assert_eq!(seen(&reports, &[0]).primary_team, [1, 2]);
        assert!(seen(&reports[..1], &[0]).primary_team.is_empty());
        let overview = Overview { robots: &reports[..1], absent: &[0] };
        assert!(overview.primary_team().is_empty(), "nor do events name it");
        assert_eq!(Overview { robots: &reports, absent: &[] }.primary_team(), [0], "it runs");
    }

    /// Robot 1 has stopped: those behind it are of the team all the same. Where robot 3 has taken its place, it goes by
    /// that one.
    #[test]
    fn a_team_is_seen_across_a_member_that_has_stopped() {
        let at = |post, follows| member(post, follows, 2, Phase::Advance);
        let reports = [at(40, None), at(41, Some(40)), at(42, Some(41)), at(43, Some(40))];
        assert_eq!(seen(&reports[..3], &[1]).primary_team, [2, 0]);
        assert_eq!(seen(&reports, &[1]).primary_team, [3, 0]);
    }

    /// Robot 0 knew the newest notice when it stopped.
    #[test]
    fn the_phase_is_that_of_a_robot_that_runs() {
        let reports =
            [member(30, None, 9, Phase::PathAgreement), member(40, None, 5, Phase::Advance)];
        let (all, without) = (seen(&reports, &[]), seen(&reports, &[0]));
        assert_eq!((all.phase, without.phase), (Phase::PathAgreement, Phase::Advance));
        assert_eq!(without.active_team, [1]);
        assert_eq!(seen(&reports[..1], &[0]).phase, Phase::Idle);
    }
}
