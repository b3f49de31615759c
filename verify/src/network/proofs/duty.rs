//! Hand-overs lose no duty and leave no place that matters.

use pleach_discrete::network::path::{Ties, is_break_point, last_break_point, subgroups};

use super::below;
use crate::network::duty::are_conserved;

/// Any three duties of three kinds before and after: they are conserved exactly if some order of
/// the first gives the second.
#[kani::proof]
#[kani::unwind(5)]
fn duties_are_conserved_exactly_by_permutations() {
    const ORDERS: [[usize; 3]; 6] =
        [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let before = [below(3), below(3), below(3)];
    let after = [below(3), below(3), below(3)];
    let is_order = |order: &[usize; 3]| {
        before[order[0]] == after[0] && before[order[1]] == after[1] && before[order[2]] == after[2]
    };
    let permuted = is_order(&ORDERS[0])
        || is_order(&ORDERS[1])
        || is_order(&ORDERS[2])
        || is_order(&ORDERS[3])
        || is_order(&ORDERS[4])
        || is_order(&ORDERS[5]);
    kani::cover!(permuted && before[0] != after[0] && before[0] == before[1]);
    kani::cover!(!permuted && before[0] == after[0]);
    assert!(are_conserved(&before, &after) == permuted);
}

/// Places of the longest path.
const PLACES: usize = 5;

/// A path of 2 to 5 places, any break points, with and without a leader to be released. The
/// subgroups walk one after the other, each robot to the place ahead; the first of a subgroup sets
/// out only when another robot is at its place. At every step each break point but the recruit's
/// is held, and in the end the posts behind the recruit's are held by one robot each.
///
/// The walk is a model: the rule of Algorithm 3 as this harness states it; break points and subgroups are
/// those of the robots. The walk that robots run is explored in `exploration`. Ties alone give all sets of
/// break points that crossings give.
#[kani::proof]
#[kani::unwind(7)]
fn a_model_of_the_shift_keeps_break_points_held() {
    let places = 2 + below(PLACES - 1);
    let last = last_break_point(places, kani::any());
    let (mut points, mut count) = ([0; PLACES], 0);
    for place in 0..PLACES {
        let ties = Ties { services_task: kani::any(), bears_others: false };
        if place < places && is_break_point(place, last, ties, false) {
            kani::cover!(place == 4);
            points[count] = place;
            count += 1;
        }
    }
    let points = &points[..count];
    // The holder of the post of each place, and which post each robot holds in the end.
    let mut holders = [1_u8; PLACES];
    let mut held = [0, 1, 2, 3, 4];
    for subgroup in subgroups(points) {
        kani::cover!(subgroup.first > 0);
        // Another robot has come to the place of the first: it may set out.
        assert!(subgroup.first == 0 || holders[subgroup.first] == 2);
        for (place, holders) in holders.iter_mut().enumerate() {
            if subgroup.places().contains(&place) {
                kani::cover!(place == 3);
                *holders -= 1;
            }
        }
        for point in points {
            kani::cover!(*point == 4);
            assert!(*point == 0 || holders[*point] >= 1);
        }
        for place in 0..PLACES - 1 {
            if subgroup.places().contains(&place) {
                kani::cover!(place == 3);
                holders[place + 1] += 1;
                held[place] = place + 1;
            }
        }
    }
    kani::cover!(count == 4 && places == 5);
    kani::cover!(count == 2 && last == 4);
    kani::cover!(count == 1);
    // The last robot that Σ relieves joins the team: it hands its post to the one behind it.
    assert!(last == 0 || held[last] == last);
    held[last] = 0;
    assert!(are_conserved(&[0, 1, 2, 3, 4], &held));
}
