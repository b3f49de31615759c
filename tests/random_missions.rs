//! Missions on floor plans that nobody tuned the robots to.
//!
//! A few run in every `cargo test`; many with
//! `cargo test --release --test random_missions -- --ignored --nocapture`. To look at single
//! ones: `cargo run --release --example stress -- FAMILY FIRST_SEED COUNT FOLDER`.

#![allow(clippy::unwrap_used)] // a test that panics has failed

mod floor_plans;

use floor_plans::{Family, scenario};
use pleach::automaton::network::record::{MissionEvent, Outcome, Snapshot};
use pleach::discrete::network::Role;
use pleach::mission::{Watcher, run};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use std::io;

/// Missions of each family in the long run.
const MANY: u64 = 100;
/// Missions of the hall, which take some fifty times as long.
const MANY_HALLS: u64 = 5;

/// Counts the robots that nobody needs.
#[derive(Default)]
struct Reserve {
    redundant: usize,
}

impl Watcher for Reserve {
    fn observe(&mut self, snapshot: &Snapshot, _: &[MissionEvent]) -> io::Result<()> {
        self.redundant = snapshot.roles.iter().filter(|&&role| role == Role::Redundant).count();
        Ok(())
    }
}

/// Runs a mission; what is wrong with its end, if anything is. Tasks can be reached and every
/// property is monitored, so that a mission ends with all tasks serviced or without a robot left.
fn complaint(family: Family, seed: u64) -> Option<String> {
    let scenario = scenario(family, seed);
    let mut reserve = Reserve::default();
    let end = match run(&scenario, &mut [&mut reserve]) {
        Ok(completed) => completed.end,
        Err(error) => return Some(format!("{}: {error}", scenario.name)),
    };
    let fair = match end.outcome {
        Outcome::Serviced => true,
        Outcome::InsufficientRobots => reserve.redundant == 0 || scenario.access_point.len() > 1,
        _ => false,
    };
    (!fair).then(|| {
        let left = reserve.redundant;
        format!("{}: {:?}, {left} redundant left: {}", scenario.name, end.outcome, end.reason)
    })
}

/// Every family but the hall, which takes too long for every day.
fn any_family() -> impl Strategy<Value = Family> {
    let families = Family::ALL.into_iter().filter(|&family| family != Family::Hall);
    proptest::sample::select(families.collect::<Vec<_>>())
}

proptest! {
    #![proptest_config(Config {
        cases: 200,
        max_shrink_iters: 0,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..Config::default()
    })]

    #[test]
    fn a_mission_is_serviced_or_runs_out_of_robots(family in any_family(), seed in 0_u64..1000) {
        let complaint = complaint(family, seed);
        prop_assert!(complaint.is_none(), "{}", complaint.unwrap());
    }
}

#[test]
fn a_family_and_a_seed_are_one_scenario() {
    for family in Family::ALL {
        assert_eq!(scenario(family, 3), scenario(family, 3));
        assert_ne!(scenario(family, 3).robot, scenario(family, 4).robot);
    }
}

#[test]
#[ignore = "takes minutes: cargo test --release --test random_missions -- --ignored --nocapture"]
fn many_missions_of_every_family() {
    let mut complaints = Vec::new();
    for family in Family::ALL {
        let count = if family == Family::Hall { MANY_HALLS } else { MANY };
        let before = complaints.len();
        complaints.extend((1..=count).filter_map(|seed| complaint(family, seed)));
        println!("{:12} {count} missions, {} complaints", family.name(), complaints.len() - before);
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
