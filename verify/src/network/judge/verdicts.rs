//! Whether a mission may end because robots are too few.
//!
//! That is proved where any tree to its tasks takes more robots than there are ([`Spans`]). Otherwise the
//! record has to show that every way was tried: in the tree in which a recruit was called for last, no
//! robot could have come, and the robots of every other tree that are free have been tried before.

use std::collections::BTreeSet;

use pleach_automaton::network::certificate::Then;
use pleach_automaton::network::record::{MissionEvent, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;
use pleach_discrete::network::Role;

use super::ledger::{Ledger, Stage};
use super::terms::all_stay;
use crate::network::bound::Spans;

/// What has been tried for the task that is pursued.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Tried {
    /// The access points in whose trees no recruit was left.
    trees: BTreeSet<usize>,
    /// The access point in whose tree the leader was elected: those of its robots that are left were asked then.
    led_from: Option<usize>,
    /// The calls that no robot could answer.
    trials: Vec<Trial>,
}

/// A call for a recruit that no robot could answer.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Trial {
    /// The robot that called.
    pub caller: usize,
    /// Its team.
    pub team: Vec<usize>,
    /// The access point in whose tree its leader was elected.
    pub led_from: Option<usize>,
    /// Whether the leader was to be released.
    pub releases_leader: bool,
    /// Whether links were stretched already.
    pub stretched: bool,
    /// What came of it.
    pub then: Then,
    /// The last instant before it was given up.
    pub snapshot: Snapshot,
}

impl Tried {
    /// An event, with the ledger before it and the snapshots before and after.
    pub(super) fn enter(
        &mut self,
        event: &MissionEvent,
        ledger: &Ledger,
        scenes: [Option<&Snapshot>; 2],
    ) {
        match event {
            MissionEvent::TaskAnnounced { .. }
            | MissionEvent::TaskReannounced { .. }
            | MissionEvent::TaskGivenUp { .. } => {
                *self = Tried::default();
            }
            MissionEvent::LeaderElected { robot, .. } => {
                let mut scenes = scenes.into_iter().flatten();
                self.led_from = scenes.find_map(|snapshot| tree_of(*robot, snapshot));
            }
            MissionEvent::ElectionRepeated { .. } => {
                let trees = scenes
                    .into_iter()
                    .flatten()
                    .filter_map(|snapshot| tree_of(*ledger.primary_team.first()?, snapshot));
                self.trees.extend(trees.chain(self.led_from));
                self.note(ledger, scenes[0], Then::ElectionRepeated);
            }
            // Robots of trees that have been asked before can come where links are longer.
            MissionEvent::LinksStretched { .. } => {
                self.trees.clear();
                self.note(ledger, scenes[0], Then::LinksStretched);
            }
            _ => {}
        }
    }

    fn note(&mut self, ledger: &Ledger, before: Option<&Snapshot>, then: Then) {
        self.trials.extend(before.and_then(|before| self.trial(ledger, before, then)));
    }

    /// The call that is under way by the ledger, given up after this instant; none if no robot calls.
    pub(super) fn trial(&self, ledger: &Ledger, snapshot: &Snapshot, then: Then) -> Option<Trial> {
        let caller = *ledger.primary_team.first()?;
        (ledger.stage() == Stage::Calling).then(|| Trial {
            caller,
            team: ledger.primary_team.clone(),
            led_from: self.led_from,
            releases_leader: ledger.awaits_release,
            stretched: ledger.stretched,
            then,
            snapshot: snapshot.clone(),
        })
    }

