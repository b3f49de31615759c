//! The robot as a node: what it does at each tick of its clock, and what it hears in between.
//!
//! A control period is a sequence of stages that takes no time. The robot counts its own rounds:
//! at a tick it makes something of what it has heard since the last one, and speaks. Then it waits
//! for what the others say, up to the next tick. When it has set off, its clock calls again at
//! τ = Δt.

use pleach_continuous::Point;
use pleach_discrete::network::NodeId;

use super::super::member::Sense;
use super::super::message::Message;
use super::super::record::MissionEvent;
use super::super::scenario::RoutingMethod;
use super::Robot;
use crate::automaton::TransitionError;
use crate::node::{Input, Node, Outputs};

/// Sweeps until the routes are feasible: with each, overloaded robots are relieved of what does
/// not come over the tree, and a tree that can carry the rates needs few.
const MAX_SWEEPS: usize = 6;
/// Rounds in which proposals are checked and halved; a mover that still meets an objection in the
/// one after them gives its move up.
const NEGOTIATION_ROUNDS: usize = 8;
/// More transitions than this at one instant are taken for endless; a mission has about ten
/// steps, and a robot takes a few of them at a time.
const MOST_JUMPS: usize = 32;

type Out = Outputs<Message, MissionEvent>;

/// Where a robot stands in its control period: what it waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The next sample, while it moves.
    Sample,
    /// Beacons, in this round.
    Beacons(usize),
    /// The flows of the period before over the links as they are now; for ADAL.
    OldFlows,
    /// Multipliers, in this iteration.
    Multipliers(usize),
    /// Flows, in this iteration.
    Flows(usize),
    /// The demands of its children in the tree, in this sweep.
    Demands(usize),
    /// The flows after this sweep.
    SweptFlows(usize),
    /// Whether somebody cannot pass on what it is sent after this sweep.
    Shortages(usize),
    /// The flows that were taken off overloaded robots after this sweep.
    Reliefs(usize),
    /// Nothing: it is about to propose a move.
    Move,
    /// Proposals, in this round.
    Proposals(usize),
    /// Objections, in this round.
    Objections(usize),
}

/// Why a robot cannot go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RobotError {
    /// A guard speaks of something that robots do not measure.
    #[error(transparent)]
    Guard(#[from] TransitionError),
    /// A robot jumps and jumps, and no time passes.
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

    fn step(
        &mut self,
        input: Input<'_, Message, Sense>,
        outputs: &mut Out,
    ) -> Result<(), RobotError> {
        match input {
            Input::Heard { from, message } => self.hear(from, message, outputs),
            Input::Sensed(Sense::Position(position)) => {
                self.find_itself_at(position);
                self.jump()?;
            }
            Input::Sensed(Sense::Tasks(_)) => {}
            Input::Tick => self.tick(outputs)?,
        }
        if !self.log.is_empty() {
            self.log.drain(..).for_each(|event| outputs.report(event));
        }
        Ok(())
    }

    fn time_to_tick(&self) -> Option<f64> {
        Some(match self.stage {
            Stage::Sample => self.time_to_sample(),
            _ => 0.0,
        })
    }

    /// Between jumps: ẋ = u, τ̇ = 1 (eq. 23), integrated exactly; at the sample the robot is where
    /// its certified move ends, to the last bit.
    fn flow(&mut self, duration: f64) {
        self.clock += duration;
        self.position = match self.time_to_sample() > 0.0 {
            true => self.position + self.velocity * duration,
            false => self.arrival,
        };
    }

    fn body(&self) -> Point {
        self.position
    }
}

impl Robot {
    /// The robot stands at `position`, and has not got on for `still_periods` control periods.
    pub(super) fn stand_at(&mut self, position: Point, still_periods: u32) {
        (self.position, self.arrival, self.resting_place) = (position, position, position);
        self.still_periods = still_periods;
        self.stir();
    }

    /// The robot finds that it stands at `position`, and how far its neighbours are from there.
    fn find_itself_at(&mut self, position: Point) {
        self.stand_at(position, 0);
        for known in &mut self.neighbours {
            *known = known.seen_from(position, &self.site);
        }
    }

    /// Time until the clock calls for the next sample.
    fn time_to_sample(&self) -> f64 {
        (self.site.settings.period - self.clock).max(0.0)
    }

