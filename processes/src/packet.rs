//! What nodes send in a round: a packet, with the messages that they send in it.
//!
//! Packets are written with [postcard](https://docs.rs/postcard). What arrives was written by anyone:
//! it is bounded in length, read without trust, and refused where it is not what a node can have
//! sent.

use crate::repeats::Content;
use pleach::automaton::network::scenario::MOST_PERIODS;
use pleach::automaton::network::{Message, Site};
use pleach::automaton::node::{Destination, NodeId};
use pleach::continuous::Point;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The most bytes of a packet.
pub const LONGEST_PACKET: usize = 1 << 16;

/// The most messages of a packet.
const MOST_MESSAGES: usize = 1 << 10;

/// The most rounds of a control period, and exchanges of a round.
const MOST_ROUNDS: u32 = 1 << 20;

/// When a packet is sent, in the order of time.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct Stamp {
    /// k: the control period, from 0.
    pub period: u32,
    /// The round of ticks in it, from 1.
    pub round: u32,
    /// 0 for what is sent at the tick, and n for the nth exchange of what is sent in answer.
    pub answer: u32,
}

/// What a node sends in a round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Packet {
    /// When.
    pub stamp: Stamp,
    /// The round in which the node ticks next if it hears nothing, if there is one in this period.
    pub next: Option<u32>,
    /// Whether a message in it may be answered at once.
    pub asks: bool,
    /// Whether the node knows that the mission has ended, and is at rest.
    pub is_over: bool,
    /// Where its body is.
    pub position: [f64; 2],
    /// Its messages.
    pub letters: Vec<Letter>,
}

/// A message as it is written, with its destination.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Letter {
    /// The receiver; none if it is for all that hear the sender.
    pub to: Option<u32>,
    /// The message; of a beacon, what stands before its content.
    pub message: Vec<u8>,
    /// The content of a beacon, unless it is in the message.
    pub beacon: Option<Content>,
}

/// Why something that has arrived is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Refusal {
    /// It is longer than anything that a process sends.
    TooLong,
    /// It is no packet, hello or report, or says what no node can have sent.
    Malformed,
    /// A message in it is malformed, or was sent in the name of another node.
    Message,
    /// No node of the scenario has this number.
    NoSuchNode,
    /// It was sent under the number of a node of this process.
    OwnNumber,
    /// It was sent twice.
    Repeated,
    /// More has come ahead of time than is kept.
    TooFarAhead,
    /// More has come at once than is kept.
    TooMany,
}

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Refusal::TooLong => "too long",
            Refusal::Malformed => "malformed",
            Refusal::Message => "with a malformed message",
            Refusal::NoSuchNode => "from no node of the scenario",
            Refusal::OwnNumber => "under the number of this process",
            Refusal::Repeated => "repeated",
            Refusal::TooFarAhead => "too far ahead",
            Refusal::TooMany => "too many at once",
        })
    }
}

/// How much was refused, and why.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Refusals(BTreeMap<Refusal, u64>);

impl Refusals {
    /// Counts what is refused.
    pub fn count(&mut self, refusal: Refusal) {
        *self.0.entry(refusal).or_default() += 1;
    }

    /// How much was refused in all.
    pub fn total(&self) -> u64 {
        self.0.values().sum()
    }
}

impl fmt::Display for Refusals {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} packets refused", self.total())?;
        let reasons: Vec<_> = self.0.iter().map(|(why, count)| format!("{count} {why}")).collect();
        if reasons.is_empty() { Ok(()) } else { write!(formatter, ": {}", reasons.join(", ")) }
    }
}

impl Packet {
    /// The packet as it is sent.
    ///
    /// # Errors
    /// Never with numbers that a format can hold.
    pub fn encode(&self) -> Result<Vec<u8>, postcard::Error> {
        postcard::to_stdvec(self)
    }

    /// Reads what has arrived, in a scenario with this many nodes.
    ///
    /// # Errors
    /// Why it is refused.
    pub fn decode(bytes: &[u8], nodes: usize) -> Result<Self, Refusal> {
        if bytes.len() > LONGEST_PACKET {
            return Err(Refusal::TooLong);
        }
        let packet: Packet = read(bytes).ok_or(Refusal::Malformed)?;
        let Stamp { period, round, answer } = packet.stamp;
        let is_known = |letter: &Letter| letter.to.is_none_or(|to| (to as usize) < nodes);
        let is_sound = packet.position.iter().all(|number| number.is_finite())
            && period < MOST_PERIODS
            && (1..MOST_ROUNDS).contains(&round)
            && answer < MOST_ROUNDS
            && packet.next.is_none_or(|next| (round + 1..MOST_ROUNDS).contains(&next))
            && packet.letters.len() <= MOST_MESSAGES
            && packet.letters.iter().all(is_known);
        if is_sound { Ok(packet) } else { Err(Refusal::Malformed) }
    }

    /// Where the sender is.
    pub fn place(&self) -> Point {
        self.position.into()
    }
}

impl Letter {
    /// The letter with a message.
    ///
    /// # Errors
    /// Never with numbers that a format can hold.
    pub fn of(to: Destination, message: &Message) -> Result<Self, postcard::Error> {
        let to = match to {
            Destination::Everyone => None,
            Destination::One(node) => Some(node as u32),
        };
        Ok(Letter { to, message: postcard::to_stdvec(message)?, beacon: None })
    }

    /// Whether it is for this node.
    pub fn is_for(&self, node: NodeId) -> bool {
        self.to.is_none_or(|to| to as usize == node)
    }
}

/// The message that node `from` of this site has sent in these bytes.
///
/// # Errors
/// Why it is refused.
pub fn open(bytes: &[u8], from: NodeId, site: &Site) -> Result<Message, Refusal> {
    let message: Message = read(bytes).ok_or(Refusal::Message)?;
    let is_own = match &message {
        Message::Beacon { beacon, .. } => beacon.sender == from,
        _ => true,
    };
    if is_own && message.is_possible(site) { Ok(message) } else { Err(Refusal::Message) }
}

/// Reads a value, if the bytes are one and nothing more.
fn read<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Option<T> {
    let (value, rest) = postcard::take_from_bytes(bytes).ok()?;
    rest.is_empty().then_some(value)
}
