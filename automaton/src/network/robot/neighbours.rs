//! The table of neighbours.

use std::ops::Deref;

use pleach_discrete::network::{NodeId, PostId};

use super::hearing::Neighbour;

/// The nodes that a robot hears, ascending. What they are looked up by, all the time, stands together in a line or two of
/// memory, and so does not wait for what else is known of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Neighbours {
    table: Vec<Neighbour>,
    keys: Vec<Key>,
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
