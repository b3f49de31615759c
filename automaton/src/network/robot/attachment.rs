//! The robot's place in the tree: its parent and its children (Definition 5.2).
//!
//! Redundant robots belong to the tree too. Each attaches to the node that is fewest links
//! from an access point and, among those, most reliable, over links no longer than d_build. It
//! chooses from the lineages that its neighbours tell it. Primary posts keep their parents, but for
//! that of p₁ (Remark 5.6), as long as a robot holds these. So do fixed posts in the paper's order;
//! otherwise they may be attached farther up the same way, or to the tree of another access point.

use std::collections::BTreeSet;

use pleach_continuous::Point;
use pleach_discrete::network::{Activity, Anchor, IdSet, Lineage, NodeId, Phase, Post, PostId};

use crate::automaton::TransitionError;
use crate::located::Place as _;

use super::Robot;
use super::hearing::Neighbour;
use super::motion::ROUNDING;
use crate::network::beacon::{Announcement, Notice, Reports};
use crate::network::duty::{Bound, Duty, Station};

/// p₁ changes its parent only if that brings it nearer to its target by this share of d_build.
const REATTACHMENT_GAIN: f64 = 0.05;

/// A robot looks for another parent when it has heard nobody that stands for the one that it has for this many
/// control periods.
const PATIENCE_WITH_ORPHANED_POSTS: u32 = 12;

/// A node without a branch becomes redundant after this many control periods.
pub(in super::super) const PATIENCE_WITH_UNUSED_POSTS: u32 = 2;

impl Robot {
    /// Renews the robot's place in the tree from what it has heard.
    pub(super) fn keep_place(&mut self) -> Result<(), TransitionError> {
        self.tree.desire_nothing();
        if self.is_engaged() {
            // The place goes with the duty that is being handed over.
            self.trace_lineage()?;
            self.collect_below();
            return Ok(());
        }
        let mut reattaches_to = None;
        let desired = match self.duty.location() {
            Activity::Standby if !self.tree_is_frozen() || self.anchor().is_none() => {
                self.choose_parent()
            }
            Activity::Following | Activity::Leading => self.replace_parent().or_else(|| {
                let (anchor, node) = self.reattach()?;
                reattaches_to = node;
                Some(Some(anchor))
            }),
            Activity::Relay | Activity::Junction | Activity::Leaf | Activity::Bound => {
                self.replace_parent().or_else(|| self.shorten_way())
            }
            Activity::Standby
            | Activity::Waiting
            | Activity::AwaitingRelease
            | Activity::Shifting => None,
        };
        let has_to_confirm = self.has_to_confirm(desired);
        self.tree.desire(desired, reattaches_to, has_to_confirm);
        self.look_after_place()
    }

    /// What follows from its duty and what it hears: its way to the access point, what is attached
    /// to it, and its parent.
    pub(super) fn look_after_place(&mut self) -> Result<(), TransitionError> {
        self.trace_lineage()?;
        let can_detach =
            !self.is_engaged() && self.duty.is_redundant() && self.finds_other_parent();
        self.tree.note_other_parent(can_detach);
        self.collect_below();
        self.remember_parent();
        Ok(())
    }

    /// Once a period: for how long no branch has depended on the post, Remark 5.6 (ii). A robot that does not
    /// hear its parent may be cut off from its branches, too. A bound leader, whose post depends on it alone, counts
    /// for how long such posts of others have had time to be given up.
    pub(super) fn count_unused_periods(&mut self) {
        let is_unused = || {
            self.duty.post().is_some_and(|post| post.is_fixed() && post.task.is_none())
                && !self.bears_branch()
                && !self.hears_no_parent()
        };
        let counts = match self.duty.is_bound() {
            true => self.is_eager() || self.is_bound_to_unused_post(),
            false => is_unused(),
        };
        let is_paused = self.tree_is_frozen() || self.is_engaged();
        self.tree.count_unused_period(counts && !is_paused, PATIENCE_WITH_UNUSED_POSTS + 1);
        if self.tree.unused_periods() >= PATIENCE_WITH_UNUSED_POSTS {
            self.changes.allow_jump();
        }
    }

