//! Judging moves: whether a robot consents to the moves that it has received (Sec. IV, Algorithm 5).
//!
//! It judges them all together, whichever of them are carried out, with its own ([`negotiation`](super::negotiation)). If it
//! could be overloaded, or its link to the tree overstretched, it objects; it halves its own move if that is part of the
//! cause. Otherwise it consents.

use pleach_continuous::network::acceptance::{Capsule, Segment, is_acceptable, worst_load_within};
use pleach_discrete::network::{NodeId, Stage};

use super::Robot;
use super::hearing::Neighbour;
use super::motion::ROUNDING;
use super::places::places;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;
use crate::network::roll::Wreck;

impl Robot {
    /// Sends its proposed move, if it has one, until all that rely on it consent.
    pub(super) fn tell_proposal(&mut self, outputs: &mut NodeOutputs) {
        if self.negotiation.has_proposal() {
            let reliant = self.reliant();
            if self.negotiation.has_to_send(&reliant) {
                let witness = if reliant.is_empty() { self.witness() } else { None };
                self.negotiation.send(self.schedule.period(), witness, outputs);
            }
        }
    }

    /// Where this robot would be.
    pub(super) fn own_move(&self) -> Segment {
        self.negotiation.own_move(self.body.position())
    }

    /// The proposal of a neighbour is received. Every robot that receives it knows where the sender is and how
    /// far it may go.
    pub(super) fn hear_proposal(
        &mut self,
        from: NodeId,
        segment: Segment,
        witness: Option<NodeId>,
    ) {
        self.membership.note(Wreck::setting_off(from, segment, self.schedule.period()));
        if self.membership.is_absent(from) {
            self.note_change();
        }
        let waits = self.relies_on(from) || witness == Some(self.id);
        self.negotiation.receive_proposal(from, segment, waits);
    }

    fn move_of(&self, node: NodeId) -> Segment {
        self.negotiation.move_of(node).unwrap_or_else(|| {
            let known = self.neighbour(node).map(Neighbour::position);
            Segment::still(known.unwrap_or(self.body.position()))
        })
    }

    /// Whether the robot could be harmed by a move of this node: it sends to it, or may have to
    /// receive that it still may, or is attached to it in the tree.
    fn relies_on(&self, node: NodeId) -> bool {
        self.reservation.has_asked(node) || self.tree_parent() == Some(node)
    }

    /// The robots that rely on this one, as far as it knows: those to which it has granted a flow, and
    /// those that report that they are attached to it.
    fn reliant(&self) -> Vec<NodeId> {
        self.reservation.senders().chain(self.tree_children().map(Neighbour::id)).collect()
    }

    /// The node that it requests as the witness of its move, where nobody relies on it: its parent if that has been
    /// received in this control period. While it makes no progress, all nodes that have take turns.
    fn witness(&self) -> Option<NodeId> {
        let period = self.schedule.period();
        let received = self.neighbours.iter().filter(|known| known.heard_in == period);
        let mut candidates: Vec<NodeId> = received.map(Neighbour::id).collect();
        candidates.sort_by_key(|&node| Some(node) != self.tree.parent()); // the parent first
        let turn = self.body.still_periods() as usize % candidates.len().max(1);
        candidates.get(turn).copied()
    }

    /// Without the consent of all that rely on it, and of one node at least, the robot stays.
    pub(super) fn stay_without_consent(&mut self) {
        if self.negotiation.has_proposal() {
            let reliant = self.reliant();
            self.negotiation.stay_without_consent(&reliant);
        }
    }

    /// Judges the moves that it has received together with its own: objects, and halves its own, or
    /// consents. Moves that are as they were when it accepted them are not judged again.
    pub(super) fn judge_moves(&mut self, outputs: &mut NodeOutputs) {
        if !self.negotiation.is_idle() {
            if self.is_unsure() {
                return self.negotiation.withdraw();
            }
            if self.negotiation.must_judge() && !self.accepts_moves(outputs) {
                return;
            }
        }
        self.negotiation.consent(self.schedule.period(), outputs);
    }

    /// Whether all moves together are acceptable; if not, an objection is sent to those that could be the cause. Its own
    /// move is one of them unless those of others are too much by themselves.
    fn accepts_moves(&mut self, outputs: &mut NodeOutputs) -> bool {
        let (own, still) = (self.own_move(), Segment::still(self.body.position()));
        let (is_overloaded, overstretched) =
            (self.is_overloaded(own), self.overstretched_parent(own));
        if !is_overloaded && overstretched.is_none() {
            return true;
        }
        let overloading = if is_overloaded { self.overloading_movers(own) } else { Vec::new() };
        let period = self.schedule.period();
        for mover in self.negotiation.movers() {
            if overstretched == Some(mover) || overloading.contains(&mover) {
                outputs.send(mover, Message::Objection { period });
            }
        }
        let others_exceed_limits =
            self.is_overloaded(still) || self.overstretched_parent(still).is_some();
        if !others_exceed_limits || self.is_last_chance() {
            self.yield_to_objection();
        }
        false
    }

