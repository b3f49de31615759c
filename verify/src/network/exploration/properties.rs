//! What is to hold in every state of the protocol, and where every mission leads.

use pleach_automaton::network::Robot;
use pleach_automaton::network::beacon::Notice;
use pleach_automaton::network::duty::Duty;
use pleach_discrete::network::{Phase, PostKind, Role};

use super::protocol::{Protocol, State};
use crate::exploration::Property;
use crate::network::{team, tree};

/// The properties that hold in every state.
pub const ALWAYS: &[Property<Protocol>] = &[
    Property { name: "the tree is rooted", holds: tree_is_rooted },
    Property { name: "every robot on duty is in the tree", holds: everyone_on_duty_is_in_the_tree },
    Property { name: "at most one robot leads", holds: one_robot_leads },
    Property { name: "serviced tasks are held", holds: serviced_tasks_are_held },
    Property { name: "no task is held twice for good", holds: no_task_is_held_twice },
    Property { name: "subgroups agree", holds: subgroups_agree },
    Property { name: "elections agree", holds: elections_agree },
    Property { name: "posts have holders", holds: bearing_posts_have_holders },
];

fn parents(protocol: &Protocol, state: &State) -> Vec<Option<usize>> {
    protocol.robots(state).map(Robot::tree_parent).collect()
}

/// From parent to parent, every robot that has one comes to an access point.
fn tree_is_rooted(protocol: &Protocol, state: &State) -> bool {
    tree::is_rooted(&parents(protocol, state))
}

fn everyone_on_duty_is_in_the_tree(protocol: &Protocol, state: &State) -> bool {
    let parents = parents(protocol, state);
    let mut robots = protocol.robots(state).zip(&parents);
    robots.all(|(robot, &parent)| tree::is_member_unless_redundant(robot.role(), parent))
}

fn one_robot_leads(protocol: &Protocol, state: &State) -> bool {
    let roles: Vec<Role> = protocol.robots(state).map(Robot::role).collect();
    team::has_at_most_one_leader(&roles)
}

/// The tasks that are known to be serviced: those before the newest one announced.
fn serviced(protocol: &Protocol, state: &State) -> usize {
    protocol
        .locals(state)
        .map(|local| match local.notice() {
            Notice::Task { task, .. } => *task,
            Notice::Serviced { task } => task + 1,
            _ => 0,
        })
        .max()
        .unwrap_or_default()
}

fn holders(protocol: &Protocol, state: &State, task: usize) -> usize {
    let holds = |robot: &Robot| robot.duty().post().is_some_and(|post| post.task == Some(task));
    protocol.robots(state).filter(|robot| holds(robot)).count()
}

fn serviced_tasks_are_held(protocol: &Protocol, state: &State) -> bool {
    (0..serviced(protocol, state)).all(|task| holders(protocol, state, task) > 0)
}

fn no_task_is_held_twice(protocol: &Protocol, state: &State) -> bool {
    let is_handing_over = protocol.robots(state).any(|robot| {
        robot.beacon().reply.is_some_and(|reply| reply.accepted.is_some())
            || matches!(robot.duty(), Duty::Wait { .. } | Duty::Shift { .. })
    });
    is_handing_over
        || (0..serviced(protocol, state)).all(|task| holders(protocol, state, task) < 2)
}

/// All robots that know the break points of the same path know the same.
fn subgroups_agree(protocol: &Protocol, state: &State) -> bool {
    let known: Vec<_> = protocol
        .robots(state)
        .filter(|robot| robot.phase() == Phase::Shift)
        .filter_map(|robot| Some((robot.beacon().agreement?.number(), robot.subgroups().to_vec())))
        .collect();
    known.iter().all(|(number, groups)| {
        known.iter().all(|(other, others)| number != other || groups == others)
    })
}

/// Who knows all tokens of an election knows the same winner.
fn elections_agree(protocol: &Protocol, state: &State) -> bool {
    let over: Vec<_> = protocol
        .robots(state)
        .filter(|robot| robot.phase() != Phase::LeaderElection || true)
        .filter_map(|robot| robot.concluded_election())
        .collect();
    over.iter().all(|(number, best)| over.iter().all(|(n, b)| n != number || b == best))
}

/// A post on which a fixed one or one of the primary team hangs has a holder, or is that of a
/// robot on its way along Σ.
fn bearing_posts_have_holders(protocol: &Protocol, state: &State) -> bool {
    let posts: Vec<_> =
        protocol.robots(state).filter_map(|robot| robot.duty().post().copied()).collect();
    let is_shifting =
        protocol.robots(state).any(|robot| matches!(robot.duty(), Duty::Shift { .. }));
    is_shifting
        || posts.iter().filter(|post| post.kind != PostKind::Redundant).all(|post| {
            match post.parent {
                Some(pleach_discrete::network::Anchor::Post(parent)) => {
                    posts.iter().any(|other| other.id == parent)
                }
                _ => true,
            }
        })
}

/// Whether the mission has ended, one way or another, and every robot knows.
pub fn has_ended(protocol: &Protocol, state: &State) -> bool {
    protocol.robots(state).all(|robot| robot.phase() == Phase::Ended)
}
