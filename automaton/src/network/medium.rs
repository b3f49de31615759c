//! The radio: which nodes hear each other.

use pleach_continuous::Point;
use pleach_continuous::network::reliability::LinkReliability;
use pleach_discrete::network::NodeId;

use super::message::Message;
use super::site::Site;
use crate::node::{Arrivals, Delivery, Destination, Envelope, Medium};

/// A synchronous medium in memory: every message arrives at once, over links with R_ij > 0, over
/// the wire between access points and over that from the user to the first of them.
///
/// Nodes are numbered from 0: robots first, then access points, last the user.
#[derive(Debug)]
pub struct Radio {
    range: f64,
    robots: usize,
    access_points: usize,
    /// Where the nodes were when audiences were found.
    bodies: Vec<Point>,
    audiences: Vec<Vec<NodeId>>,
    sent: Vec<Envelope<Message>>,
    delivered: u64,
}

impl Radio {
    /// The radio of a site.
    pub fn new(site: &Site) -> Self {
        Radio {
            range: site.radio.range(),
            robots: site.robots,
            access_points: site.access_points.len(),
            bodies: Vec::new(),
            audiences: Vec::new(),
            sent: Vec::new(),
            delivered: 0,
        }
    }

    /// The number of messages delivered so far.
    pub const fn delivered(&self) -> u64 {
        self.delivered
    }

    /// The nodes that hear `sender`, ascending.
    pub fn audience(&self, sender: NodeId) -> &[NodeId] {
        self.audiences.get(sender).map_or(&[], Vec::as_slice)
    }

    /// The nodes that `node` is wired to.
    fn wired(&self, node: NodeId) -> std::ops::Range<NodeId> {
        let (first, user) = (self.robots, self.robots + self.access_points);
        match node {
            robot if robot < first => 0..0,
            // The user is wired to the first access point.
            access_point if access_point == first => first..user + 1,
            access_point if access_point < user => first..user,
            _ => first..first + 1,
        }
    }
}

impl Medium<Message, Point> for Radio {
    fn update(&mut self, bodies: &[Point]) {
        if self.bodies == bodies {
            return;
        }
        self.bodies.clear();
        self.bodies.extend_from_slice(bodies);
        self.audiences.resize_with(bodies.len(), Vec::new);
        let user = self.robots + self.access_points;
        let with_radio = &bodies[..user.min(bodies.len())];
        let cells = Cells::new(with_radio, self.range);
        for node in 0..bodies.len() {
            let wired = self.wired(node);
            let audience = &mut self.audiences[node];
            audience.clear();
            if node < user {
                cells.around(bodies[node], |other| {
                    let near = (bodies[node] - bodies[other]).norm() < self.range;
                    if other != node && near && !(node >= self.robots && other >= self.robots) {
                        audience.push(other);
                    }
                });
            }
            audience.extend(wired.filter(|&other| other != node && other < bodies.len()));
            audience.sort_unstable();
        }
    }

    fn send(&mut self, envelope: Envelope<Message>) {
        self.sent.push(envelope);
    }

    fn time_to_arrival(&self) -> Option<f64> {
        (!self.sent.is_empty()).then_some(0.0)
    }

    fn flow(&mut self, _: f64) {}

    fn deliver<E>(
        &mut self,
        mut hand_over: impl FnMut(Delivery<'_, Message>) -> Result<(), E>,
    ) -> Result<(), E> {
        let Radio { audiences, sent, delivered, .. } = self;
        sent.drain(..).try_for_each(|envelope| {
            let receivers = receivers(audiences, &envelope);
            *delivered += receivers.len() as u64;
            let Envelope { from, message, .. } = envelope;
            receivers.iter().try_for_each(|&to| hand_over(Delivery { from, to, message: &message }))
        })
    }

    fn hand_out(&mut self, arrivals: &mut Arrivals<Message>) -> bool {
        let Radio { audiences, sent, delivered, .. } = self;
        arrivals.add(sent, |envelope| receivers(audiences, envelope));
        *delivered += arrivals.deliveries() as u64;
        true
    }
}

/// The nodes that hear a message.
fn receivers<'a>(audiences: &'a [Vec<NodeId>], envelope: &Envelope<Message>) -> &'a [NodeId] {
    let audience = audiences.get(envelope.from).map_or(&[][..], Vec::as_slice);
    match envelope.to {
        Destination::Everyone => audience,
        Destination::One(node) => match audience.binary_search(&node) {
            Ok(at) => &audience[at..=at],
            Err(_) => &[],
        },
    }
}

/// Nodes sorted into square cells as wide as the radio's range.
struct Cells {
    width: f64,
    sorted: Vec<((i64, i64), NodeId)>,
}

impl Cells {
    fn new(positions: &[Point], width: f64) -> Self {
        let mut sorted: Vec<_> =
            positions.iter().enumerate().map(|(node, &p)| (Self::cell(p, width), node)).collect();
        sorted.sort_unstable();
        Cells { width, sorted }
    }

    fn cell(place: Point, width: f64) -> (i64, i64) {
        ((place.x / width).floor() as i64, (place.y / width).floor() as i64)
    }

    fn around(&self, place: Point, mut visit: impl FnMut(NodeId)) {
        let (column, row) = Self::cell(place, self.width);
        for x in column - 1..=column + 1 {
            let from = self.sorted.partition_point(|&(cell, _)| cell < (x, row - 1));
            let to = self.sorted.partition_point(|&(cell, _)| cell <= (x, row + 1));
            self.sorted[from..to].iter().for_each(|&(_, node)| visit(node));
        }
    }
}
