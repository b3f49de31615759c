//! How setting up, the first control period and those after it grow with the number of robots.
//!
//! ```text
//! cargo run --release -p pleach-benches --example scale -- [ROBOTS]...
//! ```
//!
//! Each number of robots stands in a hall of its own, in which every robot hears twelve others and 49
//! share an access point; without numbers 100, 1,000 and 10,000. Robots of a hall without tasks are at rest: they
//! maintain their network only. In a busy hall the same robots pursue ten tasks. Exponents are those of the power law
//! through the first and the last hall.

use std::process::ExitCode;
use std::time::Instant;
use std::{env, fs};

use mimalloc::MiMalloc;
use pleach_benches::course::Course;
use pleach_benches::hall::hall;

/// As in the command-line program.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

const SIZES: [usize; 3] = [100, 1_000, 10_000];
/// Control periods that count, after those in which the network gathers and its routes come to rest.
const PERIODS: u32 = 10;
const GATHERING: usize = 60;
/// The tasks of a busy hall, and its first control periods, in which robots elect leaders and form teams.
const TASKS: usize = 10;
const BUSY_PERIODS: u32 = 40;

/// What was measured in a hall.
struct Row {
    robots: usize,
    /// Seconds for reading the hall, the first control period, one at rest, and one of a busy hall.
    times: [f64; 4],
    /// Bytes of memory that the mission takes.
    memory: Option<f64>,
}

impl Row {
    fn of(robots: usize) -> Row {
        let before = resident();
        let (scenario, setup) = timed(|| hall(robots, 0));
        let (mut course, first) = timed(|| Course::new(&scenario));
        (0..GATHERING).for_each(|_| course.pass_period());
        let ((), periods) = timed(|| (0..PERIODS).for_each(|_| course.pass_period()));
        let memory = resident().zip(before).map(|(after, before)| after - before);
        drop(course);
        let mut busy = Course::new(&hall(robots, TASKS));
        let ((), busy_periods) = timed(|| (0..BUSY_PERIODS).for_each(|_| busy.pass_period()));
        let [at_rest, busy] =
            [periods / f64::from(PERIODS), busy_periods / f64::from(BUSY_PERIODS)];
        Row { robots, times: [setup, first, at_rest, busy], memory }
    }

    fn print(&self) {
        let [setup, first, at_rest, busy] = self.times.map(|seconds| seconds * 1e3);
        let each = at_rest * 1e3 / self.robots as f64;
        let memory = self.memory.map_or("—".to_owned(), |bytes| {
            format!("{:.0} kB", bytes / 1e3 / self.robots as f64)
        });
        let robots = self.robots;
        println!(
            "| {robots} | {setup:.1} ms | {first:.1} ms | {at_rest:.2} ms | {each:.1} µs | {busy:.2} ms | {memory} |"
        );
    }
}

fn main() -> ExitCode {
    let numbers: Result<Vec<usize>, _> = env::args().skip(1).map(|word| word.parse()).collect();
    let sizes = match numbers {
        Ok(numbers) if numbers.contains(&0) => {
            eprintln!("a hall has at least one robot: give numbers from 1 on, such as 100 1000");
            return ExitCode::from(2);
        }
        Ok(numbers) if numbers.is_empty() => SIZES.to_vec(),
        Ok(numbers) => numbers,
        Err(error) => {
            eprintln!("the arguments are numbers of robots, such as 100 1000: {error}");
            return ExitCode::from(2);
        }
    };
    println!(
        "| robots | set up | first period | period at rest | a robot and period | busy period | memory a robot |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let mut rows = Vec::with_capacity(sizes.len());
    for robots in sizes {
        let row = Row::of(robots);
        row.print();
        rows.push(row);
    }
    if let [first, .., last] = &rows[..] {
        let growth = (last.robots as f64 / first.robots as f64).ln();
        let exponent = |which: usize| (last.times[which] / first.times[which]).ln() / growth;
        let [setup, first, at_rest, busy] = [0, 1, 2, 3].map(exponent);
        println!("| exponent | {setup:.2} | {first:.2} | {at_rest:.2} | | {busy:.2} | |");
    }
    ExitCode::SUCCESS
}

/// The result, and the seconds that it took.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = Instant::now();
    let result = work();
    (result, begin.elapsed().as_secs_f64())
}

/// The bytes of memory that the process holds, where the system tells.
fn resident() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? * 1024.0)
}
