//! Trees stay trees, whatever step the protocol takes.

use pleach_discrete::network::lineage::closes_cycle;
use pleach_discrete::network::{Offers, PostId};

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
/// an access point. A lemma on trees as a model, by the functions of the judge; that robots leave only without
/// children is explored.
#[kani::proof]
#[kani::unwind(7)]
fn a_model_of_the_tree_stays_rooted_without_a_leaf() {
    let parents = any_tree();
    let (leaver, other) = (below(ROBOTS), below(ROBOTS));
    for parent in &parents {
        kani::assume(*parent != Some(leaver));
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

/// Any tree of four posts, each held by one robot: two robots exchange their duties, by the offer, the answer
/// and the conclusion of [`Offers`]. The tree of posts is as it was; the tree of robots, in which each is below
/// the one that holds the parent of its post, is rooted before and after, with as many members; and between
/// the two steps, when both robots have the post of the parked one, the tree is that of the duties in effect.
#[kani::proof]
#[kani::unwind(7)]
fn an_exchange_of_duties_keeps_the_tree() {
    let parents = any_tree();
    let (mover, parked) = (below(ROBOTS), below(ROBOTS));
    kani::assume(mover != parked);
    let mut posts = [0, 1, 2, 3];
    let (mut of_mover, mut of_parked) = (Offers::new(), Offers::new());
    of_mover.make_offer(parked, posts[mover]);
    if let Some(offer) = of_mover.offer() {
        kani::cover!();
        of_parked.answer(mover, offer, Some(posts[parked]));
    }
    let taken = of_parked.reply().and_then(|reply| of_mover.hear(mover, reply));
    posts[mover] = taken.unwrap_or(posts[mover]);
    let in_effect = of_parked.taking().copied();
    let given = of_parked.conclude(of_mover.offer(), of_mover.offers_made());
    posts[parked] = given.unwrap_or(posts[parked]);
    assert!(given.is_some() && given == in_effect);
    let mut holders = [ROBOTS; ROBOTS + 1];
    for (robot, own) in posts.iter().enumerate() {
        for (post, holder) in holders.iter_mut().enumerate() {
            if post == *own {
                kani::cover!();
                *holder = robot;
            }
        }
    }
    let mut changed = [None; ROBOTS];
    for post in 0..ROBOTS {
        assert!(holders[post] < ROBOTS);
        for (robot, parent) in changed.iter_mut().enumerate() {
            if robot == holders[post] {
                kani::cover!();
                *parent = parents[post].map(|parent| holders[parent]);
            }
        }
    }
    kani::cover!(parents[mover] == Some(parked) && parents[parked].is_some());
    kani::cover!(parents[mover].is_none() && parents[parked].is_some());
    assert!(is_rooted(&changed));
    for (post, holder) in holders.iter().take(ROBOTS).enumerate() {
        assert!(is_member(&changed, *holder) == is_member(&parents, post));
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