    /// Whether it is a bound leader, and nodes that the last task or team has left without a branch may not have become
    /// redundant yet. In the paper's order it does not wait for them, nor if it takes its post along.
    pub(super) fn awaits_retirements(&self) -> bool {
        let may_retire = |known: &Announcement| known.again || !known.before.is_empty();
        let awaits_others = || self.is_eager() && self.announcement().is_some_and(may_retire);
        self.duty.is_bound()
            && !self.takes_post_along()
            && self.tree.unused_periods() <= PATIENCE_WITH_UNUSED_POSTS
            && (self.is_bound_to_unused_post() || awaits_others())
    }

    /// Whether it is a bound leader, services no task from its post, and no branch depends on that; robots that are
    /// attached to it find another parent.
    pub(super) fn is_bound_to_unused_post(&self) -> bool {
        let Duty::Bound(Bound(held)) = *self.duty else { return false };
        held.station.post.task.is_none()
            && !self.bears_branch()
            && !self.hears_no_parent()
            && self.children().all(|child| child.beacon.can_detach)
    }

    /// Whether it looks for another parent for its fixed post, or no branch depends on that any more.
    pub(super) fn is_settling(&self) -> bool {
        let looks_for_parent = self.tree.awaits_confirmation() || self.finds_better_parent();
        let is_unused = self.duty.location() == Activity::Relay && !self.bears_branch();
        self.is_eager() && (looks_for_parent && !self.duty.is_redundant() || is_unused)
    }

    /// While a path Σ is being sought or walked, no robot changes its parent.
    pub(super) fn tree_is_frozen(&self) -> bool {
        matches!(self.phase(), Phase::RecruitElection | Phase::PathAgreement | Phase::Shift)
    }

    /// Whether the mission has been given up.
    fn has_been_given_up(&self) -> bool {
        matches!(self.notice(), Notice::Ended { outcome, .. } if outcome.is_given_up())
    }

    /// Whether a fixed post or one of the primary team is attached to this robot's post.
    pub(super) fn bears_branch(&self) -> bool {
        self.branches() > 0
    }

    /// The number of branches that are attached to this robot's post. The primary team is one, also
    /// while a member of it has yet to attach to the newcomer.
    pub(super) fn branches(&self) -> usize {
        self.duty.post().map_or(0, |post| self.branches_of(post.id))
    }

    /// The number of branches attached to `post`.
    pub(super) fn branches_of(&self, post: PostId) -> usize {
        let branch_of = |post: &Post| match post.is_primary() {
            true => Some(None),
            false => post.is_fixed().then_some(Some(post.id)),
        };
        let children = self.children_of(post).filter_map(Neighbour::post);
        // During a hand-over two robots hold the same post.
        children.filter_map(branch_of).collect::<BTreeSet<Option<PostId>>>().len()
    }

    pub(super) fn anchor(&self) -> Option<Anchor> {
        self.duty.post().and_then(|post| post.parent)
    }

    /// Whether a link of this length may be made.
    pub(super) fn may_build(&self, length: f64) -> bool {
        length <= self.build_length() * (1.0 + ROUNDING)
    }

    /// Whether a link of the tree to this neighbour may be made: it is no longer than d_build, and will be no longer than
    /// d_hard when both have come to their posts.
    fn may_link(&self, neighbour: &Neighbour) -> bool {
        let coming = |station: Option<&Station>, from: Point| {
            let post = station.filter(|held| held.post.is_fixed()).map(|held| held.reference);
            post.filter(|&place| self.is_apart(from, place))
        };
        let (here, there) = (self.body.position(), neighbour.position());
        let own = coming(self.duty.station(), here);
        let other = coming(neighbour.station(), there);
        let may_last = |from: Point, to: Point| self.site.walk(from, to) <= self.hard_length();
        self.may_build(self.walk_to(neighbour))
            && own.is_none_or(|own| may_last(own, there))
            && other.is_none_or(|other| may_last(here, other))
            && own.zip(other).is_none_or(|(own, other)| may_last(own, other))
    }

