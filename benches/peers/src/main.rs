//! Speed beside other libraries and beside itself, in one run.
//!
//! ```sh
//! cargo run --release --manifest-path benches/peers/Cargo.toml
//! cargo run --release --manifest-path benches/peers/Cargo.toml -- docs/guarantees.md
//! ```
//!
//! The second command also puts the tables into the document. Their numbers are ratios of times within
//! the run; the times themselves, which depend on the machine, go to the standard error.
//!
//! ```sh
//! cargo run --release --manifest-path benches/peers/Cargo.toml -- ways
//! ```
//!
//! This prints the table of shortest ways alone, and `loops` that of events and sampled control.
//!
//! ```sh
//! cargo run --release --manifest-path benches/peers/Cargo.toml -- one orbit run 1e-9 100
//! cargo run --release --manifest-path benches/peers/Cargo.toml -- one bounces 1000 1
//! ```
//!
//! These do one thing as often as they are told, for a profiler: a problem as a `function`, as
//! `formulas`, as the `run` of an automaton or by the `peer`, at a relative tolerance; or runs with
//! many events, or with as many as a row of the table of loops says.
//!
//! Times are those of the processor. SciPy is part of the comparison where `python3` has it.

mod events;
mod loops;
mod measure;
mod problems;
mod report;
mod solvers;
mod ways;

use std::hint::black_box;
use std::io;
use std::path::Path;
use std::time::Duration;

use measure::{fastest_in_turn, ratio};
use problems::{Problem, chain, coupled_van_der_pol, lorenz, orbit};
use report::Report;
use solvers::tolerance_for;

fn main() -> io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if let ["one", rest @ ..] = &arguments[..] {
        return one(rest).ok_or_else(|| io::Error::other("one NAME [WAY] NUMBER TIMES"));
    }
    let mut report = Report::default();
    if let [one @ ("ways" | "loops")] = arguments[..] {
        if one == "ways" {
            ways::all(&mut report)
        } else {
            loops::all(&mut report)
        }
        print!("{report}");
        return Ok(());
    }
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
    loops::all(&mut report);
    ways::all(&mut report);
    print!("{report}");
    arguments.first().map_or(Ok(()), |document| report.put_into(Path::new(document)))
}

/// Does one thing several times; none if it is not known.
fn one(arguments: &[&str]) -> Option<()> {
    let times = arguments.last()?.parse().ok()?;
    match *arguments {
        ["Lorenz", way, relative, _] => lorenz().repeat(way, relative.parse().ok()?, times),
        ["oscillators", way, relative, _] => {
            coupled_van_der_pol().repeat(way, relative.parse().ok()?, times)
        }
        ["chain", way, relative, _] => chain().repeat(way, relative.parse().ok()?, times),
        ["orbit", way, relative, _] => orbit().repeat(way, relative.parse().ok()?, times),
        [name, number, _] => {
            let number = number.parse().ok()?;
            events::repeat(name, number, times).or_else(|| loops::repeat(name, number, times))
        }
        _ => None,
    }
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
        let solvers = ours.map(|solve| (solve, relative)).into_iter();
        let peers = others.iter().map(|(_, solve)| {
            (*solve, tolerance_for(error, |relative| problem.error(relative, *solve)))
        });
        let solvers: Vec<(Solve<'_, N>, f64)> = solvers.chain(peers).collect();
        let times = fastest_in_turn(ROUNDS, solvers.len(), |number| {
            let (solve, relative) = solvers[number];
            solve(black_box(relative), problem.end)
        });
        let (own, times) = times.split_at(ours.len());
        let names = others.map(|(name, _)| name);
        let (best, peer) = times.iter().zip(names).min().unwrap_or((&Duration::ZERO, ""));
        eprintln!("{} at {relative:e}: {own:.1?}; {times:.1?}", problem.name);
        let ratios = own.iter().map(|time| format!("{:.1}", ratio(*time, *best)));
        let first = [problem.name.to_owned(), format!("{error:.0e}")];
        report.row(first.into_iter().chain(ratios).chain([peer.to_owned()]));
    }
}

/// How often everything that is compared is run, one after the other, so that what else runs on the machine
/// meets all of it.
const ROUNDS: usize = 100;
