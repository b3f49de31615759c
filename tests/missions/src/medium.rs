//! The radio with a passage behind it: tests see every message that would arrive, and decide whether,
//! where and as what it does.

use pleach::automaton::network::{Message, Radio, Site};
use pleach::automaton::node::{Delivery, Envelope, Medium};
use pleach::continuous::Point;
use pleach::discrete::network::NodeId;
use std::collections::BTreeMap;
use std::ops::Deref;

/// A message that would arrive.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// The number of messages before it.
    pub number: u64,
    /// k.
    pub period: usize,
    /// Who sends it.
    pub sender: NodeId,
    /// Who would hear it.
    pub receiver: NodeId,
    /// The length of the link; none of a wire.
    pub distance: Option<f64>,
    /// Whether it is a beacon.
    pub is_beacon: bool,
    /// Whether it is a probe for circles of flows.
    pub is_probe: bool,
}

/// What happens to a message between the radio and a node that would hear it.
pub trait Passage {
    /// Where the nodes are now.
    fn update(&mut self, _: &[Point]) {}

    /// A node sends this.
    fn note_sent(&mut self, _: &Envelope<Message>) {}

    /// Hands a message over as often as it arrives, and as it arrives.
    fn pass<E>(
        &mut self,
        delivery: Delivery<'_, Message>,
        mut hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        hand_over(delivery)
    }
}

/// A radio with a passage behind it.
#[derive(Debug)]
pub struct Through<P> {
    radio: Radio,
    passage: P,
}

impl<P> Through<P> {
    /// The radio of a site with this passage.
    pub fn new(site: &Site, passage: P) -> Self {
        Through { radio: Radio::new(site), passage }
    }
}

impl<P> Deref for Through<P> {
    type Target = P;

    fn deref(&self) -> &P {
        &self.passage
    }
}

impl<P: Passage> Medium<Message, Point> for Through<P> {
    fn update(&mut self, bodies: &[Point]) {
        self.passage.update(bodies);
        self.radio.update(bodies);
    }

    fn send(&mut self, envelope: Envelope<Message>) {
        self.passage.note_sent(&envelope);
        self.radio.send(envelope);
    }

    fn time_to_arrival(&self) -> Option<f64> {
        self.radio.time_to_arrival()
    }

    fn flow(&mut self, duration: f64) {
        self.radio.flow(duration);
    }

    fn deliver<E>(
        &mut self,
        mut hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        let Through { radio, passage } = self;
        radio.deliver(|delivery| passage.pass(delivery, &mut hand_over))
    }
}

/// Loses the messages of which `loses` says so.
#[derive(Debug)]
pub struct Filtered<F> {
    robots: usize,
    positions: Vec<Point>,
    messages: u64,
    updates: usize,
    loses: F,
}

impl<F: FnMut(Arrival) -> bool> Filtered<F> {
    /// The radio of a site, without the messages of which `loses` says so.
    pub fn new(site: &Site, loses: F) -> Through<Self> {
        let positions = Vec::new();
        let filter = Filtered { robots: site.robots, positions, messages: 0, updates: 0, loses };
        Through::new(site, filter)
    }

    /// How many messages have arrived or been lost.
    pub const fn messages(&self) -> u64 {
        self.messages
    }
}

impl<F: FnMut(Arrival) -> bool> Passage for Filtered<F> {
    fn update(&mut self, bodies: &[Point]) {
        self.updates += 1;
        bodies.clone_into(&mut self.positions);
    }

    fn pass<E>(
        &mut self,
        delivery: Delivery<'_, Message>,
        mut hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        let (sender, receiver) = (delivery.from, delivery.to);
        let is_wire = sender >= self.robots && receiver >= self.robots;
        let length = || (self.positions[sender] - self.positions[receiver]).norm();
        let distance = (!is_wire).then(length);
        let (number, period) = (self.messages, self.updates - 1);
        self.messages += 1;
        let is_beacon = matches!(delivery.message, Message::Beacon { .. });
        let is_probe = matches!(delivery.message, Message::Probe(_));
        let arrival = Arrival { number, period, sender, receiver, distance, is_beacon, is_probe };
        if (self.loses)(arrival) { Ok(()) } else { hand_over(delivery) }
    }
}

