//! What messages carry, in files and packets of any format (feature `serde`).
//!
//! Reading refuses what no node can have sent: a set that is not ascending or holds an absurd
//! number, an election whose best bidder has placed no token, a break point without a vote, and a
//! lineage with a cycle. What is written is read back, in every format that has sequences, options
//! and named fields.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use serde::ser::{Serialize, Serializer};

use super::{Agreement, Bid, Election, IdSet, Lineage, NodeId, NoticeId, PostId};

/// Sets of identities hold numbers below this, so that a set that is read is small.
const LARGEST_SET: usize = 1 << 16;

/// A set is written as its numbers, ascending, for people to read. For machines it is written as
/// its runs, each with how many numbers are missing before it and how many are in it, since the sets
/// of large networks are mostly full or empty.
impl Serialize for IdSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // Formats without an end of sequences want to know the length beforehand.
        match serializer.is_human_readable() {
            true => serializer.collect_seq(self.iter().collect::<Vec<_>>()),
            false => serializer.collect_seq(runs(self)),
        }
    }
}

impl<'de> Deserialize<'de> for IdSet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match deserializer.is_human_readable() {
            true => deserializer.deserialize_seq(Ascending),
            false => deserializer.deserialize_seq(Runs),
        }
    }
}

/// The runs of a set.
fn runs(set: &IdSet) -> Vec<(usize, usize)> {
    let (mut runs, mut end): (Vec<(usize, usize)>, usize) = (Vec::new(), 0);
    for number in set.iter() {
        match runs.last_mut() {
            Some((_, length)) if number == end => *length += 1,
            _ => runs.push((number - end, 1)),
        }
        end = number + 1;
    }
    runs
}

struct Runs;

impl<'de> Visitor<'de> for Runs {
    type Value = IdSet;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "runs of numbers below {LARGEST_SET}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut runs: A) -> Result<IdSet, A::Error> {
        let (mut set, mut end) = (IdSet::new(), 0_usize);
        while let Some((gap, length)) = runs.next_element::<(usize, usize)>()? {
            let begin = end.saturating_add(gap);
            // Only the first run may begin at once.
            let is_apart = gap > 0 || end == 0;
            end = begin.saturating_add(length);
            if length == 0 || !is_apart || end > LARGEST_SET {
                let wrong = format_args!("a run of {length} numbers from {begin} in a set");
                return Err(A::Error::custom(wrong));
            }
            for number in begin..end {
                set.insert(number);
            }
        }
        Ok(set)
    }
}

struct Ascending;

impl<'de> Visitor<'de> for Ascending {
    type Value = IdSet;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "ascending numbers below {LARGEST_SET}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<IdSet, A::Error> {
        let (mut set, mut least) = (IdSet::new(), 0);
        while let Some(number) = numbers.next_element::<usize>()? {
            if !(least..LARGEST_SET).contains(&number) {
                let wrong =
                    format_args!("{number} in a set of ascending numbers below {LARGEST_SET}");
                return Err(A::Error::custom(wrong));
            }
            set.insert(number);
            least = number + 1;
        }
        Ok(set)
    }
}

/// The parts of an [`Election`] before they are checked.
#[derive(serde::Deserialize)]
#[serde(rename = "Election", deny_unknown_fields)]
pub(super) struct ElectionParts {
    id: NoticeId,
    tokens: IdSet,
    best: Option<(Bid, NodeId)>,
}

impl TryFrom<ElectionParts> for Election {
    type Error = &'static str;

    fn try_from(ElectionParts { id, tokens, best }: ElectionParts) -> Result<Self, Self::Error> {
        Election::from_parts(id, tokens, best).ok_or("the best bidder has placed no token")
    }
}

/// The parts of an [`Agreement`] before they are checked.
#[derive(serde::Deserialize)]
#[serde(rename = "Agreement", deny_unknown_fields)]
pub(super) struct AgreementParts {
    id: NoticeId,
    voted: IdSet,
    breaks: IdSet,
    arrived: IdSet,
    given_up: IdSet,
}

