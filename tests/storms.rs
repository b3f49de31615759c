//! Missions in storms: whatever becomes of messages, robots do not collide.
//!
//! `cargo run --release --example storm -- table 4` shows all kinds of storms, and what breaks in them.

use crate::missions::shipped;
use pleach::automaton::network::record::Outcome;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::verify::network::Property;
use pleach::verify::network::storm::{Kind, Verdict, draw, ride};

const PERIODS: usize = 600;
/// Seconds for which the mission is taken to last when faults are drawn.
const DURATION: f64 = 300.0;

/// A mission in a storm without partitions: robots that approach each other while no message gets
/// through between them cannot know of each other.
fn storm(name: &str, kind: Kind, seed: u64) -> Verdict {
    storm_for(PERIODS, name, kind, seed)
}

fn storm_for(periods: usize, name: &str, kind: Kind, seed: u64) -> Verdict {
    let scenario = ValidScenario::new(shipped(name)).expect("it is valid");
    let mut storm = draw(kind, seed, &scenario, DURATION);
    storm.weather.partitions.clear();
    ride(&scenario, &storm, periods).expect("nodes go on whatever they receive")
}

/// What no loss of messages breaks.
const HOLDS: &[Property] = &[
    Property::Separation,
    Property::Clearance,
    Property::Residual,
    Property::Shares,
    Property::Load,
    Property::TreeRange,
];

#[test]
fn no_loss_of_messages_brings_robots_into_contact_or_breaks_routes() {
    let kinds = [
        (Kind::Loss { rate: 0.3, later: false }, 2),
        (Kind::Loss { rate: 0.3, later: true }, 2),
        (Kind::Loss { rate: 0.6, later: true }, 10),
        (Kind::Delay, 2),
        (Kind::Copies, 2),
        (Kind::Silence, 2),
        (Kind::Radio, 2),
    ];
    for name in ["corridor", "study-2"] {
        for (kind, seeds) in kinds {
            for seed in 0..seeds {
                let violations = storm(name, kind, seed).violations;
                if let Some(broken) = violations.iter().find(|it| HOLDS.contains(&it.property)) {
                    panic!("{name}, {}, seed {seed}: {broken}", kind.name());
                }
            }
        }
    }
}

/// One message in ten is lost, and the mission takes hardly longer.
#[test]
fn the_mission_goes_on_although_messages_are_lost() {
    for later in [false, true] {
        let verdict = storm("corridor", Kind::Loss { rate: 0.1, later }, 0);
        let end = verdict.end.expect("it ends in time");
        assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
    }
}

/// A robot that joins late, or restarts with nothing known, does not decide elections alone.
#[test]
fn robots_that_join_late_or_restart_go_on() {
    for kind in [Kind::Late, Kind::Restart] {
        for seed in 0..6 {
            let verdict = storm("study-2", kind, seed);
            assert!(verdict.periods > 0, "{} {seed}", kind.name());
        }
    }
}

/// A robot that stops is given up. The others go round it, and service all tasks.
#[test]
fn the_mission_goes_on_without_a_robot_that_stops() {
    for (name, seeds) in [("corridor", 0..4), ("study-2", 0..2)] {
        for seed in seeds {
            let verdict = storm_for(1_500, name, Kind::Crash, seed);
            assert!(verdict.violations.is_empty(), "{name} {seed}: {}", verdict.violations[0]);
            let end = verdict.end.expect("it ends in time");
            assert_eq!(end.outcome, Outcome::Serviced, "{name} {seed}: {}", end.reason);
        }
    }
}
