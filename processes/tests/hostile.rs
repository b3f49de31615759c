//! What a process gets from others is untrusted: it is refused or borne, and never brings it down.

#![allow(clippy::unwrap_used)] // a test that panics has failed

use pleach::automaton::Executor;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{Message, Network, Radio, Site};
use pleach::automaton::node::{Delivery, Destination, Envelope, Medium, NodeId};
use pleach::continuous::Point;
use pleach::discrete::network::IdSet;
use pleach_processes::local_nodes::LocalNodes;
use pleach_processes::packet::{LONGEST_PACKET, Letter, Packet, Refusal, Stamp, open};
use pleach_processes::repeats::{Content, Heard};
use pleach_processes::report::Report;
use proptest::prelude::*;
use std::path::Path;
use std::sync::OnceLock;

/// The radio of a simulation, which notes every kind of message that goes over it.
struct Noting {
    radio: Radio,
    noted: Vec<(NodeId, Destination, Message)>,
}

impl Medium<Message, Point> for Noting {
    fn update(&mut self, bodies: &[Point]) {
        self.radio.update(bodies);
    }

    fn send(&mut self, envelope: Envelope<Message>) {
        let Envelope { from, to, message } = &envelope;
        self.noted.push((*from, *to, message.clone()));
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
        hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.radio.deliver(hand_over)
    }
}

fn scenario() -> &'static ValidScenario {
    static SCENARIO: OnceLock<ValidScenario> = OnceLock::new();
    SCENARIO.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/redundant-node.toml");
        pleach::scenario_file::read(&path).unwrap()
    })
}

fn nodes() -> usize {
    scenario().robot.len() + scenario().access_point.len() + 1
}

fn site() -> &'static Site {
    scenario().site()
}

/// The letters of a whole mission, each with its sender; of the many that say the same a few.
fn letters() -> &'static [(NodeId, Letter)] {
    static LETTERS: OnceLock<Vec<(NodeId, Letter)>> = OnceLock::new();
    LETTERS.get_or_init(|| {
        let site = std::sync::Arc::clone(scenario().site());
        let medium = Noting { radio: Radio::new(&site), noted: Vec::new() };
        let mut network = Network::with_medium(scenario(), site, medium).unwrap();
        Executor::new(400.0, 1_000_000).unwrap().run(&mut network, &mut ()).unwrap();
        let noted = &network.medium().noted;
        let mut letters: Vec<(NodeId, Letter)> = noted
            .iter()
            .map(|(from, to, message)| (*from, Letter::of(*to, message).unwrap()))
            .collect();
        letters.sort_by(|(_, one), (_, other)| one.message.cmp(&other.message));
        letters.dedup_by(|(_, one), (_, other)| one.message == other.message);
        letters
    })
}

fn empty() -> Letter {
    Letter { to: None, message: Vec::new(), beacon: None }
}

fn packet(letters: Vec<Letter>) -> Packet {
    let stamp = Stamp { period: 3, round: 2, answer: 0 };
    Packet { stamp, next: Some(7), asks: true, is_over: false, position: [0.3, 0.4], letters }
}

#[test]
fn messages_of_a_mission_are_read_as_they_were_written() {
    assert!(letters().len() > 1_000);
    for (from, letter) in letters() {
        let message = open(&letter.message, *from, site()).unwrap();
        assert_eq!(Letter::of(Destination::Everyone, &message).unwrap().message, letter.message);
    }
}

#[test]
fn no_beacon_is_taken_in_the_name_of_another_node() {
    let is_beacon = |(from, letter): &&(NodeId, Letter)| {
        matches!(open(&letter.message, *from, site()).unwrap(), Message::Beacon { .. })
    };
    let (from, letter) = letters().iter().find(is_beacon).unwrap();
    assert_eq!(open(&letter.message, from + 1, site()), Err(Refusal::Message));
}

#[test]
fn packets_are_bounded() {
    let sound = packet(vec![letters()[0].1.clone(); 3]);
    let bytes = sound.encode().unwrap();
    assert_eq!(Packet::decode(&bytes, nodes()), Ok(sound.clone()));
    assert_eq!(Packet::decode(&vec![0; LONGEST_PACKET + 1], nodes()), Err(Refusal::TooLong));
    let refused = |packet: Packet| {
        assert_eq!(Packet::decode(&packet.encode().unwrap(), nodes()), Err(Refusal::Malformed));
    };
    let at = |round, answer| Stamp { period: 0, round, answer };
    refused(Packet { stamp: Stamp { period: u32::MAX, round: 1, answer: 0 }, ..sound.clone() });
    refused(Packet { position: [f64::NAN, 0.0], ..sound.clone() });
    refused(Packet { stamp: at(0, 0), ..sound.clone() });
    refused(Packet { stamp: at(u32::MAX, 0), next: None, ..sound.clone() });
    refused(Packet { stamp: at(1, u32::MAX), ..sound.clone() });
    refused(Packet { next: Some(2), ..sound.clone() });
    refused(Packet { next: Some(u32::MAX), ..sound.clone() });
    refused(packet(vec![Letter { to: Some(nodes() as u32), ..empty() }]));
    refused(packet(vec![empty(); 1_025]));
}