    /// Whether no robot that it hears holds the post that its own is attached to.
    pub(super) fn is_orphan(&self) -> bool {
        matches!(self.anchor(), Some(Anchor::Post(_))) && self.named_parent().is_none()
    }

    /// Whether it hears nobody that stands for what its post is attached to: no robot that holds that post, or
    /// not the access point.
    pub(super) fn hears_no_parent(&self) -> bool {
        match self.anchor() {
            Some(anchor @ Anchor::Access(_)) => self.neighbour_at(anchor).is_none(),
            _ => self.is_orphan(),
        }
    }

    /// Once a period: for how long it has not heard its parent, or its post has been attached to none.
    pub(super) fn count_orphaned_periods(&mut self) {
        let is_unattached = self.duty.post().is_some_and(|post| post.parent.is_none());
        let has_no_parent = is_unattached || self.hears_no_parent();
        self.tree.count_orphaned_period(has_no_parent, PATIENCE_WITH_ORPHANED_POSTS + 1);
    }

    /// Another parent, where no robot has held the post for long that its own is attached to, or it is
    /// attached to none, since it had lost its parent when another robot came to rely on it: the node with the
    /// fewest links to an access point that is near enough; one that is confirmed already, if there is one.
    fn replace_parent(&self) -> Option<Option<Anchor>> {
        let (post, lost) = (self.duty.post()?.id, self.anchor());
        if let Some(followed) = self.new_post_of_parent() {
            return Some(Some(followed));
        }
        if lost.is_some() && self.tree.orphaned_periods() <= PATIENCE_WITH_ORPHANED_POSTS {
            return None;
        }
        let limit = self.hard_length() * (1.0 + ROUNDING);
        let leads_through_lost = |lineage: &Lineage| match lost {
            Some(Anchor::Post(lost)) => lineage.contains(lost),
            Some(Anchor::Access(lost)) => lineage.root() == lost,
            None => false,
        };
        let ways = self.neighbours.iter().filter_map(|neighbour| {
            let lineage = neighbour.beacon.lineage.as_ref()?;
            let usable = self.may_bear(post, neighbour)
                && !leads_through_lost(lineage)
                && self.walk_to(neighbour) <= limit;
            let order = (!self.is_confirmed(neighbour), lineage.hops());
            self.anchor_of(neighbour).filter(|_| usable).map(|anchor| (order, anchor))
        });
        ways.min_by_key(|&(order, _)| order).map(|(_, anchor)| Some(anchor))
    }

    /// Where the robot that its fixed post is attached to has joined the team from its own post, and the one that has taken that
    /// over is out of reach: the new post of the first. The task was serviced before p₁ was attached to it.
    fn new_post_of_parent(&self) -> Option<Anchor> {
        let own = self.duty.post().filter(|post| post.is_fixed())?.id;
        let parent = self.tree_parent().filter(|_| self.is_orphan())?;
        let node = self.neighbour(parent).filter(|node| self.may_bear(own, node))?;
        self.anchor_of(node)
    }

    /// With the eager strategy, while no path Σ is sought: the node farthest up the way from a fixed post to its access
    /// point that a link of length d_build reaches, past relays alone. These become redundant then, Remark 5.6 (ii).
    /// Where a mission has been given up, the tree stays as it was.
    fn shorten_way(&self) -> Option<Option<Anchor>> {
        if !self.is_eager() || self.tree_is_frozen() || self.has_been_given_up() {
            return None;
        }
        let (own, way) = (self.duty.post()?.id, self.lineage()?);
        let posts = way.posts().iter().skip(1).map(|&post| Anchor::Post(post));
        let mut farthest = None;
        for anchor in posts.chain([Anchor::Access(way.root())]) {
            let Some(node) = self.neighbour_at(anchor) else { break };
            if Some(anchor) != self.anchor() && self.may_bear(own, node) && self.may_link(node) {
                farthest = Some(anchor);
            }
            if !node.is_relay() {
                break;
            }
        }
        farthest.or_else(|| self.node_of_other_tree()).map(Some)
    }

