//! How long a whole control period takes, and how that grows with the number of robots.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use pleach::automaton::network::scenario::ValidScenario;
use pleach_benches::course::Course;
use pleach_benches::hall::hall;

/// Robots of the halls.
const SIZES: [usize; 2] = [100, 1_000];
/// Tasks of the halls.
const TASKS: usize = 3;
/// Robots of the primary team when a team advances.
const TEAM: usize = 1;

/// Every scenario by its number of robots, with its tasks or without any.
fn scenarios(with_tasks: bool) -> Vec<ValidScenario> {
    let mut study = pleach_benches::study_1().into_scenario();
    if !with_tasks {
        study.task.clear();
    }
    let study = ValidScenario::new(study).expect("Study I is a valid scenario");
    let halls = SIZES.map(|robots| hall(robots, if with_tasks { TASKS } else { 0 }));
    std::iter::once(study).chain(halls).collect()
}

/// The mission has ended, and the robots only keep up their network.
fn at_rest(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("period_at_rest");
    for scenario in scenarios(false) {
        let mut course = Course::new(&scenario);
        course.reach_rest();
        let robots = BenchmarkId::from_parameter(scenario.robot.len());
        group.bench_function(robots, |bencher| bencher.iter(|| course.pass_period()));
    }
}

/// A primary team is on its way to a task.
fn advancing(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("period_advancing");
    for scenario in scenarios(true) {
        let mut course = Course::new(&scenario);
        let robots = BenchmarkId::from_parameter(scenario.robot.len());
        group.bench_function(robots, |bencher| {
            bencher.iter_custom(|periods| (0..periods).map(|_| course.time_advance(TEAM)).sum());
        });
    }
}

criterion_group! {
    name = benches;
    config = pleach_benches::quick();
    targets = at_rest, advancing
}
criterion_main!(benches);
