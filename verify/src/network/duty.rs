//! Duties and the roles that carry them: identities only.

use pleach_discrete::network::Role;

/// Whether a hand-over conserves the multiset of duties: each occurs as often before as after,
/// regardless of the holder.
///
/// ```
/// use pleach_verify::network::duty::are_conserved;
///
/// assert!(are_conserved(&["junction", "task 0"], &["task 0", "junction"]));
/// assert!(!are_conserved(&["junction", "task 0"], &["task 0", "task 0"]));
/// ```
pub fn are_conserved<Duty: PartialEq>(before: &[Duty], after: &[Duty]) -> bool {
    let count = |duties: &[Duty], duty: &Duty| duties.iter().filter(|held| *held == duty).count();
    before.len() == after.len()
        && before.iter().all(|duty| count(before, duty) == count(after, duty))
}

/// Whether at each of the `places` that must not be left, those of junctions and serviced tasks,
/// a robot stands.
///
/// ```
/// use pleach_verify::network::duty::are_occupied;
///
/// let (junction, task) = (3, 5);
/// assert!(are_occupied(&[junction, task], &[5, 3, 4]));
/// assert!(!are_occupied(&[junction, task], &[4, 5])); // the junction has been left
/// ```
pub fn are_occupied<Place: PartialEq>(places: &[Place], robots: &[Place]) -> bool {
    places.iter().all(|place| robots.contains(place))
}

/// Which roles may follow one another, over one or several transitions.
pub type RoleRelation = [[bool; Role::ALL.len()]; Role::ALL.len()];

/// The reflexive and transitive closure of the table's transitions (Warshall's algorithm):
/// what an observer may see from one snapshot to the next, several jumps lying between.
pub fn closure(is_allowed: impl Fn(Role, Role) -> bool) -> RoleRelation {
    let mut relation = Role::ALL.map(|from| Role::ALL.map(|to| from == to || is_allowed(from, to)));
    for middle in 0..relation.len() {
        for from in 0..relation.len() {
            for to in 0..relation.len() {
                relation[from][to] |= relation[from][middle] && relation[middle][to];
            }
        }
    }
    relation
}

/// Whether `to` can follow `from` by the relation.
pub fn is_reachable(relation: &RoleRelation, from: Role, to: Role) -> bool {
    relation[from as usize][to as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closure_passes_through_and_does_not_turn_back() {
        let chain = |from: Role, to: Role| from as usize + 1 == to as usize;
        let relation = closure(chain);
        for from in Role::ALL {
            for to in Role::ALL {
                assert_eq!(is_reachable(&relation, from, to), from <= to, "{from:?} {to:?}");
            }
        }
    }

    #[test]
    fn a_duty_is_neither_lost_nor_doubled() {
        assert!(are_conserved(&[1, 2, 2], &[2, 1, 2]));
        assert!(!are_conserved(&[1, 2], &[2]));
        assert!(!are_conserved(&[2], &[1, 2]));
        assert!(!are_conserved(&[1, 2, 2], &[1, 1, 2]));
        assert!(are_conserved::<u8>(&[], &[]));
    }
}
