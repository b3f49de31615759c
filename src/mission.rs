//! A mission from its start to its end, and those who watch it.
//!
//! [`run`] hands the network of a scenario, or those of its fleets, to the executor. Every control period it takes the
//! observers' view of the network, holds it against the properties of [`crate::verify`], and
//! shows it to the [`Watcher`]s: the trace writer, the progress display, the summary, the
//! figures. None of them can influence the robots; a violated property ends the run, and so does
//! a watcher that asks for it.
//!
//! # A room
//!
//! A [`Scenario`](crate::automaton::network::scenario::Scenario) is plain data. A
//! [`ValidScenario`] is one from which a mission can
//! start: read from a file by [`scenario_file::read`](crate::scenario_file::read), or built as here. This is a room of 1.2 by 0.6
//! with an access point at the left and a task at the right, farther away than one link reaches.
//!
//! ```
//! use pleach::automaton::network::scenario::{
//!     AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Task, ValidScenario,
//!     WorkspaceOutline,
//! };
//!
//! let robot = |x, y| RobotStart::at([x, y], 0.075);
//! let scenario = ValidScenario::new(Scenario {
//!     name: "room".into(),
//!     description: None,
//!     workspace: WorkspaceOutline {
//!         boundary: vec![[0.0, 0.0], [1.2, 0.0], [1.2, 0.6], [0.0, 0.6]],
//!         holes: vec![],
//!     },
//!     link: LinkRanges::new(0.4, 0.5),
//!     control: Control::default(),
//!     mission: Agenda::default(),
//!     access_point: vec![AccessPoint { position: [0.1, 0.3] }],
//!     robot: vec![robot(0.1, 0.1), robot(0.25, 0.2), robot(0.1, 0.5)],
//!     task: vec![Task::at([0.9, 0.3])],
//! })?;
//! assert!(scenario.remarks().is_empty()); // every task can be reached, and no link crosses a wall
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`run`] runs the mission to its end. [`Watcher`]s see every control
//! period; the [`Summary`](crate::summary::Summary) that the program prints is one of them.
//!
//! ```
//! # use pleach::automaton::network::scenario::{
//! #     AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Task, ValidScenario,
//! #     WorkspaceOutline,
//! # };
//! # let robot = |x, y| RobotStart::at([x, y], 0.075);
//! # let scenario = ValidScenario::new(Scenario {
//! #     name: "room".into(),
//! #     description: None,
//! #     workspace: WorkspaceOutline {
//! #         boundary: vec![[0.0, 0.0], [1.2, 0.0], [1.2, 0.6], [0.0, 0.6]],
//! #         holes: vec![],
//! #     },
//! #     link: LinkRanges::new(0.4, 0.5),
//! #     control: Control::default(),
//! #     mission: Agenda::default(),
//! #     access_point: vec![AccessPoint { position: [0.1, 0.3] }],
//! #     robot: vec![robot(0.1, 0.1), robot(0.25, 0.2), robot(0.1, 0.5)],
//! #     task: vec![Task::at([0.9, 0.3])],
//! # })?;
//! use pleach::automaton::network::record::Outcome;
//! use pleach::summary::Summary;
//!
//! let mut summary = Summary::new(&scenario);
//! let completed = pleach::mission::run(&scenario, &mut [&mut summary])?;
//!
//! assert_eq!(completed.end.outcome, Outcome::Serviced);
//! assert_eq!(summary.recruits(), 1); // one relay between the access point and the leader
//!
//! // The monitor has checked every instant of the mission against the properties in `verify`.
//! let closest = completed.extremes.pair_distance.ok_or("there are three robots")?;
//! assert!(closest.value >= 2.0 * 0.01); // 2ρ, where ρ is l/40 by default
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The README has a custom watcher of a few lines. A custom medium, for example one that delays
//! messages within a control period, goes into the network that [`run_network`] runs; for
//! one that loses messages there is [`run_network_with_faults`].
//!
//! # An automaton
//!
//! The discrete behaviour of a robot is a few automata over its state. They are values too: the
//! tables that are run can also be queried and drawn.
//!
//! ```
//! use pleach::automaton::{diagram, network::Automata};
//! use pleach::discrete::network::{Activity, DutyEvent};
//!
//! let automaton = Automata::new()?.duty;
//! let duties = automaton.table();
//! assert_eq!(duties.next(Activity::Standby, DutyEvent::Elected), Ok(Activity::Leading));
//! // A leaf services a task: it leaves only when another robot has taken its place.
//! assert!(duties.next(Activity::Leaf, DutyEvent::Retired).is_err());
//! assert!(diagram::mermaid(&automaton).starts_with("stateDiagram-v2"));
//! # Ok::<(), pleach::automaton::BuildError>(())
//! ```
//!
//! # Where to read on
//!
//! | layer | holds, of the network |
//! | --- | --- |
//! | [`discrete::network`](crate::discrete::network) | roles, elections, posts, agreements |
//! | [`continuous`](crate::continuous) | [geometry](crate::continuous::geometry); [links, routing, motion, certified acceptance](crate::continuous::network) |
//! | [`automaton::network`](crate::automaton::network) | robots, medium, composition |
//! | [`verify::network`](crate::verify::network) | the properties, each stated once, and their monitor |
//! | this crate | [scenario files](crate::scenario_file), missions, [traces](crate::trace), [summaries](crate::summary), [stories](crate::story), [figures](crate::figures), [pages](crate::page) |
//!
//! `docs/model.md` in the repository leads from each equation and algorithm of the paper to the item
//! that implements it.

