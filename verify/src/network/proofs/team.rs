//! From ties to teams: what the robots of Σ vote, agree on and form.

use pleach_discrete::network::Agreement;
use pleach_discrete::network::path::{Ties, is_break_point, last_break_point, subgroups};

use super::below;
use crate::network::team::{
    break_points_divide, has_no_repetition, is_one_team, subgroups_partition, teams_are_disjoint,
};

/// The robots of a path: any will do that differ.
const PATH: [usize; 5] = [5, 3, 8, 1, 6];
/// Its places.
const PLACES: usize = PATH.len();

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

/// A path of five robots, any ties and crossings, with and without a leader to be released. Two
/// robots hear the votes in different orders; as soon as both are settled they know the same
/// break points, and the subgroups that each forms alone are the same.
#[kani::proof]
#[kani::unwind(7)]
fn robots_that_have_heard_every_vote_form_the_same_subgroups() {
    let votes = any_votes(last_break_point(PLACES, kani::any()));
    let (mut one, mut other) = (Agreement::new(1), Agreement::new(1));
    for (place, vote) in votes.into_iter().enumerate() {
        one.vote(place, vote);
    }
    // The other hears the votes from the end of the path on, and of some twice.
    for place in [4, 3, 2, 1, 0] {
        let mut voter = Agreement::new(1);
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

/// A path of five robots, any ties and crossings, with and without a leader to be released, and a
/// primary team that begins with the last robot of Σ: break points divide Σ, the subgroups
/// partition it, each is one team, and none has a robot of the primary team.
#[kani::proof]
#[kani::unwind(7)]
fn the_subgroups_of_any_votes_are_teams() {
    let releases_leader = kani::any();
    let votes = any_votes(last_break_point(PLACES, releases_leader));
    let mut view = Agreement::new(1);
    for (place, vote) in votes.into_iter().enumerate() {
        view.vote(place, vote);
    }
    let (places, count) = break_points(&view);
    let places = &places[..count];
    let primary_team = [PATH[PLACES - 1], 2, 7];
    let mut robots = [0; PLACES];
    for (robot, place) in robots.iter_mut().zip(places) {
        *robot = PATH[*place];
    }
    let mut formed: [&[usize]; PLACES] = [&[]; PLACES];
    let mut groups = 0;
    for subgroup in subgroups(places) {
        formed[groups] = &PATH[subgroup.places()];
        groups += 1;
    }
    kani::cover!(groups == 3);
    kani::cover!(groups == 1 && formed[0].len() == 4);
    assert!(break_points_divide(&PATH, &robots[..count]));
    assert!(subgroups_partition(&PATH, &robots[..count], &formed[..groups]));
    let active = below(PLACES);
    if active < groups {
        assert!(is_one_team(formed[active], &primary_team, &PATH));
        for robot in formed[active] {
            assert!(!primary_team.contains(robot));
        }
    }
    assert!(teams_are_disjoint(&PATH, &primary_team) && has_no_repetition(&PATH));
}
