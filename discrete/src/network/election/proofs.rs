//! Merging elections is taking a maximum: order, repetition and delay of messages do not matter.

use super::*;

/// Robots whose tokens are placed.
const ROBOTS: usize = 3;

/// The election that the views are of.
const ID: NoticeId = NoticeId::new(1, 1);

/// No bid, or one of four that differ in rank and merit.
fn any_bid() -> Option<Bid> {
    let code: u8 = kani::any_where(|code| *code < 5);
    (code > 0).then(|| Bid { rank: (code - 1) / 2, merit: i64::from((code - 1) % 2), economy: 0 })
}

/// What a robot knows that has heard the tokens of any of the robots.
fn any_view(bids: &[Option<Bid>; ROBOTS]) -> Election {
    let mut view = Election::new(ID);
    for (robot, bid) in bids.iter().enumerate() {
        if kani::any() {
            view.place(robot, *bid);
        }
    }
    view
}

/// The maximum of two views.
fn merged(mut one: Election, other: &Election) -> Election {
    one.merge(other);
    one
}

/// Three robots, any bids of two ranks and two merits, any three views of the same election:
/// merging is commutative, associative and idempotent.
#[kani::proof]
#[kani::unwind(5)]
fn merging_views_is_taking_a_maximum() {
    let bids = [any_bid(), any_bid(), any_bid()];
    let (one, two, three) = (any_view(&bids), any_view(&bids), any_view(&bids));
    kani::cover!(one != two && two != three && one.best() == two.best() && one.best().is_some());
    assert!(merged(one.clone(), &two) == merged(two.clone(), &one));
    assert!(merged(merged(one.clone(), &two), &three) == merged(one.clone(), &merged(two, &three)));
    assert!(merged(one.clone(), &one) == one);
}

/// A view of another election changes nothing, whatever it contains: not of one before or after, nor of
/// one that another node called for at the same step.
#[kani::proof]
#[kani::unwind(5)]
fn a_view_of_another_election_changes_nothing() {
    let bids = [any_bid(), any_bid(), any_bid()];
    let view = any_view(&bids);
    let below_four = |drawn: &u8| *drawn < 4;
    let (number, issuer) = (kani::any_where(below_four), kani::any_where(below_four));
    kani::assume((number, issuer) != (1, 1));
    let mut old = Election::new(NoticeId::new(number.into(), issuer.into()));
    // By reference: see the proofs of agreements.
    for (robot, bid) in bids.iter().enumerate() {
        old.place(robot, *bid);
    }
    kani::cover!(old.best() > view.best());
    kani::cover!(number == 1);
    assert!(merged(view.clone(), &old) == view);
}

/// Any bids that fit the type, of rank, merit and economy: the order is total, goes by rank
/// first, and of two robots with the same bid the one with the higher index wins.
#[kani::proof]
#[kani::unwind(2)]
fn bids_are_ordered_by_rank_first_and_ties_go_to_the_higher_index() {
    let bid = || Bid { rank: kani::any(), merit: kani::any(), economy: kani::any() };
    let one = bid();
    let other = if kani::any() { one } else { bid() };
    let mut election = Election::new(ID);
    election.place(0, Some(one));
    election.place(1, Some(other));
    kani::cover!(one == other);
    kani::cover!(one.rank > other.rank && one.merit < other.merit);
    kani::cover!(one.rank == other.rank && one.merit == other.merit && one.economy < other.economy);
    let wins = if one > other { (one, 0) } else { (other, 1) };
    assert!(election.best() == Some(wins));
    assert!(one.rank <= other.rank || one > other);
}
