//! Listening: the table of neighbours and what each of them last sent.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use pleach_continuous::Point;
use pleach_continuous::network::reliability::LinkReliability;
use pleach_discrete::network::{Anchor, NodeId, Post, PostId};

use super::Robot;
use crate::network::beacon::Beacon;
use crate::network::duty::{Duty, Station};
use crate::network::roll::Wreck;
use crate::network::site::Site;

/// A node that the robot hears, R_ij > 0.
#[derive(Clone, Debug)]
pub(super) struct Neighbour {
    id: NodeId,
    pub beacon: Arc<Beacon>,
    /// The newest confirmation of its way that it has passed on.
    pub confirmed: Option<u32>,
    pub distance: f64,
    pub reliability: f64,
    walk: Walk,
    /// Where the robot stood when it measured the link.
    measured_at: Point,
    /// The control period in which it was heard last.
    pub heard_in: u32,
    /// Whether it has been heard in this round.
    is_heard: bool,
    /// Rounds since it was heard.
    silent_rounds: u8,
}

/// A length that is measured when it is first asked for: the bits of a number, of one that is none before.
#[derive(Debug)]
struct Walk(AtomicU64);

impl Walk {
    fn of(length: f64) -> Self {
        Walk(AtomicU64::new(length.to_bits()))
    }

    fn known(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }

    fn or_measured(&self, measure: impl FnOnce() -> f64) -> f64 {
        let known = self.known();
        if !known.is_nan() {
            return known;
        }
        let length = measure();
        self.0.store(length.to_bits(), Ordering::Relaxed);
        length
    }
}

impl Default for Walk {
    fn default() -> Self {
        Walk::of(f64::NAN)
    }
}

impl Clone for Walk {
    fn clone(&self) -> Self {
        Walk::of(self.known())
    }
}

/// A beacon is sent in this many rounds, at the beginning of a control period and whenever it has
/// changed, so that all of these messages but one may be lost. A neighbour that is silent in as many
/// of the rounds in which all robots send is out of range.
pub(in super::super) const ROUNDS_TO_BE_HEARD: usize = 3;

/// Control periods for which a robot counts as attached that is not heard.
pub(super) const PATIENCE_WITH_CHILDREN: u32 = 8;

impl Neighbour {
    /// A node as heard from `own`.
    pub(super) fn new(
        beacon: &Arc<Beacon>,
        confirmed: Option<u32>,
        period: u32,
        own: Point,
        site: &Site,
    ) -> Self {
        let distance = (beacon.position - own).norm();
        Neighbour {
            id: beacon.sender,
            beacon: Arc::clone(beacon),
            confirmed,
            distance,
            reliability: site.link.reliability(distance),
            walk: Walk::default(),
            measured_at: own,
            heard_in: period,
            is_heard: true,
            silent_rounds: 0,
        }
    }

    /// The same node, as last heard, seen from elsewhere.
    pub(super) fn seen_from(&self, own: Point, site: &Site) -> Self {
        let (is_heard, silent_rounds) = (self.is_heard, self.silent_rounds);
        Neighbour {
            is_heard,
            silent_rounds,
            ..Neighbour::new(&self.beacon, self.confirmed, self.heard_in, own, site)
        }
    }

    pub(super) fn id(&self) -> NodeId {
        self.id
    }

    pub(super) fn position(&self) -> Point {
        self.beacon.position
    }

    pub(super) fn station(&self) -> Option<&Station> {
        self.beacon.duty.as_ref()?.station()
    }

    pub(super) fn post(&self) -> Option<&Post> {
        self.beacon.duty.as_ref()?.post()
    }

    /// Whether its post is attached to `post`, if there is one.
    pub(super) fn is_attached_to(&self, post: Option<PostId>) -> bool {
        post.is_some_and(|post| self.post().is_some_and(|held| held.is_child_of(post)))
    }

    /// Whether it holds a fixed post from which no task is serviced and no branches part.
    pub(super) fn is_relay(&self) -> bool {
        matches!(self.beacon.duty, Some(Duty::Relay(_)))
    }

    pub(super) fn is_access_point(&self) -> bool {
        self.beacon.duty.is_none()
    }

    /// Whether it has been heard in this control period or in the one before.
    pub(super) const fn is_present(&self, period: u32) -> bool {
        self.heard_in.saturating_add(1) >= period
    }

    /// It is heard in the control period `heard_in`; returns whether it was not present before, or silent.
    const fn note_heard(&mut self, heard_in: u32, period: u32) -> bool {
        let is_back = !self.is_present(period) || !self.was_heard();
        (self.heard_in, self.is_heard, self.silent_rounds) = (heard_in, true, 0);
        is_back
    }

