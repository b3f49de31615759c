//! The page of a trace.

use std::io::{self, BufRead};

use pleach_automaton::network::record::MissionEvent;
use pleach_automaton::network::scenario::{InvalidScenario, ValidScenario};
use thiserror::Error;

use super::MissionPage;
use crate::mission::Watcher;
use crate::trace::{TraceEntry, TraceError, TraceReader};

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
    /// A step cannot be put into the page.
    #[error("a step cannot be written: {0}")]
    Step(#[source] io::Error),
}

/// Makes the page of a trace. A trace that breaks off, as a run leaves it that was killed, is shown
/// up to there, and the page says that no end is recorded.
///
/// # Errors
/// When the text is no trace, or the scenario in its header cannot be run.
pub fn of_trace(trace: impl BufRead) -> Result<String, PageError> {
    let reader = TraceReader::new(trace)?;
    let scenario = ValidScenario::new(reader.scenario().clone())?;
    let mut page = MissionPage::with_faults(&scenario, reader.faults());
    let mut events: Vec<MissionEvent> = Vec::new();
    for entry in reader {
        match entry? {
            TraceEntry::Event { event, .. } => events.push(event),
            TraceEntry::Step(snapshot) => {
                page.observe(&snapshot, &events).map_err(PageError::Step)?;
                events.clear();
            }
            TraceEntry::End(end) => page.end(&end).map_err(PageError::Step)?,
        }
    }
    Ok(page.render())
}
