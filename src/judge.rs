//! Judging a finished run from its trace alone.
//!
//! The [`Judge`](crate::verify::network::Judge) reads what the trace says: it holds the world against
//! the properties, each event against the world and the events before it, and what observers concluded
//! against what it derives itself. Nothing of the run is trusted, and nothing of it is computed
//! again. Where the header says that messages are lost or nodes stop, the trace is held against what
//! must hold under any fault ([`Safety`](crate::verify::network::Safety)).

use std::io::BufRead;

use thiserror::Error;

use crate::automaton::network::record::{End, MissionEvent, Snapshot};
use crate::automaton::network::scenario::{InvalidScenario, ValidScenario};
use crate::discrete::network::activity::may_follow;
use crate::trace::{TraceEntry, TraceError, TraceReader};
use crate::verify::network::{Extremes, Instant, Property, Referee, TreeLinks, Violation};

/// What a trace amounts to.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Everything in it is as it should be.
    Sound {
        /// How many control periods it tells of.
        periods: usize,
        /// How the mission ended.
        end: Box<End>,
        /// How near it came to its bounds.
        extremes: Extremes,
        /// The links of the tree that crossed walls.
        links: TreeLinks,
    },
    /// The first thing that is not.
    Violated(Violation),
}

/// Why a trace cannot be judged.
#[derive(Debug, Error)]
pub enum JudgeError {
    /// It cannot be read.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// No mission can start from the scenario in its header.
    #[error("line 1: {0}")]
    Scenario(#[from] InvalidScenario),
}

/// Judges a trace.
///
/// # Errors
/// The trace cannot be read, or its header holds no scenario from which a mission can start.
pub fn judge<R: BufRead>(trace: TraceReader<R>) -> Result<Verdict, JudgeError> {
    let scenario = ValidScenario::new(trace.scenario().clone())?;
    let mut reading = Reading {
        scenario: &scenario,
        judge: Referee::new(&scenario, trace.faults(), may_follow),
        links: TreeLinks::default(),
        order: Order::new(),
        periods: 0,
        end: None,
    };
    for entry in trace {
        if let Err(violation) = reading.take(entry?) {
            return Ok(Verdict::Violated(violation));
        }
    }
    Ok(reading.close())
}

/// A trace that is being read.
struct Reading<'a> {
    scenario: &'a ValidScenario,
    judge: Referee<'a>,
    links: TreeLinks,
    order: Order,
    periods: usize,
    end: Option<End>,
}

impl Reading<'_> {
    fn take(&mut self, entry: TraceEntry) -> Result<(), Violation> {
        let (told, fault) = self.order.next(entry);
        if let Some(fault) = fault {
            return Err(fault);
        }
        match told {
            Some(Told::Period(snapshot, events)) => {
                self.periods += 1;
                self.judge.observe(&snapshot, &events)?;
                self.links.observe(&snapshot, self.scenario.site());
            }
            Some(Told::End(end)) => {
                self.judge.conclude(&end)?;
                self.end = Some(end);
            }
            None => {}
        }
        Ok(())
    }

    fn close(self) -> Verdict {
        match self.end {
            Some(end) => {
                let (extremes, links) = (self.judge.extremes().clone(), self.links);
                Verdict::Sound { periods: self.periods, end: Box::new(end), extremes, links }
            }
            None => Verdict::Violated(self.order.fault(
                Property::Outcome,
                "the trace breaks off: it does not say how it ends".to_owned(),
            )),
        }
    }
}

/// What a trace tells, one after the other.
pub(crate) enum Told {
    /// A control period: the snapshot with which it ends, and its events.
    Period(Box<Snapshot>, Vec<MissionEvent>),
    /// How the mission ended.
    End(End),
}

/// The order of the entries of a trace: events stand before the step for which they are recorded, and the end is
/// the last of all.
pub(crate) struct Order {
    /// The last step.
    now: Instant,
    /// The events since then, each with the step for which it is recorded.
    events: Vec<(usize, MissionEvent)>,
    has_ended: bool,
}

impl Order {
    /// That of a trace of which nothing is read.
    pub(super) fn new() -> Self {
        Order { now: Instant { step: 0, time: 0.0 }, events: Vec::new(), has_ended: false }
    }

    /// Takes the next entry: what is told with it, and the fault if it stands where it does not belong.
    pub(super) fn next(&mut self, entry: TraceEntry) -> (Option<Told>, Option<Violation>) {
        let after_end = self.has_ended.then(|| "the trace goes on after its end".to_owned());
        let before = self.now;
        let (told, misplaced) = match entry {
            TraceEntry::Event { step, event } => {
                self.events.push((step, event));
                (None, None)
            }
            TraceEntry::Step(snapshot) => {
                self.now = Instant::of(&snapshot);
                let other = self.events.iter().find(|(step, _)| *step != snapshot.step);
                let misplaced = other
                    .map(|(step, _)| format!("an event of step {step} stands before this step"));
                let events = self.events.drain(..).map(|(_, event)| event).collect();
                (Some(Told::Period(snapshot, events)), misplaced)
            }
            TraceEntry::End(end) => {
                self.has_ended = true;
                let is_late = !self.events.is_empty();
                let misplaced = is_late.then(|| "events stand after the last step".to_owned());
                (Some(Told::End(end)), misplaced)
            }
        };
        let fault = match (after_end, misplaced) {
            (Some(sentence), _) => {
                Some(before.violation(Property::Record, &[], (0.0, 1.0), sentence))
            }
            (None, misplaced) => misplaced.map(|sentence| self.fault(Property::Record, sentence)),
        };
        (told, fault)
    }

    fn fault(&self, property: Property, sentence: String) -> Violation {
        self.now.violation(property, &[], (0.0, 1.0), sentence)
    }
}
