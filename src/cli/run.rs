//! `pleach run`: one mission with its story, or many with a table.

use super::arguments::RunArguments;
use super::batch;
use super::faults::Stop;
use super::interrupt::Interrupt;
use super::job::{self, Finished, Outputs};
use super::output;
use super::plan::{Planned, plan};
use super::progress::Progress;
use super::record::{Record, write_csv, write_json};
use super::remarks;
use super::source::is_standard;
use super::status::{Failure, Status};
use super::{table, terminal};
use std::io;
use std::path::{Path, PathBuf};

/// Runs the missions that the arguments ask for.
pub(super) fn run(arguments: &RunArguments) -> Result<Status, Failure> {
    if arguments.pdf && !cfg!(feature = "pdf") {
        return Err(Failure::Without { what: "--pdf", feature: "pdf" });
    }
    output::check_places(
        arguments.scenarios.iter().chain(&arguments.tasks),
        data_outputs(arguments),
    )?;
    let runs = plan(arguments)?;
    check_tables(arguments)?;
    let interrupt = Interrupt::listen()?;
    match runs.as_slice() {
        [one] => run_one(one, arguments, &interrupt),
        runs => run_many(runs, arguments, &interrupt),
    }
}

fn run_one(
    run: &Planned,
    arguments: &RunArguments,
    interrupt: &Interrupt,
) -> Result<Status, Failure> {
    if !arguments.quiet {
        warn_of(run);
    }
    let default_folder = || Path::new("figures").join(&run.scenario.name);
    let outputs = Outputs {
        trace: arguments.trace.clone(),
        figures: (!arguments.no_figures)
            .then(|| arguments.figures.clone().unwrap_or_else(default_folder)),
        plain: arguments.plain,
        pdf: arguments.pdf,
    };
    let mut progress = Progress::new(&run.scenario, arguments.quiet);
    let finished = job::run(run, &outputs, &mut progress, interrupt)?;
    write_tables(arguments, std::slice::from_ref(&finished.record))?;
    let periods = finished.summary.periods();
    for stop in arguments.faults.stop.iter().filter(|stop| stop.from >= periods) {
        let Stop { robot, from, .. } = stop;
        output::tell(format_args!(
            "warning: robot {robot} has not stopped: the mission ends before control period {from}"
        ));
    }
    say(arguments, &told(&finished, arguments.trace.as_deref()))?;
    Ok(finished.record.status)
}

/// What a person reads of a mission that has ended: its summary, and where the files are.
pub fn told(finished: &Finished, trace: Option<&Path>) -> String {
    let mut told = finished.summary.to_string();
    if let Some(path) = trace {
        told += &format!("  trace               {}\n", path.display());
    }
    if let Some(page) = finished.figures.last() {
        let count = finished.figures.len();
        told += &format!("  figures             {count}: open {}\n", page.display());
    }
    told
}

fn run_many(
    runs: &[Planned],
    arguments: &RunArguments,
    interrupt: &Interrupt,
) -> Result<Status, Failure> {
    if arguments.trace.as_deref().is_some_and(is_standard) {
        let what = "--trace names a folder for several runs: one trace fits on the standard output";
        return Err(Failure::Usage(what.to_owned()));
    }
    for folder in [&arguments.trace, &arguments.figures].into_iter().flatten() {
        output::create_folder(folder)?;
    }
    let outputs = |run: &Planned| {
        let name = run.file_name(runs.len());
        Outputs {
            trace: arguments.trace.as_ref().map(|folder| folder.join(format!("{name}.jsonl"))),
            figures: arguments.figures.as_ref().map(|folder| folder.join(name)),
            plain: arguments.plain,
            pdf: arguments.pdf,
        }
    };
    let mission = |run: &Planned| -> Record {
        let mut unseen = Progress::new(&run.scenario, true);
        let finished = job::run(run, &outputs(run), &mut unseen, interrupt);
        finished.map_or_else(
            |failure| Record::failed(run, failure.to_string()),
            |Finished { record, .. }| record,
        )
    };
    let records = batch::run(runs, arguments.jobs(), arguments.quiet, interrupt, mission);
    write_tables(arguments, &records)?;
    let mut said = table::draw(&records, terminal::width());
    said += &table::reasons(&records);
    if records.len() < runs.len() {
        said += &format!("{} of {} runs did not begin\n", runs.len() - records.len(), runs.len());
    }
    say(arguments, &said)?;
    let incomplete = (records.len() < runs.len()).then_some(Status::Unserviced);
    let statuses = records.iter().map(|record| record.status).chain(incomplete);
    Ok(statuses.max_by_key(|status| status.severity()).unwrap_or(Status::Done))
}

/// What is told before the mission: tasks that no robot can service, with which it will end, what is taken
/// otherwise than it stands in the file, and what keeps robots from moving where messages are lost.
pub fn warn_of(run: &Planned) {
    use pleach::automaton::network::scenario::Remark;
    let remarks = run.scenario.remarks();
    let told = remarks.iter().filter(|remark| match remark {
        Remark::ThroughWalls { .. } => false,
        Remark::FewRounds { .. } => run.faults.messages,
        _ => true,
    });
    for line in remarks::lines(told) {
        output::tell(format_args!("warning: {}: {line}", run.source));
    }
}

/// Whether the standard output carries data, so that what people read goes to the error output.
fn carries_data(arguments: &RunArguments) -> bool {
    data_outputs(arguments).any(|path| is_standard(path))
}

/// Where data go, apart from figures.
fn data_outputs(arguments: &RunArguments) -> impl Iterator<Item = &PathBuf> {
    [&arguments.trace, &arguments.csv, &arguments.json].into_iter().flatten()
}

fn say(arguments: &RunArguments, text: &str) -> io::Result<()> {
    let wrapped = |width| terminal::wrapped(text, width, terminal::SUMMARY_INDENT);
    if carries_data(arguments) {
        output::tell(wrapped(terminal::error_width()).trim_end());
        return Ok(());
    }
    output::say(&wrapped(terminal::width()))
}

/// A table that cannot be written is told before the missions, not after them; until then the one that is there
/// stays.
fn check_tables(arguments: &RunArguments) -> Result<(), Failure> {
    [&arguments.csv, &arguments.json].into_iter().flatten().try_for_each(|path| output::check(path))
}

/// Writes the tables, no file if no run has begun.
fn write_tables(arguments: &RunArguments, records: &[Record]) -> Result<(), Failure> {
    let is_wanted = |path: &&PathBuf| !records.is_empty() || is_standard(path);
    if let Some(path) = arguments.csv.as_ref().filter(is_wanted) {
        write_csv(records, output::open(path)?)?;
    }
    if let Some(path) = arguments.json.as_ref().filter(is_wanted) {
        write_json(records, output::open(path)?)?;
    }
    Ok(())
}
