//! From ties to teams: what the robots of Σ vote, agree on and form.

use pleach_discrete::network::path::{Ties, is_break_point, last_break_point, subgroups};
use pleach_discrete::network::{Agreement, NoticeId};

use super::below;
use crate::network::team::{
    break_points_divide, has_no_repetition, is_one_team, subgroups_partition, teams_are_disjoint,
};

/// The robots of a path: any will do that differ.
const PATH: [usize; 4] = [5, 3, 8, 1];
/// Its places.
const PLACES: usize = PATH.len();
/// The notice that announces the path.
const ID: NoticeId = NoticeId::new(1, 0);

/// What the robots vote: any ties, any crossings.
fn any_votes(last: usize) -> [bool; PLACES] {
    let crossing: [bool; PLACES] = kani::any();
    let mut votes = [false; PLACES];
    for place in 0..PLACES {
        let ties = Ties { services_task: kani::any(), bears_others: false };
        let at_crossing = crossing[place] || place > 0 && crossing[place - 1];
        votes[place] = is_break_point(place, last, ties, at_crossing);
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

/// How many sets of places there are.
const SETS: usize = 1 << PLACES;

/// Any break points that robots may agree on, as a set of places: bit i is for place i.
fn any_break_points() -> usize {
    let votes = any_votes(last_break_point(PLACES, kani::any()));
    let mut view = Agreement::new(ID);
    for (place, vote) in votes.iter().enumerate() {
        view.vote(place, *vote);
    }
    let mut set = 0;
    for place in 0..PLACES {
        if view.is_break_point(place) {
            set |= 1 << place;
        }
    }
    set
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

/// A path of four robots, any ties and crossings, with and without a leader to be released. Two
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
        other.merge(&one);
    }
    let ((points, count), (same, as_many)) = (break_points(&one), break_points(&other));
    kani::cover!(count == 4);
    assert!(count == as_many);
    for place in 0..PLACES {
        assert!(points[place] == same[place]);
    }
}

/// A path of four robots, any ties and crossings, with and without a leader to be released: break
/// points divide Σ, and the subgroups partition it.
#[kani::proof]
#[kani::unwind(17)]
fn the_subgroups_of_any_votes_partition_the_path() {
    let drawn = any_break_points();
    let (mut groups, mut length) = (0, 0);
    // Case by case, so that in each the lengths of all slices are constants.
    for set in 0..SETS {
        if set == drawn {
            (groups, length) = subgroups_partition_the_path(set);
        }
    }
    kani::cover!(groups == 3);
    kani::cover!(groups == 1 && length == 3);
}

/// Says how many subgroups there are, and how many robots the first has.
fn subgroups_partition_the_path(set: usize) -> (usize, usize) {
    let (places, count) = places_of(set);
    let places = &places[..count];
    // A path of its own, not the constant: Kani reads a constant byte by byte.
    let path = PATH;
    let mut robots = [0; PLACES];
    for (robot, place) in robots.iter_mut().zip(places) {
        *robot = path[*place];
    }
    let mut formed: [&[usize]; PLACES] = [&[]; PLACES];
    let mut groups = 0;
    for subgroup in subgroups(places) {
        formed[groups] = &path[subgroup.places()];
        groups += 1;
    }
    assert!(break_points_divide(&path, &robots[..count]));
    assert!(subgroups_partition(&path, &robots[..count], &formed[..groups]));
    (groups, formed[0].len())
}

/// A path as above, and a primary team that begins with the last robot of Σ: any one of the
/// subgroups is one team, and none of its robots is in the primary team.
#[kani::proof]
#[kani::unwind(17)]
fn the_subgroups_of_any_votes_are_teams() {
    let (drawn, active) = (any_break_points(), below(PLACES - 1));
    let mut robots = 0;
    for set in 0..SETS {
        for subgroup in 0..PLACES - 1 {
            if set == drawn && subgroup == active {
                robots = a_subgroup_is_a_team(set, subgroup);
            }
        }
    }
    kani::cover!(active == 2 && robots == 1);
    kani::cover!(active == 0 && robots == 3);
}

/// Says how many robots the subgroup has.
fn a_subgroup_is_a_team(set: usize, active: usize) -> usize {
    let (places, count) = places_of(set);
    let path = PATH;
    let primary_team = [path[PLACES - 1], 2, 7];
    let mut team: &[usize] = &[];
    for (index, subgroup) in subgroups(&places[..count]).enumerate() {
        if index == active {
            team = &path[subgroup.places()];
        }
    }
    assert!(is_one_team(team, &primary_team, &path));
    for robot in team {
        assert!(!primary_team.contains(robot));
    }
    assert!(teams_are_disjoint(&path, &primary_team) && has_no_repetition(&path));
    team.len()
}
