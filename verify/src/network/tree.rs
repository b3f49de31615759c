//! The tree and the communication network as graphs: identities only, no coordinates.
//!
//! Nodes are numbered as in a snapshot: robots 0 … N−1, then access points. Everything here
//! works on small slices with bounded loops and allocates nothing, so that a model checker can
//! run the same functions as the monitor.

use pleach_discrete::network::Role;

/// Writes the parent of every robot, from edges (child, parent).
///
/// `parents` has one element per robot. Edges of children that are no robots are skipped.
///
/// # Errors
///
/// The robot that has two parents.
///
/// ```
/// use pleach_verify::network::tree::parents_of;
///
/// let mut parents = [None; 3];
/// assert_eq!(parents_of(&[(0, 3), (1, 0)], &mut parents), Ok(()));
/// assert_eq!(parents, [Some(3), Some(0), None]);
/// assert_eq!(parents_of(&[(0, 3), (0, 1)], &mut parents), Err(0));
/// ```
pub fn parents_of(edges: &[(usize, usize)], parents: &mut [Option<usize>]) -> Result<(), usize> {
    parents.fill(None);
    for &(child, parent) in edges {
        match parents.get_mut(child) {
            Some(Some(_)) => return Err(child),
            Some(place) => *place = Some(parent),
            None => {}
        }
    }
    Ok(())
}

/// Whether a robot comes to an access point when it goes from parent to parent.
///
/// A path without repetition has at most N steps, so a longer one has met a cycle.
pub fn leads_to_access_point(parents: &[Option<usize>], robot: usize) -> bool {
    let mut node = robot;
    for _ in 0..=parents.len() {
        match parents.get(node) {
            None => return true,
            Some(None) => return false,
            Some(Some(parent)) => node = *parent,
        }
    }
    false
}

/// Whether every robot that has a parent comes to an access point: the edges form trees that
/// are rooted at access points, without a cycle (Def. 5.2).
pub fn is_rooted(parents: &[Option<usize>]) -> bool {
    (0..parents.len())
        .all(|robot| parents[robot].is_none() || leads_to_access_point(parents, robot))
}

/// Whether going from parent to parent never comes back, be the end an access point or not.
pub fn is_acyclic(parents: &[Option<usize>]) -> bool {
    (0..parents.len()).all(|robot| !descends_from(parents, robot, robot))
}

/// Whether `ancestor` is met when one goes up from the parent of `node`.
///
/// Hanging a robot on another parent keeps the tree a tree if that parent is neither the robot
/// itself nor descends from it.
pub fn descends_from(parents: &[Option<usize>], node: usize, ancestor: usize) -> bool {
    let mut node = node;
    for _ in 0..parents.len() {
        match parents.get(node) {
            Some(Some(parent)) if *parent == ancestor => return true,
            Some(Some(parent)) => node = *parent,
            _ => return false,
        }
    }
    false
}

/// Whether a robot is in the tree, as every robot must be that is not redundant.
pub fn is_member_unless_redundant(role: Role, parent: Option<usize>) -> bool {
    role == Role::Redundant || parent.is_some()
}

/// Marks every robot from which directed links lead to an access point.
///
/// `connected` has one element per robot; links go from sender to receiver, and a receiver that is
/// no robot is an access point. The links are swept until nothing changes: at most N + 1
/// times, in practice as often as the network is deep.
///
/// ```
/// use pleach_verify::network::tree::mark_connected;
///
/// let mut connected = [false; 3];
/// mark_connected(&[(0, 1), (1, 3), (1, 2)], &mut connected);
/// assert_eq!(connected, [true, true, false]);
/// ```
pub fn mark_connected(links: &[(usize, usize)], connected: &mut [bool]) {
    connected.fill(false);
    for _ in 0..=connected.len() {
        let mut changed = false;
        for &(from, to) in links {
            let arrives = connected.get(to).copied().unwrap_or(true);
            if let Some(mark) = connected.get_mut(from)
                && arrives
                && !*mark
            {
                *mark = true;
                changed = true;
            }
        }
        if !changed {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every assignment of parents to three robots, the access point being 3.
    fn every_forest() -> impl Iterator<Item = [Option<usize>; 3]> {
        let parent = |code: usize| if code == 4 { None } else { Some(code) };
        (0..125).map(move |code| [code % 5, code / 5 % 5, code / 25].map(parent))
    }

    /// An independent statement: the number of steps up to the root, by repeated composition.
    fn is_rooted_by_composition(parents: &[Option<usize>; 3]) -> bool {
        let up = |node: usize| if node == 3 { Some(3) } else { parents[node] };
        (0..3)
            .filter(|&robot| parents[robot].is_some())
            .all(|robot| up(robot).and_then(up).and_then(up) == Some(3))
    }

    #[test]
    fn rooted_and_acyclic_agree_with_composition_on_every_small_forest() {
        let mut rooted = 0;
        for parents in every_forest() {
            assert_eq!(is_rooted(&parents), is_rooted_by_composition(&parents), "{parents:?}");
            if is_rooted(&parents) {
                assert!(is_acyclic(&parents));
                rooted += 1;
            }
        }
        // Forests on subsets of three robots under one root: 1 + 3·1 + 3·3 + 16 (Cayley).
        assert_eq!(rooted, 29);
    }

    #[test]
    fn attaching_a_robot_elsewhere_keeps_the_tree_unless_below_itself() {
        for parents in every_forest().filter(|parents| is_rooted(parents)) {
            for robot in (0..3).filter(|&robot| parents[robot].is_some()) {
                for parent in (0..=3).filter(|&node| node == 3 || parents[node].is_some()) {
                    let mut changed = parents;
                    changed[robot] = Some(parent);
                    let below = parent == robot || descends_from(&parents, parent, robot);
                    assert_eq!(is_rooted(&changed), !below, "{parents:?} {robot} {parent}");
                }
            }
        }
    }

    #[test]
    fn links_count_in_their_direction_only() {
        let mut connected = [false; 2];
        mark_connected(&[(0, 2), (0, 1)], &mut connected);
        assert_eq!(connected, [true, false]);
        mark_connected(&[(0, 1), (1, 0)], &mut connected);
        assert_eq!(connected, [false, false]);
    }

    #[test]
    fn only_the_redundant_may_be_outside() {
        assert!(is_member_unless_redundant(Role::Redundant, None));
        assert!(!is_member_unless_redundant(Role::Recruit, None));
        assert!(is_member_unless_redundant(Role::Recruit, Some(1)));
    }
}
