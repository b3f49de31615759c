//! The path Σ, its break points and its subgroups (Sec. V-B and V-C).

use std::sync::Arc;

use pleach_discrete::network::path::{Ties, subgroups};
use pleach_discrete::network::{Agreement, NodeId, Phase, Post, PostId, PostKind, Subgroup};

use super::super::beacon::Notice;
use super::super::duty::{Duty, Hop, Path, Shifting, Waiting};
use super::super::record::MissionEvent;
use super::Robot;
use super::hearing::Neighbour;

impl Robot {
    /// The path Σ is known: its members say whether they are break points.
    pub fn begin_path(&mut self) {
        let Notice::Path(path) = self.bulletin.notice() else { return };
        let path = Arc::clone(path);
        let mut agreement = Agreement::new(self.bulletin.sequence());
        self.subgroups.clear();
        self.subgroup = 0;
        if let Some(&station) = self.duty.station()
            && let Some(place) = path.place_of(station.post.id)
        {
            let ties = Ties {
                services_task: station.post.task.is_some(),
                bears_others: self.has_ties_off(&path),
            };
            agreement.vote(place, path.is_break_point(place, ties));
        }
        self.agreement = Some(agreement);
        self.path = Some(path);
    }

    /// Whether this robot has a neighbour in the tree that is not on the path.
    fn has_ties_off(&self, path: &Path) -> bool {
        let parent_off = self.anchor().is_some_and(|anchor| !path.passes(anchor));
        let child_off = self
            .children()
            .filter_map(Neighbour::post)
            .any(|post| path.place_of(post.id).is_none());
        parent_off || child_off
    }

    pub(super) fn break_points(&self) -> Option<Vec<usize>> {
        self.agreement.as_ref()?.break_points(self.path.as_ref()?.len())
    }

    /// The break points are agreed: every robot computes the same subgroups.
    pub fn form_subgroups(&mut self) {
        let Some(points) = self.break_points() else { return };
        self.subgroups = subgroups(&points).collect();
        self.subgroup = 0;
        if let (Duty::Waiting(Waiting { place: 0, .. }), Some(path)) = (&*self.duty, &self.path) {
            let robots: Vec<_> = path.hops.iter().map(|hop| hop.robot).collect();
            let break_points = points.iter().map(|&place| robots[place]).collect();
            self.report(MissionEvent::RecruitElected {
                robot: self.id,
                path: robots,
                break_points,
            });
        }
    }

    /// How many subgroups of the path have arrived, as far as it knows.
    pub fn subgroups_done(&self) -> usize {
        self.subgroup
    }

    /// The subgroup that is the active team, while one is.
    pub fn active_subgroup(&self) -> Option<Subgroup> {
        (self.phase == Phase::Shift).then(|| self.subgroups.get(self.subgroup).copied())?
    }

    /// Says so when it has arrived at the next place of Σ.
    pub(super) fn report_arrival(&mut self) {
        if let Duty::Shifting(Shifting { place, .. }) = *self.duty
            && self.subgroups.get(self.subgroup).is_some()
            && !self.is_engaged()
            && self.has_arrived()
            && let Some(agreement) = &mut self.agreement
        {
            agreement.arrive(place);
        }
    }

    /// The robots that stood at the places of a subgroup when Σ was announced.
    pub(super) fn robots_at(&self, subgroup: Subgroup) -> Vec<NodeId> {
        let hops = self.path.as_ref().and_then(|path| path.hops.get(subgroup.places()));
        hops.into_iter().flatten().map(|hop| hop.robot).collect()
    }

    /// Whether another robot holds `post` and knows its parent: it does not hang on this one any
    /// more, unless that is the parent.
    pub(super) fn is_relieved_of(&self, post: PostId) -> bool {
        let own = self.duty.post().map(|held| held.id);
        self.holder(post).is_some_and(|holder| {
            let hangs_here = |held: &Post| own.is_some_and(|own| held.hangs_on(own));
            holder.beacon.parent != Some(self.id) || holder.post().is_some_and(hangs_here)
        })
    }

    /// The place that this robot goes to along Σ.
    pub(super) fn next_hop(&self) -> Option<&Hop> {
        match *self.duty {
            Duty::Shifting(Shifting { place, .. }) => self.path.as_ref()?.hops.get(place + 1),
            _ => None,
        }
    }

    /// Every member of the active subgroup has arrived: the next one is the active team.
    pub fn next_subgroup(&mut self) {
        self.subgroup += 1;
    }

    /// The last robot that Σ relieves has joined the primary team, or leads it.
    pub fn announce_advance(&mut self) {
        let joined = self.duty.post().and_then(|post| match post.kind {
            PostKind::Primary { follows: Some(follows) } => Some((post.id, follows)),
            _ => None,
        });
        self.issue(Notice::Advance { joined });
        self.resume();
    }

    /// The primary team is the active team again.
    pub fn resume(&mut self) {
        self.subgroups.clear();
        self.still_periods = 0;
    }
}