use std::collections::BTreeMap;
use std::io;
use std::ops::ControlFlow;

use thiserror::Error;

use crate::automaton::network::certificate::{Bound, Certificate, Hindrance, Standing};
use crate::automaton::network::phrase;
use crate::automaton::network::record::{End, Faults, FleetEnd, MissionEvent, Outcome, Snapshot};
use crate::automaton::network::scenario::{Fleet, ValidScenario};
use crate::automaton::network::{
    Fleets, KernelTimes, Message, Network, NetworkError, RobotNode, SATURATED,
};
use crate::automaton::node::Medium;
use crate::automaton::{Executor, HybridTime, InvalidLimit, Observer, Reason, System};
use crate::continuous::Point;
use crate::discrete::network::activity::may_follow;
use crate::verify::network::storm::{self, Storm};
use crate::verify::network::{Extremes, Referee, Violation};

/// Something that watches a mission.
pub trait Watcher {
    /// The robots are about to move; `events` is what has happened in this control period.
    ///
    /// # Errors
    /// The watcher cannot write what it has to.
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()>;

    /// Why the mission is to end now, if it is: asked after each period has been observed. The
    /// mission then ends in order, with the outcome [`Outcome::Interrupted`] and this reason.
    fn interruption(&self) -> Option<String> {
        None
    }

    /// The mission has ended.
    ///
    /// # Errors
    /// The watcher cannot write what it has to.
    fn end(&mut self, _: &End) -> io::Result<()> {
        Ok(())
    }
}

/// Why a mission could not be run to an end.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MissionError {
    /// The network cannot be set up, or a guard cannot be evaluated.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// The settings leave no time for the mission.
    #[error(transparent)]
    Limit(#[from] InvalidLimit),
    /// The network came to a state in which it could not go on.
    #[error("internal error: the executor stopped at t = {time} s: {reason}")]
    Stopped {
        /// t in seconds.
        time: f64,
        /// How the executor names it.
        reason: String,
    },
    /// Nodes whose clocks are behind where each access point has a team of its own.
    #[error(
        "where control.teams is \"per_access_point\", the clocks of all nodes tick together: run the mission \
         without shifted clocks, or with one team"
    )]
    ShiftedClocksOfFleets,
    /// A watcher cannot write what it has to.
    #[error("cannot write: {0}")]
    Watcher(#[from] io::Error),
}

