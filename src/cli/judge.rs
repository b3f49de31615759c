//! `pleach judge`.

use super::arguments::JudgeArguments;
use super::status::{Failure, Status};
use super::{output, source};
use crate::summary::links_told;
use pleach::automaton::network::scenario::Settings;
use pleach::judge::{Verdict, judge};
use pleach::trace::TraceReader;
use pleach::verify::network::judged_faults;

/// Judges a trace and says what is wrong with it.
pub(super) fn run(arguments: &JudgeArguments) -> Result<Status, Failure> {
    let path = &arguments.trace;
    let failure = |what: String| Failure::Judge(format!("{}: {what}", path.display()));
    let unreadable = |what: String| failure(format!("{what}; nothing was judged"));
    let spoiled = |what: String| failure(format!("{what}; no property is violated before it"));
    let input =
        source::open(path).map_err(|error| unreadable(format!("cannot be read: {error}")))?;
    let reader = TraceReader::new(input).map_err(|error| unreadable(error.to_string()))?;
    let faults = judged_faults(&Settings::resolve(reader.scenario()), reader.faults());
    let whole = if faults.are_none() { "" } else { ", judged by what must hold under any fault" };
    match judge(reader).map_err(|error| spoiled(error.to_string()))? {
        Verdict::Sound { periods, end, links, .. } => {
            let (trace, name) = (path.display(), end.outcome.name().replace('_', " "));
            let crossing = match links.most() {
                Some(_) => format!("; links through walls: {}", links_told(&links)),
                None => String::new(),
            };
            output::say(&format!(
                "{trace}: sound, {periods} control periods{whole}; the outcome is: {name}{crossing}\n"
            ))?;
            Ok(Status::Done)
        }
        Verdict::Violated(violation) => {
            output::say(&format!("{}: {violation}\n", path.display()))?;
            Ok(Status::InvariantViolated)
        }
    }
}
