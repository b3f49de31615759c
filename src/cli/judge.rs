//! `pleach judge`.

use super::arguments::JudgeArguments;
use super::status::{Failure, Status};
use pleach::judge::{Verdict, judge};
use pleach::trace::TraceReader;
use std::fs::File;
use std::io::BufReader;

/// Judges a trace and says what is wrong with it.
pub fn run(arguments: &JudgeArguments) -> Result<Status, Failure> {
    let path = &arguments.trace;
    let unreadable =
        |what: String| Failure::Judge(format!("{}: {what}; nothing was judged", path.display()));
    let file = File::open(path).map_err(|error| unreadable(format!("cannot be read: {error}")))?;
    let reader =
        TraceReader::new(BufReader::new(file)).map_err(|error| unreadable(error.to_string()))?;
    match judge(reader).map_err(|error| unreadable(error.to_string()))? {
        Verdict::Sound { steps, end, .. } => {
            let name = end.outcome.name().replace('_', " ");
            println!("{}: sound, {steps} control periods; the outcome is: {name}", path.display());
            Ok(Status::Done)
        }
        Verdict::Violated(violation) => {
            println!("{}: {violation}", path.display());
            Ok(Status::InvariantViolated)
        }
    }
}