/// A mission that has ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Completed {
    /// How it ended.
    pub end: End,
    /// How near it came to its bounds.
    pub extremes: Extremes,
    /// Time spent in the parts of the control periods.
    pub times: KernelTimes,
}

/// Runs the mission of `scenario` to its end.
///
/// # Errors
/// When a watcher fails, a node cannot go on, or the settings leave no time for the mission.
pub fn run(
    scenario: &ValidScenario,
    watchers: &mut [&mut dyn Watcher],
) -> Result<Completed, MissionError> {
    match scenario.fleets().is_empty() {
        true => run_network(scenario, &mut Network::new(scenario)?, watchers),
        false => run_fleets(scenario, &mut Fleets::new(scenario)?, watchers),
    }
}

/// Runs `fleets`, which are those of `scenario` over any media, until the missions of all have ended.
///
/// # Errors
/// When a watcher fails, a node cannot go on, or the settings leave no time for the mission.
pub fn run_fleets<M: Medium<Message, Point>, N: RobotNode>(
    scenario: &ValidScenario,
    fleets: &mut Fleets<M, N>,
    watchers: &mut [&mut dyn Watcher],
) -> Result<Completed, MissionError> {
    carry_out(scenario, Faults::default(), fleets, watchers)
}

/// Runs `network`, which is the network of `scenario` over any medium, to its end.
///
/// # Errors
/// When a watcher fails, a node cannot go on, or the settings leave no time for the mission.
pub fn run_network<M: Medium<Message, Point>, N: RobotNode>(
    scenario: &ValidScenario,
    network: &mut Network<M, N>,
    watchers: &mut [&mut dyn Watcher],
) -> Result<Completed, MissionError> {
    run_network_with_faults(scenario, Faults::default(), network, watchers)
}

/// The same for a network in which these faults occur. It is held against what must hold under any fault.
///
/// # Errors
/// When a watcher fails, a node cannot go on, or the settings leave no time for the mission.
pub fn run_network_with_faults<M: Medium<Message, Point>, N: RobotNode>(
    scenario: &ValidScenario,
    faults: Faults,
    network: &mut Network<M, N>,
    watchers: &mut [&mut dyn Watcher],
) -> Result<Completed, MissionError> {
    carry_out(scenario, faults, network, watchers)
}

/// What is run as a mission: a network, or those of several fleets.
trait Runnable: System<Finish = End, Error = NetworkError> {
    /// What observers see at this instant, if there is anything to be seen, and what has happened in this control
    /// period.
    fn seen(&self) -> Option<(Snapshot, Vec<MissionEvent>)>;

    /// How it has ended if a watcher has ended it so.
    fn interrupted(&self, end: End) -> End;

    /// Time spent in each part so far.
    fn times(&self) -> KernelTimes;
}

impl<M: Medium<Message, Point>, N: RobotNode> Runnable for Network<M, N> {
    fn seen(&self) -> Option<(Snapshot, Vec<MissionEvent>)> {
        Some((self.snapshot(), self.events()))
    }

    fn interrupted(&self, end: End) -> End {
        end
    }

    fn times(&self) -> KernelTimes {
        self.times()
    }
}

impl<M: Medium<Message, Point>, N: RobotNode> Runnable for Fleets<M, N> {
    fn seen(&self) -> Option<(Snapshot, Vec<MissionEvent>)> {
        Some((self.snapshot()?, self.events()))
    }

    fn interrupted(&self, end: End) -> End {
        self.end(&end)
    }

    fn times(&self) -> KernelTimes {
        self.times()
    }
}