    /// Most messages are beacons and multipliers, and say nothing new.
    #[inline]
    fn hear(&mut self, from: NodeId, message: &Message, outputs: &mut Out) {
        match message {
            Message::Beacon(beacon) => self.hear_beacon(beacon),
            Message::Multiplier { report, parent } => self.hear_multiplier(from, *report, *parent),
            _ => self.hear_of_routes_or_moves(from, message, outputs),
        }
    }

    #[inline(never)]
    fn hear_of_routes_or_moves(&mut self, from: NodeId, message: &Message, outputs: &mut Out) {
        match message {
            Message::Flow(flow) => self.hear_flow(from, *flow),
            Message::Demand(more) => self.hear_demand(from, *more, outputs),
            Message::Shortage => self.hear_shortage(from, outputs),
            Message::Proposal(segment) => self.hear_proposal(from, *segment),
            Message::Objection => self.yield_to_objection(),
            _ => {}
        }
    }

    /// The stages of a control period, in their order.
    #[inline(never)]
    fn tick(&mut self, outputs: &mut Out) -> Result<(), RobotError> {
        self.stage = match self.stage {
            Stage::Sample => {
                self.restart_clock();
                self.jump()?;
                self.begin_period()?;
                self.speak(outputs);
                Stage::Beacons(1)
            }
            Stage::Beacons(round) => {
                self.end_round();
                self.deliberate()?;
                self.jump()?;
                if round < self.rounds_of_this_period() {
                    self.speak(outputs);
                    Stage::Beacons(round + 1)
                } else {
                    self.begin_routes(outputs)
                }
            }
            Stage::OldFlows => {
                self.begin_routing();
                self.tell_multiplier(outputs);
                Stage::Multipliers(1)
            }
            Stage::Multipliers(iteration) => {
                self.primal_step();
                self.tell_flows(outputs);
                Stage::Flows(iteration)
            }
            Stage::Flows(iteration) => {
                self.dual_step();
                if iteration < self.site.settings.routing_iterations {
                    self.tell_multiplier(outputs);
                    Stage::Multipliers(iteration + 1)
                } else {
                    self.begin_sweep(outputs);
                    Stage::Demands(1)
                }
            }
            Stage::Demands(sweep) => {
                self.end_sweep();
                self.tell_flows(outputs);
                Stage::SweptFlows(sweep)
            }
            Stage::SweptFlows(sweep) => {
                self.settle_residual();
                if sweep < MAX_SWEEPS {
                    self.admit_shortage(outputs);
                    Stage::Shortages(sweep)
                } else {
                    self.end_routes();
                    Stage::Move
                }
            }
            Stage::Shortages(sweep) => {
                self.tell_flows(outputs);
                Stage::Reliefs(sweep)
            }
            Stage::Reliefs(sweep) => {
                self.sweep_again(outputs);
                Stage::Demands(sweep + 1)
            }
            Stage::Move => {
                self.propose();
                self.tell_proposal(outputs);
                Stage::Proposals(0)
            }
            Stage::Proposals(round) => {
                self.object(outputs);
                Stage::Objections(round)
            }
            Stage::Objections(round) if round < NEGOTIATION_ROUNDS => {
                self.tell_proposal(outputs);
                Stage::Proposals(round + 1)
            }
            Stage::Objections(_) => {
                self.set_off();
                self.jump()?;
                Stage::Sample
            }
        };
        Ok(())
    }

    /// Whether an objection that is heard now is the last.
    pub(super) const fn is_last_chance(&self) -> bool {
        matches!(
            self.stage,
            Stage::Proposals(NEGOTIATION_ROUNDS) | Stage::Objections(NEGOTIATION_ROUNDS)
        )
    }

    /// A control period has a fixed number of rounds. In the first one there are as many as news
    /// can take to cross the network and come back, so that the tree stands when the clock starts.
    fn rounds_of_this_period(&self) -> usize {
        let in_a_period = self.site.settings.rounds_per_period;
        if self.is_new { in_a_period.max(self.site.rounds_there_and_back()) } else { in_a_period }
    }

    /// The very same beacon as before is sent unless something in it has changed.
    fn speak(&mut self, outputs: &mut Out) {
        outputs.broadcast(Message::Beacon(self.next_beacon()));
    }

    fn begin_routes(&mut self, outputs: &mut Out) -> Stage {
        self.is_new = false;
        self.survey_links();
        if self.site.settings.routing_method == RoutingMethod::Adal {
            self.tell_flows(outputs);
            return Stage::OldFlows;
        }
        self.tell_multiplier(outputs);
        Stage::Multipliers(1)
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
        Err(RobotError::Zeno { robot: self.id })
    }
}
