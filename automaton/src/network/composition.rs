//! The network: N robots, their access points, the user and the medium, composed.
//!
//! It is an [`Ensemble`] of nodes, run by the executor. Control is sampled: at t_k every node takes
//! the stages of its control period, one at each tick of its clock, and hears messages between
//! them; none of this takes time. Until t_{k+1} every robot flows with ẋ = u, τ̇ = 1.
//!
//! The network passes messages on and has no access to the state of nodes. What observers
//! see is put together in [`crate::network::observer`].

use std::fmt::{self, Debug};
use std::sync::Arc;
use std::time::{Duration, Instant};

use pleach_continuous::Point;
use pleach_discrete::network::Stage;

use super::access_point::AccessPoint;
use super::faulty_node::FaultyNode;
use super::medium::Radio;
use super::member::{Member, Sense};
use super::message::Message;
use super::record::{End, MissionEvent};
use super::robot::{Robot, RobotError, RobotView};
use super::scenario::{Scenario, ValidScenario};
use super::site::Site;
use super::user::User;
use crate::executor::{Ending, Executor, Round, System};
use crate::node::{Ensemble, Medium, Node, NodeJump, Observed};

/// What went wrong inside the simulator.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NetworkError {
    /// A node cannot go on.
    #[error(transparent)]
    Node(#[from] RobotError),
}

/// Time spent in the parts of a control period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KernelTimes {
    /// Messages, coordination and the automata.
    pub coordination: Duration,
    /// Routes.
    pub routing: Duration,
    /// Geodesics, cells and motion problems.
    pub motion: Duration,
    /// The certified acceptance.
    pub acceptance: Duration,
}

impl KernelTimes {
    /// What two networks have spent together.
    pub fn and(self, other: Self) -> Self {
        KernelTimes {
            coordination: self.coordination + other.coordination,
            routing: self.routing + other.routing,
            motion: self.motion + other.motion,
            acceptance: self.acceptance + other.acceptance,
        }
    }

    /// The part that a round belongs to which takes a robot from one stage to another.
    const fn of(&mut self, from: Stage, to: Stage) -> &mut Duration {
        match (from, to) {
            (Stage::Moving | Stage::Beacons, _) => &mut self.coordination,
            (Stage::Reserving, Stage::Negotiation) => &mut self.motion,
            (Stage::Negotiation, _) => &mut self.acceptance,
            _ => &mut self.routing,
        }
    }
}

/// Times that differ by this share of a control period are the same: elapsed time is a sum.
const SAME: f64 = 1e-6;

/// Control periods for which a run goes on at most when the mission has ended and no robot moves, if robots are still
/// about to change their places in the tree.
pub const LONGEST_SETTLING: usize = 8;

/// The network of robots. Its nodes are [`Member`]s, or [`FaultyNode`](super::FaultyNode) ones.
pub struct Network<M = Radio, N: RobotNode = Member> {
    pub(super) site: Arc<Site>,
    pub(super) nodes: Ensemble<N, M>,
    pub(super) events: Vec<MissionEvent>,
    /// Seconds since the beginning.
    elapsed: f64,
    pub(super) step: usize,
    /// Whether the current control period is over.
    has_flowed: bool,
    /// Control periods at whose end the mission had ended and no robot could move, up to now.
    at_rest: usize,
    times: KernelTimes,
}

impl Network<Radio> {
    /// The network of a scenario at its start, with the synchronous medium.
    ///
    /// # Errors
    /// When the user cannot take up its tasks.
    pub fn new(scenario: &ValidScenario) -> Result<Self, NetworkError> {
        let site = Arc::clone(scenario.site());
        let medium = Radio::new(&site);
        Network::with_medium(scenario, site, medium)
    }

    /// Runs up to the horizon, or to the end of the mission if that comes first, while nobody watches; with
    /// observers see [`Executor::run`].
    ///
    /// # Errors
    /// When a node cannot go on.
    // Not generic: what runs ordinary networks is compiled in this package, and optimised in tests of others.
    pub fn run(&mut self, executor: &Executor) -> Result<Ending<End>, NetworkError> {
        executor.run(self, &mut ())
    }
}

