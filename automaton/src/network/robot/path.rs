//! The path Σ, its break points and its subgroups (Sec. V-B and V-C).

use std::sync::Arc;

use pleach_discrete::network::path::{Ties, subgroups};
use pleach_discrete::network::{
    Agreement, Anchor, NodeId, NoticeId, Post, PostId, PostKind, Subgroup,
};

use super::Robot;
use super::hearing::Neighbour;
use super::mission::{Effects, MissionEffect};
use crate::network::beacon::Notice;
use crate::network::duty::{Duty, Hop, Path, Shifting, Waiting};
use crate::network::mission::{Advance, PathAgreement, Shift};
use crate::network::record::MissionEvent;

/// The path Σ is known: its members report whether they are break points.
pub(super) fn vote<A>(_: &A, robot: &Robot, effects: &mut Effects) -> Option<PathAgreement> {
    let Notice::Path(path) = robot.notice() else { return None };
    let agreement = robot.vote_on(path, robot.notice_id());
    effects.extend(robot.learns_who_leads());
    effects.extend([MissionEffect::Agree(Some(agreement)), MissionEffect::ForgetRoute]);
    Some(PathAgreement { path: Arc::clone(path) })
}

/// The break points are agreed: every robot computes the same subgroups.
pub(super) fn form_subgroups(
    agreed: &PathAgreement,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<Shift> {
    let points = robot.break_points()?;
    if matches!(*robot.duty, Duty::Waiting(Waiting { place: 0, .. })) {
        let path: Vec<NodeId> = agreed.path.hops.iter().map(|hop| hop.robot).collect();
        let break_points = points.iter().map(|&place| path[place]).collect();
        let event = MissionEvent::RecruitElected { robot: robot.id, path, break_points };
        effects.push(MissionEffect::Report(event));
    }
    Some(Shift {
        path: Arc::clone(&agreed.path),
        subgroups: subgroups(&points).collect(),
        arrived: 0,
    })
}

/// Every member of the active subgroup has arrived: the next one is the active team.
pub(super) fn next_subgroup(shift: &Shift, _: &Robot, _: &mut Effects) -> Shift {
    Shift { arrived: shift.arrived + 1, ..shift.clone() }
}

/// The last robot that Σ relieves has joined the primary team, or leads it.
pub(super) fn announce_advance(shift: &Shift, robot: &Robot, effects: &mut Effects) -> Advance {
    let joined = robot.duty.post().and_then(|post| match post.kind {
        PostKind::Primary { follows: Some(follows) } => Some((post.id, follows)),
        _ => None,
    });
    effects.extend([MissionEffect::Issue(Notice::Advance { joined }), MissionEffect::Restart]);
    Advance { path: Some(Arc::clone(&shift.path)), in_vain: false }
}

/// The primary team is the active team again.
pub(super) fn resume<A>(_: &A, robot: &Robot, effects: &mut Effects) -> Advance {
    effects.extend(robot.learns_who_leads());
    effects.extend([MissionEffect::Restart, MissionEffect::ForgetRoute]);
    Advance { path: robot.mission.path().cloned(), in_vain: robot.learns_that_call_is_vain() }
}

impl Robot {
    /// The vote of the robot on the break points of `path`.
    pub(super) fn vote_on(&self, path: &Path, id: NoticeId) -> Agreement {
        let mut agreement = Agreement::new(id);
        if let Some(station) = self.duty.station()
            && let Some(place) = path.place_of(station.post.id)
        {
            let ties = Ties {
                services_task: station.post.task.is_some(),
                bears_others: self.has_ties_off(path, place),
            };
            agreement.vote(place, path.is_break_point(place, ties));
        }
        agreement
    }

    /// Whether this robot, at `place` of the path, has a link in the tree that is none of the path.
    fn has_ties_off(&self, path: &Path, place: usize) -> bool {
        let children = self.children().filter_map(Neighbour::post);
        let children = children.map(|post| Anchor::Post(post.id));
        self.anchor().into_iter().chain(children).any(|other| !path.takes_link(place, other))
    }

    pub(super) fn break_points(&self) -> Option<Vec<usize>> {
        self.ballot.agreement()?.break_points(self.mission.path()?.len())
    }

    /// How many subgroups of the path have arrived, as far as it knows.
    pub(super) fn subgroups_done(&self) -> usize {
        self.mission.shift().map_or(0, |shift| shift.arrived)
    }

    /// The subgroup that is the active team, while one is.
    pub(super) fn active_subgroup(&self) -> Option<Subgroup> {
        self.mission.shift()?.active()
    }

    /// Whether the robot at `place` of Σ has reported that it has arrived at the next.
    pub(super) fn has_reported(&self, place: usize) -> bool {
        self.ballot.agreement().is_some_and(|known| known.have_arrived(place..place + 1))
    }

    /// Whether every member of `subgroup` has reported that it has arrived.
    pub(super) fn knows_arrived(&self, subgroup: Subgroup) -> bool {
        self.ballot.agreement().is_some_and(|agreement| agreement.have_arrived(subgroup.places()))
    }

    /// Whether the robot at `place` of Σ has given its post up to the robot behind.
    pub(super) fn has_given_up(&self, place: usize) -> bool {
        self.ballot.agreement().is_some_and(|agreement| agreement.has_given_up(place))
    }

    /// The place of Σ whose post it holds and leaves to another.
    pub(super) fn waiting_place(&self) -> Option<usize> {
        self.duty.held().and_then(|_| self.duty.place())
    }

    /// Gives its post up to the subgroup that relieves it, once that has arrived: from now on the
    /// robot behind may hold it.
    pub(super) fn yield_post(&mut self) {
        let shift = self.mission.shift();
        if let Some(place) = self.waiting_place()
            && let Some(behind) = shift.and_then(|shift| shift.subgroup_up_to(place))
            && self.knows_arrived(behind)
            && !self.is_engaged()
        {
            self.ballot.give_up(place);
        }
    }

    /// Reports that it has arrived at the next place of Σ.
    pub(super) fn report_arrival(&mut self) {
        if let Duty::Shifting(Shifting { place, .. }) = *self.duty
            && self.active_subgroup().is_some()
            && !self.is_engaged()
            && self.has_arrived()
        {
            self.ballot.arrive(place);
        }
    }

    /// The robots that stood at the places of a subgroup when Σ was announced.
    pub(super) fn robots_at(&self, subgroup: Subgroup) -> Vec<NodeId> {
        let hops = self.mission.path().and_then(|path| path.hops.get(subgroup.places()));
        hops.into_iter().flatten().map(|hop| hop.robot).collect()
    }

    /// Whether another robot holds `post` and knows its parent: it does not attach to this one any
    /// more, unless that is the parent, or stands for it as soon as it sets out. One that has given its duty to this
    /// robot, and has not taken the other duty yet, does not hold the post to relieve it.
    pub(super) fn is_relieved_of(&self, post: PostId) -> bool {
        let own = self.duty.post().map(|held| held.id);
        !self.is_being_given_duty()
            && self.holder(post).is_some_and(|holder| {
                let is_child = |held: &Post| own.is_some_and(|own| held.is_child_of(own));
                let is_below = |held: &Post| is_child(held) || self.is_to_follow(held.parent);
                holder.beacon.parent != Some(self.id) || holder.post().is_some_and(is_below)
            })
    }

    /// Whether the robot ahead on Σ has left this post, and waits for this one to follow.
    fn is_to_follow(&self, post: Option<Anchor>) -> bool {
        let (Some(Anchor::Post(post)), Some(shift), Some(place)) =
            (post, self.mission.shift(), self.waiting_place())
        else {
            return false;
        };
        let ahead = place + 1;
        let has_left = |known: &Neighbour| matches!(known.beacon.duty, Some(Duty::Shifting(_)));
        shift.path.place_of(post) == Some(ahead) && self.neighbours_at(ahead).any(has_left)
    }

    /// The place that this robot goes to along Σ.
    pub(super) fn next_hop(&self) -> Option<&Hop> {
        let Duty::Shifting(Shifting { place, .. }) = *self.duty else { return None };
        self.mission.path()?.hops.get(place + 1)
    }
}
