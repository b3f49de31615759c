//! What robots send: messages and bytes for each robot and control period, in missions that are
//! simulated, written as processes write them.
//!
//! `cargo run --release --manifest-path processes/Cargo.toml --example traffic` prints a table for
//! Study I and for halls with 100 and 1,000 robots. It fails if one of them exceeds the budget.

#[path = "../../benches/support/hall.rs"]
#[allow(dead_code)] // the benchmarks use the rest
mod hall;

use pleach::automaton::Executor;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{Message, Network, Radio};
use pleach::automaton::node::{Delivery, Envelope, Medium, NodeId};
use pleach::continuous::Point;
use pleach_processes::packet::Letter;
use pleach_processes::repeats::Sent;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

/// How much of something was sent.
#[derive(Clone, Copy, Default)]
struct Weight {
    messages: u64,
    bytes: u64,
}

/// The radio of a simulation, which weighs what robots send over it.
struct Scales {
    radio: Radio,
    robots: usize,
    sent: BTreeMap<NodeId, Sent>,
    beacons: Weight,
    /// The beacons, if each were sent whole.
    whole: Weight,
    others: Weight,
}

impl Scales {
    fn new(scenario: &ValidScenario) -> Self {
        Scales {
            radio: Radio::new(scenario.site()),
            robots: scenario.robot.len(),
            sent: BTreeMap::new(),
            beacons: Weight::default(),
            whole: Weight::default(),
            others: Weight::default(),
        }
    }

    fn weigh(&mut self, Envelope { from, to, message }: &Envelope<Message>) {
        if *from >= self.robots {
            return;
        }
        let sent = self.sent.entry(*from).or_default();
        let letter = sent.letter(*to, message);
        if matches!(message, Message::Beacon { .. }) {
            self.whole.add(Letter::of(*to, message));
            self.beacons.add(letter);
        } else {
            self.others.add(letter);
        }
    }
}

impl Weight {
    fn add(&mut self, letter: Result<Letter, postcard::Error>) {
        let bytes = letter.and_then(|letter| postcard::to_stdvec(&letter));
        self.messages += 1;
        self.bytes += bytes.map_or(0, |bytes| bytes.len() as u64);
    }
}

impl Medium<Message, Point> for Scales {
    fn update(&mut self, bodies: &[Point]) {
        self.radio.update(bodies);
    }

    fn send(&mut self, envelope: Envelope<Message>) {
        self.weigh(&envelope);
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

/// The most messages and bytes that a robot may send in a control period, on average.
const BUDGET: Budget = Budget { messages: 42.0, bytes: 1_500.0 };

struct Budget {
    messages: f64,
    bytes: f64,
}

/// Prints a line of the table: the first `periods` control periods of a mission.
fn weigh(scenario: &ValidScenario, periods: usize) -> Result<(), Box<dyn Error>> {
    let (site, scales) = (Arc::clone(scenario.site()), Scales::new(scenario));
    let period = site.settings.period;
    let mut network = Network::with_medium(scenario, site, scales)?;
    Executor::new((periods as f64 - 0.5) * period, 1_000_000)?.run(&mut network, &mut ())?;
    let robots = scenario.robot.len();
    let each = |count: u64| count as f64 / (robots * network.step()) as f64;
    let Scales { beacons, whole, others, .. } = network.medium();
    println!(
        "| {} | {robots} | {} | {:.1} | {:.1} | {:.0} | {:.0} | {:.0} | {:.0} |",
        scenario.name,
        network.step(),
        each(beacons.messages),
        each(others.messages),
        each(whole.bytes),
        each(beacons.bytes),
        each(others.bytes),
        each(beacons.bytes + others.bytes),
    );
    let messages = each(beacons.messages + others.messages);
    let bytes = each(beacons.bytes + others.bytes);
    if messages > BUDGET.messages || bytes > BUDGET.bytes {
        let Budget { messages: most, bytes: most_bytes } = BUDGET;
        let name = &scenario.name;
        return Err(format!(
            "{name}: a robot sends {messages:.1} messages and {bytes:.0} bytes a control period; the \
             budget is {most} and {most_bytes}"
        )
        .into());
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
    let study = pleach::scenario_file::read(&scenarios.join("study-1.toml"))?;
    println!(
        "| mission | robots | periods | beacons | other messages | bytes of beacons sent whole | \
         bytes of beacons | of others | of all |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    weigh(&study, 1_000)?;
    weigh(&hall::hall(100, 2), 300)?;
    weigh(&hall::hall(1_000, 2), 100)
}
