//! The radio: which nodes hear each other.

use pleach_continuous::Point;
use pleach_continuous::geometry::Neighbours;
use pleach_continuous::network::reliability::LinkReliability;
use pleach_discrete::network::NodeId;

use super::message::Message;
use super::site::Site;
use crate::node::{Delivery, Destination, Envelope, Mail, Medium};

/// A synchronous medium in memory: every message arrives at once, over links with R_ij > 0, over
/// the wire between access points and over that from the user to the first of them.
///
/// Nodes are numbered from 0: robots first, then access points, last the user.
#[derive(Debug)]
pub struct Radio {
    range: f64,
    robots: usize,
    access_points: usize,
    /// Where the nodes are, by number.
    bodies: Vec<Point>,
    audiences: Audiences,
    sent: Vec<Envelope<Message>>,
    mail: Mail<Message>,
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
            audiences: Audiences::default(),
            sent: Vec::new(),
            mail: Mail::default(),
            delivered: 0,
        }
    }

    /// The number of messages delivered so far.
    pub const fn delivered(&self) -> u64 {
        self.delivered
    }

    /// The nodes that hear `sender`, ascending.
    pub fn audience(&self, sender: NodeId) -> &[NodeId] {
        self.audiences.of(sender)
    }

    /// Recomputes which nodes are in range of each other.
    fn survey(&mut self) {
        let Radio { range, robots, access_points, ref bodies, .. } = *self;
        let user = robots + access_points;
        let with_radio = &bodies[..user.min(bodies.len())];
        let neighbours = Neighbours::new(with_radio, range);
        let mut audiences = Audiences::default();
        for (node, &place) in bodies.iter().enumerate() {
            let first = audiences.nodes.len();
            if node < user {
                neighbours.for_each_within(place, range, |other, distance| {
                    let is_wired = node >= robots && other >= robots;
                    if other != node && distance < range && !is_wired {
                        audiences.nodes.push(other);
                    }
                });
            }
            let wired = self.wired(node).filter(|&other| other != node && other < bodies.len());
            audiences.nodes.extend(wired);
            audiences.nodes[first..].sort_unstable();
            audiences.ends.push(audiences.nodes.len());
        }
        self.audiences = audiences;
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
        if self.bodies != bodies {
            bodies.clone_into(&mut self.bodies);
            self.survey();
        }
    }

    fn send(&mut self, envelope: Envelope<Message>) {
        self.sent.push(envelope);
    }

    fn send_all(&mut self, envelopes: &mut Vec<Envelope<Message>>) {
        match self.sent.is_empty() {
            true => std::mem::swap(&mut self.sent, envelopes),
            false => self.sent.append(envelopes),
        }
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
            let receivers = audiences.receivers_of(&envelope);
            *delivered += receivers.len() as u64;
            let Envelope { from, message, .. } = &envelope;
            receivers.iter().try_for_each(|&to| hand_over(Delivery { from: *from, to, message }))
        })
    }

    fn mail(&mut self) -> Option<&Mail<Message>> {
        let Radio { audiences, sent, mail, delivered, .. } = self;
        let may_be_answered = sent.iter().any(|it| it.message.may_be_answered_at_once());
        let receivers_of = |envelope: &Envelope<Message>| audiences.receivers_of(envelope);
        mail.sort(sent, audiences.ends.len(), receivers_of, may_be_answered);
        *delivered += mail.len() as u64;
        Some(mail)
    }
}

/// The nodes that hear each node, one after another.
#[derive(Debug, Default)]
struct Audiences {
    nodes: Vec<NodeId>,
    /// Where among them those end that hear a node, by its number.
    ends: Vec<usize>,
}

impl Audiences {
    /// The nodes that hear `sender`, ascending.
    fn of(&self, sender: NodeId) -> &[NodeId] {
        let Some(&end) = self.ends.get(sender) else { return &[] };
        let first = sender.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.nodes[first..end]
    }

