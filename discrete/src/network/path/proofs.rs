//! Break points: the rule, and the subgroups that it cuts out.

use super::*;

/// Places of the longest path.
const PLACES: usize = 6;

/// Any ties, any crossings, paths of 2 to 6 places with and without a leader to be released: the
/// first and the last that Σ relieves are break points, none behind them is, and a crossing
/// has one on each side, so that one robot alone walks it.
#[kani::proof]
#[kani::unwind(8)]
fn the_recruit_the_last_and_both_sides_of_a_crossing_break() {
    let places = usize::from(kani::any_where(|places: &u8| 2 <= *places && *places <= 6));
    let last = last_break_point(places, kani::any());
    let place = usize::from(kani::any_where(|place: &u8| usize::from(*place) < places));
    let ties = Ties { services_task: kani::any(), bears_others: kani::any() };
    let crossing: [bool; PLACES] = kani::any();
    let at_crossing = crossing[place] || place > 0 && crossing[place - 1];
    let breaks = is_break_point(place, last, ties, at_crossing);
    kani::cover!(breaks && 0 < place && place < last && !ties.services_task);
    kani::cover!(!breaks);
    assert!(breaks || !(place == 0 || place == last));
    assert!(!breaks || place <= last);
    assert!(breaks || place > last || !(ties.services_task || ties.bears_others || at_crossing));
    assert!(!breaks || place == 0 || place == last || ties != Ties::default() || at_crossing);
}

/// Any break points of a path of 6 places, the first of them 0: every place before the last
/// break point is in exactly one subgroup, and a subgroup ends where the next begins.
#[kani::proof]
#[kani::unwind(8)]
fn every_place_before_the_last_break_point_is_in_one_subgroup() {
    let chosen: [bool; PLACES] = kani::any();
    let (mut points, mut count) = ([0; PLACES], 1);
    for (place, is_chosen) in chosen.iter().enumerate().skip(1) {
        if *is_chosen {
            kani::cover!();
            points[count] = place;
            count += 1;
        }
    }
    let place = usize::from(kani::any_where(|place: &u8| *place < 6));
    let (mut holding, mut end) = (0, 0);
    for subgroup in subgroups(&points[..count]) {
        kani::cover!(subgroup.first > 0);
        assert!(subgroup.first == end);
        end = subgroup.end;
        if subgroup.places().contains(&place) {
            kani::cover!();
            holding += 1;
        }
    }
    kani::cover!(count == 4 && holding == 1);
    kani::cover!(holding == 0 && count > 1);
    assert!(end == points[count - 1]);
    assert!(holding == usize::from(place < end));
}
