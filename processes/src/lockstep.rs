//! When a round is over: every node that takes part has sent its packet, or a time limit has passed.
//!
//! All processes count control periods, rounds and exchanges alike, and each of them goes on when it
//! has the packets of all others. So a mission by processes takes the same steps as one that is
//! simulated. A node whose packet does not come within the limit is taken to be gone, and waited for
//! again when it is heard again. What comes after its round is over is lost, as over a radio. This
//! part reads no clock and sends nothing.

use crate::packet::{Packet, Refusal, Stamp};
use pleach::automaton::node::NodeId;
use std::collections::{BTreeMap, BTreeSet};

/// The most messages that are kept of one sender ahead of their time.
const MOST_AHEAD: usize = 1 << 12;

/// What a process knows of the rounds of the others.
#[derive(Clone, Debug)]
pub struct Lockstep {
    own: BTreeSet<NodeId>,
    at: Stamp,
    /// The nodes that are waited for.
    expected: BTreeSet<NodeId>,
    /// Nodes that have sent too late in this control period: they are waited for in the next one.
    returning: BTreeSet<NodeId>,
    /// The packets of each sender for this round and later ones.
    waiting: BTreeMap<NodeId, BTreeMap<Stamp, Packet>>,
    /// When each sender has sent last.
    newest: BTreeMap<NodeId, Stamp>,
    late: u64,
}

impl Lockstep {
    /// The rounds of a process with these nodes.
    pub fn new(own: impl IntoIterator<Item = NodeId>) -> Self {
        Lockstep {
            own: own.into_iter().collect(),
            at: Stamp::default(),
            expected: BTreeSet::new(),
            returning: BTreeSet::new(),
            waiting: BTreeMap::new(),
            newest: BTreeMap::new(),
            late: 0,
        }
    }

    /// Waits for this node from now on.
    pub fn expect(&mut self, node: NodeId) {
        if !self.own.contains(&node) {
            self.expected.insert(node);
        }
    }

    /// How many nodes are waited for.
    pub fn expected(&self) -> usize {
        self.expected.len()
    }

    /// How many packets came after their round was over.
    pub const fn late(&self) -> u64 {
        self.late
    }

    /// Takes in a packet.
    ///
    /// # Errors
    /// Why it is refused.
    pub fn receive(&mut self, from: NodeId, packet: Packet) -> Result<(), Refusal> {
        if self.own.contains(&from) {
            return Err(Refusal::OwnNumber);
        }
        let stamp = packet.stamp;
        if stamp < self.at {
            self.late += 1;
            if stamp.period == self.at.period && !self.expected.contains(&from) {
                self.returning.insert(from);
            }
            return Ok(());
        }
        let waiting = self.waiting.entry(from).or_default();
        if waiting.contains_key(&stamp) {
            return Err(Refusal::Repeated);
        }
        if waiting.len() >= MOST_AHEAD {
            return Err(Refusal::TooFarAhead);
        }
        waiting.insert(stamp, packet);
        let newest = self.newest.entry(from).or_default();
        *newest = stamp.max(*newest);
        self.expected.insert(from);
        Ok(())
    }

    /// Goes on to a round, from which on packets are taken in.
    pub fn go_on_to(&mut self, stamp: Stamp) {
        if stamp.period > self.at.period {
            self.expected.append(&mut self.returning);
        }
        self.at = stamp;
        for packets in self.waiting.values_mut() {
            *packets = packets.split_off(&stamp);
        }
    }

    /// The nodes whose packet of this round has not come.
    pub fn missing(&self) -> impl Iterator<Item = NodeId> {
        let is_missing =
            |node: &NodeId| self.newest.get(node).is_none_or(|newest| *newest < self.at);
        self.expected.iter().copied().filter(is_missing)
    }

    /// Whether all others are given up: nothing tells then how fast to go on.
    pub fn is_alone(&self) -> bool {
        self.expected.is_empty() && !self.newest.is_empty()
    }