    /// The node of the tree of another access point over which the way from its post is shortest, if it is shorter than
    /// its own.
    fn node_of_other_tree(&self) -> Option<Anchor> {
        let hops = self.lineage()?.hops();
        let nodes = self.nodes_of_other_trees().filter(|&(other, _)| other + 1 < hops);
        nodes.min_by_key(|&(hops, _)| hops).map(|(_, anchor)| anchor)
    }

    /// Whether it could be attached to another tree: over a shorter way or, once links may be as long as they ever are,
    /// over any.
    pub(super) fn is_near_other_tree(&self) -> bool {
        let is_longest = self.mission.notices().is_stretched() || !self.site.could_stretch();
        self.node_of_other_tree().is_some()
            || is_longest && self.nodes_of_other_trees().next().is_some()
    }

    /// The nodes of the trees of other access points, within d_build, to which its post could be attached, each with the
    /// number of links to its access point. Redundant robots do not count: they may be recruited.
    fn nodes_of_other_trees(&self) -> impl Iterator<Item = (usize, Anchor)> {
        let own = self.duty.post().map(|post| post.id).zip(self.lineage());
        self.neighbours.iter().filter_map(move |node| {
            let ((post, way), other) = (own?, node.beacon.lineage.as_ref()?);
            let may_attach = other.root() != way.root()
                && self.may_bear(post, node)
                && node.post().is_none_or(Post::is_fixed)
                && self.may_link(node);
            self.anchor_of(node).filter(|_| may_attach).map(|anchor| (other.hops(), anchor))
        })
    }

    /// Whether its post services no task and could move so that the one announced is serviced from it: its children and a
    /// possible parent would stay in range.
    pub(super) fn could_move_post_to(&self, task: Point) -> bool {
        let Some(post) = self.duty.post().filter(|post| post.task.is_none()) else { return false };
        let reach = self.site.settings.arrival_radius();
        let short_of = task + (self.body.position() - task).cap_magnitude(reach);
        let place = match self.site.free_space.contains(short_of) {
            true => short_of,
            false => self.site.place_to_service(task, self.body.position()),
        };
        let holds = |node: &Neighbour, limit: f64| self.site.walk(place, node.position()) <= limit;
        let mut nodes = self.neighbours.iter();
        let mut bound = self.tree_children().filter(|child| !child.beacon.can_detach);
        nodes.any(|node| self.may_bear(post.id, node) && holds(node, self.build_length()))
            && bound.all(|child| holds(child, self.hard_length()))
    }

    fn choose_parent(&self) -> Option<Option<Anchor>> {
        let post = *self.duty.post()?;
        let current = post.parent.and_then(|anchor| {
            let holder = self.neighbour_at(anchor)?;
            let lineage = holder.beacon.lineage.as_ref()?;
            let usable = self.may_attach_to(holder)
                && !lineage.contains(post.id)
                && self.walk_to(holder) <= self.longest_length() * (1.0 + ROUNDING);
            usable.then_some((lineage.hops(), anchor))
        });
        let best = |admits: &dyn Fn(&Neighbour) -> bool| self.best_parent(post.id, None, admits);
        let best = match current {
            Some(_) => best(&|_| true),
            None => best(&|node| self.is_confirmed(node)).or_else(|| best(&|_| true)),
        };
        Some(match (current, best) {
            (Some((hops, anchor)), Some((fewer, _))) if hops <= fewer => Some(anchor),
            (Some((_, anchor)), None) => Some(anchor),
            (None, None) => post.parent.filter(|&anchor| self.awaits_way_of(anchor)),
            (_, best) => best.map(|(_, anchor)| anchor),
        })
    }

