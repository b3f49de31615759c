//! `pleach export`: traces as recordings.

use super::job;
use super::status::{Failure, Status};
use pleach::recording::{self, RecordingError};
use pleach::scenario_file::ScenarioError;
use pleach::trace::TraceReader;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Turns a trace into a recording.
pub fn export(trace: &Path, recording: &Path) -> Result<Status, Failure> {
    let failed = |source: RecordingError| Failure::Recording { path: trace.into(), source };
    let file = File::open(trace)
        .map_err(|source| ScenarioError::Unreadable { path: trace.into(), source })?;
    let reader = TraceReader::new(BufReader::new(file)).map_err(|error| failed(error.into()))?;
    let messages = recording::write(reader, job::create_file(recording)?).map_err(failed)?;
    println!("{}: {messages} messages", recording.display());
    Ok(Status::Done)
}
