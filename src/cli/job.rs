//! One run with everything that it writes.

use super::interrupt::Interrupt;
use super::output;
use super::plan::Planned;
use super::progress::Progress;
use super::record::Record;
use super::status::Failure;
#[cfg(feature = "pdf")]
use pleach::figures::ANIMATION;
use pleach::figures::Album;
use pleach::mission::{self, Completed, Watcher};
#[cfg(feature = "pdf")]
use pleach::pdf::Printer;
use pleach::summary::Summary;
use pleach::trace::TraceWriter;
use std::path::PathBuf;
use std::time::Instant;

/// What a run writes besides its record.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// The file of its trace; `-` for the standard output.
    pub trace: Option<PathBuf>,
    /// The folder of its figures.
    pub figures: Option<PathBuf>,
    /// Whether figures go without titles.
    pub plain: bool,
    /// Whether figures are written as PDF, too.
    pub pdf: bool,
}

/// A run that has ended.
pub struct Finished {
    /// What tables say of it.
    pub record: Record,
    /// What a person reads.
    pub summary: Summary,
    /// The files of its figures, the page last.
    pub figures: Vec<PathBuf>,
}

/// Runs a mission. Files that cannot be written are told before it begins.
pub(super) fn run(
    planned: &Planned,
    outputs: &Outputs,
    progress: &mut Progress,
    interrupt: &Interrupt,
) -> Result<Finished, Failure> {
    watch(planned, outputs, progress, interrupt, |watchers| {
        let scenario = &planned.scenario;
        Ok(match &planned.storm {
            None => mission::run(scenario, watchers)?,
            Some(storm) => mission::run_in_storm(scenario, storm, watchers)?,
        })
    })
}

/// Watches a mission that `carry_out` carries out, here or elsewhere.
pub fn watch(
    planned: &Planned,
    outputs: &Outputs,
    progress: &mut Progress,
    interrupt: &Interrupt,
    carry_out: impl FnOnce(&mut [&mut dyn Watcher]) -> Result<Completed, Failure>,
) -> Result<Finished, Failure> {
    let scenario = &planned.scenario;
    let mut interrupt = interrupt.clone();
    let mut summary = Summary::new(scenario);
    let mut trace = match &outputs.trace {
        Some(path) => {
            Some(TraceWriter::with_faults(output::open(path)?, scenario, planned.faults)?)
        }
        None => None,
    };
    if let Some(folder) = &outputs.figures {
        output::create_folder(folder)?;
    }
    #[cfg(feature = "pdf")]
    let printer = outputs.pdf.then(Printer::new).transpose()?;
    let open = |album: Album| if outputs.plain { album.plain() } else { album };
    let mut album =
        outputs.figures.as_ref().map(|_| open(Album::with_faults(scenario, planned.faults)));

    let mut watchers: Vec<&mut dyn Watcher> = vec![&mut summary, progress, &mut interrupt];
    watchers.extend(trace.as_mut().map(|trace| trace as &mut dyn Watcher));
    watchers.extend(album.as_mut().map(|album| album as &mut dyn Watcher));
    let clock = Instant::now();
    let completed = carry_out(&mut watchers)?;
    let elapsed = clock.elapsed();

    let record = Record::of(planned, &summary, &completed);
    let figures = match (album, &outputs.figures) {
        (Some(album), Some(folder)) => album.write(folder, &completed.end)?,
        _ => Vec::new(),
    };
    #[cfg(feature = "pdf")]
    let figures = match printer {
        Some(printer) => with_pdf(&printer, figures)?,
        None => figures,
    };
    Ok(Finished { record, summary: summary.completed(completed, elapsed), figures })
}

/// The figures, before them a PDF of each that is a picture.
#[cfg(feature = "pdf")]
fn with_pdf(printer: &Printer, figures: Vec<PathBuf>) -> Result<Vec<PathBuf>, Failure> {
    let pictures = figures.iter().filter(|path| {
        path.extension().is_some_and(|kind| kind == "svg") && !path.ends_with(ANIMATION)
    });
    let mut all =
        pictures.map(|picture| printer.print_beside(picture)).collect::<Result<Vec<_>, _>>()?;
    all.extend(figures);
    Ok(all)
}
