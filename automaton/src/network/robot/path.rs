//! The path Σ, its break points and its subgroups (Sec. V-B and V-C).

use std::sync::Arc;

use pleach_discrete::network::path::{Ties, subgroups};
use pleach_discrete::network::{
    Agreement, Anchor, NodeId, Phase, Post, PostId, PostKind, Subgroup,
};

use super::super::beacon::Notice;
use super::super::duty::{Duty, Hop, Path, Station};
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
            if place <= path.last_break_point() {
                self.duty = Duty::Wait { station, place };
            }
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
        if let (Duty::Wait { place: 0, .. }, Some(path)) = (&self.duty, &self.path) {
            let robots: Vec<_> = path.hops.iter().map(|hop| hop.robot).collect();
            let break_points = points.iter().map(|&place| robots[place]).collect();
            self.report(MissionEvent::RecruitElected {
                robot: self.id,
                path: robots,
                break_points,
            });
        }
        self.walk_path();
    }

    /// How many subgroups of the path have arrived, as far as it knows.
    pub fn subgroups_done(&self) -> usize {
        self.subgroup
    }

    /// The subgroup that is the active team, while one is.
    pub fn active_subgroup(&self) -> Option<Subgroup> {
        (self.phase == Phase::Shift).then(|| self.subgroups.get(self.subgroup).copied())?
    }

    /// Sets out when it is this robot's turn, and says so when it has arrived.
    pub(super) fn walk_path(&mut self) {
        let Some(active) = self.subgroups.get(self.subgroup).copied() else { return };
        if self.is_engaged() {
            return;
        }
        if let Duty::Wait { station, place } = self.duty
            && active.places().contains(&place)
            && (place == 0 || place > active.first || self.is_relieved_of(station.post.id))
        {
            if place == active.first {
                let robots = self.robots_at(active);
                self.report(MissionEvent::SubgroupStarted { subgroup: self.subgroup, robots });
            }
            // The recruit's own place is given up; every other is taken over by the robot behind.
            self.left_post = (place > 0).then_some(station.post.id);
            self.duty = Duty::Shift { place };
            self.still_periods = 0;
        }
        if let Duty::Shift { place } = self.duty
            && self.has_arrived()
            && let Some(agreement) = &mut self.agreement
        {
            agreement.arrive(place);
        }
    }

    /// The robots that stood at the places of a subgroup when Σ was announced.
    fn robots_at(&self, subgroup: Subgroup) -> Vec<NodeId> {
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
        match self.duty {
            Duty::Shift { place } => self.path.as_ref()?.hops.get(place + 1),
            _ => None,
        }
    }

    /// Every member of the active subgroup has arrived: each takes the post it has come to.
    pub fn take_posts(&mut self) {
        let Some(active) = self.subgroups.get(self.subgroup).copied() else { return };
        if let Duty::Shift { place } = self.duty
            && active.places().contains(&place)
        {
            if place == active.first {
                let robots = self.robots_at(active);
                self.report(MissionEvent::SubgroupArrived { subgroup: self.subgroup, robots });
            }
            self.take_post_ahead();
        }
        self.subgroup += 1;
        self.walk_path();
    }

    fn take_post_ahead(&mut self) {
        if let Some(hop) = self.next_hop() {
            // A plain node that queues behind the next member makes its place where it stands.
            let place = hop.place.reference;
            let radius = self.site.settings.service_radius;
            let queues = (self.position - place).norm() > radius;
            let reference = if queues { self.position } else { place };
            let station = Station { post: hop.post, reference };
            self.duty = Duty::Hold(station);
            self.left_post = None;
            self.remember_parent();
        }
    }

    /// The last robot that Σ relieves joins the primary team, or leads it.
    pub fn join_team(&mut self) {
        let (Some(path), Some(&station)) = (self.path.clone(), self.duty.station()) else { return };
        let follows = match path.hops.last() {
            Some(last) if !path.releases_leader => Some(last.post.id),
            _ => None,
        };
        let parent = match self.subgroups.is_empty() {
            true => station.post.parent,
            false => Some(Anchor::Post(station.post.id)),
        };
        let id = PostId((self.site.robots as u32) + self.bulletin.sequence());
        let mut post = Post::redundant(id);
        post.kind = PostKind::Primary { follows };
        post.parent = parent;
        self.left_post = (!self.subgroups.is_empty()).then_some(station.post.id);
        self.duty = Duty::Hold(Station { post, reference: self.position });
        self.still_periods = 0;
        self.awaits_release = false;
        self.report(match follows {
            Some(_) => MissionEvent::JoinedPrimary { robot: self.id, team: Vec::new() },
            None => MissionEvent::Released { robot: self.id },
        });
        self.issue(Notice::Advance { joined: follows.map(|follows| (id, follows)) });
        self.resume();
    }

    /// The primary team is the active team again.
    pub fn resume(&mut self) {
        match self.duty {
            Duty::Shift { .. } => self.take_post_ahead(),
            Duty::Wait { station, .. } => self.duty = Duty::Hold(station),
            Duty::Hold(_) => {}
        }
        self.subgroups.clear();
        self.still_periods = 0;
    }
}
