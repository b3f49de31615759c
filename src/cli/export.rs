//! `pleach export`: traces as recordings.

use super::status::{Failure, Status};
use super::{output, source};
use pleach::recording::{self, RecordingError};
use pleach::scenario_file::ScenarioError;
use pleach::trace::TraceReader;
use std::path::Path;

/// Turns a trace into a recording.
pub(super) fn export(trace: &Path, recording: &Path) -> Result<Status, Failure> {
    let failed = |source: RecordingError| Failure::Recording { path: trace.into(), source };
    output::check_places([&trace.to_owned()], [&recording.to_owned()])?;
    let input = source::open(trace)
        .map_err(|source| ScenarioError::Unreadable { path: trace.into(), source })?;
    let reader = TraceReader::new(input).map_err(|error| failed(error.into()))?;
    let messages = recording::write(reader, output::open(recording)?).map_err(failed)?;
    if !source::is_standard(recording) {
        output::say(&format!("{}: {messages} messages\n", recording.display()))?;
    }
    Ok(Status::Done)
}
