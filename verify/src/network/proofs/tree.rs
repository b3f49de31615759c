//! Trees stay trees, whatever step the protocol takes.

use pleach_discrete::network::PostId;
use pleach_discrete::network::lineage::closes_cycle;

use super::below;
use crate::network::tree::{
    descends_from, is_acyclic, is_rooted, leads_to_access_point, mark_connected, parents_of,
};

/// Robots; the access point has the next number.
const ROBOTS: usize = 4;

/// Any parent: a robot, the access point, or none.
fn any_parent() -> Option<usize> {
    let code = below(ROBOTS + 2);
    (code <= ROBOTS).then_some(code)
}

/// Any tree of four robots below one access point, of which some may not belong to it.
fn any_tree() -> [Option<usize>; ROBOTS] {
    let parents = [any_parent(), any_parent(), any_parent(), any_parent()];
    kani::assume(is_rooted(&parents));
    parents
}

/// Whether a node is in the tree.
fn is_member(parents: &[Option<usize>; ROBOTS], node: usize) -> bool {
    node == ROBOTS || parents[node].is_some()
}

/// The lineage that a node tells: itself and the posts above it.
///
/// Robots stand for their posts. The places after the length are not part of the way.
fn lineage(parents: &[Option<usize>; ROBOTS], node: usize) -> ([PostId; ROBOTS], usize) {
    let (mut way, mut hops, mut node) = ([PostId(0); ROBOTS], 0, node);
    for place in &mut way {
        if node == ROBOTS {
            break;
        }
        *place = PostId(node as u32);
        hops += 1;
        node = parents[node].unwrap_or(ROBOTS);
    }
    (way, hops)
}

/// Any tree of four robots; a robot, in the tree or not, attaches to a member whose lineage
/// does not contain it: the tree stays a tree, and all nodes stay in it. If the lineage contains
/// the robot, the step would close a cycle.
///
/// Assumes that the lineage is the way as it is; late ones are explored in `exploration`.
#[kani::proof]
#[kani::unwind(7)]
fn a_robot_that_avoids_its_own_lineage_keeps_the_tree() {
    let parents = any_tree();
    let (robot, parent) = (below(ROBOTS), below(ROBOTS + 1));
    kani::assume(is_member(&parents, parent));
    let (way, hops) = lineage(&parents, parent);
    let closes = closes_cycle(&way[..hops], PostId(robot as u32));
    let mut changed = parents;
    changed[robot] = Some(parent);
    kani::cover!(!closes && hops == 3 && parents[robot].is_some());
    kani::cover!(closes && hops == 4);
    assert!(is_rooted(&changed) != closes);
    assert!(closes == (parent == robot || descends_from(&parents, parent, robot)));
    assert!(closes || is_acyclic(&changed));
}

/// Any tree of four robots: one without children may leave, and all others still come to
/// an access point.
#[kani::proof]
#[kani::unwind(7)]
fn a_robot_without_children_may_leave() {
    let parents = any_tree();
    let (leaver, other) = (below(ROBOTS), below(ROBOTS));
    for parent in parents {
        kani::assume(parent != Some(leaver));
    }
    let mut changed = parents;
    changed[leaver] = None;
    kani::cover!(parents[leaver].is_some() && other != leaver && parents[other].is_some());
    assert!(is_rooted(&changed));
    assert!(
        other == leaver
            || leads_to_access_point(&changed, other) == leads_to_access_point(&parents, other)
    );
}

/// Any tree of four robots: two of them exchange their duties, and with them their places in the
/// tree. It stays a tree with the same number of members.
#[kani::proof]
#[kani::unwind(7)]
fn an_exchange_of_duties_keeps_the_tree() {
    let parents = any_tree();
    let (one, other) = (below(ROBOTS), below(ROBOTS));
    let exchanged = |node: usize| match node {
        _ if node == one => other,
        _ if node == other => one,
        _ => node,
    };
    let mut changed = [None; ROBOTS];
    for (robot, parent) in parents.into_iter().enumerate() {
        changed[exchanged(robot)] = parent.map(exchanged);
    }
    kani::cover!(parents[one] == Some(other) && parents[other].is_some());
    kani::cover!(parents[one].is_none() && parents[other].is_some());
    assert!(is_rooted(&changed));
    for robot in 0..ROBOTS {
        assert!(is_member(&changed, exchanged(robot)) == is_member(&parents, robot));
    }
}

/// Any three edges between four robots and an access point: they are taken as parents exactly
/// if no robot has two, and then each edge is.
#[kani::proof]
#[kani::unwind(7)]
fn edges_give_parents_unless_a_robot_has_two() {
    let edge = || (below(ROBOTS), below(ROBOTS + 1));
    let edges = [edge(), edge(), edge()];
    let mut parents = [None; ROBOTS];
    let outcome = parents_of(&edges, &mut parents);
    let twice = edges[0].0 == edges[1].0 || edges[0].0 == edges[2].0 || edges[1].0 == edges[2].0;
    kani::cover!(outcome.is_ok() && is_rooted(&parents));
    kani::cover!(outcome.is_ok() && !is_rooted(&parents));
    assert!(outcome.is_err() == twice);
    for (child, parent) in edges {
        assert!(twice || parents[child] == Some(parent));
    }
}

/// Any four directed links between three robots and an access point: those are marked connected
/// from which a way of links leads to the access point.
#[kani::proof]
#[kani::unwind(6)]
fn the_connected_are_those_with_a_way_out() {
    const NODES: usize = 4;
    let link = || (below(NODES - 1), below(NODES));
    let links = [link(), link(), link(), link()];
    let mut connected = [false; NODES - 1];
    mark_connected(&links, &mut connected);
    let mut reaches = [[false; NODES]; NODES];
    for (from, to) in links {
        reaches[from][to] = true;
    }
    for middle in 0..NODES {
        for from in 0..NODES {
            for to in 0..NODES {
                reaches[from][to] |= reaches[from][middle] && reaches[middle][to];
            }
        }
    }
    kani::cover!(connected[0] && !connected[1] && connected[2]);
    for robot in 0..NODES - 1 {
        assert!(connected[robot] == reaches[robot][NODES - 1]);
    }
}
