//! Many runs at once, with a line for each that has ended.

use super::interrupt::Interrupt;
use super::plan::Planned;
use super::record::Record;
use super::{output, table, terminal};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// Carries out `mission` for each run, in up to `jobs` threads, and gives the records in the order
/// of the runs. After an interruption no further run begins.
pub(super) fn run(
    runs: &[Planned],
    jobs: usize,
    quiet: bool,
    interrupt: &Interrupt,
    mission: impl Fn(&Planned) -> Record + Sync,
) -> Vec<Record> {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    let mut display = Display::new(runs.len(), quiet);
    let mut records: Vec<Record> = thread::scope(|scope| {
        for _ in 0..jobs.min(runs.len()) {
            let (sender, next, mission) = (sender.clone(), &next, &mission);
            scope.spawn(move || {
                while interrupt.signal().is_none()
                    && let Some(run) = runs.get(next.fetch_add(1, Ordering::Relaxed))
                {
                    // Only a display that is gone does not listen, and that cannot be here.
                    let _ = sender.send(attempt(run, mission));
                }
            });
        }
        drop(sender);
        receiver.iter().inspect(|record| display.show(record)).collect()
    });
    display.finish();
    records.sort_by_key(|record| record.run);
    records
}

/// A panic in one run is a fault of the program, and does not end the others.
fn attempt(run: &Planned, mission: &impl Fn(&Planned) -> Record) -> Record {
    catch_unwind(AssertUnwindSafe(|| mission(run)))
        .unwrap_or_else(|_| Record::failed(run, "the program panicked in this run".into()))
}

/// Runs that have ended, on the error output: as lines above a bar on a terminal, as lines alone
/// elsewhere.
enum Display {
    Quiet,
    Lines,
    Live(ProgressBar),
}

impl Display {
    fn new(runs: usize, quiet: bool) -> Self {
        if quiet {
            return Display::Quiet;
        }
        if !terminal::is_lively() {
            return Display::Lines;
        }
        let bar = ProgressBar::with_draw_target(Some(runs as u64), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{wide_bar} {pos} of {len} runs  {elapsed}");
        Display::Live(style.map_or_else(|_| bar.clone(), |style| bar.clone().with_style(style)))
    }

    fn show(&mut self, record: &Record) {
        match self {
            Display::Quiet => {}
            Display::Lines => output::tell(table::line(record)),
            Display::Live(bar) => {
                bar.inc(1);
                bar.println(table::line(record));
            }
        }
    }

    fn finish(&self) {
        if let Display::Live(bar) = self {
            bar.finish_and_clear();
        }
    }
}
