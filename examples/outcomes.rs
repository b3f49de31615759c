//! Runs many random missions and tells what became of them, family by family.
//!
//! `cargo run --release --example outcomes -- MISSIONS [FOLDER] [--strategy paper]` runs that many missions of
//! each family (a tenth as many of the halls, which take fifty times as long) and prints a table:
//!
//! - *serviced*, *proved* and *unproved*: all tasks were serviced; robots were too few, by a bound that
//!   rests on lengths alone ([`Spans`]); they were too few by that bound or not, and the mission ended
//!   all the same. *Bad* are ends that must not be: blocked, out of time, in violation, in error.
//! - *robots*: of the missions that are serviced, those robots that are not redundant at the end, as a
//!   multiple of a spanning tree of the access points and tasks over d_build, median and worst; and as a
//!   multiple of the robots of such a tree, whose edges are chains of whole links.
//! - *time*: their control periods, as a multiple of the ways from access points to all tasks at full
//!   speed, one after the other, median and worst.
//!
//! A second table says what these missions spend their control periods with, in per cent: leaders are
//! elected, or no task is pursued; the primary team is the active one and *advances* or *stands* still; a
//! recruit is *called* for; break points are *agreed* upon; subgroups *shift* along Σ. In the *moving* ones,
//! of whatever kind, a robot of the primary team moves.
//!
//! With a folder, scenarios that are not serviced are written there.

use clap::Parser;
use missions::floor_plans::{Family, scenario};
use missions::{strategies, used};
use pleach::automaton::network::record::{MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::{Strategy, ValidScenario};
use pleach::discrete::network::Phase;
use pleach::mission::{Watcher, run};
use pleach::verify::network::Spans;
use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

/// Runs random missions and tells what became of them, family by family
#[derive(Parser)]
struct Arguments {
    /// How many of each family, and a tenth as many of the halls
    missions: u64,
    /// Where scenarios that are not serviced are written
    folder: Option<PathBuf>,
    /// When recruits are called for: paper or eager
    #[arg(long, value_parser = strategies::named)]
    strategy: Option<Strategy>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { missions, folder, strategy } = Arguments::parse();
    if let Some(folder) = &folder {
        std::fs::create_dir_all(folder)?;
    }
    let folder = folder.as_deref();
    println!(
        "family        missions serviced proved unproved  bad   robots median worst   of whole links   \
         time median worst"
    );
    let (mut all, mut spent, mut spent_in_all) = (Vec::new(), Vec::new(), Spent::default());
    for family in Family::ALL.into_iter().chain(Family::WINDING) {
        let count = if family == Family::Hall { missions.div_ceil(10) } else { missions };
        let (mut results, mut spent_here) = (Vec::new(), Spent::default());
        for seed in 1..=count {
            let scenario = strategies::following(strategy, scenario(family, seed));
            results.push(mission(&scenario, folder, &mut spent_here)?);
        }
        println!("{}", row(family.name(), &results));
        all.extend(results);
        spent_in_all.add(&spent_here);
        spent.push((family.name(), spent_here));
    }
    println!("{}", row("all", &all));
    println!("\nfamily        electing advancing standing calling agreeing shifting   moving");
    for (name, spent) in spent {
        println!("{name:13} {spent}");
    }
    println!("{:13} {spent_in_all}", "all");
    Ok(())
}

/// What became of a mission.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// With what robots and time amount to, as multiples of their bounds.
    Serviced { robots: f64, whole: f64, time: f64 },
    /// Too few robots, and whether that is proved.
    Insufficient { proved: bool },
    /// It must not end like this.
    Bad,
}

/// Counts the control periods, and the robots that a mission uses.
#[derive(Default)]
struct Usage {
    periods: usize,
    robots: usize,
    tasks: usize,
    spent: Spent,
    previous: Option<Snapshot>,
}

/// Control periods by what they are spent with, in the order of the columns, and those in which the primary
/// team moves.
#[derive(Clone, Copy, Default)]
struct Spent {
    periods: [usize; 6],
    moving: usize,
}

impl Spent {
    fn add(&mut self, other: &Spent) {
        self.periods.iter_mut().zip(other.periods).for_each(|(sum, count)| *sum += count);
        self.moving += other.moving;
    }

