//! The place of a robot in the tree: its parent and its way to an access point, what is attached to it, and which parent it
//! looks for.

use std::sync::Arc;

use pleach_discrete::network::{Anchor, Confirmation, IdSet, Lineage, NodeId};

use super::lineage::{Detached, HeardWay, PlaceInTree};
use crate::located::Current;
use crate::network::beacon::{Branch, Reports};
use crate::network::shared::renew;

/// The place of a robot in the tree.
#[derive(Clone, Debug)]
pub(super) struct TreePlace {
    place: Current<PlaceInTree>,
    /// The parent as it was last.
    parent: Option<NodeId>,
    heard_way: HeardWay,
    /// The robot has been given the post of another robot in this jump.
    is_displaced: bool,
    /// The robots of its branch, itself among them.
    below: Arc<IdSet>,
    /// The robots that know no way, as far as it has received.
    strays: Arc<IdSet>,
    /// The tasks that are serviced in its branch.
    serves: Arc<IdSet>,
    /// Where the robots are that are attached to it.
    branches: Arc<Vec<Branch>>,
    /// The parent that it has found to be best, none if it has looked for none.
    desired_parent: Option<Option<Anchor>>,
    /// The node that p₁ finds to be a better parent.
    reattaches_to: Option<NodeId>,
    /// How recently the way from its post has been confirmed.
    confirmation: Confirmation,
    /// Another parent would be better, and is not confirmed yet.
    awaits_confirmation: bool,
    /// Whether its post could be attached elsewhere.
    can_detach: bool,
    /// Control periods for which no branch has depended on its post.
    unused_periods: u32,
    /// Control periods for which it has not received its parent.
    orphaned_periods: u32,
}

impl TreePlace {
    /// That of a robot which is attached to nothing.
    pub(super) fn alone(id: NodeId) -> Self {
        TreePlace {
            place: Current::new(PlaceInTree::Detached(Detached)),
            parent: None,
            heard_way: HeardWay::NoParent,
            is_displaced: false,
            below: Arc::new(IdSet::singleton(id)),
            strays: Arc::default(),
            serves: Arc::default(),
            branches: Arc::default(),
            desired_parent: None,
            reattaches_to: None,
            confirmation: Confirmation::default(),
            awaits_confirmation: false,
            can_detach: false,
            unused_periods: 0,
            orphaned_periods: 0,
        }
    }

    pub(super) const fn current(&self) -> &Current<PlaceInTree> {
        &self.place
    }

    pub(super) const fn current_mut(&mut self) -> &mut Current<PlaceInTree> {
        &mut self.place
    }

    /// The way from the post of the robot to an access point, if one is known.
    pub(super) fn lineage(&self) -> Option<&Arc<Lineage>> {
        match &*self.place {
            PlaceInTree::Detached(_) => None,
            PlaceInTree::Attached(attached) => Some(&attached.way),
        }
    }

    /// The parent as it was last.
    pub(super) const fn parent(&self) -> Option<NodeId> {
        self.parent
    }

    /// The parent is this node now.
    pub(super) const fn attach_to(&mut self, parent: Option<NodeId>) {
        self.parent = parent;
    }

    /// What is received of the way from the parent.
    pub(super) const fn heard_way(&self) -> HeardWay {
        self.heard_way
    }

    /// This is received of the way from the parent.
    pub(super) const fn hear_way(&mut self, way: HeardWay) {
        self.heard_way = way;
    }

    /// Whether the robot has been given the post of another robot in this jump.
    pub(super) const fn is_displaced(&self) -> bool {
        self.is_displaced
    }

    /// The robot has been given the post of another robot in this jump, or the way from there has been looked for.
    pub(super) const fn displace(&mut self, is_displaced: bool) {
        self.is_displaced = is_displaced;
    }

    /// The robot has got another duty: it looks for a parent of its new post.
    pub(super) const fn begin_duty(&mut self) {
        self.desire_nothing();
        self.unused_periods = 0;
    }

    /// The parent that the robot has found to be best, if it has looked for one.
    pub(super) const fn desired_parent(&self) -> Option<Option<Anchor>> {
        self.desired_parent
    }

    /// The node that p₁ finds to be a better parent.
    pub(super) const fn reattaches_to(&self) -> Option<NodeId> {
        self.reattaches_to
    }

    /// The robot has found this parent to be best, which p₁ attaches to at this node; or it has to wait until the way of
    /// that is confirmed.
    pub(super) const fn desire(
        &mut self,
        parent: Option<Option<Anchor>>,
        reattaches_to: Option<NodeId>,
        awaits_confirmation: bool,
    ) {
        self.awaits_confirmation = awaits_confirmation;
        (self.desired_parent, self.reattaches_to) = match awaits_confirmation {
            true => (None, None),
            false => (parent, reattaches_to),
        };
    }

