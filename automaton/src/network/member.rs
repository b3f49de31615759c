//! The nodes of the network: robots, access points and the user.

use std::sync::Arc;

use pleach_continuous::Point;

use super::access_point::AccessPoint;
use super::message::Message;
use super::record::MissionEvent;
use super::robot::{Robot, RobotError, RobotView};
use super::scenario::Task;
use super::user::User;
use crate::node::{Input, Node, Observed, Outputs};

/// A node of the network.
#[derive(Clone, Debug)]
pub enum Member {
    /// A robot.
    Robot(Box<Robot>),
    /// An access point.
    AccessPoint(Box<AccessPoint>),
    /// The user.
    User(Box<User>),
}

/// What a node measures, or is requested to do.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Sense {
    /// The position of a robot, as it measures it.
    Position(Point),
    /// At a sample, the position of a robot as its localisation measures it.
    Fix(Point),
    /// At a sample, where the robots of other fleets are that are in range of the radio.
    Bodies(Arc<[Point]>),
    /// The tasks that a person wants, in order of announcement.
    Tasks(Arc<[Task]>),
}

/// What a node of the network sends and reports in its steps.
pub(super) type NodeOutputs = Outputs<Message, MissionEvent>;

/// A node as observers see it.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum MemberView<'a> {
    /// A robot.
    Robot(RobotView<'a>),
    /// An access point.
    AccessPoint(&'a AccessPoint),
    /// The user.
    User(&'a User),
}

impl<'a> MemberView<'a> {
    /// The robot, if it is one.
    pub const fn robot(self) -> Option<RobotView<'a>> {
        match self {
            MemberView::Robot(robot) => Some(robot),
            _ => None,
        }
    }

    /// The user, if it is one.
    pub const fn user(self) -> Option<&'a User> {
        match self {
            MemberView::User(user) => Some(user),
            _ => None,
        }
    }
}

impl Node for Member {
    type Message = Message;
    type Sense = Sense;
    type Report = MissionEvent;
    type Body = Point;
    type Error = RobotError;

    #[inline]
    fn step(
        &mut self,
        input: Input<'_, Message, Sense>,
        outputs: &mut NodeOutputs,
    ) -> Result<(), RobotError> {
        match self {
            Member::Robot(robot) => robot.step(input, outputs),
            Member::AccessPoint(access_point) => access_point.step(input, outputs),
            Member::User(user) => user.step(input, outputs),
        }
    }

    fn time_to_tick(&self) -> Option<f64> {
        match self {
            Member::Robot(robot) => robot.time_to_tick(),
            Member::AccessPoint(access_point) => access_point.time_to_tick(),
            Member::User(user) => user.time_to_tick(),
        }
    }

    fn rounds_to_pass(&self) -> usize {
        match self {
            Member::Robot(robot) => robot.rounds_to_pass(),
            Member::AccessPoint(_) | Member::User(_) => 0,
        }
    }

    fn flow(&mut self, duration: f64) {
        match self {
            Member::Robot(robot) => robot.flow(duration),
            Member::AccessPoint(access_point) => access_point.flow(duration),
            Member::User(user) => user.flow(duration),
        }
    }

    fn check_invariant(&self) -> Result<(), RobotError> {
        match self {
            Member::Robot(robot) => robot.check_invariant(),
            Member::AccessPoint(access_point) => access_point.check_invariant(),
            Member::User(user) => user.check_invariant(),
        }
    }

    fn body(&self) -> Point {
        match self {
            Member::Robot(robot) => robot.body(),
            Member::AccessPoint(access_point) => access_point.body(),
            Member::User(user) => user.body(),
        }
    }
}

impl Observed for Member {
    type View<'a> = MemberView<'a>;

    fn view(&self) -> MemberView<'_> {
        match self {
            Member::Robot(robot) => MemberView::Robot(robot.view()),
            Member::AccessPoint(access_point) => MemberView::AccessPoint(access_point),
            Member::User(user) => MemberView::User(user),
        }
    }
}
