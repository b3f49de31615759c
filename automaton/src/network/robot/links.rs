//! The links of the tree that the robot must not lose.
//!
//! While a subgroup of Σ is on its way, the posts that it left have no holder. The chain of its
//! robots then stands for them: going up the tree each is attached to the next, going down each is
//! attached to the one before, and the break points at both ends hold the chain.

use pleach_continuous::Point;
use pleach_continuous::geometry::Geodesic;
use pleach_discrete::network::{Anchor, NodeId, Post, PostId};

use super::Robot;
use super::hearing::Neighbour;
use super::motion::ROUNDING;
use crate::network::duty::{Course, Duty, Hop, Shifting};

/// Control periods within which both robots of an exchange are heard with their new posts, while some messages
/// get through.
const PATIENCE_WITH_EXCHANGES: u32 = 3;

/// A link of the tree, as one of its ends sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeLink {
    /// The other end.
    pub to: NodeId,
    /// The geodesic length that it should not exceed.
    pub limit: f64,
}

impl Robot {
    /// Its parent in the tree: the node that its duty names or, while that is not heard, the one before.
    pub(super) fn tree_parent(&self) -> Option<NodeId> {
        self.named_parent()
            .filter(|&parent| parent != self.id)
            .or_else(|| self.tree.parent().filter(|&parent| self.may_be_parent(parent)))
    }

    /// Whether this node, which was its parent, may still be. One that has given its post in an exchange tells so
    /// before the other one is heard with it; one that has begun again holds another post for good.
    fn may_be_parent(&self, node: NodeId) -> bool {
        let Some(known) = self.neighbour(node) else { return false };
        let is_under_way = self.duty.post().is_none();
        let holds_anchor = |post: &Post| self.anchor() == Some(Anchor::Post(post.id));
        is_under_way
            || known.post().is_none_or(holds_anchor)
            || self.tree.orphaned_periods() <= PATIENCE_WITH_EXCHANGES
    }

    /// Stores its parent.
    pub(super) fn remember_parent(&mut self) {
        let parent = self.tree_parent();
        self.tree.attach_to(parent);
    }

    /// The links of the tree at this robot: to its parent first, then to its children.
    pub(super) fn tree_links(&self) -> Vec<TreeLink> {
        let mut links = Vec::new();
        links.extend(self.parent_link());
        links.extend(self.tree_children().map(|child| TreeLink {
            to: child.id(),
            limit: self.limit_of(child.beacon.duty.as_ref()),
        }));
        links
    }

    pub(super) fn parent_link(&self) -> Option<TreeLink> {
        let to = self.tree_parent()?;
        Some(TreeLink { to, limit: self.limit_of(Some(&*self.duty)) })
    }

    /// Whether its duty leads it away from its parent while it does not hear that: neither could tell how long
    /// their link becomes. On Σ an access point may be its parent that is not within range yet.
    pub(super) fn would_lose_parent(&self) -> bool {
        let parent = self.tree_parent();
        match self.duty.course() {
            Course::AlongPath(_) => parent.is_none(),
            Course::WithTeam => {
                self.anchor().is_some() && parent.and_then(|node| self.neighbour(node)).is_none()
            }
            Course::AtPost => false,
        }
    }

    /// The robots that report that they are attached to this one.
    pub(super) fn tree_children(&self) -> impl Iterator<Item = &Neighbour> {
        self.neighbours.iter().filter(|neighbour| neighbour.beacon.parent == Some(self.id))
    }

    /// Links are made within d_build; those of the primary team stay so, and d_hard is never
    /// exceeded.
    fn limit_of(&self, duty: Option<&Duty>) -> f64 {
        match duty {
            Some(duty) if duty.is_primary() => self.build_length(),
            _ => self.hard_length(),
        }
    }

    /// d_build: up to which length a link of the tree may be made.
    pub(super) fn build_length(&self) -> f64 {
        self.site.lengths(self.mission.notices().is_stretched()).build
    }

    /// d_hard: which length no link of the tree exceeds.
    pub(super) fn hard_length(&self) -> f64 {
        self.site.lengths(self.mission.notices().is_stretched()).hard
    }

    /// Up to which length a link of the tree may have got through errors, as far as both of its ends may stray.
    pub(super) fn longest_length(&self) -> f64 {
        self.hard_length() + 2.0 * self.stray()
    }

    /// Up to which length a link of the tree may have got when both of its ends have settled at posts d_hard apart.
    pub(super) fn settled_length(&self) -> f64 {
        (self.hard_length() + 2.0 * self.settling_radius()) * (1.0 + ROUNDING)
    }

