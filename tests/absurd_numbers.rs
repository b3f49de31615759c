//! Numbers that nobody means, at every place of a scenario where a number can stand.
//!
//! A scenario with one of them is refused with a message that names the key, or it is lawful; then its
//! mission runs, too. What is lawful is told here, apart from the ranges that the product states.

use missions::{network_over, run_unmonitored};
use pleach::automaton::network::Radio;
use pleach::automaton::network::scenario::{CONTROL, Values};
use pleach::scenario_file::parse_with;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::Path;
use std::time::{Duration, Instant};

const ABSURD: [&str; 15] = [
    "0",
    "-0.0",
    "-1",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "1e-300",
    "-1e-300",
    "9e18",
    "1e19",
    "1e300",
    "-1e300",
    "9000000000000000000",
    "-9223372036854775808",
];

/// The keys at which a number can stand, each with those of [`ABSURD`] that are lawful there, and with
/// what every line of a refusal names.
const NUMBERS: &[(&str, &[&str], &str)] = &[
    ("link.full_range", &[], "full_range"),
    ("link.max_range", &[], "max_range"),
    ("link.steepness", &[], "link.steepness"),
    ("control.clearance", &[], "clearance"),
    ("control.service_radius", &[], "control.service_radius"),
    ("control.step_radius", &[], "control.step_radius"),
    ("control.position_error", NOTHING_OR_LITTLE, "control.position_error"),
    ("control.motion_error", NOTHING_OR_LITTLE, "control.motion_error"),
    ("control.residual_tolerance", NOTHING_OR_LITTLE, "control.residual_tolerance"),
    ("control.max_steps", &[], "control.max_steps"),
    ("control.period", &[], "control.period"),
    ("control.rounds_per_period", &[], "control.rounds_per_period"),
    ("control.routing_iterations", &[], "control.routing_iterations"),
    ("control.routing_reserve", &[], "control.routing_reserve"),
    ("control.slope_aversion", NOTHING_OR_LITTLE, "control.slope_aversion"),
    ("control.build_reliability", &[], "control.build_reliability"),
    ("control.tree_reliability", &["1e-300"], "control.tree_reliability"),
    ("robot[1].rate", NOTHING_OR_LITTLE, "robot[1].rate"),
    ("robot[1].position[0]", &[], "robot[1].position"),
    ("robot[1].position[1]", &[], "robot[1].position"),
    // Where no robot hears it, every robot is cut off from it.
    ("access_point[0].position[0]", &[], "access_point"),
    ("access_point[0].position[1]", &[], "access_point"),
    // A task is anywhere: one that no robot can come close to ends the mission.
    ("task[0].position[0]", NEAR, "task[0].position[0]"),
    ("task[0].position[1]", NEAR, "task[0].position[1]"),
    ("workspace.boundary[0][0]", NEAR, "workspace.boundary[0][0]"),
    ("workspace.boundary[2][1]", &[], "workspace"),
    ("workspace.holes[0][0][0]", &[], "workspace"),
    ("workspace.holes[0][2][1]", &[], "workspace"),
];

const NOTHING_OR_LITTLE: &[&str] = &["0", "-0.0", "1e-300"];
const NEAR: &[&str] = &["0", "-0.0", "-1", "1e-300", "-1e-300"];

/// A room for robots with small errors, over links with a steepness.
fn room() -> String {
    let room = include_str!("scenarios/room.toml");
    let link = "max_range = 0.5\nmodel = \"logistic\"\nsteepness = 4.0";
    room.replace("max_range = 0.5", link)
}

#[test]
fn an_absurd_number_is_refused_by_its_key_or_does_no_harm() {
    let room = room();
    for &(key, lawful, named) in NUMBERS {
        for number in ABSURD {
            let begin = Instant::now();
            let setting = format!("{key}={number}");
            let read = parse_with(&room, Path::new("room.toml"), &[setting.parse().unwrap()]);
            match read {
                Ok(scenario) => {
                    assert!(lawful.contains(&number), "{setting} is read");
                    let mut network = network_over(&scenario, Radio::new);
                    run_unmonitored(&mut network, 10);
                }
                Err(error) => {
                    assert!(!lawful.contains(&number), "{setting} is refused: {error}");
                    let error = error.to_string().replace("cut off", "cut off from access_point");
                    // What is said behind the setting itself.
                    let said = error.replace(&format!("with {setting}: "), "");
                    let is_named = said.lines().all(|line| line.contains(named));
                    assert!(is_named, "{setting}: {error}");
                    println!("{error}");
                }
            }
            let spent = begin.elapsed();
            assert!(spent < Duration::from_secs(20), "{setting} takes {spent:?}");
        }
    }
}

/// Polygons with many corners are read, and not for minutes: a round hall with a round pillar.
#[test]
fn ten_thousand_corners_are_read() {
    let round = |radius: f64| -> String {
        let corner = |at: u32| {
            let angle = TAU * f64::from(at) / f64::from(CORNERS);
            format!("[{}, {}],", radius * angle.cos(), radius * angle.sin())
        };
        (0..CORNERS).map(corner).collect()
    };
    let text = format!(
        "name = \"rotunda\"\n[workspace]\nboundary = [{}]\nholes = [[{}]]\n\
         [link]\nfull_range = 0.4\nmax_range = 0.5\n[[access_point]]\nposition = [1.0, 0.0]\n\
         [[robot]]\nposition = [1.2, 0.0]\n",
        round(2.0),
        round(0.5)
    );
    let begin = Instant::now();
    let scenario = parse_with(&text, Path::new("rotunda.toml"), &[]).unwrap();
    println!("read in {:?}", begin.elapsed());
    assert_eq!(scenario.workspace.boundary.len(), CORNERS as usize);
    assert!(begin.elapsed() < Duration::from_secs(60), "{:?}", begin.elapsed());
}

const CORNERS: u32 = 10_000;

/// A key that is new is tried out with the others.
#[test]
fn every_number_of_the_control_settings_is_tried_out() {
    let keys = CONTROL.iter().filter(|key| !matches!(key.values, Values::OneOf(_)));
    let stated: BTreeSet<String> = keys.map(|key| format!("control.{}", key.name)).collect();
    let tried = NUMBERS.iter().map(|(key, ..)| key.to_string());
    let tried: BTreeSet<String> = tried.filter(|key| key.starts_with("control.")).collect();
    assert_eq!(tried, stated);
}
