//! The ballot: the election and the agreement that a robot takes part in, and the way to the robot that calls.

use std::sync::Arc;

use pleach_discrete::network::{Agreement, Bid, Election, NodeId, NoticeId};

use crate::network::beacon::{Beacon, CallRoute};
use crate::network::shared::merge_election;

/// What a robot knows of the election that it takes part in, and of the agreement on Σ (Remarks 5.3 and 5.4).
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ballot {
    election: Option<Arc<Election>>,
    /// What the robot has bid in this election itself.
    bid: Option<Bid>,
    /// For how many rounds it has taken part.
    waited_rounds: usize,
    /// The way to the robot that calls.
    route: Option<CallRoute>,
    /// The break points of Σ, and who has arrived.
    agreement: Option<Agreement>,
}

impl Ballot {
    /// The robot takes part in an election, from the way to the caller that it knows.
    pub(super) fn begin(&mut self, election: Election, route: Option<CallRoute>) {
        (self.election, self.bid, self.route) = (Some(Arc::new(election)), None, route);
        self.waited_rounds = 1;
    }

    /// The robot takes part in this agreement, or in none.
    pub(super) fn agree(&mut self, agreement: Option<Agreement>) {
        self.agreement = agreement;
    }

    /// Merges what a neighbour knows.
    pub(super) fn merge(&mut self, beacon: &Beacon) {
        if let (Some(own), Some(heard)) = (&mut self.election, &beacon.election) {
            merge_election(own, heard);
        }
        if let (Some(own), Some(heard)) = (&mut self.agreement, &beacon.agreement) {
            own.merge(heard);
        }
    }

    /// The election that the robot takes part in, or took part in last.
    pub(super) const fn election(&self) -> Option<&Arc<Election>> {
        self.election.as_ref()
    }

    /// Whether this is the election.
    pub(super) fn is_of(&self, election: NoticeId) -> bool {
        self.election.as_ref().is_some_and(|own| own.id() == election)
    }

    /// Whether the token of the robot is in the election.
    pub(super) fn has_token(&self, robot: NodeId) -> bool {
        self.election.as_ref().is_some_and(|election| election.has_token(robot))
    }

    /// The best bid that is known, and the robot that has placed it.
    pub(super) fn best(&self) -> Option<(Bid, NodeId)> {
        self.election.as_ref()?.best()
    }

    /// Places the token of the robot, with its bid if it competes, once.
    pub(super) fn place(&mut self, robot: NodeId, bid: Option<Bid>) {
        if let Some(election) = &mut self.election
            && !election.has_token(robot)
        {
            Arc::make_mut(election).place(robot, bid);
            self.bid = bid;
        }
    }

    /// Counts one more round; returns whether a wait is over, where news takes at most `longest_wait` rounds.
    pub(super) const fn count_round(&mut self, longest_wait: usize) -> bool {
        self.pass_round();
        self.waited_rounds == longest_wait + 1 || self.waited_rounds == 2 * longest_wait
    }

    /// A round of the election is over.
    pub(super) const fn pass_round(&mut self) {
        self.waited_rounds += 1;
    }

    /// For how many rounds the election has been under way: the round in which it began does not count.
    pub(super) const fn rounds_passed(&self) -> usize {
        self.waited_rounds.saturating_sub(1)
    }

    /// Whether the robot has taken part for this many rounds.
    pub(super) const fn has_waited_for(&self, rounds: usize) -> bool {
        self.waited_rounds >= rounds
    }

    /// The way to the robot that has issued this call.
    pub(super) fn route_of(&self, call: NoticeId) -> Option<&CallRoute> {
        self.route.as_ref().filter(|&&(id, _)| id == call)
    }

    /// The way to the robot that called last.
    pub(super) const fn route(&self) -> Option<&CallRoute> {
        self.route.as_ref()
    }

    /// The way to the robot that calls is this, or is not known.
    pub(super) fn set_route(&mut self, route: Option<CallRoute>) {
        self.route = route;
    }

    /// The agreement that the robot takes part in, or took part in last.
    pub(super) const fn agreement(&self) -> Option<&Agreement> {
        self.agreement.as_ref()
    }

    /// The robot reports that it has left this place of Σ, and arrived at the next.
    pub(super) fn arrive(&mut self, place: usize) {
        if let Some(agreement) = &mut self.agreement {
            agreement.arrive(place);
        }
    }

    /// The robot gives up the post at this place of Σ.
    pub(super) fn give_up(&mut self, place: usize) {
        if let Some(agreement) = &mut self.agreement {
            agreement.give_up(place);
        }
    }
}

#[cfg(any(test, feature = "abstraction"))]
impl Ballot {
    /// What the robot has bid in the election.
    pub(super) const fn bid(&self) -> Option<Bid> {
        self.bid
    }

    /// For how many rounds it has taken part.
    pub(super) const fn waited_rounds(&self) -> usize {
        self.waited_rounds
    }
}

#[cfg(test)]
impl Ballot {
    /// The robot takes part in this election.
    pub(super) fn takes_part_in(&mut self, election: Election) {
        self.election = Some(Arc::new(election));
    }

    /// The robot has taken part for this many rounds.
    pub(super) const fn has_waited(&mut self, rounds: usize) {
        self.waited_rounds = rounds;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CALL: NoticeId = NoticeId::new(3, 1);

    fn bid(merit: i64) -> Bid {
        Bid { rank: 1, merit, economy: 0 }
    }

    #[test]
    fn a_token_is_placed_once() {
        let mut ballot = Ballot::default();
        ballot.place(0, Some(bid(1)));
        assert!(!ballot.has_token(0) && !ballot.is_of(CALL), "there is no election");
        ballot.begin(Election::new(CALL), None);
        assert!(ballot.is_of(CALL) && !ballot.has_token(0));
        ballot.place(0, Some(bid(1)));
        ballot.place(0, Some(bid(2)));
        assert_eq!((ballot.best(), ballot.bid()), (Some((bid(1), 0)), Some(bid(1))));
        ballot.begin(Election::new(CALL), None);
        assert_eq!((ballot.best(), ballot.bid()), (None, None));
    }

    #[test]
    fn waits_are_over_after_one_and_two_times_what_news_take() {
        let mut ballot = Ballot::default();
        ballot.begin(Election::new(CALL), None);
        let over: Vec<usize> = (2..12).filter(|_| ballot.count_round(4)).collect();
        assert_eq!((over, ballot.waited_rounds()), (vec![5, 8], 11));
        assert!(ballot.has_waited_for(11) && !ballot.has_waited_for(12));
    }
}
