//! A medium that fails: messages are lost, late, copied and overtaken, and links are cut.
//!
//! [`Unreliable`] stands between the nodes and another medium, which decides who is in range. What
//! it does to messages are its [`MessageFaults`]. Draws are those of a seed: the same nodes under the same
//! faults hear the same messages in every run.

use super::{Delivery, Envelope, Medium, NodeId};
use crate::chance::Chance;

/// What becomes of messages, and when.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MessageFaults {
    /// The probability that a message does not reach one of its receivers.
    pub loss: f64,
    /// The probability that nothing gets over a link in one direction for a whole second.
    pub silence: f64,
    /// The probability that a message is late.
    pub lateness: f64,
    /// A late message arrives after at most this many deliveries; others overtake it meanwhile.
    pub longest_delay: u64,
    /// The probability that a message that arrives does so once more, late.
    pub copies: f64,
    /// Nothing gets over from one side to the other.
    pub partitions: Vec<Partition>,
    /// Seconds after which messages begin to fail.
    pub begin: f64,
    /// Seconds after which messages fail no more; none if they always do.
    pub end: Option<f64>,
    /// Messages between nodes with this number or a higher one go over a wire, and never fail; none
    /// if all nodes have a radio.
    pub wired_from: Option<NodeId>,
}

/// A time in which two groups of nodes do not hear each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Partition {
    /// Seconds after which it begins.
    pub begin: f64,
    /// Seconds after which it ends.
    pub end: f64,
    /// The nodes on one side.
    pub side: Vec<NodeId>,
}

impl Partition {
    fn parts(&self, from: NodeId, to: NodeId, time: f64) -> bool {
        let on_side = |node| self.side.contains(&node);
        (self.begin..self.end).contains(&time) && on_side(from) != on_side(to)
    }
}

impl MessageFaults {
    /// Whether messages over this link may fail now.
    fn fails(&self, from: NodeId, to: NodeId, time: f64) -> bool {
        let is_wire = self.wired_from.is_some_and(|first| from >= first && to >= first);
        !is_wire && time >= self.begin && self.end.is_none_or(|end| time < end)
    }

    /// Whether nothing gets over this link now.
    fn cuts(&self, from: NodeId, to: NodeId, time: f64, seed: u64) -> bool {
        let second = time as usize;
        let link = ((from as u64) << 32 | to as u64).wrapping_mul(LINK_STEP);
        let is_silent = || Chance::new(seed ^ link, second).share() < self.silence;
        self.silence > 0.0 && is_silent()
            || self.partitions.iter().any(|partition| partition.parts(from, to, time))
    }
}

/// Tells the draws of links apart: any odd number with its bits mixed will do.
const LINK_STEP: u64 = 0xD6E8_FEB8_6659_FD93;

/// A medium whose messages fail.
#[derive(Clone, Debug)]
pub struct Unreliable<M, W> {
    medium: W,
    faults: MessageFaults,
    seed: u64,
    chance: Chance,
    time: f64,
    /// How many times messages have been delivered.
    deliveries: u64,
    late: Vec<Late<M>>,
    lost: u64,
}

/// A message that arrives with a later delivery.
#[derive(Clone, Debug)]
struct Late<M> {
    due: u64,
    from: NodeId,
    to: NodeId,
    message: M,
}

impl<M, W> Unreliable<M, W> {
    /// This medium, with these faults; `seed` decides which messages fail.
    pub fn new(medium: W, faults: MessageFaults, seed: u64) -> Self {
        Unreliable {
            medium,
            faults,
            seed,
            chance: Chance::new(seed, 0),
            time: 0.0,
            deliveries: 0,
            late: Vec::new(),
            lost: 0,
        }
    }

    /// The medium beneath.
    pub const fn medium(&self) -> &W {
        &self.medium
    }

    /// How many messages were lost so far, counted for each receiver.
    pub const fn lost(&self) -> u64 {
        self.lost
    }
}

impl<M: Clone, B, W: Medium<M, B>> Medium<M, B> for Unreliable<M, W> {
    fn update(&mut self, bodies: &[B]) {
        self.medium.update(bodies);
    }

    fn send(&mut self, envelope: Envelope<M>) {
        self.medium.send(envelope);
    }

    /// Late messages arrive with others: none of them makes a delivery of its own.
    fn time_to_arrival(&self) -> Option<f64> {
        self.medium.time_to_arrival()
    }

    fn flow(&mut self, duration: f64) {
        self.time += duration;
        self.medium.flow(duration);
    }