/// Runs what these faults occur in, while the judge and the watchers look on.
fn carry_out<S: Runnable>(
    scenario: &ValidScenario,
    faults: Faults,
    system: &mut S,
    watchers: &mut [&mut dyn Watcher],
) -> Result<Completed, MissionError> {
    let mut gallery = Gallery::with_faults(scenario, faults, watchers);
    let settings = scenario.settings();
    let horizon = settings.period * (settings.max_steps as f64 + 1.0);
    let ending = Executor::new(horizon, JUMPS_PER_PERIOD)?.run(system, &mut gallery)?;
    let end = match ending.reason {
        Reason::Finished(end) | Reason::Interrupted(end) => end,
        other => {
            return Err(MissionError::Stopped { time: ending.at.t, reason: format!("{other:?}") });
        }
    };
    let end = match end.outcome {
        Outcome::Interrupted => system.interrupted(end),
        _ => end,
    };
    Ok(Completed { times: system.times(), ..gallery.conclude(end)? })
}

/// Runs the mission of `scenario` in a storm. It is held against what must hold under any fault. Where each access point
/// has a team of its own, messages and nodes fail within each fleet; where the robots of other fleets are, is always
/// known.
///
/// # Errors
/// As for [`run`], and when clocks are shifted where there are several teams.
pub fn run_in_storm(
    scenario: &ValidScenario,
    storm: &Storm,
    watchers: &mut [&mut dyn Watcher],
) -> Result<Completed, MissionError> {
    if !scenario.fleets().is_empty() {
        if storm.shifts_clocks() {
            return Err(MissionError::ShiftedClocksOfFleets);
        }
        let mut fleets = Fleets::of_networks(scenario, |fleet| {
            storm::network(fleet.scenario(), &storm.of_fleet(fleet))
        })?;
        return carry_out(scenario, storm.faults(), &mut fleets, watchers);
    }
    let mut network = storm::network(scenario, storm)?;
    run_network_with_faults(scenario, storm.faults(), &mut network, watchers)
}

/// Far more rounds of jumps than the messages of a control period ever take: only a cycle of
/// transitions that consumes no time can reach it.
const JUMPS_PER_PERIOD: u32 = 1_000_000;

/// The end of a mission that its record contradicts; one that was stopped for a violation says so.
fn stopped(violation: &Violation, end: &End) -> End {
    match end.outcome {
        Outcome::InvariantViolated => end.clone(),
        _ => End::new(Outcome::InvariantViolated, violation.to_string(), end.task),
    }
}

/// The judge and the watchers of a mission: they look on while the executor runs it, or while it goes
/// on elsewhere and its snapshots come from there.
pub struct Gallery<'a, 'w> {
    scenario: ValidScenario,
    judge: Referee<'a>,
    watchers: &'a mut [&'w mut dyn Watcher],
    failure: Option<io::Error>,
    /// The robots that send nearly all the time in the last period, with their loads.
    saturated: Vec<(usize, f64)>,
    /// The tasks that were given up, each with the reason.
    given_up: BTreeMap<usize, String>,
}

/// The robots that send nearly all the time, each with its load Σ_j T_ij.
fn saturated(snapshot: &Snapshot) -> Vec<(usize, f64)> {
    let mut loads = vec![0.0; snapshot.positions.len()];
    for route in &snapshot.routes {
        if let Some(load) = loads.get_mut(route.from) {
            *load += route.share;
        }
    }
    loads.into_iter().enumerate().filter(|&(_, load)| load >= SATURATED).collect()
}

