//! What observers see of a mission: one snapshot a control period, and events between them.
//!
//! Nodes are numbered from 0: robots first, then access points.

use nalgebra::Point2;
use pleach_discrete::network::{Activity, ExchangeStage, Phase, Role};
use serde::{Deserialize, Serialize};

use super::certificate::Certificate;

/// The observers' view of one instant, just before the robots move.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// k: the number of the control period that begins here.
    pub step: usize,
    /// t_k in seconds.
    pub time: f64,
    /// x_i of every robot.
    pub positions: Vec<Point2<f64>>,
    /// The role of every robot.
    pub roles: Vec<Role>,
    /// Where the mission stands.
    pub phase: Phase,
    /// The robots that may move in this period, ascending.
    pub active: Vec<usize>,
    /// The active team 𝒜, in its own order (a subgroup of Σ or the primary team); others that
    /// may move are settling on their posts.
    pub active_team: Vec<usize>,
    /// The primary team 𝒫, from p₁ to the leader.
    pub primary_team: Vec<usize>,
    /// The path Σ while a secondary team is at work, from the recruit to p₁ (or the leader).
    pub path: Vec<usize>,
    /// c_i of every robot, eq. (5).
    pub residuals: Vec<f64>,
    /// λ_i of every robot.
    pub multipliers: Vec<f64>,
    /// The routes in use: only those with T_ij > 0.
    pub routes: Vec<Route>,
    /// Tree edges (child, parent), redundant robots included, by ascending child.
    pub tree: Vec<(usize, usize)>,
    /// The task being pursued.
    pub task: Option<usize>,
    /// The tasks serviced so far, each with the robot that is answerable for it now.
    pub serviced: Vec<(usize, usize)>,
    /// The tasks that are over, ascending, as far as robots know: they have ended, or been taken back. Empty in what
    /// is read from traces that lack them.
    pub closed: Vec<usize>,
    /// Fixed posts: reference position, the robot that holds it, and whether it is a junction.
    pub posts: Vec<PostView>,
    /// What else each robot shows of itself; empty in what is read from traces that lack it.
    pub robots: Vec<RobotSnapshot>,
    /// The robots and access points that do not run or are not heard, ascending. They are bodies,
    /// and nothing else of them is in the lists above but what each has one entry for every robot.
    pub absent: Vec<usize>,
    /// What there is one of for each fleet, by access point, where there are several; empty in the snapshot of one
    /// network. The lists above then hold those of all fleets, and phase and task are those of the first fleet whose
    /// mission goes on, or of the first.
    pub fleets: Vec<FleetView>,
}

/// A mission under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pursuit<'a> {
    /// The access point of the fleet, where there are several.
    pub access_point: Option<usize>,
    /// Where the mission stands.
    pub phase: Phase,
    /// The task being pursued.
    pub task: Option<usize>,
    /// The primary team, from p₁ to the leader.
    pub primary_team: &'a [usize],
}

impl<'a> Pursuit<'a> {
    fn of(fleet: &'a FleetView) -> Self {
        let FleetView { access_point, phase, task, ref primary_team, .. } = *fleet;
        Pursuit { access_point: Some(access_point), phase, task, primary_team }
    }
}

/// What there is one of for each fleet.
#[derive(Clone, Debug, PartialEq)]
pub struct FleetView {
    /// The access point to which its robots belong.
    pub access_point: usize,
    /// Where its mission stands.
    pub phase: Phase,
    /// The task that it pursues.
    pub task: Option<usize>,
    /// Its active team.
    pub active_team: Vec<usize>,
    /// Its primary team.
    pub primary_team: Vec<usize>,
    /// Its path Σ.
    pub path: Vec<usize>,
    /// The control period from whose beginning on its mission is over, if it is: its robots stand where they are.
    pub ended: Option<usize>,
}