    /// Whether a link of the tree from here to the holder of this parent would not be too long.
    pub(super) fn reaches_parent(&self, parent: Option<Anchor>) -> bool {
        let node = parent.and_then(|anchor| self.neighbour_at(anchor));
        node.is_some_and(|node| self.walk_to(node) <= self.hard_length())
    }

    /// Whether the robot could take this post on Σ where it is: it is linked to the parent of the post, and no link to that
    /// or to a child of the post is too long.
    pub(super) fn links_hold_at(&self, post: Post) -> bool {
        let limit = self.hard_length();
        let has_parent = match post.parent {
            Some(Anchor::Access(access)) => {
                self.distance_to_access(access, self.body.position()) <= limit
            }
            Some(Anchor::Post(_)) => {
                self.neighbours.iter().any(|node| self.is_coming_to(node, post.parent))
            }
            None => true,
        };
        has_parent
            && self.robots_linked_at(post).all(|node| self.walk_to(node) <= limit)
            && self.reaches_branches_out_of_range(post.id)
    }

    /// Whether the robot has settled at this post on Σ, as near to its links as robots come. The primary team is attached to
    /// the robot that is relieved, which joins it.
    pub(super) fn has_settled_at(&self, post: Post, reference: Point) -> bool {
        let stays = |node: &&Neighbour| node.post().is_none_or(|held| !held.is_primary());
        let limit = self.settled_length();
        !self.is_off(reference)
            && self.robots_linked_at(post).filter(stays).all(|node| self.walk_to(node) <= limit)
    }

    /// The robots that it hears with the posts that this one is attached to and that are attached to it.
    fn robots_linked_at(&self, post: Post) -> impl Iterator<Item = &Neighbour> {
        self.neighbours.iter().filter(move |node| {
            self.is_coming_to(node, post.parent)
                || self.post_ahead_of(node).is_some_and(|held| held.is_child_of(post.id))
        })
    }

    /// Whether a robot holds this anchor, or goes to it along Σ.
    fn is_coming_to(&self, node: &Neighbour, anchor: Option<Anchor>) -> bool {
        self.post_ahead_of(node).is_some_and(|held| anchor == Some(Anchor::Post(held.id)))
    }

    /// The post of a robot: on Σ, the post that it goes to.
    fn post_ahead_of(&self, node: &Neighbour) -> Option<Post> {
        let Some(Duty::Shifting(Shifting { place, .. })) = node.beacon.duty else {
            return node.post().copied();
        };
        let hop = self.mission.path().and_then(|path| path.hops.get(place + 1));
        hop.map(|hop| hop.post)
    }

    /// Whether the robot is near enough to those that are attached to the holder of this post and that it does not hear
    /// itself. They would not hear that this robot has taken the post over.
    fn reaches_branches_out_of_range(&self, post: PostId) -> bool {
        let branches = self.holder(post).into_iter().flat_map(|it| it.beacon.branches.iter());
        let mut unheard = branches
            .filter(|branch| branch.robot != self.id && self.neighbour(branch.robot).is_none());
        unheard
            .all(|branch| self.site.walk(self.body.position(), branch.place) <= self.hard_length())
    }

    pub(super) fn named_parent(&self) -> Option<NodeId> {
        if let Duty::Shifting(Shifting { place, .. }) = *self.duty {
            return self.parent_under_way(place);
        }
        match self.anchor()? {
            Anchor::Access(access) => Some(self.site.robots + access),
            Anchor::Post(post) => {
                let holder = self.holder(post).filter(|holder| self.may_be_linked_to(holder));
                holder.map(Neighbour::id).or_else(|| self.stand_in_for(post))
            }
        }
    }

    /// Whether there is a link of the tree to the holder of the post that its own is attached to. One that it has not been
    /// linked to, and that it hears from farther away than links are long, may be out of range again in the next moment:
    /// others have stopped or begun again meanwhile, and the robots between the two are gone.
    fn may_be_linked_to(&self, holder: &Neighbour) -> bool {
        self.tree.parent() == Some(holder.id()) || self.walk_to(holder) <= self.settled_length()
    }

    /// The parent of the robot that has left `place`.
    fn parent_under_way(&self, place: usize) -> Option<NodeId> {
        let shift = self.mission.shift()?;
        let (path, active) = (&shift.path, shift.active()?);
        let hop = path.hops.get(place)?;
        if path.descends(active.first) {
            return match place == active.first {
                true => self.holder(hop.post.id).map(Neighbour::id),
                false => self.robot_at(place - 1),
            };
        }
        if hop.crossing.is_empty() {
            return self
                .robot_at(place + 1)
                .or_else(|| self.holder(path.hops.get(place + 1)?.post.id).map(Neighbour::id));
        }
        let access = hop.crossing.get(self.index_in_crossing(&hop.crossing))?;
        Some(self.site.robots + access)
    }