    /// The nodes that hear a message, ascending.
    fn receivers_of(&self, envelope: &Envelope<Message>) -> &[NodeId] {
        let audience = self.of(envelope.from);
        match envelope.to {
            Destination::Everyone => audience,
            Destination::One(node) => match audience.binary_search(&node) {
                Ok(at) => &audience[at..=at],
                Err(_) => &[],
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use serde_json::json;

    use super::super::scenario::Scenario;
    use super::*;

    /// A radio of three robots in a row, of which only neighbours hear each other, and two access points.
    fn radio() -> Radio {
        let scenario: Scenario = serde_json::from_value(json!({
            "name": "a row",
            "workspace": {"boundary": [[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [0.0, 4.0]]},
            "link": {"full_range": 1.0, "max_range": 2.0},
            "access_point": [{"position": [1.0, 1.0]}, {"position": [9.0, 1.0]}],
            "robot": [
                {"position": [2.0, 1.0], "rate": 0.1},
                {"position": [3.5, 1.0], "rate": 0.1},
                {"position": [5.0, 1.0], "rate": 0.1},
            ],
            "task": [{"position": [8.0, 1.0]}],
        }))
        .expect("it is a scenario");
        let site = Site::new(&scenario).expect("its numbers make sense");
        let places = [(2.0, 1.0), (3.5, 1.0), (5.0, 1.0), (1.0, 1.0), (9.0, 1.0), (0.0, 0.0)];
        let mut radio = Radio::new(&site);
        radio.update(&places.map(|(x, y)| Point::new(x, y)));
        radio
    }

    const NODES: usize = 6;

    /// What each node hears of these messages, with the senders: as all are handed over, and node by node.
    fn heard(sent: &[(NodeId, Destination, f64)]) -> [[Vec<(NodeId, Message)>; NODES]; 2] {
        let heard = |by_node: bool| {
            let mut radio = radio();
            for &(from, to, flow) in sent {
                radio.send(Envelope { from, to, message: Message::Flow(flow) });
            }
            let mut heard: [Vec<_>; NODES] = Default::default();
            let hand_over = |Delivery { from, to, message }: Delivery<'_, Message>| {
                heard[to].push((from, message.clone()));
                Ok::<(), Infallible>(())
            };
            let Ok(()) = match by_node {
                true => {
                    let mail = radio.mail().expect("a radio sorts its messages");
                    let deliveries = (0..NODES).flat_map(|node| mail.of(node));
                    deliveries.map(|(_, delivery)| delivery).try_for_each(hand_over)
                }
                false => radio.deliver(hand_over),
            };
            assert_eq!(radio.time_to_arrival(), None);
            assert_eq!(radio.delivered(), heard.iter().map(Vec::len).sum::<usize>() as u64);
            heard
        };
        [heard(false), heard(true)]
    }

    #[test]
    fn robots_hear_those_in_range_and_access_points_hear_each_other() {
        let radio = radio();
        let audiences: Vec<&[NodeId]> = (0..=NODES).map(|node| radio.audience(node)).collect();
        assert_eq!(audiences, [&[1, 3][..], &[0, 2], &[1], &[0, 4, 5], &[3], &[3], &[]]);
    }

    #[test]
    fn each_node_hears_the_same_in_the_same_order_where_each_is_served_in_turn() {
        use Destination::{Everyone, One};
        let sent = [
            (0, Everyone, 0.1),
            (1, One(2), 0.2),
            (1, Everyone, 0.3),
            (3, Everyone, 0.4),
            (2, One(0), 0.5), // out of range
            (0, One(1), 0.6),
            (5, Everyone, 0.7),
        ];
        let [all, by_node] = heard(&sent);
        assert_eq!(all, by_node);
        let counts = all.map(|heard| heard.len());
        assert_eq!(counts, [2, 2, 2, 2, 1, 1]);
        assert!(heard(&[]).iter().flatten().all(Vec::is_empty));
    }
}
