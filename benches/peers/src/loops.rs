//! Events and sampled control beside other libraries: the processor time of an event and of a tick.

mod impacts;
mod sampled;
mod scipy;

use std::time::Duration;

use pleach_automaton::Settings;

use crate::measure::{fastest, peak_of, ratio};
use crate::report::Report;
use scipy::Scipy;

/// The tolerances of all libraries: those of a run without others.
const TOLERANCE: f64 = 1e-9;

/// How many events or ticks are run.
const COUNT: u32 = 4096;

/// How often, since what else runs on the machine leaves little in the caches.
const RUNS: usize = 25;

/// The final value of a run of this many events or ticks.
type Run<'a> = Box<dyn Fn(u32) -> f64 + 'a>;

/// What a library takes for events or ticks.
#[derive(Debug)]
struct Row {
    count: u32,
    /// Of each of them.
    time: Duration,
    /// What the run ends with.
    end: f64,
}

/// Events or ticks, by each library that has them.
struct Case<'a> {
    name: &'static str,
    answer: Run<'a>,
    pleach: Run<'a>,
    ode_solvers: Option<Run<'a>>,
    diffsol: Run<'a>,
}

pub fn all(report: &mut Report) {
    report.table(&[
        "an event or a tick",
        "`pleach`",
        "error",
        "memory",
        "`ode_solvers` Dopri5",
        "`diffsol` Tsit45",
        "`solve_ivp` RK45",
    ]);
    let scipy = Scipy::run();
    for case in impacts::cases().into_iter().chain(sampled::cases()) {
        case.measure(&scipy, report);
    }
}

/// Runs one of them several times, if it is one.
pub fn repeat(name: &str, count: u32, times: u32) -> Option<()> {
    let mut cases = impacts::cases().into_iter().chain(sampled::cases());
    let case = cases.find(|case| case.name == name)?;
    (0..times).for_each(|_| eprintln!("{}", (case.pleach)(count)));
    Some(())
}

impl Case<'_> {
    /// Adds a row: time, error and memory of `pleach`, then how many times as long others take, and their errors.
    fn measure(&self, scipy: &Scipy, report: &mut Report) {
        let peak = |count| peak_of(|| (self.pleach)(count));
        let grown = peak(COUNT).zip(peak(10 * COUNT)).map(|(one, ten)| ten.saturating_sub(one));
        let own = row_of(&self.pleach);
        let other = |row: Option<&Row>| match row {
            Some(row) => format!("{:.2} ({})", ratio(row.time, own.time), self.error(row)),
            None => "—".to_owned(),
        };
        let (ode_solvers, diffsol) = (self.ode_solvers.as_ref().map(row_of), row_of(&self.diffsol));
        let scipy = scipy.row(self.name);
        eprintln!("{}: {own:.2?}, {ode_solvers:.2?}, {diffsol:.2?}, {scipy:.2?}", self.name);
        report.row([
            self.name.to_owned(),
            format!("{:.1} µs", own.time.as_secs_f64() * 1e6),
            self.error(&own),
            grown.map_or_else(|| "—".to_owned(), |it| format!("{} B", it / u64::from(9 * COUNT))),
            other(ode_solvers.as_ref()),
            other(Some(&diffsol)),
            other(scipy),
        ]);
    }

    fn error(&self, row: &Row) -> String {
        format!("{:.0e}", ((self.answer)(row.count) - row.end).abs())
    }
}

fn row_of(run: &Run<'_>) -> Row {
    Row { count: COUNT, time: fastest(RUNS, || run(COUNT)) / COUNT, end: run(COUNT) }
}

/// Settings with the tolerances of all.
fn settings() -> Settings {
    Settings { relative_tolerance: TOLERANCE, absolute_tolerance: TOLERANCE, ..Settings::default() }
}
