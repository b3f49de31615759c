//! Whether a mission may end because robots are too few.
//!
//! That is proved where any tree to its tasks takes more robots than there are ([`Spans`]). Otherwise the
//! record has to show that every way was tried: in the tree in which a recruit was called for last, no
//! robot could have come, and the robots of every other tree that are free have been tried before.

use std::collections::BTreeSet;

use pleach_automaton::network::record::{MissionEvent, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;
use pleach_discrete::network::Role;

use super::ledger::Ledger;
use crate::network::bound::Spans;

/// What has been tried for the task that is pursued.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tried {
    /// The access points in whose trees no recruit was left.
    trees: BTreeSet<usize>,
}

impl Tried {
    /// An event, with the ledger before it and the snapshots before and after.
    pub fn enter(&mut self, event: &MissionEvent, ledger: &Ledger, scenes: [Option<&Snapshot>; 2]) {
        match event {
            MissionEvent::TaskAnnounced { .. } | MissionEvent::TaskReannounced { .. } => {
                self.trees.clear();
            }
            MissionEvent::ElectionRepeated { .. } => {
                let trees = scenes
                    .into_iter()
                    .flatten()
                    .filter_map(|snapshot| tree_of(*ledger.primary_team.first()?, snapshot));
                self.trees.extend(trees);
            }
            _ => {}
        }
    }

    /// A robot that could have helped where the mission ended because none could, in a clause.
    pub fn overlooked(&self, ledger: &Ledger, snapshot: &Snapshot) -> Option<String> {
        let caller = *ledger.primary_team.first()?;
        let tree = tree_of(caller, snapshot)?;
        let is_free = |robot: &usize| snapshot.roles[*robot] == Role::Redundant;
        let robots = 0..snapshot.roles.len();
        for robot in robots.filter(is_free) {
            match tree_of(robot, snapshot) {
                Some(own) if own == tree => {
                    return Some(format!(
                        "robot {robot} is redundant, and in the tree of robot {caller}, which calls"
                    ));
                }
                Some(own) if !self.trees.contains(&own) => {
                    return Some(format!(
                        "robot {robot} is redundant, and the tree of access point {own} was not tried"
                    ));
                }
                _ => {}
            }
        }
        let bearer = parent_of(caller, snapshot).filter(|&node| node < snapshot.roles.len())?;
        let children = snapshot.tree.iter().filter(|(_, parent)| *parent == bearer);
        let bears_caller_alone = children.map(|(child, _)| *child).eq([caller]);
        let may_join = snapshot.roles[bearer] == Role::Node && !ledger.awaits_release;
        (may_join && bears_caller_alone).then(|| {
            format!(
                "robot {bearer} bears nothing but robot {caller}, which calls, and did not join it"
            )
        })
    }
}

/// How many robots the tasks announced so far take at least, if that is more than there are.
pub fn missing(scenario: &ValidScenario, announced: usize) -> Option<usize> {
    let least = Spans::of(scenario).ok()?.least_robots(announced)?;
    (least > scenario.robot.len()).then_some(least)
}

fn parent_of(robot: usize, snapshot: &Snapshot) -> Option<usize> {
    snapshot.tree.iter().find(|(child, _)| *child == robot).map(|&(_, parent)| parent)
}

/// The access point at the root of the tree that a robot is in.
fn tree_of(robot: usize, snapshot: &Snapshot) -> Option<usize> {
    let robots = snapshot.roles.len();
    let mut node = robot;
    for _ in 0..=robots {
        node = parent_of(node, snapshot)?;
        if node >= robots {
            return Some(node - robots);
        }
    }
    None
}
