//! Elections: agreement, validity, and an end after as many rounds as the component is wide.

use pleach_discrete::network::{Bid, Election, IdSet, NoticeId, Role};

use crate::network::election::{have_agreed, is_won_by_best};
use crate::network::team::has_at_most_one_leader;

/// Any graph of N robots: whether two hear each other.
#[allow(clippy::needless_range_loop)] // both halves of the matrix are written
fn any_graph<const N: usize>() -> [[bool; N]; N] {
    let mut hears = [[false; N]; N];
    for one in 0..N {
        for other in 0..one {
            let hear_each_other = kani::any();
            hears[one][other] = hear_each_other;
            hears[other][one] = hear_each_other;
        }
    }
    hears
}

/// No bid, or one of four that differ in rank and merit.
fn any_bid() -> Option<Bid> {
    let code: u8 = kani::any_where(|code| *code < 5);
    (code > 0).then(|| Bid { rank: (code - 1) / 2, merit: i64::from((code - 1) % 2), economy: 0 })
}

/// Every robot places its own token.
fn begin<const N: usize>(bids: &[Option<Bid>; N]) -> [Election; N] {
    let mut views = [(); N].map(|()| Election::new(NoticeId::new(1, 0)));
    for (robot, view) in views.iter_mut().enumerate() {
        view.place(robot, bids[robot]);
    }
    views
}

/// Every robot hears the views of its neighbours as they were at the beginning of the round.
fn round<const N: usize>(views: &mut [Election; N], hears: &[[bool; N]; N]) {
    let said = views.clone();
    for (robot, view) in views.iter_mut().enumerate() {
        for (other, heard) in said.iter().enumerate() {
            if hears[robot][other] {
                view.merge(heard);
            }
        }
    }
}

/// Four robots, any graph: after each round a robot knows the tokens of exactly those that are so
/// many links away. So an election ends within as many rounds as its component is wide.
///
/// Assumes that every message of a round arrives; lost and late ones are explored in
/// `exploration`, and change nothing but the number of rounds, see
/// `merging_views_is_taking_a_maximum`.
#[kani::proof]
#[kani::unwind(8)]
fn after_each_round_a_robot_knows_one_link_more() {
    const ROBOTS: usize = 4;
    let hears = any_graph::<ROBOTS>();
    let mut views = begin(&[None; ROBOTS]);
    // knows[i]: the robots within this many links of i, as bits.
    let mut knows = [1_u8, 2, 4, 8];
    // No component of four robots is wider.
    for _ in 1..ROBOTS {
        round(&mut views, &hears);
        let before = knows;
        for robot in 0..ROBOTS {
            for other in 0..ROBOTS {
                if hears[robot][other] {
                    kani::cover!();
                    knows[robot] |= before[other];
                }
            }
        }
        for (robot, view) in views.iter().enumerate() {
            for other in 0..ROBOTS {
                assert!(view.has_token(other) == (knows[robot] & (1 << other) != 0));
            }
        }
    }
    kani::cover!(knows[0] == 0b1111 && !hears[0][1] && !hears[0][2]);
    kani::cover!(knows[0] == 0b0011);
}

/// Three robots in a connected graph, any bids of two ranks and two merits, or none: after two
/// rounds every roster is complete, all have agreed, the winner bid and bid best, and at most one
/// robot takes itself for the leader.
///
/// That more robots hear of each other within as many rounds as their component is wide is shown above; that what they
/// know is a maximum, by `merging_views_is_taking_a_maximum`.
#[kani::proof]
#[kani::unwind(6)]
fn robots_that_hear_each_other_elect_the_best_bidder() {
    const ROBOTS: usize = 3;
    let hears = any_graph::<ROBOTS>();
    let bids = [any_bid(), any_bid(), any_bid()];
    let mut views = begin(&bids);
    for _ in 1..ROBOTS {
        round(&mut views, &hears);
    }
    let mut roster = IdSet::new();
    for robot in 0..ROBOTS {
        roster.insert(robot);
    }
    kani::assume(views[0].is_complete(&roster));
    let mut roles = [Role::Node; ROBOTS];
    for (robot, view) in views.iter().enumerate() {
        assert!(view.is_complete(&roster));
        assert!(is_won_by_best(&bids, view.best()));
        if let Some((_, winner)) = view.best()
            && winner == robot
        {
            kani::cover!();
            roles[robot] = Role::Leader;
        }
    }
    kani::cover!(roles[1] == Role::Leader && bids[0] == bids[1] && !hears[0][1]);
    kani::cover!(views[0].best().is_none());
    assert!(have_agreed(&views));
    assert!(has_at_most_one_leader(&roles));
}
