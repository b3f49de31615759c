//! `pleach run`.

use super::arguments::RunArguments;
use super::interrupt::Interrupt;
use super::progress::Progress;
use super::status::{Failure, Status};
use pleach::automaton::network::scenario::{Scenario, ValidScenario};
use pleach::figures::Album;
use pleach::mission::{self, Watcher};
use pleach::scenario_file;
use pleach::summary::Summary;
use pleach::trace::TraceWriter;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs the mission of a scenario.
pub fn run(arguments: &RunArguments) -> Result<Status, Failure> {
    let scenario = scenario_file::read(&arguments.scenario)?;
    let mut summary = Summary::new(&scenario);
    let mut progress = Progress::new(&scenario, arguments.quiet);
    let mut trace =
        arguments.trace.as_deref().map(|path| start_trace(path, &scenario)).transpose()?;
    let folder = figures_folder(arguments, &scenario);
    if let Some(folder) = &folder {
        create_folder(folder)?;
    }
    let mut album = folder.as_ref().map(|_| open_album(&scenario));
    let mut interrupt = Interrupt::listen()?;

    let mut watchers: Vec<&mut dyn Watcher> = vec![&mut summary, &mut progress, &mut interrupt];
    watchers.extend(trace.as_mut().map(|trace| trace as &mut dyn Watcher));
    watchers.extend(album.as_mut().map(|album| album as &mut dyn Watcher));
    let clock = Instant::now();
    let completed = mission::run(&scenario, &mut watchers)?;
    let elapsed = clock.elapsed();
    let end = completed.end.clone();

    let mut output = io::stdout().lock();
    write!(output, "{}", summary.completed(completed, elapsed))?;
    if let Some(path) = &arguments.trace {
        writeln!(output, "  trace               {}", path.display())?;
    }
    if let (Some(album), Some(folder)) = (album, folder) {
        let written = album.write(&folder, &end)?;
        let index = written.last().unwrap_or(&folder);
        writeln!(output, "  figures             {}: open {}", written.len(), index.display())?;
    }
    Ok(end.outcome.into())
}

fn open_album(scenario: &ValidScenario) -> Album {
    let corners =
        |outline: &Vec<_>| outline.iter().map(|&corner| <[f64; 2]>::from(corner)).collect();
    Album::new(scenario, scenario.site().free_space.outline().iter().map(corners).collect())
}

fn start_trace(path: &Path, scenario: &Scenario) -> Result<TraceWriter<BufWriter<File>>, Failure> {
    let file =
        File::create(path).map_err(|source| Failure::Creation { path: path.to_owned(), source })?;
    Ok(TraceWriter::new(BufWriter::new(file), scenario)?)
}

/// A folder that cannot be written is told before the mission, not after it.
fn create_folder(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(|source| Failure::Creation { path: path.to_owned(), source })
}

/// Where figures go, unless they are not wanted.
fn figures_folder(arguments: &RunArguments, scenario: &Scenario) -> Option<PathBuf> {
    let default = || Path::new("figures").join(&scenario.name);
    (!arguments.no_figures).then(|| arguments.figures.clone().unwrap_or_else(default))
}