    /// Whether others have gone on without this process: one of them has sent in two later rounds.
    pub fn is_overtaken(&self) -> bool {
        let later = |packets: &BTreeMap<Stamp, Packet>| {
            packets.keys().filter(|stamp| **stamp > self.at).count()
        };
        self.waiting.values().any(|packets| later(packets) >= 2)
    }

    /// Goes on without the nodes whose packet has not come; they are named.
    pub fn give_up(&mut self) -> Vec<NodeId> {
        let missing: Vec<NodeId> = self.missing().collect();
        missing.iter().for_each(|node| {
            self.expected.remove(node);
        });
        missing
    }

    /// The packets of this round, by their senders.
    pub fn take(&mut self) -> Vec<(NodeId, Packet)> {
        let at = self.at;
        let take = |(from, packets): (&NodeId, &mut BTreeMap<Stamp, Packet>)| {
            packets.remove(&at).map(|packet| (*from, packet))
        };
        self.waiting.iter_mut().filter_map(take).collect()
    }

    /// The earliest control period that begins after `period` and of which a packet has come.
    pub fn later_period(&self, period: u32) -> Option<u32> {
        let stamps = self.waiting.values().flat_map(BTreeMap::keys);
        stamps.map(|stamp| stamp.period).filter(|later| *later > period).min()
    }

    /// The first packet that has come, in the order of time.
    pub fn earliest(&self) -> Option<Stamp> {
        self.waiting.values().filter_map(|packets| packets.keys().next().copied()).min()
    }

    /// The last packet that has come, in the order of time.
    pub fn latest(&self) -> Option<Stamp> {
        self.newest.values().max().copied()
    }
}