impl<M: Medium<Message, Point>> Network<M> {
    /// The network of a scenario at its start, with the given medium. Nodes are numbered from
    /// 0: robots first, then access points, last the user.
    ///
    /// # Errors
    /// When the user cannot take up its tasks.
    pub fn with_medium(
        scenario: &Scenario,
        site: Arc<Site>,
        medium: M,
    ) -> Result<Self, NetworkError> {
        let robot = |id: usize| {
            let start = scenario.robot[id];
            Robot::new(id, start.position.into(), start.rate, Arc::clone(&site))
        };
        let robots = (0..scenario.robot.len()).map(|id| Member::Robot(Box::new(robot(id))));
        let access_points = (0..site.access_points.len())
            .map(|number| AccessPoint::new(number, Arc::clone(&site)))
            .map(|access_point| Member::AccessPoint(Box::new(access_point)));
        let user = Member::User(Box::new(User::new(Arc::clone(&site))));
        let members: Vec<Member> = robots.chain(access_points).chain([user]).collect();
        Network::of_nodes(scenario, site, medium, members)
    }
}

/// A node of a network of robots, with the member that observers see of it.
pub trait RobotNode:
    Node<Message = Message, Sense = Sense, Report = MissionEvent, Body = Point, Error = RobotError>
{
    /// The member.
    fn member(&self) -> &Member;

    /// Whether it runs.
    fn is_running(&self) -> bool {
        true
    }
}

impl RobotNode for Member {
    fn member(&self) -> &Member {
        self
    }
}

impl RobotNode for FaultyNode {
    fn member(&self) -> &Member {
        FaultyNode::member(self)
    }

    fn is_running(&self) -> bool {
        FaultyNode::is_running(self)
    }
}

impl<M: Medium<Message, Point>, N: RobotNode> Network<M, N> {
    /// The network of a scenario whose nodes are these: robots first, then access points, last the
    /// user.
    ///
    /// # Errors
    /// When the user cannot take up its tasks.
    pub fn of_nodes(
        scenario: &Scenario,
        site: Arc<Site>,
        medium: M,
        members: Vec<N>,
    ) -> Result<Self, NetworkError> {
        let user = members.len().saturating_sub(1);
        let mut nodes = Ensemble::new(members, medium);
        nodes.sense(user, Sense::Tasks(Arc::from(&*scenario.task)))?;
        Ok(Network {
            site,
            nodes,
            events: Vec::new(),
            elapsed: 0.0,
            step: 0,
            has_flowed: false,
            at_rest: 0,
            times: KernelTimes::default(),
        })
    }
}

impl<M, N: RobotNode> Network<M, N> {
    /// What the robots know from the beginning.
    pub fn site(&self) -> &Site {
        &self.site
    }

    /// Time spent in each part so far.
    pub const fn times(&self) -> KernelTimes {
        self.times
    }

    /// k: how many control periods have passed since the first node could begin.
    pub const fn step(&self) -> usize {
        self.step
    }

    /// The robots as observers see them, by number.
    pub fn robots(&self) -> Vec<RobotView<'_>> {
        self.members().filter_map(|member| member.view().robot()).collect()
    }

    /// Where the first robot stands in its control period, as the others do: time passes for all of them at once.
    fn stage(&self) -> Stage {
        let first = self.members().next().and_then(|member| member.view().robot());
        first.map_or(Stage::Moving, RobotView::stage)
    }

    fn members(&self) -> impl Iterator<Item = &Member> {
        self.nodes.nodes().iter().map(RobotNode::member)
    }

    /// Whether this holds for a robot that runs.
    fn any_robot(&self, holds: fn(RobotView<'_>) -> bool) -> bool {
        let mut running = self.nodes.nodes().iter().filter(|node| node.is_running());
        running.any(|node| node.member().view().robot().is_some_and(holds))
    }

    /// Whether the network is at rest after this end: no robot moves, and unless the mission has been given up none is
    /// about to change its place in the tree.
    fn has_settled(&self, end: &End) -> bool {
        let is_settling =
            || self.at_rest <= LONGEST_SETTLING && self.any_robot(|robot| robot.is_settling());
        self.at_rest > 0 && (end.outcome.is_given_up() || !is_settling())
    }

    /// How the mission has ended, as the user knows it.
    fn known_end(&self) -> Option<End> {
        self.nodes.nodes().last()?.member().view().user()?.known_end()
    }
}

