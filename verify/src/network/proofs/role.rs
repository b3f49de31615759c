//! What an observer may see of a robot's role.

use pleach_discrete::network::Role;
use pleach_discrete::network::activity::may_follow;

use super::below;
use crate::network::duty::{closure, is_reachable};

/// The bound of `unwind` below: more than there are roles.
const _: () = assert!(Role::ALL.len() < 8);

/// Any role, any three changes that the table of duties allows: an observer that looks from time
/// to time may see the robot change from one to the other; and every role may come after every other.
#[kani::proof]
#[kani::unwind(8)]
fn an_observer_may_see_what_the_table_allows() {
    let relation = closure(may_follow);
    let start = Role::ALL[below(Role::ALL.len())];
    let mut role = start;
    for _ in 0..3 {
        let next = Role::ALL[below(Role::ALL.len())];
        if may_follow(role, next) {
            kani::cover!(role != next);
            role = next;
        }
        assert!(is_reachable(&relation, start, role));
    }
    kani::cover!(start == Role::Leaf && role == Role::Redundant);
    assert!(is_reachable(&relation, role, start));
}