    /// The calls that no robot could answer since the task was announced, but for one that ended the mission.
    pub(super) fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// A robot that could have helped where the mission ended because none could, in a clause.
    pub(super) fn overlooked(&self, ledger: &Ledger, snapshot: &Snapshot) -> Option<String> {
        let caller = *ledger.primary_team.first()?;
        if ledger.stage() != Stage::Calling {
            return Some(format!("robot {caller}, the first of its team, has not called for one"));
        }
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
                Some(own) if self.led_from != Some(own) && !self.trees.contains(&own) => {
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

/// How many robots these tasks take at least, if that is more than there are; none where some of them may be over
/// before the last is announced.
pub(super) fn missing(scenario: &ValidScenario, tasks: &[usize]) -> Option<usize> {
    if !all_stay(scenario, tasks) {
        return None;
    }
    let least = Spans::as_the_crow_flies(scenario).least_robots(tasks)?;
    (least > scenario.robot.len()).then_some(least)
}

/// The parent of a robot in the tree, as a node.
pub(super) fn parent_of(robot: usize, snapshot: &Snapshot) -> Option<usize> {
    snapshot.tree.iter().find(|(child, _)| *child == robot).map(|&(_, parent)| parent)
}

/// The access point at the root of the tree that a robot is in.
pub(super) fn tree_of(robot: usize, snapshot: &Snapshot) -> Option<usize> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::sample;

    /// Robot 1 leads alone and calls for a recruit; robot 0 services task 0.
    fn calling() -> Ledger {
        let mut ledger = Ledger::new(4);
        ledger.announced = [0, 1].into();
        ledger.serviced.insert(0, 0);
        (ledger.leader, ledger.primary_team, ledger.calls) = (Some(1), vec![1], true);
        ledger
    }

    fn overlooked(ledger: &Ledger, change: impl Fn(&mut Snapshot)) -> Option<String> {
        let mut snapshot = sample::snapshot(3);
        snapshot.roles[2] = Role::Node;
        change(&mut snapshot);
        Tried::default().overlooked(ledger, &snapshot)
    }

    #[test]
    fn where_no_robot_could_come_none_is_overlooked() {
        assert_eq!(overlooked(&calling(), |_| ()), None);
    }

    #[test]
    fn an_end_without_a_call_is_refuted() {
        let advancing = Ledger { calls: false, ..calling() };
        let found = overlooked(&advancing, |_| ()).unwrap();
        assert!(found.contains("robot 1, the first of its team, has not called"), "{found}");
    }

    #[test]
    fn a_redundant_robot_of_the_same_tree_is_told() {
        let found = overlooked(&calling(), |now| now.roles[2] = Role::Redundant).unwrap();
        assert!(found.contains("robot 2 is redundant, and in the tree of robot 1"), "{found}");
    }

    /// Node 5 is another access point.
    #[test]
    fn a_redundant_robot_of_another_tree_is_told_until_that_is_tried() {
        let mut snapshot = sample::snapshot(3);
        snapshot.tree.retain(|(child, _)| *child != 2);
        snapshot.tree.push((2, 5));
        let found = Tried::default().overlooked(&calling(), &snapshot).unwrap();
        assert!(found.contains("the tree of access point 1 was not tried"), "{found}");
        let mut tried = Tried::default();
        let elsewhere = Ledger { primary_team: vec![2], ..calling() };
        let repeated = MissionEvent::ElectionRepeated { task: 1 };
        tried.enter(&repeated, &elsewhere, [None, Some(&snapshot)]);
        assert_eq!(tried.overlooked(&calling(), &snapshot), None);
        tried.enter(&MissionEvent::TaskAnnounced { task: 1 }, &calling(), [None, None]);
        assert!(tried.overlooked(&calling(), &snapshot).is_some());
    }

    #[test]
    fn a_node_that_bears_the_caller_alone_is_told() {
        let bears = |now: &mut Snapshot| now.tree = vec![(0, 4), (1, 3), (2, 4), (3, 4)];
        let found = overlooked(&calling(), bears).unwrap();
        assert!(found.contains("robot 3 bears nothing but robot 1"), "{found}");
        let bound = Ledger { awaits_release: true, ..calling() };
        assert_eq!(overlooked(&bound, bears), None);
        let is_junction = |now: &mut Snapshot| {
            bears(now);
            now.tree[2] = (2, 3);
        };
        assert_eq!(overlooked(&calling(), is_junction), None);
    }
}
