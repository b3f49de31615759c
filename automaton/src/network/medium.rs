//! The medium: who hears whom.

use pleach_continuous::Point;
use pleach_discrete::network::NodeId;

use super::site::Site;

/// What carries messages between nodes.
///
/// Robots never ask it anything; the network passes every message through it. A medium may lose
/// messages, but delivers none over a link with R_ij = 0.
pub trait Medium {
    /// The nodes have moved: find the links that exist now.
    fn update(&mut self, positions: &[Point]);

    /// The nodes that may hear `sender`, ascending.
    fn audience(&self, sender: NodeId) -> &[NodeId];

    /// Whether this message, from `sender` to `receiver`, arrives.
    fn delivers(&mut self, sender: NodeId, receiver: NodeId) -> bool;
}

/// A synchronous medium in memory: every message arrives, over links with R_ij > 0 and over the
/// wire between access points.
#[derive(Debug)]
pub struct Radio {
    range: f64,
    robots: usize,
    audiences: Vec<Vec<NodeId>>,
    delivered: u64,
}

impl Radio {
    /// The radio of a site.
    pub fn new(site: &Site) -> Self {
        use pleach_continuous::network::reliability::LinkReliability;
        Radio {
            range: site.link.range(),
            robots: site.robots,
            audiences: vec![Vec::new(); site.robots + site.access_points.len()],
            delivered: 0,
        }
    }

    /// The number of messages delivered so far.
    pub const fn delivered(&self) -> u64 {
        self.delivered
    }
}

impl Medium for Radio {
    fn update(&mut self, positions: &[Point]) {
        let cells = Cells::new(positions, self.range);
        for (node, audience) in self.audiences.iter_mut().enumerate() {
            audience.clear();
            cells.around(positions[node], |other| {
                let near = (positions[node] - positions[other]).norm() < self.range;
                if other != node && near && !(node >= self.robots && other >= self.robots) {
                    audience.push(other);
                }
            });
            if node >= self.robots {
                audience.extend((self.robots..positions.len()).filter(|&other| other != node));
            }
            audience.sort_unstable();
        }
    }

    fn audience(&self, sender: NodeId) -> &[NodeId] {
        &self.audiences[sender]
    }

    fn delivers(&mut self, _: NodeId, _: NodeId) -> bool {
        self.delivered += 1;
        true
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
