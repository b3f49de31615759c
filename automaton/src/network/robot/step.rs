//! The robot as a node: what it does at each tick of its clock, and with each message in between.
//!
//! A control period is a sequence of stages that takes no time. The robot counts its own rounds: at
//! a tick it processes what it has received since the last one, and sends. Then it waits for the
//! messages of the others, up to the next tick. When it has set off, its next tick is at the next sample.

use pleach_continuous::Point;
use std::sync::Arc;

use pleach_discrete::network::{NodeId, Stage};

use super::Robot;
use super::context::context;
use crate::automaton::{InvariantError, TransitionError};
use crate::network::control::Control;
use crate::network::member::{NodeOutputs, Sense};
use crate::network::message::Message;
use crate::network::record::MissionEvent;
use crate::node::{Input, Node};

/// More transitions than this at one instant are taken for endless; a mission has about ten
/// steps, and a robot takes a few of them at a time.
const MOST_JUMPS: usize = 32;

/// A node of the network cannot go on. It is small, since every step may return one.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct RobotError(Box<RobotFault>);

impl RobotError {
    /// Why it cannot go on.
    pub fn fault(&self) -> &RobotFault {
        &self.0
    }
}

impl<F: Into<RobotFault>> From<F> for RobotError {
    fn from(fault: F) -> Self {
        RobotError(Box::new(fault.into()))
    }
}

/// Why a node of the network cannot go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RobotFault {
    /// A guard reads something that robots do not measure.
    #[error(transparent)]
    Guard(#[from] TransitionError),
    /// Time has passed although an invariant does not hold.
    #[error("node {node}: {source}")]
    Invariant {
        /// The node.
        node: NodeId,
        /// Its invariant.
        source: InvariantError,
    },
    /// A robot takes transitions without end at one instant.
    #[error("robot {robot} takes more than {MOST_JUMPS} transitions at one instant")]
    Zeno {
        /// Which.
        robot: usize,
    },
}

impl Node for Robot {
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
        match input {
            Input::Heard { from, message } => {
                self.hear(from, message, outputs);
                Ok(())
            }
            Input::Sensed(sensed) => self.sense(sensed, outputs),
            Input::Tick { passed } => self.tick(passed, outputs),
        }
    }

    fn time_to_tick(&self) -> Option<f64> {
        Some(match self.stage() {
            Stage::Moving => self.time_to_sample(),
            _ => 0.0,
        })
    }

    fn rounds_to_pass(&self) -> usize {
        Robot::rounds_to_pass(self)
    }

    /// By the flow of the stage.
    fn flow(&mut self, duration: f64) {
        let site = Arc::clone(&self.site);
        site.automata.control.flow_in_place::<Control>(self, duration);
    }

    fn check_invariant(&self) -> Result<(), RobotError> {
        let holds = self.site.automata.control.check_invariant(self.stage(), self);
        holds.map_err(|source| RobotFault::Invariant { node: self.id, source }.into())
    }

    fn body(&self) -> Point {
        self.body.position()
    }
}

impl Robot {
    fn sense(&mut self, sensed: Sense, outputs: &mut NodeOutputs) -> Result<(), RobotError> {
        match sensed {
            Sense::Position(position) => {
                self.find_itself_at(position);
                self.jump()?;
                self.tell_observers(outputs);
            }
            Sense::Fix(position) => self.correct_position(position),
            Sense::Bodies(places) => self.see_bodies(&places),
            Sense::Tasks(_) => {}
        }
        Ok(())
    }

    /// Tells observers what has happened.
    pub(super) fn tell_observers(&mut self, outputs: &mut NodeOutputs) {
        self.outbox.send_reports(outputs);
    }

    /// The robot stands at `position`, and has not got on for `still_periods` control periods.
    pub(super) fn stand_at(&mut self, position: Point, still_periods: u32) {
        self.body.stand_at(position, still_periods);
        self.note_change();
    }

    /// The robot finds that it stands at `position`, and how far its neighbours are from there.
    fn find_itself_at(&mut self, position: Point) {
        self.stand_at(position, 0);
        for known in self.neighbours.iter_mut() {
            *known = known.seen_from(position, &self.site);
        }
    }

    /// Where it stands in its control period.
    pub(super) fn stage(&self) -> Stage {
        self.schedule.stage()
    }

    /// Between jumps, by eq. (23).
    pub(super) fn advance(&mut self, duration: f64) {
        self.body.advance(duration, self.site.settings.period);
    }

    /// Time until the next sample is due.
    fn time_to_sample(&self) -> f64 {
        match self.schedule.is_behind() {
            true => 0.0,
            false => self.body.time_to_arrival(self.site.settings.period),
        }
    }