    /// Whether it hears what its post is attached to, over a link that may last, and that knows no way at present: a
    /// robot that has come to its place of Σ hears of its way a few rounds later.
    fn awaits_way_of(&self, anchor: Anchor) -> bool {
        self.neighbour_at(anchor).is_some_and(|holder| {
            holder.beacon.lineage.is_none()
                && self.walk_to(holder) <= self.hard_length() * (1.0 + ROUNDING)
        })
    }

    /// The best node to attach to of those admitted, with its number of links to the access point; ways
    /// through `avoided` do not count.
    fn best_parent(
        &self,
        own: PostId,
        avoided: Option<PostId>,
        admits: &dyn Fn(&Neighbour) -> bool,
    ) -> Option<(usize, Anchor)> {
        let mut best: Option<(usize, f64, Anchor)> = None;
        for neighbour in self.neighbours.iter() {
            let Some(lineage) = &neighbour.beacon.lineage else { continue };
            let hops = lineage.hops();
            let better = best.is_none_or(|(fewest, reliability, _)| {
                hops < fewest || hops == fewest && neighbour.reliability > reliability
            });
            let Some(anchor) = self.anchor_of(neighbour) else { continue };
            if better
                && admits(neighbour)
                && neighbour.distance <= self.build_length() * (1.0 + ROUNDING)
                && avoided.is_none_or(|avoided| !lineage.contains(avoided))
                && self.may_bear(own, neighbour)
                && self.may_link(neighbour)
            {
                best = Some((hops, neighbour.reliability, anchor));
            }
        }
        best.map(|(hops, _, anchor)| (hops, anchor))
    }

    /// Whether no robot on the path contradicts it, by its own lineage or because redundant robots
    /// may not attach to it: its own beacon is newer than what others know of it, so that robots that
    /// lose their parent at once do not attach to one another.
    fn confirms(&self, lineage: &Lineage) -> bool {
        self.neighbours.iter().all(|neighbour| {
            let place = neighbour
                .post()
                .and_then(|post| lineage.posts().iter().position(|&passed| passed == post.id));
            place.is_none_or(|place| {
                let way = neighbour.beacon.lineage.as_ref();
                Self::accepts_redundant(neighbour)
                    && way.is_some_and(|own| own.posts() == &lineage.posts()[place..])
            })
        })
    }

    /// What a neighbour stands for to which others attach: its post, or itself if it is an access point.
    pub(super) fn anchor_of(&self, neighbour: &Neighbour) -> Option<Anchor> {
        let post = neighbour.post().map(|post| Anchor::Post(post.id));
        post.or_else(|| self.site.access_point_of(neighbour.id()).map(Anchor::Access))
    }

    /// Whether this robot may attach to this neighbour: not to one that is attached to it.
    fn may_attach_to(&self, neighbour: &Neighbour) -> bool {
        Self::accepts_redundant(neighbour) && neighbour.beacon.parent != Some(self.id)
    }

    /// Whether this post may be attached to a neighbour: the way of that is confirmed, and does not lead over the post.
    fn may_bear(&self, post: PostId, neighbour: &Neighbour) -> bool {
        let way = neighbour.beacon.lineage.as_ref();
        self.may_attach_to(neighbour)
            && way.is_some_and(|way| !way.contains(post) && self.confirms(way))
    }

    fn accepts_redundant(neighbour: &Neighbour) -> bool {
        neighbour.is_access_point() || neighbour.post().is_some_and(|post| post.bears_redundant())
    }

    fn finds_other_parent(&self) -> bool {
        match (self.duty.post(), self.anchor()) {
            (Some(post), Some(Anchor::Post(parent))) => {
                self.best_parent(post.id, Some(parent), &|_| true).is_some()
            }
            _ => true,
        }
    }