    /// Whether it was heard in the last round in which all robots send.
    pub(super) const fn was_heard(&self) -> bool {
        self.silent_rounds == 0
    }

    /// Whether it has been silent for so long that it is out of range, or does not run.
    pub(super) fn is_silent(&self) -> bool {
        usize::from(self.silent_rounds) == ROUNDS_TO_BE_HEARD
    }

    /// Where its body was when it was heard last.
    pub(super) fn wreck(&self) -> Wreck {
        Wreck::heard(self.id(), self.position(), self.heard_in)
    }
}

impl Robot {
    /// Takes in a beacon. One that arrives after a newer one of its sender is ignored, and so is one
    /// that has been late since an earlier control period.
    pub(super) fn hear_beacon(
        &mut self,
        period: u32,
        confirmed: Option<u32>,
        beacon: &Arc<Beacon>,
    ) {
        if period < self.schedule.period() {
            return;
        }
        if period > self.schedule.period() {
            self.hear_of_later_period(period);
        }
        // Beacons of a round mostly come in the order of their senders, and have no news.
        let expected = self.neighbours.expected_mut();
        if let Some(known) = expected
            && Arc::ptr_eq(&known.beacon, beacon)
            && known.measured_at == self.body.position()
        {
            let is_back = known.note_heard(period, self.schedule.period());
            if is_back || self.tree.awaits_confirmation() && known.confirmed < confirmed {
                self.changes.note();
            }
            known.confirmed = known.confirmed.max(confirmed);
            self.neighbours.expect_next();
        } else {
            self.hear_news(period, confirmed, beacon);
        }
    }

    #[inline(never)]
    fn hear_news(&mut self, period: u32, confirmed: Option<u32>, beacon: &Arc<Beacon>) {
        let known = self.neighbours.place_of(beacon.sender);
        match known {
            Ok(at) => self.renew(at, period, confirmed, beacon),
            Err(at) => {
                let neighbour =
                    Neighbour::new(beacon, confirmed, period, self.body.position(), &self.site);
                self.neighbours.insert(at, neighbour);
                self.membership.find(beacon.sender);
                self.note_branches(beacon, period);
                self.note_change();
            }
        }
        let (Ok(at) | Err(at)) = known;
        self.neighbours.expect_after(at);
    }

    /// A neighbour that the robot knows is heard again. What it has passed on counts for the post that it
    /// holds in the same message.
    fn renew(&mut self, at: usize, period: u32, confirmed: Option<u32>, beacon: &Arc<Beacon>) {
        let Some(known) = self.neighbours.get_mut(at) else { return };
        let is_same = Arc::ptr_eq(&known.beacon, beacon);
        if !is_same && beacon.is_older_than(&known.beacon) {
            return;
        }
        let is_back = known.note_heard(period, self.schedule.period());
        let is_newer = known.confirmed < confirmed;
        let confirmed = if is_same { known.confirmed.max(confirmed) } else { confirmed };
        let renewed =
            if (known.measured_at, known.position()) != (self.body.position(), beacon.position) {
                Neighbour::new(beacon, confirmed, period, self.body.position(), &self.site)
            } else if !is_same {
                Neighbour { beacon: Arc::clone(beacon), confirmed, ..known.clone() }
            } else {
                known.confirmed = confirmed;
                if is_back || self.tree.awaits_confirmation() && is_newer {
                    self.note_change();
                }
                return;
            };
        self.neighbours.replace(at, renewed);
        if !is_same {
            self.note_branches(beacon, period);
        }
        self.note_change();
    }

    /// A round of beacons is over. In the first rounds of a period all robots send; only in these is
    /// silence counted.
    pub(super) fn end_round(&mut self) {
        self.neighbours.expect_first();
        let counts_silence = self.schedule.rounds().count() <= ROUNDS_TO_BE_HEARD;
        let (mut at, mut hears_all) = (0, true);
        while let Some(known) = self.neighbours.get_mut(at) {
            let is_heard = std::mem::take(&mut known.is_heard);
            // A message may have arrived after the last round of the period before.
            hears_all &= is_heard && known.heard_in == self.schedule.period();
            at = if is_heard || !counts_silence { at + 1 } else { self.miss(at) };
        }
        if counts_silence {
            self.neighbours.note_round(hears_all.then_some(self.schedule.period()));
        }
    }

