//! The algebra of the teams of Sec. V: primary team, path Σ, break points, subgroups, active
//! team. Identities only, on small slices, with bounded loops and without allocation.

use pleach_discrete::network::Role;

/// Whether at most one robot is the leader.
pub fn has_at_most_one_leader(roles: &[Role]) -> bool {
    roles.iter().filter(|&&role| role == Role::Leader).count() <= 1
}

/// Whether a leader, if there is one, is the last of the primary team; and, if that team is
/// `active`, whether its last robot is the leader (Sec. V-A3).
///
/// A robot elected while it has another duty is no leader yet: it becomes one when it is
/// released (L_b = 1), before the team moves.
pub fn leader_comes_last(roles: &[Role], primary_team: &[usize], active: bool) -> bool {
    let last = primary_team.last().copied();
    let led = last.is_some_and(|robot| roles.get(robot) == Some(&Role::Leader));
    let mut numbered = roles.iter().enumerate();
    numbered.all(|(robot, role)| *role != Role::Leader || last == Some(robot)) && (led || !active)
}

/// Whether a team is a subgroup of Σ as far as Σ alone tells: robots that follow each other on
/// the path, without its last one (p₁, or the leader to be released).
pub fn is_run_of_path(team: &[usize], path: &[usize]) -> bool {
    let Some((_, before_last)) = path.split_last() else { return false };
    !team.is_empty() && before_last.windows(team.len()).any(|run| are_same(run, team))
}

/// Robot by robot, which a model checker follows better than a comparison of memory.
fn are_same(one: &[usize], other: &[usize]) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| one == other)
}

/// Whether the active team 𝒜 is one team: empty, the primary team, or a subgroup of Σ
/// (Sec. V-C, Algorithm 3).
///
/// ```
/// use pleach_verify::network::team::is_one_team;
///
/// let (primary_team, path) = ([7, 8], [1, 2, 3, 7]);
/// assert!(is_one_team(&[7, 8], &primary_team, &path));
/// assert!(is_one_team(&[1, 2], &primary_team, &path));
/// assert!(!is_one_team(&[1, 3], &primary_team, &path)); // 2 stands between them
/// assert!(!is_one_team(&[3, 7], &primary_team, &path)); // p₁ does not move
/// ```
pub fn is_one_team(active_team: &[usize], primary_team: &[usize], path: &[usize]) -> bool {
    active_team.is_empty()
        || are_same(active_team, primary_team)
        || is_run_of_path(active_team, path)
}

/// Whether one team is active: every robot that moves is in it, be it the primary team or a subgroup
/// of Σ, and no robot of the other teams moves. Where no robot moves, no two teams do.
///
/// ```
/// use pleach_verify::network::team::exactly_one_is_active;
///
/// let (primary_team, subgroups): (_, [&[usize]; 2]) = ([7, 8], [&[1, 2], &[3]]);
/// assert!(exactly_one_is_active(&[2], &primary_team, &subgroups));
/// assert!(!exactly_one_is_active(&[2, 3], &primary_team, &subgroups)); // two subgroups
/// assert!(!exactly_one_is_active(&[3, 8], &primary_team, &subgroups)); // both kinds of team
/// assert!(!exactly_one_is_active(&[5], &primary_team, &subgroups)); // in no team
/// ```
pub fn exactly_one_is_active(
    moving: &[usize],
    primary_team: &[usize],
    subgroups: &[&[usize]],
) -> bool {
    let moves_alone = |team: &[usize]| moving.iter().all(|robot| team.contains(robot));
    moves_alone(primary_team) || subgroups.iter().any(|team| moves_alone(team))
}

/// Whether Σ without its last robot and the primary team have no robot in common.
pub fn teams_are_disjoint(path: &[usize], primary_team: &[usize]) -> bool {
    let Some((_, secondary_team)) = path.split_last() else { return true };
    secondary_team.iter().all(|robot| !primary_team.contains(robot))
}

/// Whether no robot occurs twice on a path or in a team.
pub fn has_no_repetition(robots: &[usize]) -> bool {
    (1..robots.len()).all(|place| !robots[..place].contains(&robots[place]))
}

/// Whether the break points 𝓑 divide Σ: they occur on it in its order, the first is the
/// recruit s₁, and the last is the last robot that is replaced or joins the primary team:
/// that is the last of Σ (the leader, L_b = 1) or the one before it (p₁ being the last,
/// L_b = 0).
pub fn break_points_divide(path: &[usize], break_points: &[usize]) -> bool {
    let mut rest = path;
    for (index, point) in break_points.iter().enumerate() {
        let Some(place) = rest.iter().position(|robot| robot == point) else { return false };
        if index == 0 && place != 0 {
            return false;
        }
        rest = &rest[place + 1..];
    }
    !break_points.is_empty() && rest.len() <= 1
}