/// Changes of bytes.
#[derive(Clone, Debug)]
enum Change {
    Set(usize, u8),
    Add(usize, u8),
    Drop(usize),
    Cut(usize),
    Splice(usize, usize, usize),
}

fn changes() -> impl Strategy<Value = Vec<Change>> {
    let change = prop_oneof![
        (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Change::Set(at, byte)),
        // The numbers at which the format and the reader have their bounds.
        (any::<usize>(), prop_oneof![Just(0u8), Just(1), Just(127), Just(128), Just(255)])
            .prop_map(|(at, byte)| Change::Set(at, byte)),
        (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Change::Add(at, byte)),
        any::<usize>().prop_map(Change::Drop),
        any::<usize>().prop_map(Change::Cut),
        any::<(usize, usize, usize)>().prop_map(|(at, from, to)| Change::Splice(at, from, to)),
    ];
    proptest::collection::vec(change, 0..6)
}

fn changed(bytes: &[u8], changes: &[Change]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for change in changes {
        let length = bytes.len().max(1);
        match *change {
            _ if bytes.is_empty() => bytes.push(0),
            Change::Set(at, byte) => bytes[at % length] = byte,
            Change::Add(at, byte) => bytes.insert(at % length, byte),
            Change::Drop(at) => drop(bytes.remove(at % length)),
            Change::Cut(at) => bytes.truncate(at % length),
            Change::Splice(at, from, to) => {
                let (from, to) = (from % length, to % length);
                let part = bytes[from.min(to)..from.max(to)].to_vec();
                bytes.splice(at % length..at % length, part);
            }
        }
    }
    bytes
}

/// A letter of the mission with changes, as it would be if it came from `from`.
fn hostile() -> impl Strategy<Value = (NodeId, Letter)> {
    (any::<prop::sample::Index>(), changes()).prop_map(|(which, changes)| {
        let (from, letter) = which.get(letters());
        let message = changed(&letter.message, &changes);
        (*from, Letter { message, ..letter.clone() })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(2_000)))]

    #[test]
    fn bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = Packet::decode(&bytes, nodes());
        let _ = Report::decode(&bytes, scenario());
        let _ = open(&bytes, 0, site());
        let beacon = Some(Content::Whole(bytes.clone()));
        let letter = Letter { to: None, message: bytes, beacon };
        let whole = Heard::default().message(0, 1, &letter);
        let _ = open(&whole.unwrap_or_default(), 0, site());
    }

    /// For machines sets are written as runs.
    #[test]
    fn sets_are_read_as_they_were_written(numbers in proptest::collection::btree_set(0..300_usize, 0..80)) {
        let set: IdSet = numbers.iter().copied().collect();
        let bytes = postcard::to_stdvec(&set).unwrap();
        prop_assert_eq!(postcard::from_bytes::<IdSet>(&bytes), Ok(set));
        let everyone: IdSet = (0..1_000).collect();
        prop_assert!(postcard::to_stdvec(&everyone).unwrap().len() < 5);
    }

    #[test]
    fn changed_packets_are_read_or_refused(
        which in proptest::collection::vec(any::<prop::sample::Index>(), 0..4),
        changes in changes(),
    ) {
        let letters = which.iter().map(|which| which.get(letters()).1.clone()).collect();
        let bytes = changed(&packet(letters).encode().unwrap(), &changes);
        if let Ok(packet) = Packet::decode(&bytes, nodes()) {
            prop_assert_eq!(Packet::decode(&packet.encode().unwrap(), nodes()), Ok(packet));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(400)))]

    /// Whatever is not refused, a node bears: it goes on, and its numbers stay finite.
    #[test]
    fn nodes_bear_what_is_not_refused(
        node in 0..nodes() - 1,
        periods in proptest::collection::vec(proptest::collection::vec((hostile(), 0..40u32), 0..60), 1..5),
    ) {
        let robots = scenario().robot.len();
        let mut nodes = match node.checked_sub(robots) {
            None => LocalNodes::robot(scenario(), node, scenario().robot[node].position.into()),
            Some(number) => LocalNodes::access_points(scenario(), [number]).unwrap(),
        };
        for letters in periods {
            nodes.begin_period();
            for round in 1..400 {
                let heard: Vec<_> = letters
                    .iter()
                    .filter(|((from, _), at)| *at == round && *from != node)
                    .filter_map(|((from, letter), _)| Some((*from, node, open(&letter.message, *from, site()).ok()?)))
                    .collect();
                prop_assert!(nodes.tick(round).is_ok());
                prop_assert!(nodes.hear(&heard).is_ok());
                for node in nodes.nodes_mut() {
                    prop_assert!(node.letters().is_ok());
                }
            }
            for node in nodes.nodes_mut() {
                let _ = serde_json::to_string(&node.robot_report()).unwrap();
                prop_assert!(node.body().iter().all(|number| number.is_finite()));
            }
            prop_assert!(nodes.flow().is_ok());
        }
    }
}

/// As many cases as `PROPTEST_CASES` says, or a few.
fn cases(few: u32) -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(few)
}