    /// Most messages are beacons without news.
    #[inline]
    fn hear(&mut self, from: NodeId, message: &Message, outputs: &mut NodeOutputs) {
        match message {
            Message::Beacon { period, roll, confirmed, beacon } => {
                self.hear_roll(roll);
                self.hear_beacon(*period, *confirmed, beacon);
            }
            _ => self.hear_of_flows_or_moves(from, message, outputs),
        }
    }

    /// Whether the plan of its routes can still change: what is received later does not change it.
    fn is_planning_routes(&self) -> bool {
        matches!(self.stage(), Stage::OldFlows | Stage::Iterations | Stage::Sweeps)
    }

    /// Of moves only what concerns this control period counts.
    #[inline(never)]
    fn hear_of_flows_or_moves(
        &mut self,
        from: NodeId,
        message: &Message,
        outputs: &mut NodeOutputs,
    ) {
        match message {
            Message::Multiplier { .. }
            | Message::Flow(_)
            | Message::Demand(_)
            | Message::Shortage
                if !self.is_planning_routes() => {}
            Message::Multiplier { report, parent } => {
                self.routing.receive_report(context!(self), from, *report, *parent);
            }
            Message::Flow(flow) => self.routing.receive_flow(from, *flow),
            Message::Demand(more) => {
                self.routing.receive_demand(context!(self), from, *more, outputs);
            }
            Message::Shortage => self.routing.receive_shortage(from, outputs),
            Message::AskFlow(request) => {
                self.reservation.receive_request(context!(self), from, *request);
            }
            Message::GrantFlow(grant) => {
                self.reservation.receive_grant(context!(self), from, *grant);
            }
            Message::Probe(probe) => {
                self.reservation.receive_probe(context!(self), from, probe, outputs);
            }
            Message::Proposal { period, .. }
            | Message::Objection { period }
            | Message::Consent { period }
                if *period != self.schedule.period() => {}
            Message::Proposal { segment, witness, .. } => {
                self.hear_proposal(from, *segment, *witness);
            }
            Message::Objection { .. } => self.yield_to_objection(),
            Message::Consent { .. } => self.negotiation.receive_consent(from),
            Message::Beacon { .. } | Message::Request(_) | Message::News(_) => {}
        }
    }

    /// The robot's own transitions, which are taken at once.
    pub(super) fn jump(&mut self) -> Result<(), RobotError> {
        for _ in 0..MOST_JUMPS {
            if !self.measure() {
                return Ok(());
            }
            if !self.jump_once()? {
                return Ok(());
            }
        }
        Err(RobotFault::Zeno { robot: self.id }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::scenario::Scenario;
    use super::super::super::site::Site;
    use super::*;
    use pleach_continuous::Vector;
    use pleach_continuous::geometry::HalfPlane;
    use pleach_continuous::network::acceptance::Segment;
    use pleach_continuous::network::motion::MotionProblem;
    use serde_json::json;

    /// The executor checks the invariant of the location in which time passes; a robot that leaves it
    /// is named.
    #[test]
    fn a_robot_that_leaves_the_region_of_its_motion_problem_ends_the_run() {
        let scenario: Scenario = serde_json::from_value(json!({
            "name": "one robot",
            "workspace": {"boundary": [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]},
            "link": {"full_range": 1.0, "max_range": 2.0},
            "access_point": [{"position": [1.0, 1.0]}],
            "robot": [{"position": [2.0, 2.0], "rate": 0.1}],
            "task": [{"position": [3.0, 3.0]}],
        }))
        .expect("it is a scenario");
        let site = Arc::new(Site::new(&scenario).expect("its numbers make sense"));
        let position = Point::new(2.0, 2.0);
        let mut robot = Robot::new(0, position, 0.1, site);
        let east = Vector::new(1.0, 0.0);
        let problem = MotionProblem {
            position,
            waypoint: position,
            half_planes: vec![HalfPlane::new(east, 2.05)],
            discs: Vec::new(),
        };
        let moves = Segment { from: position, to: position + 0.2 * east };
        robot.negotiation.propose(moves, problem);
        robot.body.restart_clock();
        robot.body.set_off(moves, 0.0, 1.0);
        Node::flow(&mut robot, 0.2);
        assert!(Node::check_invariant(&robot).is_ok());
        Node::flow(&mut robot, 0.2);
        let error = Node::check_invariant(&robot).expect_err("it is 0.03 outside").to_string();
        assert!(error.contains("node 0") && error.contains("outside"), "{error}");
    }
}