    /// The robots and tasks of which an access point hears through this one: those of its branch of the
    /// tree, and robots that know no way, on their way along Σ or with a parent that has failed.
    fn collect_below(&mut self) {
        let own = self.duty.post().map(|post| post.id);
        let mut reports = Reports {
            below: IdSet::singleton(self.id),
            serves: self.duty.post().and_then(|post| post.task).into_iter().collect(),
            ..Reports::default()
        };
        // On its way along Σ it holds no post, and knows no way itself.
        let is_linked = self.lineage().is_some() || own.is_none();
        for neighbour in self.neighbours.iter().filter(|it| it.is_present(self.schedule.period())) {
            let is_child = neighbour.is_attached_to(own);
            reports.take_in(&neighbour.beacon, is_child, self.id, is_linked);
        }
        self.tree.collect(reports);
    }

    /// Remark 5.6: p₁ attaches to a fixed or redundant robot or an access point that is
    /// nearer to its target, if there is one within d_build; or to the newcomer that it awaits, without a node.
    fn reattach(&self) -> Option<(Anchor, Option<NodeId>)> {
        let awaited = self.awaited_parent();
        if self.phase() != Phase::Advance || !self.is_first() && awaited.is_none() {
            return None;
        }
        if let Some(awaited) = awaited
            && let Some(newcomer) = self.holder(awaited)
            && self.is_sure_of(newcomer)
            && self.may_build(self.walk_to(newcomer))
        {
            return Some((Anchor::Post(awaited), None));
        }
        if self.is_eager() && awaited.is_some() {
            // The newcomer looks for p₁ where its link leads.
            return None;
        }
        let (anchor, parent) = match self.is_before_changeover() {
            true => self.access_point_on_the_way()?,
            false => self.nearer_parent(self.build_length())?,
        };
        Some((anchor, Some(parent)))
    }

    /// The access point to which a newcomer is attached on its way over several of them to the team, if it is not yet.
    fn access_point_on_the_way(&self) -> Option<(Anchor, NodeId)> {
        let crossing = self.crossing()?;
        let access = *crossing.get(self.index_in_crossing(crossing))?;
        let anchor = Anchor::Access(access);
        let node = self.neighbour_at(anchor).filter(|node| self.may_build(self.walk_to(node)))?;
        (self.anchor() != Some(anchor)).then(|| (anchor, node.id()))
    }

    /// Whether a newcomer is where p₁ takes it to be, or nearer. In the paper's order p₁ stands, and the newcomer
    /// comes up to it; while both move p₁ has to hear it.
    fn is_sure_of(&self, newcomer: &Neighbour) -> bool {
        !self.is_eager() || newcomer.was_heard()
    }

    /// Whether p₁ hears a node that it could attach to if it came near enough, and that is nearer to its target
    /// than its parent.
    pub(super) fn hears_nearer_parent(&self) -> bool {
        self.nearer_parent(f64::INFINITY).is_some()
    }

    /// The fixed or redundant robot or access point nearest to the target of p₁ of those that are clearly nearer
    /// to it than its parent, over links of at most this length.
    fn nearer_parent(&self, longest: f64) -> Option<(Anchor, NodeId)> {
        let (goal, anchor) = (self.team_goal()?, self.anchor()?);
        let parent = self.neighbour_at(anchor)?;
        let own = self.duty.post().map(|post| post.id);
        let gain = REATTACHMENT_GAIN * self.build_length();
        let mut nearest = self.site.distance(parent.position(), goal) - gain;
        let mut better = None;
        for neighbour in self.neighbours.iter().filter(|n| self.may_attach_to(n)) {
            let Some(candidate) = self.anchor_of(neighbour) else { continue };
            let is_child = neighbour.beacon.lineage.as_ref().is_none_or(|lineage| {
                own.is_some_and(|own| lineage.contains(own)) || !self.confirms(lineage)
            });
            if candidate == anchor
                || is_child
                || neighbour.distance > longest
                || (goal - neighbour.position()).norm() >= nearest
                || self.walk_to(neighbour) > longest
            {
                continue;
            }
            let distance = self.site.distance(neighbour.position(), goal);
            if distance < nearest {
                (nearest, better) = (distance, Some((candidate, neighbour.id())));
            }
        }
        better
    }
}