impl Snapshot {
    /// The mission under way, or that of each fleet.
    pub fn pursuits(&self) -> Vec<Pursuit<'_>> {
        let (phase, task, primary_team) = (self.phase, self.task, &*self.primary_team);
        match self.fleets.is_empty() {
            true => vec![Pursuit { access_point: None, phase, task, primary_team }],
            false => self.fleets.iter().map(Pursuit::of).collect(),
        }
    }

    /// The same, where these nodes do not run or are not heard.
    #[must_use]
    pub fn without(mut self, absent: Vec<usize>) -> Self {
        let is_there = |node: &usize| absent.binary_search(node).is_err();
        self.routes.retain(|route| is_there(&route.from) && is_there(&route.to));
        self.tree.retain(|(child, parent)| is_there(child) && is_there(parent));
        self.posts.retain(|post| is_there(&post.holder));
        self.serviced.retain(|(_, robot)| is_there(robot));
        for team in
            [&mut self.active, &mut self.active_team, &mut self.primary_team, &mut self.path]
        {
            team.retain(is_there);
        }
        self.absent = absent;
        self
    }
}

/// What fails in a mission, as far as that decides on what must hold in it. Errors of position and
/// motion are settings of its scenario.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Faults {
    /// Messages are lost, late or doubled.
    pub messages: bool,
    /// Nodes stop, restart or join late.
    pub nodes: bool,
}

impl Faults {
    /// Whether nothing fails.
    pub const fn are_none(&self) -> bool {
        !self.messages && !self.nodes
    }
}

/// Where a robot is in its automata, where it goes, and how much it sends and receives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotSnapshot {
    /// Its location in the duty automaton.
    pub activity: Activity,
    /// Its location in the automaton of the exchange of duties.
    pub exchange: ExchangeStage,
    /// Where the mission stands as far as it knows.
    pub phase: Phase,
    /// Where it goes; none if it stands still.
    pub target: Option<Point2<f64>>,
    /// The messages that it has sent in this control period.
    pub sent: u64,
    /// The messages that it has heard in this control period.
    pub heard: u64,
}

/// A route in use, from robot `from` to node `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Route {
    /// The sending robot.
    pub from: usize,
    /// The receiving robot or access point.
    pub to: usize,
    /// T_ij: the share of time.
    pub share: f64,
    /// R_ij: the reliability of the link.
    pub reliability: f64,
}

/// A fixed post of the tree as an observer sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PostView {
    /// Where the post is.
    pub reference: Point2<f64>,
    /// The robot that holds it.
    pub holder: usize,
    /// The task serviced from it.
    pub task: Option<usize>,
    /// Whether branches part here.
    pub junction: bool,
}

/// Something that happened, with the identities it concerns.
///
/// Written out, as in traces, it is a table whose `event` is the name of the variant in snake
/// case, with the fields beside it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
#[allow(missing_docs)] // the fields are identities: robots, tasks, nodes
#[non_exhaustive]
pub enum MissionEvent {
    /// A user announced a task.
    TaskAnnounced { task: usize },
    /// A leader is elected (Algorithm 1); with a conflict, it has past duties (L_b = 1).
    LeaderElected { task: usize, robot: usize, conflict: bool },
    /// The primary team is at a local stationary point; `robot` is p₁. The team is that at the end of the control
    /// period: empty if it has been dissolved by then.
    Stationary { robot: usize, team: Vec<usize> },
    /// The way to the task is longer than the primary team: p₁ `robot` calls for a recruit before the team
    /// stands still.
    RecruitCalled { robot: usize },
    /// No robot could come when p₁ `robot` called for one ahead of a standstill: the primary team goes on alone.
    CalledInVain { robot: usize },
    /// No robot is left that can be recruited: the primary team of p₁ `robot` stretches its links up to the
    /// longest that the tree allows.
    LinksStretched { robot: usize },
    /// A recruit is elected (Remark 5.4), with the path Σ and the break points 𝓑.
    RecruitElected { robot: usize, path: Vec<usize>, break_points: Vec<usize> },
    /// Subgroup S_β starts to move.
    SubgroupStarted { subgroup: usize, robots: Vec<usize> },
    /// Every member of S_β has arrived, eq. (26).
    SubgroupArrived { subgroup: usize, robots: Vec<usize> },
    /// A robot joins the primary team, which is this at the end of the control period: empty if it has been
    /// dissolved by then.
    JoinedPrimary { robot: usize, team: Vec<usize> },
    /// The leader is released from its past duties.
    Released { robot: usize },
    /// A robot changes its role.
    RoleChanged { robot: usize, from: Role, to: Role },
    /// A task is serviced, eq. (2).
    TaskServiced { task: usize, robot: usize },
    /// From now on no routing carries the rates: the residual of `robot` has fallen below −c_min.
    RouteInfeasible { robot: usize },
    /// A mover and the robot in its way exchange duties.
    DutiesExchanged { mover: usize, parked: usize },
    /// p₁ attaches to another node of the tree (Remark 5.6).
    Reattached { robot: usize, parent: usize },
    /// No recruit can come: the election is repeated among the robots of other trees, or among those whose posts can move.
    ElectionRepeated { task: usize },
    /// Robots are gone that take part in the elections for the task, or serviced it, or others have joined
    /// since and those before have given up: it is announced again to those that take part now.
    TaskReannounced {
        task: usize,
        gone: Vec<usize>,
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        joined: Vec<usize>,
    },
    /// A task has been serviced for as long as it was to be: its robot is free.
    TaskEnded { task: usize },
    /// The user has taken a task back: the robots that service or pursue it are free.
    TaskWithdrawn { task: usize },
    /// No robot can service a task: it is given up, its team is dissolved, and the mission goes on with the others.
    /// The certificate is the observers' account of why.
    TaskGivenUp {
        task: usize,
        outcome: Outcome,
        reason: String,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        certificate: Option<Box<Certificate>>,
    },
}

