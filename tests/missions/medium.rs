//! The radio with a filter: tests see every message that would arrive, and may lose it.

use pleach::automaton::network::{Message, Radio, Site};
use pleach::automaton::node::{Delivery, Envelope, Medium};
use pleach::continuous::Point;
use pleach::discrete::network::NodeId;

/// A message that would arrive.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// The number of messages before it.
    pub number: u64,
    /// k.
    pub period: usize,
    pub sender: NodeId,
    pub receiver: NodeId,
    /// The length of the link; none of a wire.
    pub distance: Option<f64>,
}

/// A radio that loses the messages of which `loses` says so.
#[derive(Debug)]
pub struct Filtered<F> {
    radio: Radio,
    robots: usize,
    positions: Vec<Point>,
    messages: u64,
    updates: usize,
    loses: F,
}

impl<F: FnMut(Arrival) -> bool> Filtered<F> {
    pub fn new(site: &Site, loses: F) -> Self {
        let (radio, robots) = (Radio::new(site), site.robots);
        Filtered { radio, robots, positions: Vec::new(), messages: 0, updates: 0, loses }
    }

    /// How many messages have arrived or been lost.
    pub const fn messages(&self) -> u64 {
        self.messages
    }
}

impl<F: FnMut(Arrival) -> bool> Medium<Message, Point> for Filtered<F> {
    fn update(&mut self, bodies: &[Point]) {
        self.updates += 1;
        bodies.clone_into(&mut self.positions);
        self.radio.update(bodies);
    }

    fn send(&mut self, envelope: Envelope<Message>) {
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
        let Filtered { radio, robots, positions, messages, updates, loses } = self;
        radio.deliver(|delivery| {
            let (sender, receiver) = (delivery.from, delivery.to);
            let is_wire = sender >= *robots && receiver >= *robots;
            let distance = (!is_wire).then(|| (positions[sender] - positions[receiver]).norm());
            let (number, period) = (*messages, *updates - 1);
            *messages += 1;
            let arrival = Arrival { number, period, sender, receiver, distance };
            if loses(arrival) { Ok(()) } else { hand_over(delivery) }
        })
    }
}

/// A radio over which the user's request also arrives at a second access point, so that two of them serve the
/// same user.
#[derive(Debug)]
pub struct AskedTwice {
    radio: Radio,
    second: NodeId,
}

impl AskedTwice {
    pub fn new(site: &Site) -> Self {
        AskedTwice { radio: Radio::new(site), second: site.robots + 1 }
    }
}

impl Medium<Message, Point> for AskedTwice {
    fn update(&mut self, bodies: &[Point]) {
        self.radio.update(bodies);
    }

    fn send(&mut self, envelope: Envelope<Message>) {
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
        let AskedTwice { radio, second } = self;
        radio.deliver(|Delivery { from, to, message }| {
            hand_over(Delivery { from, to, message })?;
            match message {
                Message::Request(_) => hand_over(Delivery { from, to: *second, message }),
                _ => Ok(()),
            }
        })
    }
}

/// A radio between processes: every message is written as text by its sender and read by each of its
/// receivers, and nothing else goes from node to node.
#[derive(Debug)]
pub struct Written {
    radio: Radio,
    bytes: u64,
}

impl Written {
    pub fn new(site: &Site) -> Self {
        Written { radio: Radio::new(site), bytes: 0 }
    }

    /// The length of all texts so far.
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl Medium<Message, Point> for Written {
    fn update(&mut self, bodies: &[Point]) {
        self.radio.update(bodies);
    }

    fn send(&mut self, envelope: Envelope<Message>) {
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
        let Written { radio, bytes } = self;
        radio.deliver(|Delivery { from, to, message }| {
            let text = serde_json::to_string(message).expect("a message can be written");
            *bytes += text.len() as u64;
            let message: Message =
                serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
            hand_over(Delivery { from, to, message: &message })
        })
    }
}