    /// The robot looks for no parent while its duty is being handed over. What it waits for stays.
    pub(super) const fn desire_nothing(&mut self) {
        (self.desired_parent, self.reattaches_to) = (None, None);
    }

    /// Whether another parent would be better, and is not confirmed yet.
    pub(super) const fn awaits_confirmation(&self) -> bool {
        self.awaits_confirmation
    }

    /// How recently the way from the post has been confirmed.
    pub(super) const fn confirmation(&self) -> &Confirmation {
        &self.confirmation
    }

    /// The way of the parent has been confirmed in this control period.
    pub(super) fn pass_on_confirmation(&mut self, confirmed: Option<u32>) {
        self.confirmation.pass_on(confirmed);
    }

    /// The post has been taken over from a robot that may have passed on confirmations up to this control period.
    pub(super) fn take_over_confirmation(&mut self, period: u32) {
        self.confirmation.take_over(period);
    }

    /// Whether the post could be attached elsewhere.
    pub(super) const fn can_detach(&self) -> bool {
        self.can_detach
    }

    /// The post could be attached elsewhere, or could not.
    pub(super) const fn note_other_parent(&mut self, can_detach: bool) {
        self.can_detach = can_detach;
    }

    /// Control periods for which no branch has depended on the post.
    pub(super) const fn unused_periods(&self) -> u32 {
        self.unused_periods
    }

    /// A control period in which no branch depends on the post, or one does, up to a number of interest.
    pub(super) fn count_unused_period(&mut self, is_unused: bool, most: u32) {
        self.unused_periods = if is_unused { most.min(self.unused_periods + 1) } else { 0 };
    }

    /// Control periods for which the robot has not received its parent.
    pub(super) const fn orphaned_periods(&self) -> u32 {
        self.orphaned_periods
    }

    /// A control period in which the robot has not received its parent, or has, up to a number of interest.
    pub(super) fn count_orphaned_period(&mut self, is_orphaned: bool, most: u32) {
        self.orphaned_periods = if is_orphaned { most.min(self.orphaned_periods + 1) } else { 0 };
    }

    /// What is reported of its branch.
    pub(super) fn collect(&mut self, reports: Reports) {
        renew(&mut self.below, reports.below);
        renew(&mut self.strays, reports.strays);
        renew(&mut self.serves, reports.serves);
    }

    /// The robots of the branch, those that know no way, and the tasks that are serviced.
    pub(super) const fn reports(&self) -> [&Arc<IdSet>; 3] {
        [&self.below, &self.strays, &self.serves]
    }

    /// Where the robots are that are attached to the robot.
    pub(super) const fn branches(&self) -> &Arc<Vec<Branch>> {
        &self.branches
    }

    /// The robots that are attached to the robot are there now.
    pub(super) fn locate_branches(&mut self, now: Vec<Branch>) {
        if *self.branches != now {
            self.branches = Arc::new(now);
        }
    }
}

#[cfg(feature = "abstraction")]
impl TreePlace {
    /// Every way to an access point counts as confirmed anew.
    pub(super) fn confirm_anew(&mut self) {
        self.confirmation = Confirmation::default();
    }

    /// The control periods of confirmations are numbered anew.
    pub(super) fn renumber(&mut self, number: impl Fn(u32) -> u32) {
        self.confirmation = self.confirmation.renumbered(number);
    }

    /// The robot counts as having received its parent.
    pub(super) const fn find_parent(&mut self) {
        self.orphaned_periods = 0;
    }

    /// What decides on the parent that is looked for, and on what is passed on.
    pub(super) const fn search(
        &self,
    ) -> (Option<Option<Anchor>>, Option<NodeId>, bool, &Confirmation) {
        (self.desired_parent, self.reattaches_to, self.awaits_confirmation, &self.confirmation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parent_that_is_not_confirmed_is_waited_for() {
        let mut tree = TreePlace::alone(0);
        let parent = Some(Some(Anchor::Access(0)));
        tree.desire(parent, Some(7), false);
        assert_eq!((tree.desired_parent(), tree.reattaches_to()), (parent, Some(7)));
        tree.desire(parent, Some(7), true);
        assert_eq!((tree.desired_parent(), tree.reattaches_to()), (None, None));
        tree.desire_nothing();
        assert!(tree.awaits_confirmation(), "it still passes on nothing newer");
    }

    #[test]
    fn periods_are_counted_up_to_what_is_of_interest() {
        let mut tree = TreePlace::alone(0);
        let unused = [true, true, true, false, true].map(|is_unused| {
            tree.count_unused_period(is_unused, 2);
            tree.unused_periods()
        });
        assert_eq!(unused, [1, 2, 2, 0, 1]);
        tree.begin_duty();
        assert_eq!(tree.unused_periods(), 0);
        let orphaned = [true, true, false].map(|is_orphaned| {
            tree.count_orphaned_period(is_orphaned, 9);
            tree.orphaned_periods()
        });
        assert_eq!(orphaned, [1, 2, 0]);
    }
}
