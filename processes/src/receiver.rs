//! Which messages reach the nodes of a process.
//!
//! Packets reach every process; a radio does not. Here the [`Radio`] of the simulation decides from
//! where the nodes are which of them hear a sender, and [`Unreliable`] loses as many of the messages
//! as it is told to. What does not reach a node is not even read.

use crate::packet::{Letter, Packet, Refusal, Refusals, open};
use crate::repeats::Heard;
use pleach::automaton::network::{Message, Radio, Site};
use pleach::automaton::node::{
    Delivery, Destination, Envelope, FullMesh, Medium, MessageFaults, NodeId, Unreliable,
};
use pleach::continuous::Point;
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;

/// The radio of a process, at the receiving end.
#[derive(Debug)]
pub struct Receiver {
    site: Arc<Site>,
    radio: Radio,
    bodies: Vec<Point>,
    air: Unreliable<Arc<Letter>, FullMesh<Arc<Letter>>>,
    heard: Heard,
    /// The beacon heard last of each sender, as it was written and as it was read.
    beacons: BTreeMap<NodeId, (Vec<u8>, Message)>,
}

impl Receiver {
    /// The receiver of a process at a site, where nodes stand at `bodies` as far as is known; robots
    /// are out of reach until they are heard. Messages over the radio are lost with probability
    /// `loss`, drawn from `seed`.
    pub fn new(site: &Arc<Site>, bodies: Vec<Point>, loss: f64, seed: u64) -> Self {
        let messages =
            MessageFaults { loss, wired_from: Some(site.robots), ..MessageFaults::default() };
        let mut radio = Radio::new(site);
        radio.update(&bodies);
        let air = Unreliable::new(FullMesh::new(), messages, seed);
        let (site, heard, beacons) = (Arc::clone(site), Heard::default(), BTreeMap::new());
        Receiver { site, radio, bodies, air, heard, beacons }
    }

    /// How many messages were lost on purpose.
    pub const fn lost(&self) -> u64 {
        self.air.lost()
    }

    /// How many beacons were lost because only their digest came.
    pub const fn unknown(&self) -> u64 {
        self.heard.unknown()
    }

    /// The messages of a round that reach the nodes `own`: each with its sender and its receiver, in
    /// the order in which they were sent.
    pub fn messages(
        &mut self,
        own: &[NodeId],
        packets: &[(NodeId, Packet)],
        refusals: &mut Refusals,
    ) -> Vec<(NodeId, NodeId, Message)> {
        self.look_at_bodies(packets);
        for (from, packet) in packets {
            for letter in &packet.letters {
                self.receive(*from, letter, own);
            }
        }
        let mut arrived = Vec::new();
        let take = |Delivery { from, to, message }: Delivery<'_, Arc<Letter>>| {
            arrived.push((from, to, Arc::clone(message)));
            Ok::<(), Infallible>(())
        };
        let Ok(()) = Medium::<Arc<Letter>, Point>::deliver(&mut self.air, take);
        let mut messages = Vec::with_capacity(arrived.len());
        for (from, to, letter) in arrived {
            let Some(bytes) = self.heard.message(from, to, &letter) else { continue };
            match self.read(from, bytes) {
                Ok(message) => messages.push((from, to, message)),
                Err(refusal) => refusals.count(refusal),
            }
        }
        messages
    }

    fn receive(&mut self, from: NodeId, letter: &Letter, own: &[NodeId]) {
        let audience = self.radio.audience(from);
        let hears = |to: &&NodeId| letter.is_for(**to) && audience.binary_search(to).is_ok();
        let hearers: Vec<NodeId> = own.iter().filter(hears).copied().collect();
        if hearers.is_empty() {
            return;
        }
        let letter = Arc::new(letter.clone());
        for to in hearers {
            let (to, message) = (Destination::One(to), Arc::clone(&letter));
            Medium::<Arc<Letter>, Point>::send(&mut self.air, Envelope { from, to, message });
        }
    }

    /// The message in these bytes. Beacons are mostly those of the round before: what was read of them
    /// is shared.
    fn read(&mut self, from: NodeId, bytes: Vec<u8>) -> Result<Message, Refusal> {
        let known = self.beacons.get(&from);
        if let Some((_, message)) = known.filter(|(known, _)| *known == bytes) {
            return Ok(message.clone());
        }
        let mut message = open(&bytes, from, &self.site)?;
        if let Message::Beacon { beacon, .. } = &mut message {
            if let Some((_, Message::Beacon { beacon: last, .. })) = known
                && **last == **beacon
            {
                *beacon = Arc::clone(last);
            }
            self.beacons.insert(from, (bytes, message.clone()));
        }
        Ok(message)
    }

    fn look_at_bodies(&mut self, packets: &[(NodeId, Packet)]) {
        let mut has_moved = false;
        for (from, packet) in packets {
            if let Some(body) = self.bodies.get_mut(*from)
                && *body != packet.place()
            {
                *body = packet.place();
                has_moved = true;
            }
        }
        if has_moved {
            self.radio.update(&self.bodies);
        }
    }
}
