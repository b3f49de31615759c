//! Every robot that has heard all votes knows the same break points, in whatever order it heard them.

use super::*;

/// The notice that announces the path.
const ID: NoticeId = NoticeId::new(1, 1);
/// Places of the path.
const PLACES: usize = 4;

/// What a robot knows that has heard any of the votes, and of any of the arrivals.
///
/// Here and below drawn arrays are walked by reference: what an iterator by value returns says by a
/// niche of the drawn byte whether it goes on, and a model checker then unrolls what follows.
fn any_view(votes: &[bool; PLACES]) -> Agreement {
    let mut view = Agreement::new(ID);
    for (place, vote) in votes.iter().enumerate() {
        if kani::any() {
            view.vote(place, *vote);
        }
    }
    view
}

fn merged(mut one: Agreement, other: &Agreement) -> Agreement {
    one.merge(other);
    one
}

/// Four places, any votes, any two views of them: merging is commutative, and as soon as what
/// both know together is settled, it tells every vote as it was cast.
#[kani::proof]
#[kani::unwind(6)]
fn settled_views_tell_every_vote() {
    let votes: [bool; PLACES] = kani::any();
    let (one, other) = (any_view(&votes), any_view(&votes));
    let both = merged(one.clone(), &other);
    let was_settled = one.is_settled(PLACES) || other.is_settled(PLACES);
    assert!(both == merged(other, &one));
    if both.is_settled(PLACES) {
        kani::cover!(!was_settled);
        for (place, vote) in votes.iter().enumerate() {
            assert!(both.is_break_point(place) == *vote);
        }
    }
}

/// A vote stands: whatever is reported for the same place afterwards changes nothing.
#[kani::proof]
#[kani::unwind(6)]
fn a_vote_stands() {
    let votes: [bool; PLACES] = kani::any();
    let mut view = any_view(&votes);
    let before = view.clone();
    let place = usize::from(kani::any_where(|place: &u8| usize::from(*place) < PLACES));
    for voter in 0..PLACES {
        // The number of the place is a constant in each round of this loop.
        if voter == place && before.voted.contains(voter) {
            kani::cover!();
            view.vote(voter, kani::any());
        }
    }
    kani::cover!(before.voted.contains(place));
    assert!(view == before);
}

/// Arrivals are never forgotten, and those of a range of places are known together exactly if
/// each is known; nor is it that a robot has given its post up.
#[kani::proof]
#[kani::unwind(6)]
fn arrivals_are_known_together_if_each_is_known() {
    let (arrived, heard): ([bool; PLACES], [bool; PLACES]) = (kani::any(), kani::any());
    let (yielding, yielded): (bool, u8) = (kani::any(), kani::any_where(|place| *place < 4));
    let (mut view, mut other) = (Agreement::new(ID), Agreement::new(ID));
    // The number of the place is a constant in each round of this loop.
    for place in 0..PLACES {
        if arrived[place] {
            kani::cover!();
            view.arrive(place);
        }
        if heard[place] {
            kani::cover!();
            other.arrive(place);
        }
        if yielding && place == usize::from(yielded) {
            kani::cover!();
            other.give_up(place);
        }
    }
    view.merge(&other);
    for place in 0..PLACES {
        assert!(view.has_given_up(place) == (yielding && place == usize::from(yielded)));
    }
    let (first, end): (u8, u8) =
        (kani::any_where(|first| *first < 4), kani::any_where(|end| *end <= 4));
    let places = usize::from(first)..usize::from(end);
    let expected =
        (0..PLACES).all(|place| !places.contains(&place) || arrived[place] || heard[place]);
    kani::cover!(expected && places.len() == 3 && !(arrived[1] && arrived[2]));
    assert!(view.have_arrived(places) == expected);
}

/// A view of another path changes nothing, whatever votes and arrivals it contains.
#[kani::proof]
#[kani::unwind(6)]
fn a_view_of_another_path_changes_nothing() {
    let (votes, others): ([bool; PLACES], [bool; PLACES]) = (kani::any(), kani::any());
    let view = any_view(&votes);
    // One of a path before, or of one that another node announced at the same step.
    let id = if kani::any() { NoticeId::new(0, 1) } else { NoticeId::new(1, 2) };
    let mut other = Agreement::new(id);
    for (place, vote) in others.iter().enumerate() {
        other.vote(place, *vote);
        if kani::any() {
            kani::cover!();
            other.arrive(place);
        }
    }
    kani::cover!(
        other.have_arrived(0..PLACES) && !view.voted.contains(0) && view.is_break_point(1)
    );
    assert!(merged(view.clone(), &other) == view);
}
