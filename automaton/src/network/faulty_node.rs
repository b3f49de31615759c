//! Nodes that fail: they crash, restart, join late, and their positions and moves have errors.
//!
//! [`FaultyNode`] wraps a [`Member`] of an ensemble. It has the true position of the body; the node knows
//! what its localisation measures. Its faults are [`NodeFaults`]. Draws are those of a seed.

use std::sync::Arc;

use pleach_continuous::{Point, Vector};
use pleach_discrete::network::Stage;

use super::member::{Member, NodeOutputs, Sense};
use super::message::Message;
use super::record::MissionEvent;
use super::robot::RobotError;
use crate::chance::Chance;
use crate::node::{Input, Node, Observed};

/// The faults of one node. Times are in seconds from the beginning.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeFaults {
    /// When it joins. Its body stands at its start from the beginning, and nobody knows of it.
    pub joins: Option<f64>,
    /// When it stops.
    pub crash: Option<Crash>,
    /// By how much its clock is behind the others'.
    pub shift: f64,
    /// How far what it knows of its position may be off, in the scenario's unit.
    pub position_error: f64,
    /// How far from its end a move may end, in the scenario's unit.
    pub motion_error: f64,
}

/// A node stops. A robot then stands where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crash {
    /// When.
    pub time: f64,
    /// After this many inputs at that time: in the midst of the messages of a control period.
    pub inputs: u32,
    /// When it restarts, having forgotten everything but its number; none if it never does.
    pub back: Option<f64>,
}

/// How a node is made anew that has forgotten everything: from where its body stands.
pub(super) type Maker = Arc<dyn Fn(Point) -> Member + Send + Sync>;

/// A node with its faults.
#[derive(Clone)]
pub struct FaultyNode {
    member: Member,
    maker: Maker,
    faults: NodeFaults,
    chance: Chance,
    state: State,
    has_begun: bool,
    /// The true position.
    true_position: Point,
    time: f64,
    period: f64,
    inputs: u32,
    /// By how much the move that is under way ends elsewhere.
    disturbance: Option<Vector>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    /// It has not begun, or not begun again.
    Waiting(Wait),
    Running,
    /// It has stopped for good.
    Gone,
}

/// The wait of a node until it begins. It counts control periods as the others do: sums of periods are rounded, and
/// it has to begin at the very instant of their ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wait {
    /// When it begins, to less than half a control period.
    begin: f64,
    /// How long it is until its clock ticks next.
    to_tick: f64,
}

impl std::fmt::Debug for FaultyNode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FaultyNode")
            .field("member", &self.member)
            .field("state", &self.state)
            .field("place", &self.true_position)
            .finish_non_exhaustive()
    }
}

/// Times closer than this share of a control period are the same.
const SAME: f64 = 1e-9;

impl FaultyNode {
    /// The node that `maker` makes at `place`, with its faults; control periods take `period`
    /// seconds, and `seed` decides on errors.
    pub fn new(maker: Maker, place: Point, period: f64, faults: NodeFaults, seed: u64) -> Self {
        let begin = faults.joins.map(|time| on_grid(time, period)).unwrap_or(0.0) + faults.shift;
        FaultyNode {
            member: maker(place),
            maker,
            chance: Chance::new(seed, 0),
            state: match begin > 0.0 {
                true => State::Waiting(Wait { begin, to_tick: faults.shift.max(0.0) }),
                false => State::Running,
            },
            has_begun: begin <= 0.0,
            true_position: place,
            time: 0.0,
            period,
            inputs: 0,
            disturbance: None,
            faults,
        }
    }

    /// The node as it is now, or was when it stopped.
    pub const fn member(&self) -> &Member {
        &self.member
    }

    /// Whether it runs.
    pub fn is_running(&self) -> bool {
        self.state == State::Running
    }

    /// Whether it runs, or ran before it stopped: no other node knows of one that has not begun.
    pub const fn has_begun(&self) -> bool {
        self.has_begun
    }

    fn is_at(&self, time: f64) -> bool {
        self.time >= time - SAME * self.period
    }

