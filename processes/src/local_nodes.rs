//! The nodes of a process, and when their clocks tick.
//!
//! This is the order of an [`Ensemble`](pleach::automaton::node::Ensemble), for some of its nodes:
//! messages are heard before clocks tick, and a node may let rounds pass.

use crate::packet::Letter;
use crate::repeats::Sent;
use pleach::automaton::network::beacon::Notice;
use pleach::automaton::network::observer::RobotReport;
use pleach::automaton::network::record::{End, MissionEvent};
use pleach::automaton::network::robot::RobotError;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{AccessPoint, Member, MemberView, Message, Robot, Sense, User};
use pleach::automaton::node::{Input, Node, NodeId, Observed, Outputs, Traffic};
use pleach::continuous::Point;
use std::sync::Arc;

/// A node with what its process keeps of it.
#[derive(Debug)]
pub struct LocalNode {
    /// Its number.
    pub id: NodeId,
    member: Member,
    outputs: Outputs<Message, MissionEvent>,
    traffic: Traffic,
    sent: Sent,
    /// The round of this control period in which it has ticked last; 0 if in none.
    ticked: u32,
    /// The round in which it ticks next, if it hears nothing until then.
    ticks: Option<u32>,
}

/// The nodes of a process, ascending.
#[derive(Debug)]
pub struct LocalNodes {
    nodes: Vec<LocalNode>,
}

impl LocalNode {
    fn of(id: NodeId, member: Member) -> Self {
        let (outputs, traffic) = (Outputs::of(id), Traffic::default());
        LocalNode { id, member, outputs, traffic, sent: Sent::default(), ticked: 0, ticks: None }
    }

    fn ask(&mut self) {
        let is_due = self.member.time_to_tick().is_some_and(|wait| wait <= 0.0);
        let passes = || u32::try_from(self.member.rounds_to_pass()).unwrap_or(u32::MAX);
        self.ticks = is_due.then(|| self.ticked.saturating_add(1).saturating_add(passes()));
    }

    fn step(&mut self, input: Input<'_, Message, Sense>) -> Result<(), RobotError> {
        self.member.step(input, &mut self.outputs)
    }

    /// Where its body is.
    pub fn body(&self) -> Point {
        self.member.body()
    }

    /// The round after `round` in which it ticks next, if there is one in this control period.
    pub fn next_after(&self, round: u32) -> Option<u32> {
        self.ticks.map(|ticks| ticks.max(round + 1))
    }

    /// What it has sent since it was asked last, and whether it may be answered at once.
    ///
    /// # Errors
    /// Never with numbers that a format can hold.
    pub fn letters(&mut self) -> Result<(Vec<Letter>, bool), postcard::Error> {
        let sent = self.outputs.sent();
        let asks = sent.iter().any(|envelope| envelope.message.may_be_answered_at_once());
        self.traffic.sent += sent.len() as u64;
        let LocalNode { outputs, sent, .. } = self;
        let letters =
            outputs.drain_sent().map(|envelope| sent.letter(envelope.to, &envelope.message));
        Ok((letters.collect::<Result<_, _>>()?, asks))
    }

    /// What it has told observers since it was asked last.
    pub fn events(&mut self) -> Vec<MissionEvent> {
        self.outputs.drain_reports().map(|(_, event)| event).collect()
    }

    /// Whether it knows that the mission has ended, and is at rest.
    pub fn is_over(&self) -> bool {
        let is_end = |notice: &Notice| matches!(notice, Notice::Ended { .. });
        match self.member.view() {
            MemberView::Robot(robot) => is_end(robot.notice()) && !robot.is_active(),
            MemberView::AccessPoint(access_point) => is_end(access_point.notice()),
            MemberView::User(user) => is_end(user.notice()),
            _ => false,
        }
    }

    /// What observers need to know of it, if it is a robot.
    pub fn robot_report(&self) -> Option<RobotReport> {
        let robot = self.member.view().robot()?;
        Some(RobotReport::of(robot, self.member.body(), self.traffic))
    }

    /// How the mission has ended, if it is the user and knows it.
    pub fn known_end(&self) -> Option<End> {
        self.member.view().user()?.known_end()
    }
}

impl LocalNodes {
    /// A robot of a scenario, which stands at `position`.
    pub fn robot(scenario: &ValidScenario, id: NodeId, position: Point) -> Self {
        let rate = scenario.robot[id].rate;
        let robot = Robot::new(id, position, rate, Arc::clone(scenario.site()));
        LocalNodes { nodes: vec![LocalNode::of(id, Member::Robot(Box::new(robot)))] }
    }

    /// Access points of a scenario; the user, who asks for its tasks, is with the first of them.
    ///
    /// # Errors
    /// When the user cannot say what there is to do.
    pub fn access_points(
        scenario: &ValidScenario,
        numbers: impl IntoIterator<Item = usize>,
    ) -> Result<Self, RobotError> {
        let site = scenario.site();
        let mut nodes = Vec::new();
        let mut has_user = false;
        for number in numbers {
            let access_point = AccessPoint::new(number, Arc::clone(site));
            nodes.push(LocalNode::of(
                site.robots + number,
                Member::AccessPoint(Box::new(access_point)),
            ));
            has_user |= number == 0;
        }
        if has_user {
            let user = Member::User(Box::new(User::new(Arc::clone(site))));
            let mut node = LocalNode::of(site.nodes(), user);
            node.step(Input::Sensed(Sense::Tasks(Arc::from(&*scenario.task))))?;
            nodes.push(node);
        }
        Ok(LocalNodes { nodes })
    }

    /// The numbers of the nodes, ascending.
    pub fn ids(&self) -> Vec<NodeId> {
        self.nodes.iter().map(|node| node.id).collect()
    }

    /// The nodes.
    pub fn nodes_mut(&mut self) -> &mut [LocalNode] {
        &mut self.nodes
    }

    /// A control period begins.
    pub fn begin_period(&mut self) {
        for node in &mut self.nodes {
            (node.ticked, node.traffic) = (0, Traffic::default());
            node.ask();
        }
    }

    /// A round of ticks: the clocks of those tick that are due by then.
    ///
    /// # Errors
    /// Why a node cannot go on.
    pub fn tick(&mut self, round: u32) -> Result<(), RobotError> {
        for node in &mut self.nodes {
            if node.ticks.is_some_and(|ticks| ticks <= round) {
                let passed = (round - node.ticked).saturating_sub(1) as usize;
                node.step(Input::Tick { passed })?;
                node.ticked = round;
                node.ask();
            }
        }
        Ok(())
    }

    /// Messages arrive.
    ///
    /// # Errors
    /// Why a node cannot go on.
    pub fn hear(&mut self, messages: &[(NodeId, NodeId, Message)]) -> Result<(), RobotError> {
        for (from, to, message) in messages {
            if let Some(node) = self.nodes.iter_mut().find(|node| node.id == *to) {
                node.traffic.heard += 1;
                node.step(Input::Heard { from: *from, message })?;
            }
        }
        self.nodes.iter_mut().for_each(LocalNode::ask);
        Ok(())
    }

    /// Time passes until the next control period begins; its duration is returned.
    ///
    /// # Errors
    /// What must hold while time passes, and does not.
    pub fn flow(&mut self) -> Result<f64, RobotError> {
        let waits = self.nodes.iter().filter_map(|node| node.member.time_to_tick());
        let duration = waits.reduce(f64::min).unwrap_or(0.0);
        if duration > 0.0 {
            for node in &mut self.nodes {
                node.member.flow(duration);
                node.member.check_invariant()?;
            }
        }
        Ok(duration)
    }
}