/// Whether the subgroups partition Σ before the last break point: put one behind the other
/// they are that part of the path, each begins with its break point, S_β = [b_β, b_{β+1})_Σ
/// (Sec. V-B2), and there is one fewer than there are break points.
///
/// With L_b = 1 the last break point is the last of Σ: the subgroups then partition Σ without
/// its last robot.
///
/// ```
/// use pleach_verify::network::team::subgroups_partition;
///
/// let (path, break_points) = ([4, 2, 9, 5], [4, 9, 5]);
/// assert!(subgroups_partition(&path, &break_points, &[&[4, 2], &[9]]));
/// assert!(!subgroups_partition(&path, &break_points, &[&[4], &[2, 9]]));
/// ```
pub fn subgroups_partition(path: &[usize], break_points: &[usize], subgroups: &[&[usize]]) -> bool {
    let Some((end, starts)) = break_points.split_last() else { return subgroups.is_empty() };
    if starts.len() != subgroups.len() {
        return false;
    }
    let mut rest = path;
    for (start, subgroup) in starts.iter().zip(subgroups) {
        if subgroup.first() != Some(start) {
            return false;
        }
        match rest.split_at_checked(subgroup.len()) {
            Some((front, behind)) if are_same(front, subgroup) => rest = behind,
            _ => return false,
        }
    }
    rest.first() == Some(end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Role::{Leader, Leaf, Node};

    #[test]
    fn a_second_leader_is_one_too_many() {
        assert!(has_at_most_one_leader(&[Node, Leader]));
        assert!(!has_at_most_one_leader(&[Leader, Node, Leader]));
    }

    #[test]
    fn the_leader_heads_its_team() {
        assert!(leader_comes_last(&[Node, Leader, Node], &[0, 1], true));
        assert!(!leader_comes_last(&[Leader, Node, Node], &[0, 1], true));
        assert!(!leader_comes_last(&[Node, Leader], &[], false));
        assert!(leader_comes_last(&[Node, Leaf], &[1], false));
        assert!(!leader_comes_last(&[Node, Leaf], &[1], true));
    }

    #[test]
    fn a_subgroup_has_members_that_follow_each_other() {
        assert!(is_run_of_path(&[2, 9], &[4, 2, 9, 5]));
        assert!(!is_run_of_path(&[9, 2], &[4, 2, 9, 5]));
        assert!(!is_run_of_path(&[], &[4, 2, 9, 5]));
        assert!(!is_run_of_path(&[4], &[]));
    }

    #[test]
    fn the_secondary_team_is_apart_from_the_primary() {
        assert!(teams_are_disjoint(&[1, 2, 7], &[7, 8]));
        assert!(!teams_are_disjoint(&[1, 8, 7], &[7, 8]));
        assert!(teams_are_disjoint(&[], &[7]));
    }

    #[test]
    fn a_robot_is_named_once() {
        assert!(has_no_repetition(&[3, 1, 2]));
        assert!(!has_no_repetition(&[3, 1, 3]));
    }

    #[test]
    fn break_points_stand_in_the_order_of_the_path() {
        let path = [4, 2, 9, 5];
        assert!(break_points_divide(&path, &[4, 9, 5]));
        assert!(break_points_divide(&path, &[4, 9]));
        assert!(!break_points_divide(&path, &[4, 2]));
        assert!(!break_points_divide(&path, &[4, 5, 9]));
        assert!(!break_points_divide(&path, &[2, 9]));
        assert!(!break_points_divide(&path, &[]));
    }

    #[test]
    fn subgroups_of_every_small_path_partition_it_in_exactly_one_way() {
        let path = [5, 3, 8, 1, 6];
        // Every choice of break points among the middle three, and of cuts.
        for chosen in 0_u32..8 {
            let cut_at = |mask: u32| -> Vec<usize> {
                let middle = (1..4).filter(|place| mask >> (place - 1) & 1 == 1);
                [0].into_iter().chain(middle).chain([4]).collect()
            };
            let break_points: Vec<_> = cut_at(chosen).iter().map(|&place| path[place]).collect();
            for cuts in 0..8 {
                let places = cut_at(cuts);
                let subgroups: Vec<_> =
                    places.windows(2).map(|pair| &path[pair[0]..pair[1]]).collect();
                let partitions = subgroups_partition(&path, &break_points, &subgroups);
                assert_eq!(partitions, cuts == chosen, "{break_points:?} {subgroups:?}");
            }
        }
        assert!(!subgroups_partition(&path, &[5, 6], &[&[5, 3]]), "a gap before the last");
    }

    #[test]
    fn the_subgroups_that_the_robots_form_partition_the_path() {
        use pleach_discrete::network::path::subgroups;

        let path = [5, 3, 8, 1, 6];
        for chosen in 0_u32..16 {
            // The recruit, and any of the other places.
            let others = (1..path.len()).filter(|place| chosen >> (place - 1) & 1 == 1);
            let places: Vec<_> = [0].into_iter().chain(others).collect();
            let break_points: Vec<_> = places.iter().map(|&place| path[place]).collect();
            let formed: Vec<_> = subgroups(&places).map(|group| &path[group.places()]).collect();
            assert!(subgroups_partition(&path, &break_points, &formed), "{break_points:?}");
        }
    }
}
