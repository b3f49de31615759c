//! The table of neighbours.

use std::ops::Deref;

use pleach_discrete::network::{NodeId, PostId};

use super::bodies::Bodies;
use super::hearing::Neighbour;

/// The nodes that a robot hears, ascending. What they are looked up by, all the time, stands together in a line or two of
/// memory, and so does not wait for what else is known of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Neighbours {
    table: Vec<Neighbour>,
    keys: Vec<Key>,
    /// The neighbour whose beacon is expected next.
    expected: u32,
    /// The last control period in which all have been received in the last round in which all robots send.
    heard_all_in: Option<u32>,
    /// The robots of other fleets near it.
    bodies: Bodies,
}

/// What a neighbour is looked up by.
#[derive(Clone, Copy, Debug)]
struct Key {
    id: u32,
    post: Option<PostId>,
}

impl Key {
    fn of(neighbour: &Neighbour) -> Self {
        Key { id: neighbour.id() as u32, post: neighbour.post().map(|post| post.id) }
    }
}

impl Deref for Neighbours {
    type Target = [Neighbour];

    fn deref(&self) -> &[Neighbour] {
        &self.table
    }
}

impl Neighbours {
    /// Where a node stands, or where it would.
    pub(super) fn place_of(&self, id: NodeId) -> Result<usize, usize> {
        self.keys.binary_search_by_key(&id, |key| key.id as usize)
    }

    /// The neighbour whose beacon is expected next: beacons of a round mostly arrive in the order of their senders.
    pub(super) fn expected_mut(&mut self) -> Option<&mut Neighbour> {
        self.table.get_mut(self.expected as usize)
    }

    /// The neighbour that was expected has been received.
    pub(super) const fn expect_next(&mut self) {
        self.expected += 1;
    }

    /// The neighbour there has been received.
    pub(super) const fn expect_after(&mut self, at: usize) {
        self.expected = at as u32 + 1;
    }

    /// A round of beacons begins.
    pub(super) const fn expect_first(&mut self) {
        self.expected = 0;
    }

    /// A round in which all robots send is over; this is the control period in which all have been received in it.
    pub(super) const fn note_round(&mut self, heard_all_in: Option<u32>) {
        self.heard_all_in = heard_all_in;
    }

    /// Whether all have been received in this control period, in the last round in which all robots send.
    pub(super) fn have_all_been_heard_in(&self, period: u32) -> bool {
        self.heard_all_in == Some(period)
    }

    /// Whether that is so for this control period, or was for the one before.
    pub(super) fn have_all_been_heard_lately(&self, period: u32) -> bool {
        self.heard_all_in.is_some_and(|heard| heard.saturating_add(1) >= period)
    }

    /// The robots of other fleets near it.
    pub(super) const fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// The robots of other fleets are seen.
    pub(super) const fn bodies_mut(&mut self) -> &mut Bodies {
        &mut self.bodies
    }

    /// Those that hold `post`.
    pub(super) fn holders(&self, post: PostId) -> impl Iterator<Item = &Neighbour> {
        let holds = move |(_, key): &(&Neighbour, &Key)| key.post == Some(post);
        self.table.iter().zip(&self.keys).filter(holds).map(|(neighbour, _)| neighbour)
    }

    pub(super) fn insert(&mut self, at: usize, neighbour: Neighbour) {
        self.keys.insert(at, Key::of(&neighbour));
        self.table.insert(at, neighbour);
    }

    /// The same node as last heard.
    pub(super) fn replace(&mut self, at: usize, neighbour: Neighbour) {
        self.keys[at] = Key::of(&neighbour);
        self.table[at] = neighbour;
    }

    pub(super) fn remove(&mut self, at: usize) -> Neighbour {
        self.keys.remove(at);
        self.table.remove(at)
    }

    /// The neighbour there, for all but its beacon.
    pub(super) fn get_mut(&mut self, at: usize) -> Option<&mut Neighbour> {
        self.table.get_mut(at)
    }

    /// All of them, for all but their beacons.
    pub(super) fn iter_mut(&mut self) -> impl Iterator<Item = &mut Neighbour> {
        self.table.iter_mut()
    }
}
