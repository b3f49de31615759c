//! What an observer may see of a robot's role.

use pleach_discrete::Event;
use pleach_discrete::network::{ROLES, Role, RoleEvent};

use super::below;
use crate::network::duty::{closure, is_reachable};

/// Any role, any three events: where the table leads, over one or several transitions, an observer
/// may see the robot turn; and every role may follow every other.
#[kani::proof]
#[kani::unwind(36)]
fn an_observer_may_see_what_the_table_allows() {
    let relation =
        closure(|from, to| ROLES.rows().iter().any(|row| row.source == from && row.target == to));
    let start = Role::ALL[below(Role::ALL.len())];
    let mut role = start;
    for _ in 0..3 {
        let event = RoleEvent::ALL[below(RoleEvent::ALL.len())];
        if let Ok(next) = ROLES.next(role, event) {
            role = next;
        }
        assert!(is_reachable(&relation, start, role));
    }
    kani::cover!(start == Role::Leaf && role == Role::Redundant);
    assert!(is_reachable(&relation, role, start));
}
