//! Whether the states that robots report are those that events and methods give.

use pleach_automaton::network::record::Snapshot;
use pleach_automaton::network::scenario::RoutingMethod;

use super::ledger::Ledger;
use super::{Dispute, Scene};
use crate::network::property::Property;

/// Every change of a role is an event.
pub(super) fn roles_are_those(ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
    let mut pairs = ledger.roles.iter().zip(&snapshot.roles).enumerate();
    match pairs.find(|(_, (known, role))| known != role) {
        None => Ok(()),
        Some((robot, (known, role))) => {
            let sentence = format!(
                "robot {robot} is reported as {}, and the events make it {}",
                role.name(),
                known.name()
            );
            Err(Dispute::of(Property::RoleTransition, &[robot], sentence))
        }
    }
}

/// [`Property::Multipliers`]: of the dual methods, which project them.
pub(super) fn multipliers_are_prices(scene: &Scene) -> Result<(), Dispute> {
    let multipliers = &scene.snapshot.multipliers;
    let is_projected = scene.limits.settings().routing_method != RoutingMethod::Adal;
    match multipliers.iter().position(|&multiplier| is_projected && multiplier < 0.0) {
        None => Ok(()),
        Some(robot) => {
            let multiplier = multipliers[robot];
            let sentence = format!("the multiplier of robot {robot} is {multiplier}");
            let dispute = Dispute::of(Property::Multipliers, &[robot], sentence);
            Err(dispute.measuring(multiplier, 0.0))
        }
    }
}
