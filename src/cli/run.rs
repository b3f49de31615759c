//! `pleach run`.

use super::arguments::RunArguments;
use super::progress::Progress;
use super::status::{Failure, Status};
use pleach::automaton::network::scenario::Scenario;
use pleach::mission::{Mission, Observer, watch};
use pleach::scenario_file;
use pleach::summary::Summary;
use pleach::trace::TraceWriter;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs the mission of a scenario.
pub fn run(arguments: &RunArguments) -> Result<Status, Failure> {
    let scenario = scenario_file::read(&arguments.scenario)?;
    let mut mission = begin(&scenario)?;

    let mut summary =
        Summary::new(&scenario).map_err(|error| Failure::Internal(error.to_string()))?;
    let mut progress = Progress::new(&scenario, arguments.quiet);
    let mut trace =
        arguments.trace.as_deref().map(|path| start_trace(path, &scenario)).transpose()?;

    let mut observers: Vec<&mut dyn Observer> = vec![&mut summary, &mut progress];
    if let Some(trace) = &mut trace {
        observers.push(trace);
    }
    let clock = Instant::now();
    let end = watch(mission.as_mut(), &mut observers)?;
    let elapsed = clock.elapsed();
    progress.finish();
    if let Some(trace) = trace {
        trace.finish()?;
    }

    let mut output = io::stdout().lock();
    write!(output, "{}", summary.with_times(elapsed, mission.kernel_times()))?;
    if let Some(path) = &arguments.trace {
        writeln!(output, "  trace               {}", path.display())?;
    }
    if let Some(folder) = figures_folder(arguments, &scenario) {
        // HOOK(figures): an album watches the mission beside the summary; here it writes its
        // pictures into `folder`, and the program says so.
        writeln!(output, "  figures             none yet, meant for {}", folder.display())?;
    }
    Ok(end.outcome.into())
}

/// The mission of a valid scenario, before its first control period.
fn begin(scenario: &Scenario) -> Result<Box<dyn Mission>, Failure> {
    // HOOK(network): the robot network takes its place here.
    Err(Failure::Internal(format!("there is no network yet to run {}", scenario.name)))
}

fn start_trace(path: &Path, scenario: &Scenario) -> Result<TraceWriter<BufWriter<File>>, Failure> {
    let file =
        File::create(path).map_err(|source| Failure::Creation { path: path.to_owned(), source })?;
    Ok(TraceWriter::new(BufWriter::new(file), scenario)?)
}

/// Where figures go, unless they are not wanted.
fn figures_folder(arguments: &RunArguments, scenario: &Scenario) -> Option<PathBuf> {
    let default = || Path::new("figures").join(&scenario.name);
    (!arguments.no_figures).then(|| arguments.figures.clone().unwrap_or_else(default))
}