/// What follows a round in which these packets were sent: answers, or another round of ticks; none if
/// the control period is over. Messages arrive before either.
///
/// A node that hears a message may tick in the next round, whatever it has said before. If it does
/// not, its packet of that round says so.
pub fn after(stamp: Stamp, packets: &[(NodeId, Packet)]) -> Option<Stamp> {
    let mut sent = packets.iter().filter(|(_, packet)| !packet.letters.is_empty()).peekable();
    if sent.peek().is_some() {
        let is_answered = sent.any(|(_, packet)| packet.asks);
        return Some(match is_answered {
            true => Stamp { answer: stamp.answer + 1, ..stamp },
            false => Stamp { round: stamp.round + 1, answer: 0, ..stamp },
        });
    }
    let next = packets.iter().filter_map(|(_, packet)| packet.next).min()?;
    Some(Stamp { round: next.max(stamp.round + 1), answer: 0, ..stamp })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet::Letter;

    const fn at(period: u32, round: u32, answer: u32) -> Stamp {
        Stamp { period, round, answer }
    }

    fn packet(stamp: Stamp) -> Packet {
        Packet {
            stamp,
            next: Some(9),
            asks: false,
            is_over: false,
            position: [0.0; 2],
            letters: Vec::new(),
        }
    }

    fn missing(lockstep: &Lockstep) -> Vec<NodeId> {
        lockstep.missing().collect()
    }

    fn three() -> Lockstep {
        let mut lockstep = Lockstep::new([0]);
        (0..3).for_each(|node| lockstep.expect(node));
        lockstep.go_on_to(at(0, 1, 0));
        lockstep
    }

    #[test]
    fn a_round_waits_for_all_others() {
        let mut lockstep = three();
        assert_eq!(missing(&lockstep), [1, 2]);
        lockstep.receive(2, packet(at(0, 1, 0))).unwrap();
        assert_eq!(missing(&lockstep), [1]);
        // One that is ahead has passed this round, and is not waited for in it.
        lockstep.receive(1, packet(at(0, 1, 1))).unwrap();
        assert!(missing(&lockstep).is_empty());
        assert_eq!(lockstep.take().iter().map(|(from, _)| *from).collect::<Vec<_>>(), [2]);
        lockstep.go_on_to(at(0, 1, 1));
        assert_eq!(missing(&lockstep), [2]);
        assert_eq!(lockstep.take().len(), 1);
    }

    #[test]
    fn who_is_silent_is_gone_until_it_is_heard_again() {
        let mut lockstep = three();
        lockstep.receive(1, packet(at(0, 1, 0))).unwrap();
        assert_eq!(lockstep.give_up(), [2]);
        lockstep.go_on_to(at(0, 2, 0));
        assert_eq!(missing(&lockstep), [1]);
        assert!(!lockstep.is_alone());
        // Too late for this period, and in time for the next one.
        lockstep.receive(2, packet(at(0, 1, 0))).unwrap();
        assert_eq!((missing(&lockstep), lockstep.late()), (vec![1], 1));
        lockstep.go_on_to(at(1, 1, 0));
        assert_eq!(missing(&lockstep), [1, 2]);
    }

    #[test]
    fn a_process_is_alone_once_it_has_given_all_others_up() {
        let mut lockstep = three();
        assert!(!lockstep.is_alone(), "it waits for others");
        lockstep.receive(1, packet(at(0, 1, 0))).unwrap();
        lockstep.go_on_to(at(0, 2, 0));
        assert_eq!(lockstep.give_up(), [1, 2]);
        assert!(lockstep.is_alone());
        lockstep.receive(1, packet(at(0, 2, 0))).unwrap();
        assert!(!lockstep.is_alone());
        assert!(!Lockstep::new([0, 1]).is_alone(), "there are no others");
    }

    #[test]
    fn a_process_notices_that_it_was_left_behind() {
        let mut lockstep = three();
        lockstep.receive(1, packet(at(0, 1, 0))).unwrap();
        lockstep.receive(1, packet(at(0, 1, 1))).unwrap();
        assert!(!lockstep.is_overtaken(), "it may be one exchange ahead");
        lockstep.receive(1, packet(at(0, 2, 0))).unwrap();
        assert!(lockstep.is_overtaken());
        assert_eq!(lockstep.later_period(0), None);
        lockstep.receive(1, packet(at(3, 1, 0))).unwrap();
        assert_eq!(lockstep.later_period(0), Some(3));
    }

    #[test]
    fn what_is_kept_is_bounded_and_nothing_counts_twice() {
        let mut lockstep = three();
        assert_eq!(lockstep.receive(0, packet(at(0, 1, 0))), Err(Refusal::OwnNumber));
        for round in 1..=MOST_AHEAD as u32 {
            lockstep.receive(1, packet(at(0, round, 0))).unwrap();
        }
        assert_eq!(lockstep.receive(1, packet(at(0, 1, 0))), Err(Refusal::Repeated));
        assert_eq!(lockstep.receive(1, packet(at(9, 1, 0))), Err(Refusal::TooFarAhead));
    }

    #[test]
    fn answers_come_before_the_next_tick() {
        let quiet = |next| Packet { next, ..packet(at(0, 3, 0)) };
        let letter = Letter { to: None, message: Vec::new(), beacon: None };
        let talking = Packet { letters: vec![letter], ..quiet(Some(4)) };
        let asking = Packet { asks: true, ..talking.clone() };
        let both = [(0, quiet(Some(7))), (1, quiet(None))];
        assert_eq!(after(at(0, 3, 0), &both), Some(at(0, 7, 0)));
        assert_eq!(after(at(0, 3, 0), &[(0, quiet(Some(7))), (1, talking)]), Some(at(0, 4, 0)));
        assert_eq!(after(at(0, 3, 0), &[(0, quiet(None)), (1, asking)]), Some(at(0, 3, 1)));
        assert_eq!(after(at(0, 3, 1), &[(0, quiet(Some(2)))]), Some(at(0, 4, 0)));
        assert_eq!(after(at(0, 3, 0), &[(0, quiet(None))]), None);
    }
}
