//! Random missions on floor plans to which the robots are not tuned.
//!
//! A [`Family`] and a seed give a [`ValidScenario`], always the same one. Its tasks can be reached, and it has more
//! robots than a tree of shortest paths to its tasks needs.

mod brief;
mod dice;
mod edge_settings;
mod families;
mod outline;
mod places;
mod small_rooms;

pub use dice::Dice;
pub use edge_settings::edge_settings;
pub use families::Family;
pub use small_rooms::small_room;

use pleach::automaton::network::scenario::ValidScenario;

/// Drafts that may fail (a crowd that finds no room, walls that meet) before a family is at fault.
const ATTEMPTS: u64 = 200;

/// The mission of `family` with this seed.
pub fn scenario(family: Family, seed: u64) -> ValidScenario {
    let name = format!("{}-{seed}", family.name());
    (0..ATTEMPTS)
        .filter_map(|attempt| {
            let mut dice = Dice::new(&[family as u64, seed, attempt]);
            let brief = family.brief(&mut dice);
            brief.scenario(name.clone(), &mut dice)
        })
        .find_map(|scenario| ValidScenario::new(scenario).ok())
        .unwrap_or_else(|| panic!("{name}: none of {ATTEMPTS} drafts is a valid scenario"))
}
