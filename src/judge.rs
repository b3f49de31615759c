//! Judging a finished run from its trace alone.
//!
//! The [`Judge`](crate::verify::network::Judge) reads what the trace says: it holds the world against
//! the properties, each event against the world and the events before it, and what observers concluded
//! against what it derives itself. Nothing of the run is trusted, and nothing of it is computed
//! again. Where the header says that messages are lost or nodes stop, the trace is held against what
//! must hold under any fault ([`Safety`](crate::verify::network::Safety)).

use std::io::BufRead;

use thiserror::Error;

use crate::automaton::network::record::{End, MissionEvent};
use crate::automaton::network::scenario::{InvalidScenario, ValidScenario};
use crate::discrete::network::activity::may_follow;
use crate::trace::{TraceEntry, TraceError, TraceReader};
use crate::verify::network::{Extremes, Instant, Property, Referee, Violation};

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
        judge: Referee::new(&scenario, trace.faults(), may_follow),
        now: Instant { step: 0, time: 0.0 },
        periods: 0,
        events: Vec::new(),
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
    judge: Referee<'a>,
    /// The last step.
    now: Instant,
    periods: usize,
    /// The events since then, each with the step for which it is recorded.
    events: Vec<(usize, MissionEvent)>,
    end: Option<End>,
}

impl Reading<'_> {
    fn take(&mut self, entry: TraceEntry) -> Result<(), Violation> {
        if self.end.is_some() {
            return Err(self.fault(Property::Record, "the trace goes on after its end"));
        }
        match entry {
            TraceEntry::Event { step, event } => self.events.push((step, event)),
            TraceEntry::Step(snapshot) => {
                self.now = Instant::of(&snapshot);
                self.periods += 1;
                if let Some((step, _)) = self.events.iter().find(|(k, _)| *k != snapshot.step) {
                    let sentence = format!("an event of step {step} stands before this step");
                    return Err(self.fault(Property::Record, &sentence));
                }
                let events: Vec<_> = self.events.drain(..).map(|(_, event)| event).collect();
                self.judge.observe(&snapshot, &events)?;
            }
            TraceEntry::End(end) => {
                if !self.events.is_empty() {
                    return Err(self.fault(Property::Record, "events stand after the last step"));
                }
                self.judge.conclude(&end)?;
                self.end = Some(end);
            }
        }
        Ok(())
    }

    fn close(self) -> Verdict {
        match self.end {
            Some(end) => {
                let extremes = self.judge.extremes().clone();
                Verdict::Sound { periods: self.periods, end: Box::new(end), extremes }
            }
            None => Verdict::Violated(
                self.fault(Property::Outcome, "the trace breaks off: it does not say how it ends"),
            ),
        }
    }

    fn fault(&self, property: Property, sentence: &str) -> Violation {
        self.now.violation(property, &[], (0.0, 1.0), sentence.to_owned())
    }
}
