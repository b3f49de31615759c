//! A mission from its start to its end, and those who watch it.
//!
//! [`run`] hands the network of a scenario to the executor. Every control period it takes the
//! observers' view of the network, holds it against the properties of [`crate::verify`], and
//! shows it to the [`Watcher`]s: the trace writer, the progress display, the summary, the
//! figures. None of them can influence the robots; a violated property ends the run.

use std::io;
use std::ops::ControlFlow;

use thiserror::Error;

use crate::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use crate::automaton::network::scenario::Scenario;
use crate::automaton::network::{KernelTimes, Message, Network, NetworkError};
use crate::automaton::node::Medium;
use crate::automaton::{Executor, HybridTime, InvalidLimit, Observer, Reason};
use crate::continuous::Point;
use crate::discrete::network::activity::may_follow;
use crate::verify::network::{Extremes, Judge, LimitError, Violation};

/// Somebody who watches a mission.
pub trait Watcher {
    /// The robots are about to move; `events` is what has happened in this control period.
    ///
    /// # Errors
    /// The watcher cannot write what it has to.
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()>;

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
pub enum MissionError {
    /// No mission can start from the scenario.
    #[error(transparent)]
    Scenario(#[from] LimitError),
    /// The network cannot be set up, or a guard cannot be evaluated.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// The settings leave no time for the mission.
    #[error(transparent)]
    Limit(#[from] InvalidLimit),
    /// A watcher cannot write what it has to.
    #[error("cannot write what the mission shows: {0}")]
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
/// When no mission can start from the scenario, or a watcher fails.
pub fn run(
    scenario: &Scenario,
    watchers: &mut [&mut dyn Watcher],
) -> Result<Completed, MissionError> {
    run_network(scenario, &mut Network::new(scenario)?, watchers)
}

/// Runs `network`, which is the network of `scenario` over any medium, to its end.
///
/// # Errors
/// When no mission can start from the scenario, or a watcher fails.
pub fn run_network<M: Medium<Message, Point>>(
    scenario: &Scenario,
    network: &mut Network<M>,
    watchers: &mut [&mut dyn Watcher],
) -> Result<Completed, MissionError> {
    let mut gallery = Gallery { judge: Judge::new(scenario, may_follow)?, watchers, failure: None };
    let settings = network.site().settings;
    let horizon = settings.period * (settings.max_steps as f64 + 1.0);
    let ending = Executor::new(horizon, JUMPS_PER_PERIOD)?.run(network, &mut gallery)?;
    if let Some(error) = gallery.failure {
        return Err(error.into());
    }
    let end = match ending.reason {
        Reason::Finished(end) | Reason::Interrupted(end) => end,
        other => End {
            outcome: Outcome::StepLimit,
            reason: format!("the executor stops at t = {} s: {other:?}", ending.at.t),
            task: None,
        },
    };
    let end = gallery
        .judge
        .conclude(&end)
        .map_or_else(|violation| stopped(&violation, &end), |()| end.clone());
    for watcher in gallery.watchers.iter_mut() {
        watcher.end(&end)?;
    }
    Ok(Completed { end, extremes: gallery.judge.extremes().clone(), times: network.times() })
}

/// Far more rounds of jumps than the messages of a control period ever take: only a cycle of
/// transitions that consumes no time can reach it.
const JUMPS_PER_PERIOD: u32 = 1_000_000;

/// The end of a mission that its record belies; one that was stopped for a violation says so.
fn stopped(violation: &Violation, end: &End) -> End {
    match end.outcome {
        Outcome::InvariantViolated => end.clone(),
        _ => End {
            outcome: Outcome::InvariantViolated,
            reason: violation.to_string(),
            task: end.task,
        },
    }
}

/// The judge and the watchers, looking on while the executor runs.
struct Gallery<'a, 'w> {
    judge: Judge<'a>,
    watchers: &'a mut [&'w mut dyn Watcher],
    failure: Option<io::Error>,
}

impl Gallery<'_, '_> {
    fn show(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        for watcher in self.watchers.iter_mut() {
            watcher.observe(snapshot, events)?;
        }
        Ok(())
    }

    fn check(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> Result<(), End> {
        self.judge.observe(snapshot, events).map_err(|violation| End {
            outcome: Outcome::InvariantViolated,
            reason: violation.to_string(),
            task: snapshot.task,
        })
    }
}

impl<M: Medium<Message, Point>> Observer<Network<M>> for Gallery<'_, '_> {
    fn flows(&mut self, network: &Network<M>, _: HybridTime, _: f64) -> ControlFlow<End> {
        let (snapshot, events) = (network.snapshot(), network.events());
        if let Err(error) = self.show(&snapshot, &events) {
            let reason = error.to_string();
            self.failure = Some(error);
            return ControlFlow::Break(End { outcome: Outcome::Blocked, reason, task: None });
        }
        match self.check(&snapshot, &events) {
            Ok(()) => ControlFlow::Continue(()),
            Err(end) => ControlFlow::Break(end),
        }
    }
}
