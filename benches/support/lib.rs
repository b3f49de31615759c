//! What the benchmarks measure on: Study I, halls of any size, and missions held at a moment.

pub mod course;
pub mod hall;
pub mod scene;

use std::path::Path;
use std::time::Duration;

use criterion::Criterion;
use pleach::automaton::network::scenario::ValidScenario;

/// Study I of the paper: 13 robots, 3 tasks.
pub fn study_1() -> ValidScenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/study-1.toml");
    pleach::scenario_file::read(&path).expect("Study I is a valid scenario")
}

/// Few samples of a short time: what is compared are ratios within one run.
pub fn quick() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(1))
        .without_plots()
        .configure_from_args()
}