    /// The place on Σ that the robot has left, where it goes up the tree.
    pub(super) fn hop_left(&self) -> Option<&Hop> {
        let Duty::Shifting(Shifting { place, .. }) = *self.duty else { return None };
        let shift = self.mission.shift()?;
        let goes_up = !shift.path.descends(shift.active()?.first);
        shift.path.hops.get(place).filter(|_| goes_up)
    }

    /// The index in `crossing` of the access point to which it is attached: the last within d_build, and none before the
    /// one to which it was attached. One that has taken the duty over from another is attached to the nearest.
    pub(super) fn index_in_crossing(&self, crossing: &[usize]) -> usize {
        let parent = self.tree.parent().and_then(|node| node.checked_sub(self.site.robots));
        let reached = parent.and_then(|parent| crossing.iter().position(|&it| it == parent));
        let distance = |&at: &usize| self.distance_to_access(crossing[at], self.body.position());
        let nearest =
            || (0..crossing.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        self.changes_over(crossing, reached.unwrap_or_else(nearest), self.body.position())
    }

    /// The index of the access point to which a robot is attached at `place` that was attached to that at `index`.
    fn changes_over(&self, crossing: &[usize], index: usize, place: Point) -> usize {
        let is_near = |&at: &usize| self.may_build(self.distance_to_access(crossing[at], place));
        (index..crossing.len()).rfind(is_near).unwrap_or(index)
    }

    fn distance_to_access(&self, access: usize, place: Point) -> f64 {
        self.site.link_length(place, self.site.access_points[access])
    }

    /// Whether it keeps its link on a way from a place, if it has to change over between access points.
    pub(super) fn may_change_over_along(&self, from: Point, way: &Geodesic) -> bool {
        self.crossing().is_none_or(|crossing| self.keeps_link_along(crossing, from, way))
    }

    /// Whether the link of a robot to one of these access points after the other lasts on the shortest way between two
    /// places, with a clearance to spare.
    pub(super) fn keeps_link_on_the_way(&self, crossing: &[usize], from: Point, to: Point) -> bool {
        let way = self.site.free_space.geodesic(from, to);
        way.is_some_and(|way| self.keeps_link_along(crossing, from, &way))
    }

    /// As [`keeps_link_on_the_way`](Self::keeps_link_on_the_way), for a way from a place.
    pub(super) fn keeps_link_along(&self, crossing: &[usize], from: Point, way: &Geodesic) -> bool {
        let step = self.site.settings.step_radius;
        let limit = self.limit_of(Some(&*self.duty)) - self.clearance();
        let mut index = self.changes_over(crossing, 0, from);
        way.segments(from).all(|piece| {
            let steps = (piece.vector().norm() / step).ceil().max(1.0);
            (1..=steps as u32).all(|count| {
                let place = piece.at(f64::from(count) / steps);
                index = self.changes_over(crossing, index, place);
                self.distance_to_access(crossing[index], place) <= limit
            })
        })
    }

    /// The robot of the chain that stands for a post whose holder has left it. That of a robot that is not under
    /// way has a holder, whether that is heard or not; and the first post of every subgroup but the first has been
    /// taken by the one before.
    fn stand_in_for(&self, post: PostId) -> Option<NodeId> {
        let shift = self.mission.shift()?;
        let (path, active) = (&shift.path, shift.active()?);
        let place = path.place_of(post)?;
        let is_taken = place == active.first && shift.arrived > 0;
        if is_taken || !active.places().contains(&place) {
            return None;
        }
        match path.descends(active.first) {
            true => self.robot_at(place),
            false => self.robot_at(place.checked_sub(1)?),
        }
    }

    /// The robot that waits at or has left `place` of the path.
    fn robot_at(&self, place: usize) -> Option<NodeId> {
        self.neighbours_at(place).next().map(Neighbour::id)
    }

    /// The neighbours that wait at or have left `place` of the path.
    pub(super) fn neighbours_at(&self, place: usize) -> impl Iterator<Item = &Neighbour> {
        let place_of = |known: &Neighbour| known.beacon.duty.as_ref().and_then(Duty::place);
        self.neighbours.iter().filter(move |known| place_of(known) == Some(place))
    }
}
