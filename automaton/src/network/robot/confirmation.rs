//! How recently the robot's way to an access point has been confirmed: it attaches only to nodes
//! whose way is confirmed more recently than any of which it has told others.

use pleach_discrete::network::Anchor;

use super::Robot;
use super::hearing::Neighbour;

impl Robot {
    /// Whether this node cannot be below the robot in the tree.
    pub(super) fn is_confirmed(&self, neighbour: &Neighbour) -> bool {
        self.tree.confirmation().admits(neighbour.confirmed)
    }

    /// Whether the parent that it looks for has to be confirmed first.
    pub(super) fn has_to_confirm(&self, desired: Option<Option<Anchor>>) -> bool {
        let sought = desired.flatten().filter(|&anchor| Some(anchor) != self.anchor());
        let node = sought.and_then(|anchor| self.neighbour_at(anchor));
        node.is_some_and(|node| !self.is_confirmed(node))
    }

    /// The confirmation that it passes on: that of its parent. While it looks for another parent or
    /// hands its post over it passes on nothing newer.
    pub(super) fn pass_on_confirmation(&mut self) -> Option<u32> {
        let keeps_still =
            self.tree.awaits_confirmation() || self.is_engaged() || self.duty.place().is_some();
        if !keeps_still
            && let Some(parent) = self.anchor().and_then(|anchor| self.neighbour_at(anchor))
        {
            let confirmed = parent.confirmed;
            self.tree.pass_on_confirmation(confirmed);
        }
        self.tree.confirmation().newest()
    }
}
