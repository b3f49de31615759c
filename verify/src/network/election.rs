//! What an election promises (Algorithm 1): identities and bids only.

use pleach_discrete::network::{Bid, Election, NodeId};

/// Validity: the winner placed the bid that it is said to have placed, and none placed a better
/// one; of equal bids that of the highest index wins. Without a bid there is no winner.
///
/// `bids` has one place for each robot that took part.
///
/// ```
/// use pleach_discrete::network::Bid;
/// use pleach_verify::network::election::is_won_by_best;
///
/// let bid = Bid { rank: 1, merit: -7, economy: 0 };
/// assert!(is_won_by_best(&[Some(bid), None, Some(bid)], Some((bid, 2))));
/// assert!(!is_won_by_best(&[Some(bid), None, Some(bid)], Some((bid, 0))));
/// assert!(!is_won_by_best(&[Some(bid)], None));
/// ```
pub fn is_won_by_best(bids: &[Option<Bid>], winner: Option<(Bid, NodeId)>) -> bool {
    match winner {
        None => bids.iter().all(Option::is_none),
        Some((best, robot)) => {
            let gives_way = |other: usize, bid: Bid| bid < best || bid == best && other <= robot;
            bids.get(robot) == Some(&Some(best))
                && bids.iter().enumerate().all(|(other, bid)| match bid {
                    Some(bid) => gives_way(other, *bid),
                    None => true,
                })
        }
    }
}

/// Agreement: all views of an election name the same winner.
pub fn have_agreed(views: &[Election]) -> bool {
    views.windows(2).all(|pair| pair[0].best() == pair[1].best())
}

#[cfg(test)]
mod tests {
    use pleach_discrete::network::NoticeId;

    use super::*;

    #[test]
    fn views_that_differ_have_not_agreed() {
        let bid = |merit| Some(Bid { rank: 1, merit, economy: 0 });
        let [mut one, mut other] = [(); 2].map(|()| Election::new(NoticeId::new(4, 0)));
        one.place(0, bid(3));
        other.place(1, bid(2));
        assert!(!have_agreed(&[one.clone(), other.clone()]));
        other.merge(&one);
        assert!(have_agreed(&[one, other]));
        assert!(have_agreed(&[]));
    }
}
