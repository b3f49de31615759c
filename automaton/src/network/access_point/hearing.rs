//! The nodes that an access point receives, and what each of them last sent.

use std::sync::Arc;

use pleach_discrete::network::NodeId;

use crate::network::beacon::Beacon;

/// The nodes in range, by their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Neighbours {
    table: Vec<Neighbour>,
    /// Where the next beacon is expected.
    expected: usize,
}

/// A node in range.
#[derive(Clone, Debug)]
struct Neighbour {
    /// What it sent last.
    beacon: Arc<Beacon>,
    /// Whether nothing has been received from it in this control period yet.
    is_silent: bool,
}

impl Neighbour {
    fn id(&self) -> NodeId {
        self.beacon.sender
    }

    /// It is received again; returns whether it sends anything new. A beacon that arrives after a newer one only says
    /// that the node is in range.
    fn renew(&mut self, beacon: &Arc<Beacon>) -> bool {
        self.is_silent = false;
        let is_new = !Arc::ptr_eq(&self.beacon, beacon) && !beacon.is_older_than(&self.beacon);
        if is_new {
            self.beacon = Arc::clone(beacon);
        }
        is_new
    }
}

impl Neighbours {
    /// The beacon received last of each node in range, by their senders.
    pub(super) fn beacons(&self) -> impl Iterator<Item = &Beacon> {
        self.table.iter().map(|neighbour| &*neighbour.beacon)
    }

    /// Takes in a beacon; returns whether it is news. Beacons of a round mostly come in the order of their senders, and
    /// have no news.
    pub(super) fn receive(&mut self, beacon: &Arc<Beacon>) -> bool {
        let expected = self.table.get(self.expected);
        let place = match expected.is_some_and(|known| Arc::ptr_eq(&known.beacon, beacon)) {
            true => Ok(self.expected),
            false => self.table.binary_search_by_key(&beacon.sender, Neighbour::id),
        };
        let (Ok(at) | Err(at)) = place;
        self.expected = at + 1;
        if place.is_ok() {
            return self.table[at].renew(beacon);
        }
        self.table.insert(at, Neighbour { beacon: Arc::clone(beacon), is_silent: false });
        true
    }

    /// A control period begins, in which all nodes send again.
    pub(super) fn expect_all(&mut self) {
        self.table.iter_mut().for_each(|neighbour| neighbour.is_silent = true);
    }

    /// All nodes in range have sent in this control period: forgets those that were silent. Returns whether there were any.
    pub(super) fn forget_silent(&mut self) -> bool {
        let before = self.table.len();
        self.table.retain(|neighbour| !neighbour.is_silent);
        self.table.len() < before
    }
}

#[cfg(any(test, feature = "abstraction"))]
impl Neighbours {
    /// Forgets what all nodes have sent.
    pub(super) fn clear(&mut self) {
        self.table.clear();
    }
}

#[cfg(test)]
mod tests {
    use pleach_continuous::Point;

    use super::*;

    fn beacon(sender: NodeId) -> Arc<Beacon> {
        Arc::new(Beacon::silent(sender, Point::origin()))
    }

    #[test]
    fn another_beacon_is_news_and_the_same_again_is_not() {
        let mut neighbours = Neighbours::default();
        let [one, same, two] = [beacon(3), beacon(3), beacon(1)];
        assert!(neighbours.receive(&one) && !neighbours.receive(&one) && neighbours.receive(&same));
        assert!(neighbours.receive(&two) && !neighbours.receive(&two));
        assert_eq!(neighbours.beacons().map(|it| it.sender).collect::<Vec<_>>(), [1, 3]);
    }

    #[test]
    fn a_beacon_that_arrives_after_a_newer_one_is_no_news() {
        let mut neighbours = Neighbours::default();
        let newer = Arc::new(Beacon { offers_made: 2, ..Beacon::silent(3, Point::origin()) });
        assert!(neighbours.receive(&newer) && !neighbours.receive(&beacon(3)));
        assert_eq!(neighbours.beacons().next().map(|it| it.offers_made), Some(2));
    }

    #[test]
    fn nodes_that_are_silent_are_out_of_range() {
        let mut neighbours = Neighbours::default();
        let [one, two] = [beacon(1), beacon(2)];
        assert!(
            neighbours.receive(&one) && neighbours.receive(&two) && !neighbours.forget_silent()
        );
        neighbours.expect_all();
        assert!(!neighbours.receive(&two) && neighbours.forget_silent());
        assert_eq!(neighbours.beacons().map(|it| it.sender).collect::<Vec<_>>(), [2]);
    }
}
