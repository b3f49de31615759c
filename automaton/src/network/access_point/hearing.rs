//! Listening: the nodes that an access point hears, and what each of them last sent.

use std::sync::Arc;

use pleach_discrete::network::NodeId;

use super::AccessPoint;
use crate::network::beacon::Beacon;
use crate::network::robot::ROUNDS_TO_BE_HEARD;
use crate::network::roll::{Roll, Wreck};

/// A node in range.
#[derive(Clone, Debug)]
pub(super) struct Heard {
    /// What it sent last.
    pub beacon: Arc<Beacon>,
    /// Whether nothing has been heard of it in this control period yet.
    is_silent: bool,
}

impl Heard {
    /// A node that is heard now.
    pub fn now(beacon: &Arc<Beacon>) -> Self {
        Heard { beacon: Arc::clone(beacon), is_silent: false }
    }

    fn id(&self) -> NodeId {
        self.beacon.sender
    }

    /// It is heard again; returns whether it tells anything new. A beacon that arrives after a newer one only says
    /// that it is heard.
    fn renew(&mut self, beacon: &Arc<Beacon>) -> bool {
        self.is_silent = false;
        let is_new = !Arc::ptr_eq(&self.beacon, beacon) && !beacon.is_older_than(&self.beacon);
        if is_new {
            self.beacon = Arc::clone(beacon);
        }
        is_new
    }
}

impl AccessPoint {
    /// The beacon heard last of each node in range, by their senders.
    pub(super) fn beacons(&self) -> impl Iterator<Item = &Beacon> {
        self.heard.iter().map(|heard| &*heard.beacon)
    }

    /// Takes in a message with a beacon. One that has been late since an earlier control period only tells of the roll.
    pub(super) fn hear(&mut self, period: u32, roll: &Roll, beacon: &Arc<Beacon>) {
        let is_later = roll.called > self.roll.called;
        self.roll.merge(roll);
        if is_later {
            self.last_beacon.tell_anew();
        }
        // Nobody but the first access point calls rolls: it has begun again since.
        if is_later && (self.is_new || self.is_first()) {
            self.recall(roll, self.period.max(period));
        }
        if period < self.period {
            return;
        }
        if period > self.period {
            self.is_behind = !self.is_new;
            self.period = period - u32::from(self.is_behind);
            self.last_beacon.tell_anew();
        }
        self.hear_beacon(beacon);
        if beacon.duty.is_some() {
            let (robot, place) = (beacon.sender, beacon.position);
            self.sightings.note(Wreck::heard(robot, place, period));
            beacon.sightings(period).for_each(|seen| self.sightings.note(seen));
        }
    }

    /// Beacons of a round mostly come in the order of their senders, and have no news.
    fn hear_beacon(&mut self, beacon: &Arc<Beacon>) {
        let expected = self.heard.get(self.heard_up_to);
        let place = match expected.is_some_and(|heard| Arc::ptr_eq(&heard.beacon, beacon)) {
            true => Ok(self.heard_up_to),
            false => self.heard.binary_search_by_key(&beacon.sender, Heard::id),
        };
        match place {
            Ok(at) => self.has_news |= self.heard[at].renew(beacon),
            Err(at) => {
                self.heard.insert(at, Heard::now(beacon));
                self.has_news = true;
            }
        }
        let (Ok(at) | Err(at)) = place;
        self.heard_up_to = at + 1;
    }

    /// A control period begins, in which all nodes send again.
    pub(super) fn expect_all(&mut self) {
        self.heard.iter_mut().for_each(|heard| heard.is_silent = true);
    }

    /// After the first rounds all nodes in range have sent: those that were silent are out of range.
    pub(super) fn forget_silent(&mut self) {
        // The round that has begun is one more than those that are over; after the last, none has.
        if (1..=ROUNDS_TO_BE_HEARD).contains(&self.round()) {
            return;
        }
        let before = self.heard.len();
        self.heard.retain(|heard| !heard.is_silent);
        self.has_news |= self.heard.len() < before;
    }
}
