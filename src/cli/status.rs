//! Exit statuses, and the failures behind them.

use pleach::automaton::network::record::Outcome;
use pleach::import::{ImportError, SkeletonError};
use pleach::mission::MissionError;
use pleach::page::PageError;
use pleach::scenario_file::ScenarioError;
use pleach::starts::NoStarts;
use pleach::task_list::TaskListError;
use serde::{Serialize, Serializer};
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;
use thiserror::Error;

/// How the program ends, for those who start it from other programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// All tasks are serviced; or what was asked for is printed.
    Done = 0,
    /// The program failed, the input is not to blame.
    Failed = 1,
    /// The scenario or the arguments are wrong, and nothing was run.
    BadInput = 2,
    /// The mission ended with tasks unserviced.
    Unserviced = 3,
    /// A monitored property failed, and the mission was stopped.
    InvariantViolated = 4,
}

impl From<Outcome> for Status {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Serviced => Status::Done,
            Outcome::InvariantViolated => Status::InvariantViolated,
            // Whatever else may end a mission, some of its tasks are not serviced.
            _ => Status::Unserviced,
        }
    }
}

impl Status {
    /// How bad it is: of several runs the worst one decides.
    pub(super) fn severity(self) -> u8 {
        match self {
            Status::Done => 0,
            Status::Unserviced => 1,
            Status::BadInput => 2,
            Status::InvariantViolated => 3,
            Status::Failed => 4,
        }
    }
}

/// As its number.
impl Serialize for Status {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(*self as u8)
    }
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        ExitCode::from(status as u8)
    }
}

/// Why the program could not do what it was asked for.
#[derive(Debug, Error)]
pub enum Failure {
    /// No mission can start from the scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// No mission can start from some of the scenarios.
    #[error("{}", one_per_line(.0))]
    Scenarios(Vec<ScenarioError>),
    /// A folder without scenarios.
    #[error("{}: no scenario is in this folder; name one with files that end in .toml", folder.display())]
    NoScenarios {
        /// The folder.
        folder: PathBuf,
    },
    /// The arguments ask for more runs than can be meant.
    #[error("the arguments ask for {count} runs; at most {most} can be done in one call")]
    TooManyRuns {
        /// How many.
        count: usize,
        /// How many are possible.
        most: usize,
    },
    /// The program is built without what the arguments ask for.
    #[error(
        "{what}: this program is built without it; build one with cargo build --release --features {feature}"
    )]
    Without {
        /// The argument or the command.
        what: &'static str,
        /// The feature of the package.
        feature: &'static str,
    },
    /// Arguments that contradict each other.
    #[error("{0}")]
    Usage(String),
    /// Tasks cannot be read from a table.
    #[error(transparent)]
    Tasks(#[from] TaskListError),
    /// Robots cannot be placed at random.
    #[error(transparent)]
    Starts(#[from] NoStarts),
    /// A map cannot be read.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// No scenario comes of a map.
    #[error(transparent)]
    Skeleton(#[from] SkeletonError),
    /// A trace cannot be read or recorded.
    #[cfg(feature = "mcap")]
    #[error("{}: {source}", path.display())]
    Recording {
        /// The trace.
        path: PathBuf,
        /// What is wrong with it.
        source: pleach::recording::RecordingError,
    },
    /// A figure cannot be written as PDF.
    #[cfg(feature = "pdf")]
    #[error(transparent)]
    Pdf(#[from] pleach::pdf::PdfError),
    /// No page can be made of a trace.
    #[error("{}: {error}", path.display())]
    Trace {
        /// The trace.
        path: PathBuf,
        /// What is wrong with it.
        error: Box<PageError>,
    },
    /// A file cannot be created.
    #[error("{}: cannot be created: {source}; choose a path that may be written", path.display())]
    Creation {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A trace cannot be read, and nothing was judged.
    #[error("{0}")]
    Judge(String),
    /// The trace, the progress or a figure cannot be written.
    #[error("cannot write: {0}")]
    Output(#[from] io::Error),
    /// The mission could not be run to an end.
    #[error(transparent)]
    Mission(Box<MissionError>),
    /// Something that cannot go wrong with a valid scenario did.
    #[error("{0}")]
    Internal(String),
}

impl From<MissionError> for Failure {
    fn from(error: MissionError) -> Self {
        Failure::Mission(Box::new(error))
    }
}

fn one_per_line(errors: &[ScenarioError]) -> String {
    errors.iter().map(ScenarioError::to_string).collect::<Vec<_>>().join("\n")
}

impl Failure {
    /// The exit status that tells this failure.
    pub(super) fn status(&self) -> Status {
        match self {
            Failure::Scenario(_)
            | Failure::Scenarios(_)
            | Failure::NoScenarios { .. }
            | Failure::TooManyRuns { .. }
            | Failure::Usage(_)
            | Failure::Without { .. }
            | Failure::Tasks(_)
            | Failure::Starts(_)
            | Failure::Import(_)
            | Failure::Skeleton(_)
            | Failure::Trace { .. }
            | Failure::Judge(_)
            | Failure::Creation { .. } => Status::BadInput,
            #[cfg(feature = "mcap")]
            Failure::Recording { source: pleach::recording::RecordingError::Trace(_), .. } => {
                Status::BadInput
            }
            #[cfg(feature = "mcap")]
            Failure::Recording { .. } => Status::Failed,
            #[cfg(feature = "pdf")]
            Failure::Pdf(_) => Status::Failed,
            Failure::Output(_) | Failure::Mission(_) | Failure::Internal(_) => Status::Failed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_outcome_has_the_status_of_the_format() {
        let status = |outcome| Status::from(outcome) as u8;
        assert_eq!(status(Outcome::Serviced), 0);
        assert_eq!(status(Outcome::InsufficientRobots), 3);
        assert_eq!(status(Outcome::UnreachableTask), 3);
        assert_eq!(status(Outcome::StepLimit), 3);
        assert_eq!(status(Outcome::Blocked), 3);
        assert_eq!(status(Outcome::Interrupted), 3);
        assert_eq!(status(Outcome::InvariantViolated), 4);
    }

    #[test]
    fn the_worst_status_is_that_of_the_help() {
        use Status::{BadInput, Done, Failed, InvariantViolated, Unserviced};
        let mut all = [Done, Failed, BadInput, Unserviced, InvariantViolated];
        assert_eq!(all.map(|status| status as u8), [0, 1, 2, 3, 4]);
        all.sort_by_key(|status| std::cmp::Reverse(status.severity()));
        // Nothing is run where an input is wrong, so that 2 meets no other.
        let worst = all.iter().map(|status| *status as u8).filter(|&number| number != 2);
        assert_eq!(worst.collect::<Vec<_>>(), [1, 4, 3, 0]);
    }
}