impl<'a, 'w> Gallery<'a, 'w> {
    /// Those who watch a mission of `scenario` from its beginning.
    pub fn new(scenario: &ValidScenario, watchers: &'a mut [&'w mut dyn Watcher]) -> Self {
        Gallery::with_faults(scenario, Faults::default(), watchers)
    }

    /// The same for a mission in which these faults occur.
    pub fn with_faults(
        scenario: &ValidScenario,
        faults: Faults,
        watchers: &'a mut [&'w mut dyn Watcher],
    ) -> Self {
        let judge = Referee::new(scenario, faults, may_follow);
        let scenario = scenario.clone();
        Gallery {
            scenario,
            judge,
            watchers,
            failure: None,
            saturated: Vec::new(),
            given_up: BTreeMap::new(),
        }
    }

    /// Shows a control period, and says how the mission ends if it has to: a property is violated, a
    /// watcher asks for it, or one of them fails.
    pub fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> Option<End> {
        let events = &self.explain_events(snapshot, events)[..];
        if let Err(error) = self.show(snapshot, events) {
            let reason = error.to_string();
            self.failure = Some(error);
            return Some(End::new(Outcome::Blocked, reason, None));
        }
        self.saturated = saturated(snapshot);
        let end = self.check(snapshot, events);
        end.or_else(|| self.interruption(snapshot.task))
    }

    /// The mission has ended so: tells the watchers. Times are those of nothing.
    ///
    /// # Errors
    /// When a watcher has failed.
    pub fn conclude(self, end: End) -> Result<Completed, MissionError> {
        if let Some(error) = self.failure {
            return Err(error.into());
        }
        let end = self.explain(end);
        let judged = self.judge.conclude(&end);
        let end = judged.map_or_else(|violation| stopped(&violation, &end), |()| end.clone());
        for watcher in self.watchers.iter_mut() {
            watcher.end(&end)?;
        }
        let extremes = self.judge.extremes().clone();
        Ok(Completed { end, extremes, times: KernelTimes::default() })
    }

    /// The events of a period, where each task that is given up comes with what observers add.
    fn explain_events(
        &mut self,
        snapshot: &Snapshot,
        events: &[MissionEvent],
    ) -> Vec<MissionEvent> {
        let mut events = self.judge.explain(snapshot, events);
        for event in &mut events {
            if let MissionEvent::TaskGivenUp { task, outcome, reason, certificate } = event {
                let saturated = self.saturated_beside(*task);
                let more = addition(*outcome, certificate.as_deref(), &saturated);
                reason.push_str(&more.unwrap_or_default());
                self.given_up.insert(*task, reason.clone());
            }
        }
        events
    }

    /// The robots that send nearly all the time, of those that may pursue a task.
    fn saturated_beside(&self, task: usize) -> Vec<(usize, f64)> {
        let is_of = |fleet: &&Fleet| fleet.inward().task(task).is_some();
        let fleet = self.scenario.fleets().iter().find(is_of);
        self.saturated_of(fleet)
    }

    /// The robots that send nearly all the time, of a fleet where there are several.
    fn saturated_of(&self, fleet: Option<&Fleet>) -> Vec<(usize, f64)> {
        let is_own =
            |robot: usize| fleet.is_none_or(|it| it.robots().binary_search(&robot).is_ok());
        self.saturated.iter().filter(|&&(robot, _)| is_own(robot)).copied().collect()
    }

    fn show(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        for watcher in self.watchers.iter_mut() {
            watcher.observe(snapshot, events)?;
        }
        Ok(())
    }

    /// An end with what observers add to its reason, and with what shows that it had to be so.
    fn explain(&self, end: End) -> End {
        if !end.fleets.is_empty() {
            let fleets = self.scenario.fleets().iter().zip(end.fleets);
            return End::of_fleets(fleets.map(|(it, told)| self.explain_fleet(it, told)).collect());
        }
        let certificate = self.judge.account(&end);
        self.explained(End { certificate, ..end }, None)
    }

    /// The same for the end of the mission of a fleet.
    fn explain_fleet(&self, fleet: &Fleet, told: FleetEnd) -> FleetEnd {
        let FleetEnd { access_point, end } = told;
        let certificate = self.judge.account_of_fleet(access_point, &end);
        FleetEnd { access_point, end: self.explained(End { certificate, ..end }, Some(fleet)) }
    }

    /// An end, of a fleet where there are several, with the tasks that were given up and what observers add to its
    /// reason. Where one was, the reason is why.
    fn explained(&self, end: End, fleet: Option<&Fleet>) -> End {
        let is_own = |task: &&usize| fleet.is_none_or(|it| it.inward().task(**task).is_some());
        let tasks: Vec<usize> = self.given_up.keys().filter(is_own).copied().collect();
        match &tasks[..] {
            // The mission ends over the task that is pursued.
            _ if end.task.is_some() || tasks.is_empty() => {
                let saturated = self.saturated_of(fleet);
                let more = addition(end.outcome, end.certificate.as_ref(), &saturated);
                End { reason: end.reason + &more.unwrap_or_default(), tasks, ..end }
            }
            [task] if end.outcome.is_given_up() => {
                let reason = self.given_up[task].clone();
                End { reason, task: Some(*task), tasks, certificate: None, ..end }
            }
            _ => End { tasks, certificate: None, ..end },
        }
    }

    /// The end that a watcher asks for.
    fn interruption(&self, task: Option<usize>) -> Option<End> {
        let reason = self.watchers.iter().find_map(|watcher| watcher.interruption())?;
        Some(End::new(Outcome::Interrupted, reason, task))
    }

    /// The end where a property is violated.
    fn check(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> Option<End> {
        let violation = self.judge.observe(snapshot, events).err()?;
        Some(End::new(Outcome::InvariantViolated, violation.to_string(), snapshot.task))
    }
}

