//! Speed beside other libraries and beside itself, in one run.
//!
//! ```sh
//! cargo run --release --manifest-path benches/peers/Cargo.toml
//! ```
//!
//! Every line is a statement about ratios within this run; the times themselves depend on the machine.

mod events;
mod problems;
mod solvers;

use std::hint::black_box;
use std::time::{Duration, Instant};

use problems::{Problem, chain, coupled_van_der_pol, lorenz, orbit};

fn main() {
    println!("integration at equal error: time, and the ratio to the fastest other");
    compare(&lorenz());
    compare(&coupled_van_der_pol());
    compare(&chain());
    compare(&orbit());
    println!("\nruns of automata");
    events::all();
}

/// A line for each of two tolerances. `pleach` runs at it, the rate once as a function and once as
/// formulas; the others at the loosest tolerance with which they end no farther from the true solution.
fn compare<const N: usize>(problem: &Problem<N>) {
    let tape = problem.tape();
    for relative in [1e-6, 1e-9] {
        let error = problem.error(problem.pleach(relative));
        let ours = fastest(40, || problem.pleach(black_box(relative)));
        let formulas = fastest(40, || problem.by_formulas(&tape, black_box(relative)));
        let others = [Problem::dopri5, Problem::dop853, Problem::tsit45].map(|solve| {
            let relative = problem.tolerance_for(error, solve);
            fastest(40, || solve(problem, black_box(relative)))
        });
        let best = others.iter().min().copied().unwrap_or_default();
        let [dopri5, dop853, tsit45] = others;
        println!(
            "  {:<20} {relative:e}, error {error:.0e}: function {ours:.1?} ({:.2}), formulas \
             {formulas:.1?} ({:.2}); ode_solvers dopri5 {dopri5:.1?}, dop853 {dop853:.1?}, diffsol \
             tsit45 {tsit45:.1?}",
            problem.name,
            ratio(ours, best),
            ratio(formulas, best),
        );
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
