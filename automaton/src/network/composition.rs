//! The network: N robots, their access points and the medium, composed.
//!
//! All components share the clock that samples control. At t_k a fixed sequence of joint jumps
//! takes no time: a few rounds of messages, between which each robot takes its own at-once
//! transitions; then routes; then moves, proposed and certified. Until t_{k+1} every robot flows
//! with ẋ = u, τ̇ = 1.
//!
//! The network passes messages on and never looks into a robot to tell another of it. What
//! observers see is put together in [`crate::network::observer`].

mod moves;
mod routes;

use std::sync::Arc;
use std::time::{Duration, Instant};

use pleach_continuous::Point;
use pleach_discrete::network::{MissionStep, NodeId, Phase, Role, RoleEvent};

use crate::automaton::Jump;
use crate::executor::{Round, System};

use super::access_point::AccessPoint;
use super::automata::{MissionAutomaton, RoleAutomaton, mission_automaton, role_automaton};
use super::beacon::{Beacon, Notice};
use super::medium::{Medium, Radio};
use super::record::{End, MissionEvent, Outcome};
use super::robot::Robot;
use super::scenario::{Scenario, ValidScenario};
use super::site::Site;

/// Where a control period stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Messages are exchanged.
    Exchange,
    /// Routes are computed.
    Route,
    /// Moves are proposed and certified.
    Move,
    /// Time passes.
    Flow,
}

/// A jump of the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NetworkJump {
    /// A new control period begins: τ = Δt, and τ becomes 0.
    Sample,
    /// One round of messages.
    Exchange,
    /// The routes of the period.
    Route,
    /// The moves of the period.
    Move,
    /// A robot changes its role.
    Role(Jump<Role, RoleEvent>),
    /// A robot takes a step of the mission.
    Mission(Jump<Phase, MissionStep>),
}

