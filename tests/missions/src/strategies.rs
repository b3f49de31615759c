//! Missions with either strategy of the primary team.

use crate::valid;
use pleach::automaton::network::scenario::{Strategy, ValidScenario};

/// The paper's, and the eager one.
pub const BOTH: [Strategy; 2] = [Strategy::Paper, Strategy::Eager];

/// The strategy of this name.
///
/// # Errors
/// The names that there are.
pub fn named(name: &str) -> Result<Strategy, String> {
    let strategies = [("paper", Strategy::Paper), ("eager", Strategy::Eager)];
    let found = strategies.iter().find(|(known, _)| *known == name);
    found.map(|(_, strategy)| *strategy).ok_or_else(|| "there are: paper, eager".into())
}

/// The same mission with this strategy, if one is given.
pub fn following(strategy: Option<Strategy>, scenario: ValidScenario) -> ValidScenario {
    let Some(strategy) = strategy else { return scenario };
    let mut changed = scenario.scenario().clone();
    changed.control.strategy = Some(strategy);
    valid(changed)
}
