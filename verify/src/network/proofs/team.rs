//! From ties to teams: what the robots of Σ vote, agree on and form.

use pleach_discrete::network::path::{Ties, is_break_point, last_break_point, subgroups};
use pleach_discrete::network::{Agreement, NoticeId};

use super::below;
use crate::network::team::{break_points_divide, is_one_team, subgroups_partition};

/// The robots of a path: any will do that differ.
const PATH: [usize; 4] = [5, 3, 8, 1];
/// Its places.
const PLACES: usize = PATH.len();
/// The notice that announces the path.
const ID: NoticeId = NoticeId::new(1, 0);

/// What the robots vote: any ties, which give all sets of break points that crossings give.
fn any_votes(last: usize) -> [bool; PLACES] {
    let mut votes = [false; PLACES];
    for (place, vote) in votes.iter_mut().enumerate() {
        let ties = Ties { services_task: kani::any(), bears_others: false };
        *vote = is_break_point(place, last, ties, false);
    }
    votes
}

/// The break points that somebody knows: their places, and how many there are.
fn break_points(view: &Agreement) -> ([usize; PLACES], usize) {
    let (mut points, mut count) = ([0; PLACES], 0);
    for place in 0..PLACES {
        if view.is_break_point(place) {
            points[count] = place;
            count += 1;
        }
    }
    (points, count)
}

/// A path of four robots, any ties, with and without a leader to be released. Two
/// robots hear the votes in different orders; as soon as both are settled they know the same
/// break points, and the subgroups that each forms alone are the same.
#[kani::proof]
#[kani::unwind(6)]
fn robots_that_have_heard_every_vote_form_the_same_subgroups() {
    let votes = any_votes(last_break_point(PLACES, kani::any()));
    let (mut one, mut other) = (Agreement::new(ID), Agreement::new(ID));
    for (place, vote) in votes.iter().enumerate() {
        one.vote(place, *vote);
    }
    // The other hears the votes from the end of the path on, and of some twice.
    for place in [3, 2, 1, 0] {
        let mut voter = Agreement::new(NoticeId::new(1, 0));
        voter.vote(place, votes[place]);
        other.merge(&voter);
        assert!(other.is_settled(PLACES) == (place == 0));
    }
    if kani::any() {
        kani::cover!();
        other.merge(&one);
    }
    let ((points, count), (same, as_many)) = (break_points(&one), break_points(&other));
    kani::cover!(count == 4);
    assert!(count == as_many);
    for place in 0..PLACES {
        assert!(points[place] == same[place]);
    }
}

/// Whether places can be the break points, bit i of the set for place i: the first is one, and the last is place 2 or 3,
/// by whether Σ relieves a leader.
const fn can_break(set: usize) -> bool {
    set & 1 != 0 && (set >> 2 == 1 || set >> 3 == 1)
}

/// The places of a set, and how many there are.
fn places_of(set: usize) -> ([usize; PLACES], usize) {
    let (mut places, mut count) = ([0; PLACES], 0);
    for place in 0..PLACES {
        if set & (1 << place) != 0 {
            places[count] = place;
            count += 1;
        }
    }
    (places, count)
}

/// A path of four robots, any ties, with and without a leader to be released: break points divide Σ, and the
/// subgroups partition it.
#[kani::proof]
#[kani::unwind(17)]
fn the_subgroups_of_any_votes_partition_the_path() {
    let votes = any_votes(last_break_point(PLACES, kani::any()));
    let (mut drawn, mut groups) = (0, 0);
    for (place, vote) in votes.iter().enumerate() {
        drawn |= usize::from(*vote) << place;
    }
    // A path of its own, not the constant: Kani reads a constant byte by byte.
    let path = PATH;
    // Case by case, so that in each the lengths of all slices are constants.
    for set in 0..1 << PLACES {
        if can_break(set) && set == drawn {
            kani::cover!();
            let (places, count) = places_of(set);
            let (mut robots, mut formed) = ([0; PLACES], [[].as_slice(); PLACES]);
            for (robot, place) in robots.iter_mut().zip(&places[..count]) {
                *robot = path[*place];
            }
            for (formed, subgroup) in formed.iter_mut().zip(subgroups(&places[..count])) {
                *formed = &path[subgroup.places()];
                groups += 1;
            }
            assert!(break_points_divide(&path, &robots[..count]));
            assert!(subgroups_partition(&path, &robots[..count], &formed[..count - 1]));
        }
    }
    kani::cover!(groups == 3);
    // The votes are one of the sets, and each subgroup begins with a break point.
    assert!(groups == drawn.count_ones() as usize - 1 && groups > 0);
}

/// A path as above, and a primary team that begins with the last robot of Σ: any one of the subgroups is one team, and
/// none of its robots is in the primary team.
#[kani::proof]
#[kani::unwind(6)]
fn the_subgroups_of_any_votes_are_teams() {
    let votes = any_votes(last_break_point(PLACES, kani::any()));
    let (mut points, mut count) = ([0; PLACES], 0);
    for (place, vote) in votes.iter().enumerate() {
        if *vote {
            kani::cover!();
            points[count] = place;
            count += 1;
        }
    }
    let (path, active) = (PATH, below(PLACES - 1));
    let primary_team = [path[PLACES - 1], 2, 7];
    let (mut first, mut end) = (0, 0);
    for (index, subgroup) in subgroups(&points[..count]).enumerate() {
        if index == active {
            kani::cover!(index == 2);
            (first, end) = (subgroup.first, subgroup.end);
        }
    }
    // Case by case, so that in each the team is a constant.
    let mut robots = 0;
    for begin in 0..PLACES {
        for behind in begin + 1..PLACES {
            if begin == first && behind == end {
                kani::cover!(begin == 1);
                let team = &path[begin..behind];
                assert!(is_one_team(team, &primary_team, &path));
                for robot in team {
                    kani::cover!();
                    assert!(!primary_team.contains(robot));
                }
                robots = team.len();
            }
        }
    }
    kani::cover!(robots == 3);
    assert!((robots > 0) == (active + 1 < count));
}