    /// A neighbour that the robot knows is not heard; returns the index of the next one. One that was
    /// near when it was heard last is not out of range: it stays where it is taken to be, and this
    /// robot does not leave its place meanwhile. Nor is one to which packets flow, as long as it has
    /// granted them, nor, for a while, one that is attached to this robot's post: a branch is not cut off
    /// because its messages are lost. A robot that is gone is not waited for, once no packets flow to it.
    fn miss(&mut self, at: usize) -> usize {
        let (own, period) = (self.duty.post().map(|post| post.id), self.schedule.period());
        let Some(known) = self.neighbours.get_mut(at) else { return at };
        let (was_silent, was_heard) = (known.is_silent(), known.was_heard());
        let has_moved = known.measured_at != self.body.position();
        let silent_rounds = known.silent_rounds.saturating_add(1).min(ROUNDS_TO_BE_HEARD as u8);
        if has_moved {
            *known = known.seen_from(self.body.position(), &self.site);
        }
        known.silent_rounds = silent_rounds;
        let is_silent = known.is_silent();
        let is_kept = known.is_attached_to(own)
            && period <= known.heard_in.saturating_add(PATIENCE_WITH_CHILDREN);
        let is_lost = is_silent && (known.is_access_point() || !self.site.is_near(known.distance));
        let (id, reliability) = (known.id(), known.reliability);
        let is_gone = is_silent && self.membership.is_gone(id);
        let is_out_of_sight = (is_lost && !is_kept || is_gone) && !self.reservation.sends_to(id);
        if is_out_of_sight || reliability <= 0.0 {
            let lost = self.neighbours.remove(at);
            self.lose_sight_of(&lost);
            self.note_change();
            return at;
        }
        if has_moved || was_heard || is_silent && !was_silent {
            self.note_change();
        }
        at + 1
    }

    /// Whether the robot may leave its place in this control period: it takes part, knows who does not, is where
    /// others allow for it if they do not hear it any more, and has heard in this period where each robot is
    /// that was near when it was heard last, or could have come near since, but those that are gone; and its
    /// parent, if its duty leads it away from that.
    ///
    /// If one of two robots that could meet moves, it so knows where the other is. If both move, each
    /// keeps to its own side of the line between them (17); if one stays, its place lies on its own
    /// side. No message that is lost gives a robot the right to move.
    pub(super) fn may_leave_place(&self) -> bool {
        let is_sure = |known: &Neighbour| {
            known.heard_in == self.schedule.period()
                || known.is_access_point()
                || !self.site.is_near(known.distance) && !self.may_meet(&known.wreck())
                || self.membership.is_gone(known.id())
        };
        self.is_called()
            && self.membership.knows_who_is_absent()
            && self.is_near_trail()
            && self.neighbours.iter().all(is_sure)
            && !self.membership.missing().any(|lost| self.may_meet(&lost))
            && !self.would_lose_parent()
    }

    /// The nodes that the robot hears, and for how many rounds each has been silent.
    pub(super) fn audible(&self) -> impl Iterator<Item = (NodeId, u8)> {
        self.neighbours.iter().map(|neighbour| (neighbour.id(), neighbour.silent_rounds))
    }

    /// The beacon that the robot goes by of each of its neighbours, ascending.
    pub(super) fn held_beacons(&self) -> impl Iterator<Item = &Arc<Beacon>> {
        self.neighbours.iter().map(|neighbour| &neighbour.beacon)
    }

    /// The geodesic length of the link to a neighbour.
    pub(super) fn walk_to(&self, neighbour: &Neighbour) -> f64 {
        neighbour.walk.or_measured(|| self.site.walk(self.body.position(), neighbour.position()))
    }

    pub(super) fn neighbour(&self, id: NodeId) -> Option<&Neighbour> {
        self.neighbours.get(self.neighbours.place_of(id).ok()?)
    }

    /// The neighbour that holds `post`.
    ///
    /// At the end of an exchange of duties two robots hold it, and the one whose reply stands is
    /// about to take the other's: a robot that was still attached to it could end up below itself.
    pub(super) fn holder(&self, post: PostId) -> Option<&Neighbour> {
        let holders = self.neighbours.holders(post);
        holders.min_by_key(|neighbour| neighbour.beacon.reply.is_some())
    }

    /// The neighbour that stands for `anchor`.
    pub(super) fn neighbour_at(&self, anchor: Anchor) -> Option<&Neighbour> {
        match anchor {
            Anchor::Access(access) => self.neighbour(self.site.robots + access),
            Anchor::Post(post) => self.holder(post),
        }
    }

    /// The neighbours whose posts are attached to the post that this robot holds.
    pub(super) fn children(&self) -> impl Iterator<Item = &Neighbour> {
        let own = self.duty.post().map(|post| post.id);
        own.into_iter().flat_map(|own| self.children_of(own))
    }

    /// The neighbours whose posts are attached to `post`.
    pub(super) fn children_of(&self, post: PostId) -> impl Iterator<Item = &Neighbour> {
        self.neighbours.iter().filter(move |neighbour| neighbour.is_attached_to(Some(post)))
    }
}
