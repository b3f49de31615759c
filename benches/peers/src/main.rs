//! Speed beside other libraries and beside itself, in one run.
//!
//! ```sh
//! cargo run --release --manifest-path benches/peers/Cargo.toml
//! cargo run --release --manifest-path benches/peers/Cargo.toml -- docs/guarantees.md
//! ```
//!
//! The second command also puts the tables into the document. Their numbers are ratios of times within
//! the run; the times themselves, which depend on the machine, go to the standard error.

mod events;
mod problems;
mod report;
mod solvers;

use std::hint::black_box;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use problems::{Problem, chain, coupled_van_der_pol, lorenz, orbit};
use report::Report;
use solvers::tolerance_for;

fn main() -> io::Result<()> {
    let mut report = Report::default();
    report.table(&[
        "integration at equal error",
        "error",
        "rates as a function",
        "rates as formulas",
        "run of an automaton",
        "fastest other",
    ]);
    compare(&lorenz(), &mut report);
    compare(&coupled_van_der_pol(), &mut report);
    compare(&chain(), &mut report);
    compare(&orbit(), &mut report);
    events::all(&mut report);
    print!("{report}");
    std::env::args().nth(1).map_or(Ok(()), |document| report.put_into(Path::new(&document)))
}

/// A row for each of two tolerances, at which `pleach` runs: with the rates as a function, as formulas,
/// and as an automaton, whose run keeps the solution at every instant. The others run at the loosest
/// tolerance with which they are no farther from the answers, with the end as their only output.
fn compare<const N: usize>(problem: &Problem<N>, report: &mut Report) {
    type Solve<'a, const N: usize> = &'a dyn Fn(f64, f64) -> [f64; N];
    let (tape, automaton) = (problem.tape(), problem.automaton());
    let others: [(&str, Solve<'_, N>); 3] = [
        ("`ode_solvers` Dopri5", &|relative, end| problem.dopri5(relative, end)),
        ("`ode_solvers` Dop853", &|relative, end| problem.dop853(relative, end)),
        ("`diffsol` Tsit45", &|relative, end| problem.tsit45(relative, end)),
    ];
    let ours: [Solve<'_, N>; 3] = [
        &|relative, end| problem.by_function(relative, end),
        &|relative, end| problem.by_formulas(&tape, relative, end),
        &|relative, end| problem.by_run(&automaton, relative, end),
    ];
    for relative in [1e-6, 1e-9] {
        let error = problem.error(relative, ours[0]);
        let time = |solve: Solve<'_, N>, relative: f64| {
            fastest(40, || solve(black_box(relative), problem.end))
        };
        let times = others.map(|(name, solve)| {
            let relative = tolerance_for(error, |relative| problem.error(relative, solve));
            (time(solve, relative), name)
        });
        let (best, peer) = times.into_iter().min().unwrap_or_default();
        let own = ours.map(|solve| time(solve, relative));
        eprintln!("{} at {relative:e}: {own:.1?}; {times:.1?}", problem.name);
        let ratios = own.map(|time| format!("{:.1}", ratio(time, best)));
        let first = [problem.name.to_owned(), format!("{error:.0e}")];
        report.row(first.into_iter().chain(ratios).chain([peer.to_owned()]));
    }
}

/// The shortest of several times.
fn fastest<T>(times: usize, mut run: impl FnMut() -> T) -> Duration {
    let time = |_| {
        let start = Instant::now();
        black_box(run());
        start.elapsed()
    };
    (0..times).map(time).min().unwrap_or_default()
}

fn ratio(one: Duration, other: Duration) -> f64 {
    one.as_secs_f64() / other.as_secs_f64()
}
