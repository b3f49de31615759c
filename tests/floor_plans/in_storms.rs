//! Missions in storms of all kinds, in shipped scenarios and on the floor plans of every day in turn.

use std::path::Path;

use pleach::automaton::network::scenario::ValidScenario;
use pleach::scenario_file;
use pleach::verify::network::storm::{Kind, Storm, allowing_for, draw};

use super::{Family, scenario as plan};

/// Scenarios that are tried in storms beside random ones.
pub const SHIPPED: [&str; 5] = ["study-1", "study-2", "office", "discs", "corridor"];
/// Seconds for which a mission is taken to last when its faults are drawn.
pub const DURATION: f64 = 300.0;

/// A shipped scenario.
pub fn shipped(name: &str) -> ValidScenario {
    let path = format!("{}/scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    scenario_file::read(Path::new(&path)).unwrap_or_else(|error| panic!("{error}"))
}

/// The mission of a seed, and its storm: kinds and plans take turns.
pub fn mission_in_storm(seed: u64) -> (ValidScenario, Storm) {
    let kinds = Kind::ALL.len();
    mission_of_turn(seed as usize / kinds, Kind::ALL[seed as usize % kinds], seed)
}

/// The mission on the plan whose turn it is, in a storm of this kind.
pub fn mission_of_turn(turn: usize, kind: Kind, seed: u64) -> (ValidScenario, Storm) {
    let families: Vec<Family> = Family::of_every_day().collect();
    let scenario = match turn % (SHIPPED.len() + families.len()) {
        number if number < SHIPPED.len() => shipped(SHIPPED[number]),
        number => plan(families[number - SHIPPED.len()], seed),
    };
    // Where there is no room for errors, robots do not allow for them, and there are none.
    match allowing_for(kind, &scenario) {
        Ok(scenario) => {
            let storm = draw(kind, seed, &scenario, DURATION);
            (scenario, storm)
        }
        Err(_) => (scenario, Storm::default()),
    }
}

/// How many missions are asked for.
///
/// # Errors
/// What may be asked for.
pub fn missions(text: &str) -> Result<u64, String> {
    count(text).map_err(|error| {
        format!("{error}: how many missions are to be run; or it is one of seed, one and table")
    })
}

/// A number of missions or storms.
///
/// # Errors
/// Which numbers are possible.
pub fn count(text: &str) -> Result<u64, String> {
    text.parse()
        .ok()
        .filter(|&count| count > 0)
        .ok_or_else(|| format!("a whole number from 1 to {} is expected", u64::MAX))
}

/// A seed.
///
/// # Errors
/// Which numbers are possible.
pub fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("a whole number from 0 to {} is expected", u64::MAX))
}