/// What went wrong inside the simulator.
#[derive(Debug, thiserror::Error)]
pub enum NetworkError {
    /// An automaton is not well formed.
    #[error(transparent)]
    Build(#[from] crate::BuildError),
    /// A guard speaks of something that robots do not measure.
    #[error(transparent)]
    Guard(#[from] crate::TransitionError),
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

/// The network of robots.
#[derive(Debug)]
pub struct Network<M = Radio> {
    pub(super) site: Arc<Site>,
    pub(super) robots: Vec<Robot>,
    pub(super) access_points: Vec<AccessPoint>,
    pub(super) step: usize,
    pub(super) events: Vec<MissionEvent>,
    medium: M,
    roles: RoleAutomaton,
    mission: MissionAutomaton,
    tasks: Vec<Point>,
    positions: Vec<Point>,
    /// What each node said in the current round.
    beacons: Vec<Arc<Beacon>>,
    /// The senders that each node hears in the current round, ascending.
    inboxes: Vec<Vec<NodeId>>,
    stage: Stage,
    rounds: usize,
    times: KernelTimes,
}

impl Network<Radio> {
    /// The network of a scenario at its start, with the synchronous medium.
    ///
    /// # Errors
    /// When an automaton is not well formed.
    pub fn new(scenario: &ValidScenario) -> Result<Self, NetworkError> {
        let site = Arc::clone(scenario.site());
        let medium = Radio::new(&site);
        Network::with_medium(scenario, site, medium)
    }
}

impl<M: Medium> Network<M> {
    /// The network of a scenario at its start, with a medium of one's own.
    ///
    /// # Errors
    /// When an automaton is not well formed.
    pub fn with_medium(
        scenario: &Scenario,
        site: Arc<Site>,
        medium: M,
    ) -> Result<Self, NetworkError> {
        let robots: Vec<Robot> = scenario
            .robot
            .iter()
            .enumerate()
            .map(|(id, start)| Robot::new(id, start.position.into(), start.rate, Arc::clone(&site)))
            .collect();
        let access_points: Vec<AccessPoint> = (0..site.access_points.len())
            .map(|number| AccessPoint::new(number, Arc::clone(&site)))
            .collect();
        let nodes = robots.len() + access_points.len();
        Ok(Network {
            step: 0,
            events: Vec::new(),
            roles: role_automaton()?,
            mission: mission_automaton()?,
            tasks: scenario.task.iter().map(|task| task.position.into()).collect(),
            positions: Vec::with_capacity(nodes),
            beacons: Vec::with_capacity(nodes),
            inboxes: vec![Vec::new(); nodes],
            stage: Stage::Flow,
            rounds: 0,
            times: KernelTimes::default(),
            site,
            robots,
            access_points,
            medium,
        })
    }

    /// What the robots know from the beginning.
    pub fn site(&self) -> &Site {
        &self.site
    }

    /// The robots, for observers.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// The medium.
    pub const fn medium(&self) -> &M {
        &self.medium
    }

    /// Time spent in each part so far.
    pub const fn times(&self) -> KernelTimes {
        self.times
    }

    /// k: the number of the current control period.
    pub const fn step(&self) -> usize {
        self.step
    }

    // ---- The joint jumps of a control period -------------------------------------------------

    fn begin_period(&mut self) {
        self.events.clear();
        for robot in &mut self.robots {
            robot.restart_clock();
        }
        self.positions.clear();
        self.positions.extend(self.robots.iter().map(Robot::position));
        self.positions.extend(self.access_points.iter().map(AccessPoint::position));
        self.medium.update(&self.positions);
        self.rounds = 0;
        self.stage = Stage::Exchange;
    }

    /// One round: every node repeats its public state to those that hear it.
    fn exchange_beacons(&mut self) {
        self.beacons.clear();
        self.beacons.extend(self.robots.iter_mut().map(Robot::speak));
        self.beacons.extend(self.access_points.iter_mut().map(AccessPoint::speak));
        for sender in 0..self.beacons.len() {
            for at in 0..self.medium.audience(sender).len() {
                let receiver = self.medium.audience(sender)[at];
                if self.medium.delivers(sender, receiver) {
                    self.inboxes[receiver].push(sender);
                }
            }
        }
        let (to_robots, to_access_points) = self.inboxes.split_at_mut(self.robots.len());
        for (robot, inbox) in self.robots.iter_mut().zip(to_robots) {
            robot.hear(inbox.drain(..).map(|sender| &self.beacons[sender]));
            robot.deliberate();
        }
        for (access_point, inbox) in self.access_points.iter_mut().zip(to_access_points) {
            access_point.hear(inbox.drain(..).map(|sender| &self.beacons[sender]));
        }
        if self.step > 0
            && let Some(first) = self.access_points.first_mut()
        {
            first.speak_for_user(&self.tasks);
        }
    }

    /// The robots that a message of `sender` reaches.
    fn audience_of(&mut self, sender: NodeId) -> Vec<NodeId> {
        let audience: Vec<NodeId> = self.medium.audience(sender).to_vec();
        audience
            .into_iter()
            .filter(|&receiver| {
                receiver < self.robots.len() && self.medium.delivers(sender, receiver)
            })
            .collect()
    }

    // ---- The robots' own jumps ---------------------------------------------------------------

    /// Every robot takes at most one of its own transitions; says whether any did.
    fn jump_alone(&mut self, round: &mut Round<'_, NetworkJump>) -> Result<bool, NetworkError> {
        let mut jumped = false;
        for (id, robot) in self.robots.iter_mut().enumerate() {
            if !robot.measure() {
                continue;
            }
            if let Some(jump) = robot.step_mission(&self.mission)? {
                round.jumped(id, NetworkJump::Mission(jump));
                jumped = true;
            } else if let Some(jump) = robot.step_role(&self.roles)? {
                let (from, to) = (jump.source, jump.target);
                self.events.push(MissionEvent::RoleChanged { robot: id, from, to });
                round.jumped(id, NetworkJump::Role(jump));
                jumped = true;
            }
            self.events.extend(robot.drain_log());
        }
        for access_point in &mut self.access_points {
            self.events.extend(access_point.drain_log());
        }
        Ok(jumped)
    }

    fn jump_together(&mut self) -> NetworkJump {
        let begin = Instant::now();
        match self.stage {
            Stage::Flow => {
                self.begin_period();
                self.times.coordination += begin.elapsed();
                NetworkJump::Sample
            }
            Stage::Exchange => {
                if self.rounds == 0 {
                    self.robots.iter_mut().for_each(Robot::begin_period);
                }
                self.exchange_beacons();
                self.rounds += 1;
                if self.has_exchanged_enough() {
                    self.stage = Stage::Route;
                }
                self.times.coordination += begin.elapsed();
                NetworkJump::Exchange
            }
            Stage::Route => {
                self.route();
                self.stage = Stage::Move;
                self.times.routing += begin.elapsed();
                NetworkJump::Route
            }
            Stage::Move => {
                self.negotiate();
                self.stage = Stage::Flow;
                NetworkJump::Move
            }
        }
    }

    /// A control period has a fixed number of rounds. Before the first one the robots are given as
    /// many as news can take to cross the network and come back, so that the tree stands when the
    /// clock starts.
    fn has_exchanged_enough(&self) -> bool {
        let there_and_back = 2 * (self.robots.len() + self.access_points.len());
        let in_a_period = self.site.settings.rounds_per_period;
        let enough = if self.step == 0 { in_a_period.max(there_and_back) } else { in_a_period };
        self.rounds >= enough
    }

    /// Whether the clocks call for the next sample.
    fn is_sample_due(&self) -> bool {
        self.robots.iter().all(|robot| robot.time_to_sample() <= 0.0)
    }

    /// How the mission has ended, as the first access point knows it.
    fn announced_end(&self) -> Option<End> {
        match self.access_points.first()?.notice() {
            Notice::Ended { outcome, reason, task } => {
                Some(End { outcome: *outcome, reason: reason.to_string(), task: *task })
            }
            _ => None,
        }
    }
}

impl<M: Medium> System for Network<M> {
    type Jump = NetworkJump;
    type Finish = End;
    type Error = NetworkError;

    fn finished(&self) -> Option<End> {
        if self.stage != Stage::Flow || !self.is_sample_due() || self.step == 0 {
            return None;
        }
        let limit = self.site.settings.max_steps;
        let at_rest = !self.robots.iter().any(Robot::is_active);
        self.announced_end().filter(|_| at_rest).or_else(|| {
            (self.step >= limit).then(|| End {
                outcome: Outcome::StepLimit,
                reason: format!("the mission has taken the {limit} control periods allowed"),
                task: None,
            })
        })
    }

    fn jump(&mut self, round: &mut Round<'_, NetworkJump>) -> Result<(), NetworkError> {
        let begin = Instant::now();
        let jumped = self.jump_alone(round)?;
        self.times.coordination += begin.elapsed();
        if !jumped && (self.stage != Stage::Flow || self.is_sample_due()) {
            let jump = self.jump_together();
            round.jumped_together(jump);
        }
        Ok(())
    }

    fn time_to_jump(&self) -> Result<Option<f64>, NetworkError> {
        Ok(self.robots.iter().map(Robot::time_to_sample).reduce(f64::min))
    }

    fn flow(&mut self, duration: f64) -> Result<(), NetworkError> {
        for robot in &mut self.robots {
            robot.flow(duration);
        }
        self.step += 1;
        Ok(())
    }
}
