//! Missions on floor plans to which the robots are not tuned.
//!
//! A few run in every `cargo test -p missions`; many with
//! `cargo test --release -p missions --test it random_missions -- --ignored --nocapture`. To look at single
//! ones: `cargo run --release --example stress -- FAMILY FIRST_SEED COUNT FOLDER`.

use missions::floor_plans::{Family, scenario};
use missions::{Drawn, redundant};
use pleach::automaton::network::record::Outcome;
use pleach::automaton::network::scenario::Strategy;
use pleach::mission::run;
use proptest::test_runner::{Config, RngSeed};
use proptest::{prop_assert, proptest};
use rayon::prelude::*;

/// Missions of each family in every run; one in fifty may fail.
const DAILY: u64 = 6;
/// Missions of each family in the long run.
const MANY: u64 = 100;
/// Missions of the hall, which take some fifty times as long.
const MANY_HALLS: u64 = 5;

/// What is wrong with the end of a mission, if anything is. Tasks can be reached, so that it ends
/// with all of them serviced, or without a robot left in reach.
fn complaint(family: Family, seed: u64) -> Option<String> {
    let mission = Drawn::shared(family, seed, Strategy::Eager);
    let (end, redundant) = (&mission.end, redundant(&mission.last));
    let fair = match end.outcome {
        Outcome::Serviced => true,
        Outcome::InsufficientRobots => {
            redundant == 0 || scenario(family, seed).access_point.len() > 1
        }
        _ => false,
    };
    (!fair).then(|| {
        format!("{}: {:?}, {redundant} redundant: {}", mission.name, end.outcome, end.reason)
    })
}

/// What is wrong with the first missions of these families.
fn complaints(families: &[Family]) -> Vec<String> {
    let missions: Vec<_> =
        families.iter().flat_map(|&family| (1..=DAILY).map(move |seed| (family, seed))).collect();
    missions.into_par_iter().filter_map(|(family, seed)| complaint(family, seed)).collect()
}

/// Every family but the hall, which takes too long for every day.
fn any_family() -> impl proptest::strategy::Strategy<Value = Family> {
    proptest::sample::select(Family::of_every_day().collect::<Vec<_>>())
}

proptest! {
    #![proptest_config(Config {
        max_shrink_iters: 0,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..cases::usually(40)
    })]

    #[test]
    fn a_mission_comes_to_an_end_and_keeps_its_promises(
        family in any_family(),
        seed in 0_u64..1000,
    ) {
        let end = run(&scenario(family, seed), &mut []).unwrap().end;
        let stated = !matches!(end.outcome, Outcome::InvariantViolated | Outcome::StepLimit);
        prop_assert!(stated, "{:?}: {}", end.outcome, end.reason);
    }
}

#[test]
fn nearly_all_missions_are_serviced() {
    let families: Vec<_> = Family::of_every_day().collect();
    let complaints = complaints(&families);
    let most = families.len() * DAILY as usize / 50;
    assert!(complaints.len() <= most, "{}", complaints.join("\n"));
}

/// Where ways wind, there are many of them, and the robots have to find one.
#[test]
fn missions_on_winding_floors_are_serviced() {
    assert_eq!(complaints(&Family::WINDING), [""; 0]);
}

#[test]
fn a_family_and_a_seed_are_one_scenario() {
    for family in Family::ALL.into_iter().chain(Family::WINDING) {
        assert_eq!(scenario(family, 3), scenario(family, 3));
        assert_ne!(scenario(family, 3).robot, scenario(family, 4).robot);
    }
}

#[test]
#[ignore = "takes minutes: cargo test --release -p missions --test it random_missions -- --ignored --nocapture"]
fn many_missions_of_every_family() {
    let mut complaints = Vec::new();
    for family in Family::ALL.into_iter().chain(Family::WINDING) {
        let count = if family == Family::Hall { MANY_HALLS } else { MANY };
        let before = complaints.len();
        complaints.extend((1..=count).filter_map(|seed| complaint(family, seed)));
        println!("{:12} {count} missions, {} complaints", family.name(), complaints.len() - before);
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
