//! A mission in progress, and those who watch it.
//!
//! A [`Mission`] advances one control period at a time and reports what an outsider may see.
//! [`watch`] takes it to its end and hands every report to the [`Observer`]s: the trace writer,
//! the progress display, the summary, the figures. None of them can influence the mission.

use crate::automaton::network::record::{End, MissionEvent, Snapshot};
use std::io;
use std::time::Duration;

/// A mission that can be advanced.
pub trait Mission {
    /// Advances to the next control period and reports it.
    ///
    /// After a report with an end there is no further step.
    fn step(&mut self) -> StepReport;

    /// Processor time spent so far in each kernel (routing, motion, …), by its name.
    fn kernel_times(&self) -> Vec<(&'static str, Duration)> {
        Vec::new()
    }
}

/// What a control period shows.
#[derive(Clone, Debug, PartialEq)]
pub struct StepReport {
    /// What happened since the previous snapshot, in this order.
    pub events: Vec<MissionEvent>,
    /// The instant at which the robots are about to move.
    pub snapshot: Snapshot,
    /// How the mission ended, if it did; the robots move no more.
    pub end: Option<End>,
}

/// Somebody who watches a mission. Steps are told after the events that led to them.
#[allow(unused_variables)]
pub trait Observer {
    /// Something happened in control period `step`.
    ///
    /// # Errors
    /// The observer cannot write what it has to.
    fn event(&mut self, step: usize, event: &MissionEvent) -> io::Result<()> {
        Ok(())
    }

    /// The robots are about to move.
    ///
    /// # Errors
    /// The observer cannot write what it has to.
    fn snapshot(&mut self, snapshot: &Snapshot) -> io::Result<()> {
        Ok(())
    }

    /// The mission has ended.
    ///
    /// # Errors
    /// The observer cannot write what it has to.
    fn end(&mut self, end: &End) -> io::Result<()> {
        Ok(())
    }
}

/// Takes `mission` to its end and tells every observer what happens, in the given order.
///
/// # Errors
/// The first error of an observer; the mission stops there.
pub fn watch(mission: &mut dyn Mission, observers: &mut [&mut dyn Observer]) -> io::Result<End> {
    loop {
        let StepReport { events, snapshot, end } = mission.step();
        for observer in observers.iter_mut() {
            for event in &events {
                observer.event(snapshot.step, event)?;
            }
            observer.snapshot(&snapshot)?;
            if let Some(end) = &end {
                observer.end(end)?;
            }
        }
        if let Some(end) = end {
            return Ok(end);
        }
    }
}
