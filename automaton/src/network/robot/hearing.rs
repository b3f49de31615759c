//! Listening: the table of neighbours and what each of them last said.

use std::cell::OnceCell;
use std::sync::Arc;

use pleach_continuous::Point;
use pleach_continuous::network::reliability::LinkReliability;
use pleach_discrete::network::{Anchor, NodeId, Post, PostId};

use super::super::beacon::Beacon;
use super::super::duty::Station;
use super::Robot;

/// A node that the robot hears, R_ij > 0.
#[derive(Debug)]
pub(super) struct Neighbour {
    pub beacon: Arc<Beacon>,
    pub distance: f64,
    pub reliability: f64,
    walk: OnceCell<f64>,
    measured: (Point, Point),
}

impl Neighbour {
    pub fn id(&self) -> NodeId {
        self.beacon.sender
    }

    pub fn position(&self) -> Point {
        self.beacon.position
    }

    pub fn station(&self) -> Option<&Station> {
        self.beacon.duty.as_ref()?.station()
    }

    pub fn post(&self) -> Option<&Post> {
        self.beacon.duty.as_ref()?.post()
    }

    pub fn is_access_point(&self) -> bool {
        self.beacon.duty.is_none()
    }
}

impl Robot {
    /// Takes in the beacons heard in one round, in ascending order of their senders.
    pub fn hear(&mut self, beacons: impl Iterator<Item = Arc<Beacon>>) {
        let mut known = std::mem::take(&mut self.neighbours).into_iter().peekable();
        for beacon in beacons {
            while known.next_if(|neighbour| neighbour.id() < beacon.sender).is_some() {}
            let measured = (self.position, beacon.position);
            let neighbour = match known.next_if(|neighbour| neighbour.id() == beacon.sender) {
                Some(old) if old.measured == measured => Neighbour { beacon, ..old },
                _ => {
                    let distance = (beacon.position - self.position).norm();
                    let reliability = self.site.link.reliability(distance);
                    Neighbour { beacon, distance, reliability, walk: OnceCell::new(), measured }
                }
            };
            self.neighbours.push(neighbour);
        }
    }

    /// The geodesic length of the link to a neighbour.
    pub(super) fn walk_to(&self, neighbour: &Neighbour) -> f64 {
        *neighbour.walk.get_or_init(|| self.site.walk(self.position, neighbour.position()))
    }

    pub(super) fn neighbour(&self, id: NodeId) -> Option<&Neighbour> {
        let at = self.neighbours.binary_search_by_key(&id, Neighbour::id).ok()?;
        Some(&self.neighbours[at])
    }

    /// The neighbour that holds `post`.
    pub(super) fn holder(&self, post: PostId) -> Option<&Neighbour> {
        self.neighbours.iter().find(|n| n.post().is_some_and(|held| held.id == post))
    }

    /// The neighbour that stands for `anchor`.
    pub(super) fn bearer(&self, anchor: Anchor) -> Option<&Neighbour> {
        match anchor {
            Anchor::Access(access) => self.neighbour(self.site.robots + access),
            Anchor::Post(post) => self.holder(post),
        }
    }

    /// The neighbours whose posts hang on the post that this robot holds.
    pub(super) fn children(&self) -> impl Iterator<Item = &Neighbour> {
        let own = self.duty.post().map(|post| post.id);
        self.neighbours.iter().filter(move |neighbour| {
            own.is_some_and(|own| neighbour.post().is_some_and(|post| post.hangs_on(own)))
        })
    }
}
