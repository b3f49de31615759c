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
