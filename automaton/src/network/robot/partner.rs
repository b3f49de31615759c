//! Exchanging duties with the robot that stands in the way.
//!
//! A mover that touches a parked robot nearer to its goal offers it its duty; so does a member of the primary team
//! that touches one behind it which stands still: in a narrow corridor a team may stand in an order in which it cannot
//! go on. The parked robot answers with its own; the mover, which is within δ of the post, takes it; and when the parked
//! robot sees that, it takes the mover's duty: the [`Offers`] of the two. From the offer to the end
//! neither takes a step of the mission that changes a duty, so that what is taken over is what was offered. Between
//! the two takings both hold the duty of the parked robot, and nobody that of the mover. With every exchange the way
//! that remains gets shorter, and two members of the team exchange duties a few times at most until a newer notice is
//! heard: exchanges come to an end. A robot whose partner is gone cannot tell who has which duty: it
//! begins again, as if it had stopped, and has neither. A refusal that a gone mover has not heard is withdrawn, and made
//! again if the mover comes back with its offer. A mover that cannot pass takes a partner that is somewhat
//! farther from it, and from its goal, too, but none with which it has exchanged duties since the newest notice, or since
//! a subgroup of Σ has arrived.
//!
//! Each of the two checks that its own links of the tree hold from the place of the other one, and those of the other one,
//! as far as it hears them, from its own. Robots do not know of exchanges beside them: a link has to reach every robot
//! that may take the duty at its other end in the same period.
//!
//! [`Offers`]: pleach_discrete::network::Offers

use pleach_continuous::Point;
use pleach_discrete::network::{Agreement, NodeId, Offer, Phase, Post, PostKind, Reply};

use super::Robot;
use super::exchanges::Progress;
use super::hearing::Neighbour;
use crate::network::beacon::{Announced, TeamReport};
use crate::network::duty::{Course, Duty, Shifting};

/// Two robots touch when they are this many ρ apart; they never come closer than 2ρ.
const CONTACT: f64 = 2.6;
/// The parked robot must be nearer to the goal by this share of ρ.
const GAIN: f64 = 0.05;
/// Control periods without progress after which a mover looks for an exchange.
const PATIENCE: u32 = 2;
/// Control periods without progress after which it takes a partner that is not nearer: one that
/// leaves no room to pass, at a corner say.
pub(super) const WEDGED_AFTER: u32 = 10;
/// Then it takes one up to this many ρ away, too: the two may stand still without touching each other, in the bend of
/// a corridor or beside a third robot, and none passes between them.
const WEDGE: f64 = 4.0;
/// How often two members of the team exchange duties at most until a newer notice is heard: where others have
/// exchanged duties meanwhile, the order of the two may be wrong again.
const MOST_IN_TEAM: usize = 3;
/// How much farther from the goal, in ρ, such a partner may be.
const CONCESSION: f64 = 4.0;

/// Whether the second of two members of the primary team is behind the first.
fn is_behind(ahead: Option<&TeamReport>, behind: Option<&TeamReport>) -> bool {
    ahead.zip(behind).is_some_and(|(ahead, behind)| ahead.members < behind.members)
}

/// As [`is_behind`], and it stands still.
fn stands_behind(ahead: Option<&TeamReport>, behind: Option<&TeamReport>) -> bool {
    is_behind(ahead, behind) && behind.is_some_and(TeamReport::stands_still)
}