    fn deliver<E>(
        &mut self,
        mut hand_over: impl FnMut(Delivery<'_, M>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.deliveries += 1;
        let now = self.deliveries;
        let (arrived, waiting): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.late).into_iter().partition(|late| late.due <= now);
        self.late = waiting;
        for Late { from, to, message, .. } in &arrived {
            hand_over(Delivery { from: *from, to: *to, message })?;
        }
        let Unreliable { medium, faults, seed, chance, time, late, lost, .. } = self;
        medium.deliver(|delivery| {
            let Delivery { from, to, message } = delivery;
            if !faults.fails(from, to, *time) {
                return hand_over(delivery);
            }
            let mut happens = |probability: f64| probability > 0.0 && chance.share() < probability;
            if happens(faults.loss) || faults.cuts(from, to, *time, *seed) {
                *lost += 1;
                return Ok(());
            }
            let (is_copied, is_late) = (happens(faults.copies), happens(faults.lateness));
            if is_copied || is_late {
                let wait = 1 + chance.below(faults.longest_delay.max(1) as usize) as u64;
                late.push(Late { due: now + wait, from, to, message: message.clone() });
            }
            if is_late { Ok(()) } else { hand_over(delivery) }
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that panics has failed
mod tests {
    use super::*;
    use crate::node::{Destination, FullMesh};
    use std::convert::Infallible;

    /// The numbers that each of three nodes hears when node 0 counts to `count`.
    fn heard(faults: MessageFaults, count: u32) -> [Vec<u32>; 3] {
        let mut medium = Unreliable::new(FullMesh::new(), faults, 7);
        medium.update(&[(); 3]);
        let mut heard: [Vec<u32>; 3] = Default::default();
        for message in 0..count {
            let envelope = Envelope { from: 0, to: Destination::Everyone, message };
            Medium::<u32, ()>::send(&mut medium, envelope);
            assert_eq!(Medium::<u32, ()>::time_to_arrival(&medium), Some(0.0));
            let deliver = |delivery: Delivery<'_, u32>| {
                heard[delivery.to].push(*delivery.message);
                Ok::<(), Infallible>(())
            };
            Medium::<u32, ()>::deliver(&mut medium, deliver).unwrap();
            Medium::<u32, ()>::flow(&mut medium, 1.0);
        }
        heard
    }

    #[test]
    fn a_calm_medium_loses_nothing() {
        let all: Vec<u32> = (0..50).collect();
        assert_eq!(heard(MessageFaults::default(), 50), [vec![], all.clone(), all]);
    }

    #[test]
    fn as_many_messages_are_lost_as_the_faults_say() {
        let faults = MessageFaults { loss: 0.3, ..MessageFaults::default() };
        let first = heard(faults.clone(), 2_000);
        assert!((1_330..1_470).contains(&first[1].len()), "{}", first[1].len());
        assert_ne!(first[1], first[2], "each receiver has losses of its own");
        assert_eq!(first, heard(faults, 2_000), "the same in every run");
    }

    #[test]
    fn late_messages_are_overtaken_and_copies_come_again() {
        let late = MessageFaults { lateness: 0.2, longest_delay: 3, ..MessageFaults::default() };
        let heard_late = heard(late, 500);
        assert!(!heard_late[1].is_sorted() && heard_late[1].len() > 490);
        let copied = MessageFaults { copies: 0.2, longest_delay: 3, ..MessageFaults::default() };
        let heard_copies = heard(copied, 500);
        assert!((560..640).contains(&heard_copies[1].len()), "{}", heard_copies[1].len());
    }

    #[test]
    fn a_partition_ends_and_a_wire_never_fails() {
        let partition = Partition { begin: 10.0, end: 20.0, side: vec![2] };
        let heard_parted =
            heard(MessageFaults { partitions: vec![partition], ..MessageFaults::default() }, 30);
        assert_eq!((heard_parted[1].len(), heard_parted[2].len()), (30, 20));
        let all =
            MessageFaults { loss: 1.0, begin: 5.0, end: Some(15.0), ..MessageFaults::default() };
        assert_eq!(heard(all.clone(), 30)[1].len(), 20);
        assert_eq!(heard(MessageFaults { wired_from: Some(0), ..all }, 30)[1].len(), 30);
    }

    #[test]
    fn a_silent_link_is_silent_for_a_second_in_one_direction() {
        let faults = MessageFaults { silence: 0.5, ..MessageFaults::default() };
        let heard_some = heard(faults, 400);
        assert!((150..250).contains(&heard_some[1].len()));
        assert_ne!(heard_some[1], heard_some[2]);
    }
}
