//! Beacons that say the same again are sent as a digest.
//!
//! A beacon is sent in several rounds of a control period, and mostly it says what the one of the
//! period before has said. Its content is sent whole in the first round of each control period, and in
//! every round of a period in which it has changed; otherwise a digest stands for it. A receiver
//! that has the content takes the digest for it; one that has not loses the message, and gets the
//! whole content in the next period at the latest. So a change is repeated as often as without digests.

use crate::packet::Letter;
use pleach::automaton::network::Message;
use pleach::automaton::node::{Destination, NodeId};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The content of a beacon: all of it but the control period, the roll and the confirmation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Content {
    /// As it is written.
    Whole(Vec<u8>),
    /// The digest of one that its sender has sent before.
    Known(u64),
}

/// What a node has sent last.
#[derive(Clone, Debug, Default)]
pub struct Sent {
    content: Vec<u8>,
    changed_in: u32,
    whole_in: u32,
}

impl Sent {
    /// The letter for a message.
    ///
    /// # Errors
    /// Never with numbers that a format can hold.
    pub fn letter(
        &mut self,
        to: Destination,
        message: &Message,
    ) -> Result<Letter, postcard::Error> {
        let mut letter = Letter::of(to, message)?;
        let Message::Beacon { period, beacon, .. } = message else { return Ok(letter) };
        // The content is the last field of the message.
        let content = postcard::to_stdvec(&**beacon)?;
        letter.message.truncate(letter.message.len() - content.len());
        let is_new = self.content != content;
        if is_new {
            (self.content, self.changed_in) = (content, *period);
        }
        let is_known = !is_new && self.changed_in < *period && self.whole_in == *period;
        letter.beacon = Some(match is_known {
            true => Content::Known(digest(&self.content)),
            false => Content::Whole(self.content.clone()),
        });
        self.whole_in = *period;
        Ok(letter)
    }
}

/// A content with its digest.
#[derive(Clone, Debug)]
struct Digested {
    digest: u64,
    content: Arc<[u8]>,
}

/// The contents that nodes of a process have heard last: by sender and receiver.
#[derive(Clone, Debug, Default)]
pub struct Heard {
    contents: BTreeMap<(NodeId, NodeId), Digested>,
    unknown: u64,
}

impl Heard {
    /// How many beacons were lost because the receiver did not have the content.
    pub const fn unknown(&self) -> u64 {
        self.unknown
    }

    /// The bytes of the message of a letter that has reached node `to`; none if it has no content.
    pub fn message(&mut self, from: NodeId, to: NodeId, letter: &Letter) -> Option<Vec<u8>> {
        let content = match &letter.beacon {
            None => return Some(letter.message.clone()),
            Some(Content::Whole(content)) => {
                let content: Arc<[u8]> = content.as_slice().into();
                let digest = digest(&content);
                let kept = Digested { digest, content: Arc::clone(&content) };
                self.contents.insert((from, to), kept);
                content
            }
            Some(Content::Known(known)) => match self.contents.get(&(from, to)) {
                Some(kept) if kept.digest == *known => Arc::clone(&kept.content),
                _ => {
                    self.unknown += 1;
                    return None;
                }
            },
        };
        Some([&letter.message, &*content].concat())
    }
}

/// FNV-1a, 64 bits. It tells contents apart, and protects nothing.
pub fn digest(bytes: &[u8]) -> u64 {
    let fold = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, fold)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pleach::automaton::network::AccessPoint;
    use pleach::automaton::node::{Input, Node, Outputs};
    use pleach::scenario_file;
    use std::path::Path;

    /// The first beacon of an access point, as it would be sent in this control period.
    fn beacon(number: u32) -> Message {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/too-few.toml");
        let site = Arc::clone(scenario_file::read(&path).unwrap().site());
        let mut outputs = Outputs::of(site.robots);
        AccessPoint::new(0, site).step(Input::Tick { passed: 0 }, &mut outputs).unwrap();
        let mut sent = outputs.drain_sent().map(|envelope| envelope.message);
        match sent.find(|message| matches!(message, Message::Beacon { .. })).unwrap() {
            Message::Beacon { roll, confirmed, beacon, .. } => {
                Message::Beacon { period: number, roll, confirmed, beacon }
            }
            _ => unreachable!("it is a beacon"),
        }
    }

    fn is_whole(letter: &Letter) -> bool {
        matches!(letter.beacon, Some(Content::Whole(_)))
    }

    #[test]
    fn what_has_not_changed_is_sent_whole_once_in_a_period() {
        let mut sent = Sent::default();
        let mut is_whole_in =
            |period| is_whole(&sent.letter(Destination::Everyone, &beacon(period)).unwrap());
        let of_period = |is_whole_in: &mut dyn FnMut(u32) -> bool, period| {
            [(); 3].map(|()| is_whole_in(period))
        };
        assert_eq!(of_period(&mut is_whole_in, 4), [true; 3], "it is new");
        assert_eq!(of_period(&mut is_whole_in, 5), [true, false, false]);
        assert_eq!(of_period(&mut is_whole_in, 6), [true, false, false]);
    }

    #[test]
    fn a_digest_is_read_by_those_that_have_the_content() {
        let mut sent = Sent::default();
        let mut letter = |period| sent.letter(Destination::Everyone, &beacon(period)).unwrap();
        let whole = letter(4);
        let [next, digest] = [letter(5), letter(5)];
        assert!(is_whole(&next) && !is_whole(&digest));
        let mut heard = Heard::default();
        assert_eq!(heard.message(5, 1, &digest), None, "it has heard nothing before");
        assert_eq!(heard.unknown(), 1);
        heard.message(5, 1, &whole).unwrap();
        let message = heard.message(5, 1, &digest).unwrap();
        assert_eq!(message, postcard::to_stdvec(&beacon(5)).unwrap());
        assert_eq!(heard.message(5, 2, &digest), None, "another node has not");
        assert_eq!(heard.message(4, 1, &digest), None, "it is the content of another node");
    }
}