    /// Stops the node if the time of its crash has come.
    fn crash_if_due(&mut self) {
        let Some(crash) = self.faults.crash.filter(|crash| self.is_at(crash.time)) else { return };
        if self.state != State::Running || self.inputs < crash.inputs {
            self.inputs += 1;
            return;
        }
        self.faults.crash = None;
        self.state = match crash.back {
            Some(back) => State::Waiting(Wait {
                begin: on_grid(back, self.period) + self.faults.shift,
                to_tick: self.member.time_to_tick().unwrap_or_default(),
            }),
            None => State::Gone,
        };
    }

    /// Begins if the time for that has come; otherwise a tick begins another control period.
    fn wait(&mut self, is_tick: bool) {
        let State::Waiting(Wait { begin, to_tick }) = &mut self.state else { return };
        if *to_tick <= 0.0 && self.time > *begin - self.period / 2.0 {
            self.begin();
        } else if is_tick {
            *to_tick = self.period;
        }
    }

    fn begin(&mut self) {
        (self.state, self.has_begun) = (State::Running, true);
        self.member = (self.maker)(self.true_position);
        self.disturbance = None;
    }

    fn is_exact(&self) -> bool {
        self.faults.position_error == 0.0 && self.faults.motion_error == 0.0
    }

    /// Somewhere in a disc of this radius.
    fn somewhere(&mut self, radius: f64) -> Vector {
        let (angle, share) = (std::f64::consts::TAU * self.chance.share(), self.chance.share());
        Vector::new(angle.cos(), angle.sin()) * (radius * share.sqrt())
    }

    /// What its localisation tells a robot that is about to take a sample.
    fn locate(&mut self) -> Option<Point> {
        let robot = self.member.view().robot()?;
        let is_due = self.member.time_to_tick() == Some(0.0);
        let is_sample = is_due && robot.stage() == Stage::Moving;
        if self.is_exact() || !is_sample {
            return None;
        }
        self.disturbance = None;
        let error = self.somewhere(self.faults.position_error);
        Some(self.true_position + error)
    }
}

/// The first instant from `time` on at which a control period begins.
fn on_grid(time: f64, period: f64) -> f64 {
    (time / period - SAME).ceil().max(0.0) * period
}

impl Node for FaultyNode {
    type Message = Message;
    type Sense = Sense;
    type Report = MissionEvent;
    type Body = Point;
    type Error = RobotError;

    fn step(
        &mut self,
        input: Input<'_, Message, Sense>,
        outputs: &mut NodeOutputs,
    ) -> Result<(), RobotError> {
        self.wait(matches!(input, Input::Tick { .. }));
        self.crash_if_due();
        if self.state != State::Running {
            return match input {
                // What a person asks of the user is not forgotten.
                Input::Sensed(Sense::Tasks(_)) => self.member.step(input, outputs),
                _ => Ok(()),
            };
        }
        if matches!(input, Input::Tick { .. })
            && let Some(position) = self.locate()
        {
            self.member.step(Input::Sensed(Sense::Fix(position)), outputs)?;
        }
        self.member.step(input, outputs)
    }

    fn time_to_tick(&self) -> Option<f64> {
        match self.state {
            State::Waiting(Wait { to_tick, .. }) => Some(to_tick),
            State::Running => self.member.time_to_tick(),
            State::Gone => None,
        }
    }

    fn flow(&mut self, duration: f64) {
        self.time += duration;
        match &mut self.state {
            State::Waiting(Wait { to_tick, .. }) => {
                *to_tick = (*to_tick - duration).max(0.0);
                return;
            }
            State::Gone => return,
            State::Running => {}
        }
        let before = self.member.body();
        self.member.flow(duration);
        let after = self.member.body();
        if self.is_exact() || self.member.view().robot().is_none() {
            self.true_position = after;
        } else if before != after {
            if self.disturbance.is_none() {
                self.disturbance = Some(self.somewhere(self.faults.motion_error));
            }
            let share = (duration / self.period).min(1.0);
            self.true_position +=
                (after - before) + self.disturbance.unwrap_or_else(Vector::zeros) * share;
        }
    }

    fn rounds_to_pass(&self) -> usize {
        if self.is_running() { self.member.rounds_to_pass() } else { 0 }
    }

    fn check_invariant(&self) -> Result<(), RobotError> {
        if self.is_running() { self.member.check_invariant() } else { Ok(()) }
    }

    fn body(&self) -> Point {
        self.true_position
    }
}