impl TryFrom<AgreementParts> for Agreement {
    type Error = &'static str;

    fn try_from(parts: AgreementParts) -> Result<Self, Self::Error> {
        let AgreementParts { id, voted, breaks, arrived, given_up } = parts;
        let agreement = Agreement::from_parts(id, voted, breaks, arrived, given_up);
        agreement.ok_or("a break point has not voted")
    }
}

/// The parts of a [`Lineage`] before they are checked.
#[derive(serde::Deserialize)]
#[serde(rename = "Lineage", deny_unknown_fields)]
pub(super) struct LineageParts {
    posts: Vec<PostId>,
    root: usize,
}

impl TryFrom<LineageParts> for Lineage {
    type Error = &'static str;

    fn try_from(LineageParts { posts, root }: LineageParts) -> Result<Self, Self::Error> {
        Lineage::from_parts(posts, root).ok_or("the lineage leads through a post twice")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::de::DeserializeOwned;

    /// Whether what is written is read back, and written alike again.
    fn comes_back<T>(value: &T)
    where
        T: Serialize + DeserializeOwned + PartialEq + fmt::Debug,
    {
        let text = serde_json::to_string(value).expect("it can be written");
        let read: T = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(&read, value);
        assert_eq!(serde_json::to_string(&read).expect("it can be written"), text);
    }

    /// What is said of a text that is not a `T`.
    fn refusal<T: DeserializeOwned + fmt::Debug>(text: &str) -> String {
        serde_json::from_str::<T>(text).expect_err(text).to_string()
    }

    #[test]
    fn what_is_written_is_read_back() {
        let id = NoticeId::new(3, 17);
        comes_back(&id);
        for numbers in [vec![], vec![0], vec![63], vec![64], vec![3, 64, 200, LARGEST_SET - 1]] {
            comes_back(&numbers.into_iter().collect::<IdSet>());
        }
        let mut election = Election::new(id);
        comes_back(&election);
        election.place(2, None);
        election.place(70, Some(Bid { rank: 1, merit: i64::MIN, economy: -4 }));
        comes_back(&election);
        let mut agreement = Agreement::new(id);
        agreement.vote(0, true);
        agreement.vote(3, false);
        agreement.arrive(1);
        agreement.give_up(2);
        comes_back(&agreement);
        let lineage = Lineage::of_access_point(1);
        comes_back(&lineage);
        comes_back(&lineage.extended_by(PostId(4)).expect("no cycle"));
    }

    #[test]
    fn sets_are_ascending_and_small() {
        let expected = "in a set of ascending numbers below 65536";
        for text in ["[1,1]", "[2,1]", "[65536]", "[18446744073709551615]"] {
            assert!(refusal::<IdSet>(text).contains(expected), "{text}");
        }
        assert!(refusal::<IdSet>("[-1]").contains("invalid value"));
        assert!(refusal::<IdSet>("7").contains("expected ascending numbers below 65536"));
    }

    #[test]
    fn what_no_node_can_have_said_is_refused() {
        let id = r#""id":{"number":1,"issuer":2}"#;
        let bid = r#"[{"rank":1,"merit":0,"economy":0},5]"#;
        let election = format!(r#"{{{id},"tokens":[4],"best":{bid}}}"#);
        assert!(refusal::<Election>(&election).contains("has placed no token"));
        let agreement =
            format!(r#"{{{id},"voted":[0],"breaks":[0,1],"arrived":[],"given_up":[]}}"#);
        assert!(refusal::<Agreement>(&agreement).contains("a break point has not voted"));
        let cycle = r#"{"posts":[4,1,4],"root":0}"#;
        assert!(refusal::<Lineage>(cycle).contains("leads through a post twice"));
        assert!(refusal::<Election>(cycle).contains("unknown field `posts`"));
        assert!(refusal::<Agreement>("{}").contains("missing field `id`"));
    }
}