impl Robot {
    /// Once a period: a mover that makes no progress looks for a partner among the robots in its way. One that
    /// does not take part could be gone before it has answered.
    pub(super) fn consider_exchange(&mut self) {
        self.exchanges.choose_partner(None);
        if self.is_engaged() || self.body.still_periods() < PATIENCE || !self.may_hand_over() {
            return;
        }
        let Some(goal) = self.goal() else { return };
        let (contact, gain) = match self.body.still_periods() < WEDGED_AFTER {
            true => (CONTACT, GAIN),
            false => (WEDGE, -CONCESSION),
        };
        let farthest = self.site.distance(self.body.position(), goal) - gain * self.clearance();
        let (_, refused) = self.past_offers();
        let candidates = self.neighbours.iter().filter_map(|neighbour| {
            let id = neighbour.id();
            let is_beside = neighbour.distance <= contact * self.clearance();
            if !is_beside || !self.could_replace(neighbour) || self.would_go_to_and_fro(neighbour) {
                return None;
            }
            let way = self.site.distance(neighbour.position(), goal);
            let fits = way < farthest && self.could_be_replaced_by(neighbour);
            fits.then(|| (refused.contains(&id), way, id))
        });
        let best = candidates.min_by(|one, other| {
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)).then(one.2.cmp(&other.2))
        });
        let partner = best.map(|(_, _, id)| id);
        self.exchanges.choose_partner(partner);
    }

    /// Whether the two have exchanged duties since the mission last made progress: each of them may be nearer to the goal
    /// than the other when it has stood still for a while. Two members of the team may a few times.
    fn would_go_to_and_fro(&self, neighbour: &Neighbour) -> bool {
        let (exchanged, _) = self.past_offers();
        let times = exchanged.iter().filter(|&&partner| partner == neighbour.id()).count();
        times >= if self.is_of_team(neighbour) { MOST_IN_TEAM } else { 1 }
    }

    /// The newest notice, and how many subgroups of Σ have arrived.
    pub(super) fn progress(&self) -> Progress {
        (self.notice_id(), self.subgroups_done())
    }

    /// The robots with which it has exchanged duties since the mission last made progress, and those that have refused.
    pub(super) fn past_offers(&self) -> (&[NodeId], &[NodeId]) {
        self.exchanges.past_offers(self.progress())
    }

    /// Whether this robot is on a way that another could go on with. One that makes way for the team is not.
    fn may_hand_over(&self) -> bool {
        let makes_way =
            || matches!(*self.duty, Duty::Following(_)) && self.way_to_clear().is_some();
        match self.duty.course() {
            Course::AlongPath(Shifting { place, .. }) => {
                let active = self.active_subgroup();
                active.is_some_and(|active| active.places().contains(&place)) && !self.has_arrived()
            }
            Course::WithTeam if makes_way() => false,
            Course::WithTeam => match self.phase() {
                Phase::Advance => true,
                Phase::Shift => self.goes_on_while_recruiting(),
                Phase::Idle
                | Phase::LeaderElection
                | Phase::RecruitElection
                | Phase::PathAgreement
                | Phase::Ended => false,
            },
            Course::AtPost => false,
        }
    }

    /// Whether this robot is anywhere behind the neighbour in the primary team.
    pub(super) fn is_behind_in_team(&self, neighbour: &Neighbour) -> bool {
        self.is_of_team(neighbour)
            && is_behind(neighbour.beacon.team.as_ref(), self.mission.team().report().as_ref())
    }

    /// Whether this robot and the neighbour are both of the primary team.
    fn is_of_team(&self, neighbour: &Neighbour) -> bool {
        self.duty.is_primary() && neighbour.post().is_some_and(Post::is_primary)
    }

    /// Whether this robot could take over the post of `parked` from where it is.
    fn could_replace(&self, parked: &Neighbour) -> bool {
        let Some(station) = parked.station() else { return false };
        let settings = &self.site.settings;
        let distance_to = |place: Point| (self.body.position() - place).norm();
        let within_reach = match station.post.kind {
            PostKind::Primary { .. } | PostKind::Redundant => true,
            PostKind::Fixed => distance_to(station.reference) <= settings.arrival_radius(),
        };
        let services = station.post.task.is_none_or(|task| {
            self.task_position(task)
                .is_some_and(|place| distance_to(place) <= settings.arrival_radius())
        });
        let keeps_link_to = |node: &Neighbour| self.link_would_hold(self.body.position(), node);
        // Where the other stands for the parent itself, it does so beside this one then.
        let parent = station.post.parent.and_then(|anchor| self.neighbour_at(anchor));
        let reaches_parent =
            parked.beacon.parent == Some(self.id) || parent.is_some_and(keeps_link_to);
        let mut children = self.children_of(station.post.id);
        let children_hold = children.all(keeps_link_to);
        let makes_room = match self.is_of_team(parked) {
            true => {
                stands_behind(self.mission.team().report().as_ref(), parked.beacon.team.as_ref())
            }
            false => parked.beacon.parked,
        };
        makes_room
            && !self.membership.is_absent(parked.id())
            && parked.beacon.offer.is_none()
            && parked.beacon.reply.is_none()
            && within_reach
            && services
            && reaches_parent
            && children_hold
    }

    /// Whether the links of this robot would hold if its partner took its duty.
    fn could_be_replaced_by(&self, partner: &Neighbour) -> bool {
        self.tree_links().iter().all(|link| {
            let other = self.neighbour(link.to);
            other.is_some_and(|other| self.link_would_hold(partner.position(), other))
        })
    }

    /// Whether the links of a mover would hold if this robot took its duty. The mover has chosen its partner by what it had
    /// heard in an earlier control period.
    fn could_take_links_of(&self, mover: &Neighbour) -> bool {
        let is_attached = |node: &&Neighbour| node.beacon.parent == Some(mover.id());
        let keeps_link_to = |node: &Neighbour| self.link_would_hold(self.body.position(), node);
        let parent = mover.beacon.parent.filter(|&parent| parent != self.id);
        parent.is_none_or(|parent| self.neighbour(parent).is_some_and(keeps_link_to))
            && self.neighbours.iter().filter(is_attached).all(keeps_link_to)
    }

    /// Whether a link of the tree from `place` to `node` would hold even if `node` exchanged duties in the same instant
    /// with a robot beside it; one that does not take part exchanges nothing. If this robot does not hear that one,
    /// `node` hears the robot that comes to `place`, since the link reaches it, and makes the same check.
    fn link_would_hold(&self, place: Point, node: &Neighbour) -> bool {
        let beside = WEDGE * self.clearance();
        let reaches =
            |other: &Neighbour| self.site.walk(place, other.position()) <= self.hard_length();
        let may_stand_for_it = |other: &&Neighbour| {
            !other.is_access_point()
                && !self.membership.is_absent(other.id())
                && (other.position() - node.position()).norm() <= beside
        };
        let mut others = self.neighbours.iter().filter(may_stand_for_it);
        reaches(node) && (node.is_access_point() || others.all(reaches))
    }

    // ---- What the guards ask -----------------------------------------------------------------

    /// The partner's answer to its offer.
    pub(super) fn answer_to_offer(&self) -> Option<&Reply<Duty>> {
        let offer = self.offers().offer()?;
        let reply = self.neighbour(offer.to)?.beacon.reply.as_ref()?;
        (reply.to == self.id && reply.number == offer.number).then_some(reply)
    }

    /// The first offer to this robot that it has not answered, or refused in vain, with the mover.
    pub(super) fn offer_to_answer(&self) -> Option<(NodeId, &Offer<Duty>)> {
        self.neighbours.iter().find_map(|neighbour| {
            let (mover, offer) = (neighbour.id(), neighbour.beacon.offer.as_ref()?);
            let answered = self.exchanges.answered(mover);
            let is_asked = offer.asks(self.id, answered)
                || self.has_refused_in_vain(mover, offer) && !self.membership.is_gone(mover);
            is_asked.then_some((mover, offer))
        })
    }

    /// Whether it has refused this offer, and the mover was gone before it heard that. If it comes back, it
    /// is refused again: it may have heard the first refusal after all.
    fn has_refused_in_vain(&self, mover: NodeId, offer: &Offer<Duty>) -> bool {
        offer.to == self.id && self.exchanges.is_refused_in_vain(mover, offer)
    }

    /// Whether the mover has given its offer up, so that it has heard the reply.
    pub(super) fn is_reply_heard(&self) -> bool {
        self.offers().reply().and_then(|reply| self.neighbour(reply.to)).is_some_and(|mover| {
            let (offer, made) = (mover.beacon.offer.as_ref(), mover.beacon.offers_made);
            self.offers().has_heard_reply(offer, made)
        })
    }

    /// Whether this robot may leave its post to a mover, and go on for it.
    pub(super) fn may_be_relieved(&self) -> bool {
        let stands_behind_mover = || {
            let mover = self.offer_to_answer().and_then(|(mover, _)| self.neighbour(mover));
            mover.is_some_and(|it| {
                stands_behind(it.beacon.team.as_ref(), self.mission.team().report().as_ref())
            })
        };
        (self.is_parked() || stands_behind_mover())
            && !(self.is_caller() && self.duty.is_primary())
            && self.knows_mission()
            && self.offers().offer().is_none()
            && self.duty.station().is_some()
            && self.offer_to_answer().is_none_or(|(mover, offer)| {
                let links_hold = |it| self.could_be_replaced_by(it) && self.could_take_links_of(it);
                let is_partner = |it| self.is_beside(it) && links_hold(it);
                !self.has_refused_in_vain(mover, offer)
                    && self.neighbour(mover).is_some_and(is_partner)
                    && self.pursues_the_same(mover, offer)
            })
    }

    /// Whether it is still as near to the mover as partners are: it may have moved since that has made its offer.
    fn is_beside(&self, mover: &Neighbour) -> bool {
        self.site.may_touch(mover.distance, WEDGE * self.clearance())
    }

    /// Whether the mover goes by the same announcement, and the same Σ if one of the duties that they
    /// would exchange is on it: places on another path are other places. Where this robot knows that Σ has been walked,
    /// or that the mission has ended, it does not take a place on it any more.
    fn pursues_the_same(&self, mover: NodeId, offer: &Offer<Duty>) -> bool {
        let Some(mover) = self.neighbour(mover) else { return false };
        let task = |announced: &Option<Announced>| announced.as_ref().map(|(id, _)| *id);
        let path = |agreement: &Option<Agreement>| agreement.as_ref().map(Agreement::id);
        let is_on_path = offer.duty.place().is_some() || self.duty.place().is_some();
        let knows_path = || self.mission.walk().is_some();
        let is_same_path =
            || path(&mover.beacon.agreement) == self.ballot.agreement().map(Agreement::id);
        task(&mover.beacon.announced) == self.mission.notices().announcement_id()
            && (!is_on_path || knows_path() && is_same_path())
    }

    /// Whether it goes by the announcement by which the others go, and knows Σ where one is announced: one
    /// that has restarted does not at first.
    fn knows_mission(&self) -> bool {
        let announced = self.mission.notices().announcement_id();
        let is_current = announced.is_some_and(|id| id.epoch() == self.notice_id().epoch());
        is_current && !self.changes.facts().path_announced
    }

    /// Whether an exchange is under way. The robot then stands still, and what it does stays what
    /// it is: a duty that changed after it was offered would be taken over as it had been.
    pub(super) fn is_engaged(&self) -> bool {
        self.offers().are_under_way()
    }

    /// Whether it has refused the offer of a robot that is gone.
    pub(super) fn refuses_gone_mover(&self) -> bool {
        let refusal = self.offers().reply().filter(|reply| reply.accepted.is_none());
        refusal.is_some_and(|refusal| self.membership.is_gone(refusal.to))
    }

    /// Whether a robot gives its duty to this one, or has given it and has not taken the other duty yet.
    pub(super) fn is_being_given_duty(&self) -> bool {
        let mut replies = self.neighbours.iter().filter_map(|it| it.beacon.reply.as_ref());
        replies.any(|reply| reply.to == self.id && reply.accepted.is_some())
    }

    /// The robot to which it has offered its duty, or has given it.
    fn partner_in_exchange(&self) -> Option<NodeId> {
        let offers = self.offers();
        let given = offers.taking().and(offers.reply());
        offers.offer().map(|offer| offer.to).or(given.map(|reply| reply.to))
    }

    /// Whether a control period begins, and the robot with which it exchanges duties is gone: which of the two
    /// duties that one has, if any, is not known.
    pub(super) fn has_lost_partner(&self) -> bool {
        let partner = self.partner_in_exchange();
        self.schedule.rounds().count() == 0
            && partner.is_some_and(|partner| self.membership.is_gone(partner))
    }
}
