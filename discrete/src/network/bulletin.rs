//! The newest notice on the mission, flooded through the network.
//!
//! A mission goes through its steps one at a time, and at each step one node may issue the next
//! notice: the access point that announces, the elected leader, p₁ that calls for help, the recruit
//! that found the path. Notices are therefore numbered, and the greater number wins: a
//! max-consensus that neither loss, nor repetition, nor delay can confuse. Where two nodes issue a
//! notice at the same step, as two access points may that are asked at once, the notice of the
//! issuer with the higher index wins: [`NoticeId`] is a total order.

use super::NodeId;

#[cfg(any(kani, test))]
mod proofs;

/// The notices of an epoch: many more than are issued for one task. A node that announces a task begins the next epoch
/// where [half of them](NoticeId::is_late_in_its_epoch) have been issued.
const EPOCH: u32 = 1 << 12;

/// The identity of a notice. Identities are ordered by number and then by issuer, and a node issues
/// at most one notice of each number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct NoticeId {
    /// The step of the mission, from 0.
    pub number: u32,
    /// The node that issued the notice.
    pub issuer: NodeId,
}

impl NoticeId {
    /// The notice with this number that `issuer` issued.
    pub const fn new(number: u32, issuer: NodeId) -> Self {
        NoticeId { number, issuer }
    }

    /// The identity of the notice that `issuer` issues after this one.
    pub const fn next(self, issuer: NodeId) -> Self {
        NoticeId { number: self.number.saturating_add(1), issuer }
    }

    /// How often notices had been [superseded](Bulletin::superseding) before it was issued.
    pub const fn epoch(self) -> u32 {
        self.number / EPOCH
    }

    /// Whether half of the notices of its epoch have been issued.
    pub const fn is_late_in_its_epoch(self) -> bool {
        self.number % EPOCH >= EPOCH / 2
    }

    /// Whether this notice is newer than `other`.
    pub const fn is_newer_than(self, other: Self) -> bool {
        self.number > other.number || self.number == other.number && self.issuer > other.issuer
    }
}

/// A notice with its identity.
///
/// Nodes of a network exchange bulletins of shared notices, so that a merge copies a pointer.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Bulletin<N> {
    id: NoticeId,
    notice: N,
}

impl<N: Clone> Bulletin<N> {
    /// The bulletin that every node has before the first notice is issued.
    pub const fn first(notice: N) -> Self {
        Bulletin { id: NoticeId::new(0, 0), notice }
    }

    /// The identity of its notice.
    pub const fn id(&self) -> NoticeId {
        self.id
    }

    /// The number of its notice.
    pub const fn number(&self) -> u32 {
        self.id.number
    }

    /// What it says.
    pub const fn notice(&self) -> &N {
        &self.notice
    }

    /// The bulletin that `issuer` issues after this one.
    pub fn next(&self, issuer: NodeId, notice: N) -> Self {
        Bulletin { id: self.id.next(issuer), notice }
    }

    /// The bulletin of `issuer` that supersedes this one and all that follow from it: its number is
    /// higher than those that others issue meanwhile.
    pub fn superseding(&self, issuer: NodeId, notice: N) -> Self {
        let epoch = self.id.epoch() + 1;
        Bulletin { id: NoticeId::new(epoch.saturating_mul(EPOCH), issuer), notice }
    }

    /// Takes over `heard` if it is newer; returns whether it was.
    pub fn merge(&mut self, heard: &Self) -> bool {
        let newer = heard.id.is_newer_than(self.id);
        if newer {
            *self = heard.clone();
        }
        newer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bulletins_count_from_zero() {
        let first = Bulletin::first("announced");
        let third = first.next(4, "called").next(2, "resumed");
        assert_eq!((first.number(), *first.notice()), (0, "announced"));
        assert_eq!((third.id(), *third.notice()), (NoticeId::new(2, 2), "resumed"));
        assert_eq!(third.number(), 2);
    }

    /// What follows from the bulletin before does not get the better of the one that supersedes it.
    #[test]
    fn what_is_superseded_stays_so() {
        let first = Bulletin::first("announced");
        let mut newest = first.superseding(7, "announced again");
        let late = (0..99).fold(first, |late, issuer| late.next(issuer, "called"));
        assert!(!newest.merge(&late));
        assert_eq!((late.id().epoch(), newest.id().epoch()), (0, 1));
        assert!(newest.clone().superseding(7, "and again").id().is_newer_than(newest.id()));
    }

    #[test]
    fn two_nodes_that_issue_at_once_do_not_tie() {
        let first = Bulletin::first("announced");
        let (mut one, mut other) = (first.next(13, "by 13"), first.next(14, "by 14"));
        assert!(one.merge(&other.clone()) && !other.merge(&first.next(13, "by 13")));
        assert_eq!((one.notice(), &one), (&"by 14", &other));
    }
}