/// How a mission ended.
#[derive(Clone, Debug, PartialEq)]
pub struct End {
    /// The kind of end.
    pub outcome: Outcome,
    /// The reason, as a sentence for people.
    pub reason: String,
    /// The task concerned.
    pub task: Option<usize>,
    /// The tasks that were given up while the mission went on, ascending.
    pub tasks: Vec<usize>,
    /// What observers add to show that it had to end so, where a mission ends before its tasks are serviced.
    pub certificate: Option<Certificate>,
    /// How the mission of each fleet ended, by access point, where there are several.
    pub fleets: Vec<FleetEnd>,
}

/// How the mission of a fleet ended.
#[derive(Clone, Debug, PartialEq)]
pub struct FleetEnd {
    /// The access point to which its robots belong.
    pub access_point: usize,
    /// How it ended.
    pub end: End,
}

impl End {
    /// An end without a certificate.
    pub const fn new(outcome: Outcome, reason: String, task: Option<usize>) -> Self {
        End { outcome, reason, task, tasks: Vec::new(), certificate: None, fleets: Vec::new() }
    }

    /// Whether the mission ended as no task was left, after some had been given up.
    pub fn is_of_given_up_tasks(&self) -> bool {
        let is_given_up = |task| self.tasks.contains(&task);
        !self.tasks.is_empty() && self.task.is_none_or(is_given_up)
    }

    /// The end of a mission that has taken as many control periods as it may.
    pub fn at_step_limit(limit: usize) -> Self {
        let reason = format!("the mission has taken the {limit} control periods allowed");
        End::new(Outcome::StepLimit, reason, None)
    }
}

/// The kinds of end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Outcome {
    /// Every task is serviced.
    Serviced,
    /// No recruit is left (Assumption 1 does not hold).
    InsufficientRobots,
    /// No robot can come within δ of the task.
    UnreachableTask,
    /// The mission took more control periods than allowed.
    StepLimit,
    /// The robots cannot go on, and a recruit would not help.
    Blocked,
    /// A monitored property failed.
    InvariantViolated,
    /// A person or program ended it.
    Interrupted,
}

impl Outcome {
    /// Whether robots gave up: such an end comes with a [`Certificate`], or each task that was given up does.
    pub const fn is_given_up(self) -> bool {
        matches!(self, Outcome::InsufficientRobots | Outcome::UnreachableTask | Outcome::Blocked)
    }

    /// The name used in traces.
    pub const fn name(self) -> &'static str {
        match self {
            Outcome::Serviced => "serviced",
            Outcome::InsufficientRobots => "insufficient_robots",
            Outcome::UnreachableTask => "unreachable_task",
            Outcome::StepLimit => "step_limit",
            Outcome::Blocked => "blocked",
            Outcome::InvariantViolated => "invariant_violated",
            Outcome::Interrupted => "interrupted",
        }
    }
}