    /// The period between these snapshots.
    fn count(&mut self, before: &Snapshot, after: &Snapshot) {
        let moves =
            before.primary_team.iter().any(|&it| before.positions[it] != after.positions[it]);
        let column = match before.phase {
            Phase::Idle | Phase::LeaderElection | Phase::Ended => 0,
            Phase::Advance if moves => 1,
            Phase::Advance => 2,
            Phase::RecruitElection => 3,
            Phase::PathAgreement => 4,
            Phase::Shift => 5,
        };
        self.periods[column] += 1;
        self.moving += usize::from(moves);
    }
}

impl std::fmt::Display for Spent {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let whole = self.periods.iter().sum::<usize>().max(1) as f64;
        let [electing, advancing, standing, calling, agreeing, shifting] =
            self.periods.map(|count| 100.0 * count as f64 / whole);
        let moving = 100.0 * self.moving as f64 / whole;
        write!(
            formatter,
            "{electing:8.1} {advancing:9.1} {standing:8.1} {calling:7.1} {agreeing:8.1} {shifting:8.1} \
             {moving:8.1}"
        )
    }
}

impl Watcher for Usage {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        if let Some(before) = self.previous.replace(snapshot.clone()) {
            self.spent.count(&before, snapshot);
        }
        self.periods = snapshot.step;
        self.robots = used(snapshot);
        let announced = |event: &&MissionEvent| matches!(event, MissionEvent::TaskAnnounced { .. });
        self.tasks += events.iter().filter(announced).count();
        Ok(())
    }
}

fn mission(
    scenario: &ValidScenario,
    folder: Option<&Path>,
    spent: &mut Spent,
) -> Result<End, Box<dyn Error>> {
    let spans = Spans::along_ways(scenario)?;
    let mut usage = Usage::default();
    let (outcome, reason) = match run(scenario, &mut [&mut usage]) {
        Ok(completed) => (Some(completed.end.outcome), completed.end.reason),
        Err(error) => (None, error.to_string()),
    };
    let tasks: Vec<usize> = (0..scenario.task.len()).collect();
    let end = match outcome {
        Some(Outcome::Serviced) => {
            spent.add(&usage.spent);
            let build = scenario.site().usual.build;
            let links = spans.spanning_tree(&tasks) / build;
            let ways: f64 = tasks.iter().map(|&task| spans.way_to(task)).sum();
            let periods = ways / scenario.site().settings.step_radius;
            End::Serviced {
                robots: usage.robots as f64 / links.max(tasks.len() as f64),
                whole: usage.robots as f64 / spans.robots_of_spanning_tree(&tasks, build),
                time: usage.periods as f64 / periods.max(1.0),
            }
        }
        Some(Outcome::InsufficientRobots) => {
            let announced: Vec<usize> = (0..usage.tasks).collect();
            let least = Spans::as_the_crow_flies(scenario).least_robots(&announced);
            End::Insufficient { proved: least.is_none_or(|least| least > scenario.robot.len()) }
        }
        _ => End::Bad,
    };
    if !matches!(end, End::Serviced { .. }) {
        eprintln!("{}: {end:?}: {reason}", scenario.name);
        if let Some(folder) = folder {
            let text = toml::to_string(scenario.scenario())?;
            std::fs::write(folder.join(format!("{}.toml", scenario.name)), text)?;
        }
    }
    Ok(end)
}

fn row(name: &str, results: &[End]) -> String {
    let count = |fits: &dyn Fn(&End) -> bool| results.iter().filter(|end| fits(end)).count();
    let sorted = |of: &dyn Fn(&End) -> Option<f64>| {
        let mut values: Vec<f64> = results.iter().filter_map(of).collect();
        values.sort_by(f64::total_cmp);
        let median = values.get(values.len() / 2).copied().unwrap_or(f64::NAN);
        (median, values.last().copied().unwrap_or(f64::NAN))
    };
    let robots = sorted(&|end| match end {
        End::Serviced { robots, .. } => Some(*robots),
        _ => None,
    });
    let whole = sorted(&|end| match end {
        End::Serviced { whole, .. } => Some(*whole),
        _ => None,
    });
    let time = sorted(&|end| match end {
        End::Serviced { time, .. } => Some(*time),
        _ => None,
    });
    format!(
        "{name:13} {:8} {:8} {:6} {:8} {:4}          {:5.2} {:5.2}      {:5.2} {:5.2}        {:5.2} {:5.2}",
        results.len(),
        count(&|end| matches!(end, End::Serviced { .. })),
        count(&|end| *end == End::Insufficient { proved: true }),
        count(&|end| *end == End::Insufficient { proved: false }),
        count(&|end| *end == End::Bad),
        robots.0,
        robots.1,
        whole.0,
        whole.1,
        time.0,
        time.1,
    )
}