/// What observers add to the reason why a mission ends or a task is given up, where these robots send nearly all the
/// time.
fn addition(
    outcome: Outcome,
    certificate: Option<&Certificate>,
    saturated: &[(usize, f64)],
) -> Option<String> {
    match outcome {
        Outcome::Blocked => beside_bodies(certificate).or_else(|| overload(saturated)),
        Outcome::StepLimit => overload(saturated),
        Outcome::InsufficientRobots => shortage(certificate),
        _ => None,
    }
}

/// A mission that gets stuck while robots send all the time may be stuck because of their links: the reason
/// names them, too.
fn overload(saturated: &[(usize, f64)]) -> Option<String> {
    let loads = saturated.iter().map(|(robot, load)| format!("{load:.3} at robot {robot}"));
    let loads: Vec<String> = loads.collect();
    (!loads.is_empty()).then(|| {
        format!(
            "; the load is {}, and links carry no more: lower the rates, place robots closer together or \
             add some",
            loads.join(", ")
        )
    })
}

/// Where robots are too few wherever they stand, the reason says so.
fn shortage(certificate: Option<&Certificate>) -> Option<String> {
    let Some(Certificate::Bound(Bound { least, robots, .. })) = certificate else { return None };
    Some(format!(
        "; wherever robots stand, this task and those that are serviced take {least} of them, and there are {robots}"
    ))
}

/// Where robots of other fleets are beside the robots that stand still, the reason names these.
fn beside_bodies(certificate: Option<&Certificate>) -> Option<String> {
    let (Certificate::Blocked { team } | Certificate::Tried { team, .. }) = certificate? else {
        return None;
    };
    let is_body = |hindrance: &Hindrance| matches!(hindrance, Hindrance::Body { .. });
    let is_beside = |standing: &&Standing| standing.hindrances.iter().any(is_body);
    let robots: Vec<usize> = team.iter().filter(is_beside).map(|it| it.robot).collect();
    (!robots.is_empty()).then(|| {
        let robots = phrase::named("robot", &robots);
        format!("; a robot of another access point stands beside {robots}")
    })
}

impl<S: Runnable> Observer<S> for Gallery<'_, '_> {
    const SEES_JUMPS: bool = false;

    fn flows(&mut self, system: &S, _: HybridTime, _: f64) -> ControlFlow<End> {
        match system.seen().and_then(|(snapshot, events)| self.observe(&snapshot, &events)) {
            None => ControlFlow::Continue(()),
            Some(end) => ControlFlow::Break(end),
        }
    }
}