    /// A neighbour, or the robot itself, objects to its move.
    pub(super) fn yield_to_objection(&mut self) {
        let is_last_chance = self.is_last_chance();
        self.negotiation.yield_to_objection(is_last_chance);
    }

    fn is_last_chance(&self) -> bool {
        self.stage() == Stage::Negotiation && self.schedule.rounds().is_last_chance()
    }

    /// Whether it does not know where a robot is on which it relies.
    pub(super) fn is_unsure(&self) -> bool {
        let mut relied_on = self.routing.routes().map(|link| link.to).chain(self.tree_parent());
        relied_on.any(|node| !self.knows_place_of(node))
    }

    /// Whether a node on which this one relies is where it was received last.
    pub(super) fn knows_place_of(&self, node: NodeId) -> bool {
        places!(self).are_known_of(node, self.reservation.sends_to(node))
    }

    /// Where a robot that makes this move may measure itself afterwards. One that moves may be off by 2e + m; one that
    /// stays although it wants to go on may measure itself again, and be off by 2e; a parked one stays where it is
    /// known to be.
    fn reach_of(&self, axis: Segment, is_parked: bool) -> Capsule {
        let radius = match (axis.length() > 0.0, is_parked) {
            (true, _) => self.stray(),
            (false, false) => 2.0 * self.site.settings.errors.position,
            (false, true) => 0.0,
        };
        Capsule { axis, radius }
    }

    fn is_overloaded(&self, own: Segment) -> bool {
        self.is_too_much(self.worst_load_without(own, &[]))
    }

    fn is_too_much(&self, worst: f64) -> bool {
        !is_acceptable(worst, self.routing.load() + ROUNDING)
    }

    /// Its load at worst if these of the nodes to which it sends stay where they are.
    fn worst_load_without(&self, own: Segment, staying: &[NodeId]) -> f64 {
        let own = self.reach_of(own, self.is_parked());
        self.worst_load(own, |node| {
            let rests = |known: &Neighbour| known.is_access_point() || known.beacon.parked;
            let is_parked = self.neighbour(node).is_none_or(rests);
            let whole = self.move_of(node);
            let stays = staying.contains(&node);
            self.reach_of(if stays { Segment::still(whole.from) } else { whole }, is_parked)
        })
    }

    /// The worst load h_i whichever of the proposed moves are carried out, and wherever robots measure
    /// themselves then.
    fn worst_load(&self, own: Capsule, move_of: impl Fn(NodeId) -> Capsule) -> f64 {
        let routes = self.routing.routes();
        let receivers: Vec<_> = routes.map(|link| (link.flow(), move_of(link.to))).collect();
        worst_load_within(own, &receivers, &self.site.link)
    }

    /// The receivers whose moves add most to its load, as many as would have to stay for it not to be overloaded. A
    /// robot whose least move is too much, since the reliability of its link falls steeply there, holds up no other.
    fn overloading_movers(&self, own: Segment) -> Vec<NodeId> {
        let receives = |mover: &NodeId| self.routing.routes().any(|link| link.to == *mover);
        let movers = self.negotiation.movers().filter(receives);
        let mut by_share: Vec<(f64, NodeId)> =
            movers.map(|mover| (self.worst_load_without(own, &[mover]), mover)).collect();
        by_share.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let mut staying = Vec::new();
        for (_, mover) in by_share {
            staying.push(mover);
            if !self.is_too_much(self.worst_load_without(own, &staying)) {
                break;
            }
        }
        staying
    }

    /// By how much at least each end that moves has to shorten a link of this length. What measurements
    /// and the moves of its ends add to its limit does no harm, as the limit allows for it, but from there
    /// on a link must truly get no longer.
    fn shortening(&self, limit: f64, length: f64) -> f64 {
        let is_far_too_long = length > (limit + 2.0 * self.stray()) * (1.0 + ROUNDING);
        if is_far_too_long { self.site.settings.errors.motion } else { 0.0 }
    }

    /// The parent, if the link to it could become longer than its limit and than it is now.
    fn overstretched_parent(&self, own: Segment) -> Option<NodeId> {
        let link = self.parent_link()?;
        let other = self.move_of(link.to);
        if own.length() == 0.0 && other.length() == 0.0 {
            return None;
        }
        let neighbour = self.neighbour(link.to)?;
        let walk = self.walk_to(neighbour);
        let limit = link.limit.max(walk) * (1.0 + ROUNDING);
        let moved = |segment: Segment| if segment.length() > 0.0 { 1.0 } else { 0.0 };
        let (one, two) = (moved(own), moved(other));
        let shorter = self.shortening(link.limit, walk);
        let longest =
            [(own.to, other.from, one), (own.from, other.to, two), (own.to, other.to, one + two)]
                .into_iter()
                .map(|(a, b, moves)| self.site.free_space.link_reach(a, b) + shorter * moves)
                .fold(0.0, f64::max);
        (longest > limit).then_some(link.to)
    }
}
