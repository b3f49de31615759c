//! Elections by max-consensus (Algorithm 1, and Remark 5.4 for recruits).
//!
//! Algorithm 1 passes on a vector of bids d and a vector of tokens φ. Since the vector of bids is
//! only ever asked for its largest entry, the best bid known so far stands for it: the maximum of
//! maxima is the maximum. A robot that does not compete places its token without a bid. Ties go
//! to the robot with the highest index.

use super::{IdSet, NodeId, NoticeId};

#[cfg(any(kani, test))]
mod proofs;

/// What a robot offers; the greater, the better. Compared by `rank` first, then by `merit`, then
/// by `economy`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Bid {
    /// The class of the bid: no bid of a lower class wins against one of a higher class.
    pub rank: u8,
    /// How good the offer is.
    pub merit: i64,
    /// How little it costs.
    pub economy: i64,
}

/// One robot's view of an election.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "super::serialization::ElectionParts"))]
pub struct Election {
    id: NoticeId,
    tokens: IdSet,
    best: Option<(Bid, NodeId)>,
}

impl Election {
    /// The election that the notice `id` calls for, in which no token is known yet.
    pub const fn new(id: NoticeId) -> Self {
        Election { id, tokens: IdSet::new(), best: None }
    }

    /// The election with these tokens and this best bid; none if its bidder has placed no token.
    #[cfg(feature = "serde")]
    pub(super) fn from_parts(
        id: NoticeId,
        tokens: IdSet,
        best: Option<(Bid, NodeId)>,
    ) -> Option<Self> {
        best.is_none_or(|(_, bidder)| tokens.contains(bidder)).then_some(Election {
            id,
            tokens,
            best,
        })
    }

    /// The notice that called for it, which tells elections apart.
    pub const fn id(&self) -> NoticeId {
        self.id
    }

    /// Robot `robot` places its token, with a bid if it competes.
    pub fn place(&mut self, robot: NodeId, bid: Option<Bid>) {
        if self.tokens.insert(robot) {
            self.best = self.best.max(bid.map(|bid| (bid, robot)));
        }
    }

    /// Whether the token of `robot` is known.
    pub fn has_token(&self, robot: NodeId) -> bool {
        self.tokens.contains(robot)
    }

    /// Lines 3 and 4 of Algorithm 1: takes the maximum with what a neighbour sent.
    pub fn merge(&mut self, heard: &Election) {
        if heard.id == self.id {
            self.tokens.merge(&heard.tokens);
            self.best = self.best.max(heard.best);
        }
    }

    /// Whether what a neighbour sent contains nothing new: [`merge`](Self::merge) would change nothing.
    pub fn knows(&self, heard: &Election) -> bool {
        heard.id != self.id || self.tokens.includes(&heard.tokens) && self.best >= heard.best
    }

    /// Whether the token of every robot in `roster` is known (line 1).
    pub fn is_complete(&self, roster: &IdSet) -> bool {
        self.tokens.includes(roster)
    }

    /// The best bid known and who placed it (line 6).
    pub const fn best(&self) -> Option<(Bid, NodeId)> {
        self.best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_election_is_complete_with_the_last_token_of_its_roster() {
        let bid = Bid { rank: 1, merit: -3, economy: 0 };
        let roster: IdSet = [2, 5].into_iter().collect();
        let mut election = Election::new(NoticeId::new(7, 1));
        assert_eq!(election.id(), NoticeId::new(7, 1));
        for (robot, offer) in [(2, Some(bid)), (4, None)] {
            election.place(robot, offer);
            assert!(election.has_token(robot));
            assert!(!election.has_token(5) && !election.is_complete(&roster));
        }
        election.place(5, None);
        assert!(election.is_complete(&roster));
        assert_eq!(election.best(), Some((bid, 2)));
    }

    #[test]
    fn what_is_known_changes_nothing_and_what_is_new_does() {
        let bid = |merit| Some(Bid { rank: 1, merit, economy: 0 });
        let election = |number, placed: &[(NodeId, Option<Bid>)]| {
            let mut election = Election::new(NoticeId::new(number, 1));
            placed.iter().for_each(|&(robot, bid)| election.place(robot, bid));
            election
        };
        let own = election(7, &[(1, bid(2)), (3, None)]);
        let heard = [
            election(7, &[]),
            election(7, &[(3, None)]),
            election(7, &[(1, bid(2))]),
            election(8, &[(4, bid(9))]),
            election(7, &[(4, None)]),
            election(7, &[(3, bid(5))]),
        ];
        for (place, heard) in heard.iter().enumerate() {
            let mut merged = own.clone();
            merged.merge(heard);
            assert_eq!(own.knows(heard), merged == own, "{place}");
            assert_eq!(own.knows(heard), place < 4, "{place}");
        }
    }
}
