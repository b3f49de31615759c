//! What is said in a mission, and nodes in the midst of it that hear more.

use missions::{Passage, Through};
use pleach::automaton::Executor;
use pleach::automaton::network::{Member, Message, Network};
use pleach::automaton::node::{Envelope, Input, Node, Outputs};
use pleach::scenario_file;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The messages of each kind that are kept.
const OF_A_KIND: usize = 12;
/// Ticks for which a node goes on after it has heard something.
const TICKS: usize = 12;

/// Keeps some of what is said.
#[derive(Default)]
pub struct Ear {
    /// By kind: its beginning as text.
    said: BTreeMap<String, Vec<String>>,
}

/// The nodes of a mission that is under way.
pub struct Listeners(Vec<Member>);

impl Ear {
    /// The nodes of a mission after some control periods, and what they have said.
    pub fn listen() -> (Listeners, Vec<String>) {
        let scenario = scenario_file::read(Path::new("scenarios/corridor.toml")).unwrap();
        let site = Arc::clone(scenario.site());
        let ear = Through::new(&site, Ear::default());
        let mut network = Network::with_medium(&scenario, site, ear).unwrap();
        Executor::new(150.0, 1_000_000).unwrap().run(&mut network, &mut ()).unwrap();
        let said = network.medium().said.values().flatten().cloned().collect();
        (Listeners(network.nodes().to_vec()), said)
    }
}

impl Passage for Ear {
    fn note_sent(&mut self, envelope: &Envelope<Message>) {
        let text = serde_json::to_string(&envelope.message).unwrap();
        let kind: String = text.chars().take(12).collect();
        let known = self.said.entry(kind).or_default();
        match known.len() {
            OF_A_KIND => {
                let at = text.len() % OF_A_KIND;
                known[at] = text;
            }
            _ => known.push(text),
        }
    }
}

impl Listeners {
    /// Whether a text is a message of one of the nodes. One of the others hears it then, in each stage of
    /// its control period, and goes on.
    pub fn hear(&self, text: &str) -> bool {
        let Ok(message) = serde_json::from_str::<Message>(text) else { return false };
        let Listeners(nodes) = self;
        let from = match &message {
            Message::Beacon { beacon, .. } => beacon.sender,
            _ => 1,
        };
        if from >= nodes.len() {
            return false;
        }
        let to = (from + 1) % nodes.len();
        let (mut listener, mut outputs) = (nodes[to].clone(), Outputs::of(to));
        for _ in 0..TICKS {
            let heard = listener.step(Input::Heard { from, message: &message }, &mut outputs);
            let went_on =
                heard.and_then(|()| listener.step(Input::Tick { passed: 0 }, &mut outputs));
            if went_on.is_err() {
                return false;
            }
        }
        true
    }
}