/// The user's request also arrives at a second access point, so that two of them serve the same
/// user.
#[derive(Debug)]
pub struct AskedTwice {
    second: NodeId,
}

impl AskedTwice {
    /// The radio of a site with two access points or more.
    pub fn new(site: &Site) -> Through<Self> {
        Through::new(site, AskedTwice { second: site.robots + 1 })
    }
}

impl Passage for AskedTwice {
    fn pass<E>(
        &mut self,
        Delivery { from, to, message }: Delivery<'_, Message>,
        mut hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        hand_over(Delivery { from, to, message })?;
        match message {
            Message::Request(_) => hand_over(Delivery { from, to: self.second, message }),
            _ => Ok(()),
        }
    }
}

/// Counts what is said, by what it does: requests that are cut and moves that are halved, too.
#[derive(Debug, Default)]
pub struct Noted {
    counts: BTreeMap<&'static str, u64>,
    /// The flow that each sender has asked of each receiver, and the move that each robot has proposed.
    asked: BTreeMap<(NodeId, NodeId), f64>,
    proposed: BTreeMap<NodeId, (u32, f64)>,
}

impl Noted {
    pub fn new(site: &Site) -> Through<Self> {
        Through::new(site, Noted::default())
    }

    /// How often each kind of message has arrived.
    pub const fn counts(&self) -> &BTreeMap<&'static str, u64> {
        &self.counts
    }

    fn kind(&mut self, from: NodeId, to: NodeId, message: &Message) -> &'static str {
        match message {
            Message::Proposal { period, segment, .. } => {
                let now = (*period, segment.length());
                let before = self.proposed.insert(from, now);
                match before.is_some_and(|(at, length)| at == *period && now.1 < length) {
                    true => "proposal of a move that has been halved",
                    false => "proposal",
                }
            }
            Message::Objection { .. } => "objection",
            Message::Consent { .. } => "consent",
            Message::AskFlow(request) => {
                self.asked.insert((from, to), request.wanted);
                "request for a flow"
            }
            Message::GrantFlow(grant) => {
                let asked = self.asked.get(&(to, from)).copied().unwrap_or_default();
                if grant.flow < asked { "grant of less than is asked for" } else { "grant" }
            }
            Message::Demand(_) => "demand",
            Message::Shortage => "shortage",
            Message::Beacon { beacon, .. } => match (&beacon.offer, &beacon.reply) {
                (_, Some(reply)) if reply.accepted.is_none() => "refusal of an offer",
                (_, Some(_)) => "acceptance of an offer",
                (Some(_), None) => "offer to exchange duties",
                _ if beacon.way.is_some() => "request to make way",
                _ => "beacon",
            },
            _ => "other messages",
        }
    }
}

impl Passage for Noted {
    fn pass<E>(
        &mut self,
        delivery: Delivery<'_, Message>,
        mut hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        let kind = self.kind(delivery.from, delivery.to, delivery.message);
        *self.counts.entry(kind).or_default() += 1;
        hand_over(delivery)
    }
}

/// As between processes: every message is written as text by its sender and read by each of its
/// receivers, who take it for possible, and nothing else goes from node to node.
#[derive(Debug)]
pub struct Written {
    site: Site,
    bytes: u64,
}

impl Written {
    /// The radio of a site, which writes and reads every message.
    pub fn new(site: &Site) -> Through<Self> {
        Through::new(site, Written { site: site.clone(), bytes: 0 })
    }

    /// The length of all texts so far.
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl Passage for Written {
    fn pass<E>(
        &mut self,
        Delivery { from, to, message }: Delivery<'_, Message>,
        mut hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        let text = serde_json::to_string(message).expect("a message can be written");
        self.bytes += text.len() as u64;
        let message: Message =
            serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        assert!(message.is_possible(&self.site), "{text}");
        hand_over(Delivery { from, to, message: &message })
    }
}
