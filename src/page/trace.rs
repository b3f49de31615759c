//! The page of a trace.

use std::io::{self, BufRead};

use pleach_automaton::network::scenario::{InvalidScenario, ValidScenario};
use thiserror::Error;

use super::MissionPage;
use crate::judge::{Order, Told};
use crate::mission::Watcher;
use crate::trace::{TraceError, TraceReader};

/// Why no page can be made of a trace.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PageError {
    /// The file cannot be opened.
    #[error("cannot be read: {0}")]
    Unreadable(#[source] io::Error),
    /// The text is no trace.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The header holds a scenario that no mission starts from.
    #[error("the scenario in the header cannot be run: {0}")]
    Scenario(#[from] InvalidScenario),
    /// A step does not tell of the robots of the scenario.
    #[error("step {step} has {positions} positions for {robots} robots")]
    Positions {
        /// k.
        step: usize,
        /// How many positions it has.
        positions: usize,
        /// How many robots the scenario has.
        robots: usize,
    },
    /// A step cannot be put into the page.
    #[error("a step cannot be written: {0}")]
    Step(#[source] io::Error),
}

/// Makes the page of a trace. A trace that breaks off, as a run leaves it that was killed, is shown
/// up to there, and the page says that no end is recorded. What the judge finds wrong with a trace is
/// the headline of its page, whatever outcome the trace claims, unless it says itself that the run was
/// stopped for a violation.
///
/// # Errors
/// When the text is no trace, a step is none of these robots, or the scenario in its header cannot be run.
pub fn of_trace(trace: impl BufRead) -> Result<String, PageError> {
    let reader = TraceReader::new(trace)?;
    let scenario = ValidScenario::new(reader.scenario().clone())?;
    let mut page = MissionPage::with_faults(&scenario, reader.faults());
    let (mut order, robots) = (Order::new(), scenario.robot.len());
    for entry in reader {
        let (told, fault) = order.next(entry?);
        page.note(fault);
        match told {
            Some(Told::Period(snapshot, events)) => {
                let (step, positions) = (snapshot.step, snapshot.positions.len());
                if positions != robots {
                    return Err(PageError::Positions { step, positions, robots });
                }
                page.observe(&snapshot, &events).map_err(PageError::Step)?;
            }
            Some(Told::End(end)) => page.end(&end).map_err(PageError::Step)?,
            None => {}
        }
    }
    Ok(page.render())
}