impl<M: Debug, N: RobotNode> Debug for Network<M, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let members: Vec<&Member> = self.members().collect();
        f.debug_struct("Network")
            .field("step", &self.step)
            .field("members", &members)
            .finish_non_exhaustive()
    }
}

impl<M: Medium<Message, Point>, N: RobotNode> Network<M, N> {
    /// The nodes, by number.
    pub fn nodes(&self) -> &[N] {
        self.nodes.nodes()
    }

    /// Where the robots are, by number.
    pub(super) fn bodies(&self) -> impl Iterator<Item = Point> {
        self.nodes.nodes().iter().take(self.site.robots).map(Node::body)
    }

    /// A node senses something.
    pub(super) fn sense(&mut self, node: usize, sensed: Sense) -> Result<(), NetworkError> {
        Ok(self.nodes.sense(node, sensed)?)
    }

    /// The medium.
    pub const fn medium(&self) -> &M {
        self.nodes.medium()
    }
}

impl<M: Medium<Message, Point>, N: RobotNode> System for Network<M, N> {
    type Jump = NodeJump;
    type Finish = End;
    type Error = NetworkError;

    fn finished(&self) -> Option<End> {
        if !self.has_flowed {
            return None;
        }
        let limit = self.site.settings.max_steps;
        self.known_end()
            .filter(|end| self.has_settled(end))
            .or_else(|| (self.step >= limit).then(|| End::at_step_limit(limit)))
    }

    fn jump(&mut self, round: &mut Round<'_, NodeJump>) -> Result<(), NetworkError> {
        if std::mem::take(&mut self.has_flowed) {
            self.events.clear();
            self.nodes.forget_traffic();
        }
        let before = self.stage();
        let begin = Instant::now();
        self.nodes.jump(round)?;
        *self.times.of(before, self.stage()) += begin.elapsed();
        self.events.extend(self.nodes.drain_reports().map(|(_, event)| event));
        Ok(())
    }

    fn time_to_jump(&self) -> Result<Option<f64>, NetworkError> {
        Ok(self.nodes.time_to_jump()?)
    }

    fn flow(&mut self, duration: f64) -> Result<(), NetworkError> {
        self.nodes.flow(duration)?;
        self.elapsed += duration;
        self.step = (self.elapsed / self.site.settings.period + SAME).floor() as usize;
        self.has_flowed = true;
        let has_ended = self.known_end().is_some() && !self.any_robot(|robot| robot.may_move());
        self.at_rest = if has_ended { self.at_rest + 1 } else { 0 };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use pleach_discrete::network::{CONTROL, StageEvent as On};

    use super::*;

    /// Each round adds to one part, and the parts to the whole.
    #[test]
    fn the_time_of_a_round_counts_for_one_part() {
        let spent = |from: Stage, to: Stage| {
            let mut times = KernelTimes::default();
            *times.of(from, to) += Duration::from_secs(1);
            let KernelTimes { coordination, routing, motion, acceptance } = times;
            [coordination, routing, motion, acceptance].map(|part| part.as_secs())
        };
        for row in CONTROL.rows() {
            let expected = match row.event {
                On::SampleDue | On::NextRound | On::RoutesDue | On::OldFlowsDue => [1, 0, 0, 0],
                On::RoutesDone => [0, 0, 1, 0],
                On::ProposalsHeard | On::NextAttempt | On::MoveCertified => [0, 0, 0, 1],
                _ => [0, 1, 0, 0],
            };
            assert_eq!(spent(row.source, row.target), expected, "{:?}", row.event);
        }
    }

    #[test]
    fn what_two_networks_have_spent_is_added_part_by_part() {
        let [one, other] = [[1, 20, 300, 4000], [5, 60, 700, 8000]].map(|parts| {
            let [coordination, routing, motion, acceptance] = parts.map(Duration::from_secs);
            KernelTimes { coordination, routing, motion, acceptance }
        });
        let KernelTimes { coordination, routing, motion, acceptance } = one.and(other);
        let parts = [coordination, routing, motion, acceptance].map(|part| part.as_secs());
        assert_eq!(parts, [6, 80, 1000, 12000]);
        assert_eq!(one.and(KernelTimes::default()), one);
    }
}
