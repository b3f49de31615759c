//! A robot's place in the tree: whether its post has a way to an access point, and the table.
//!
//! Which parent a post has belongs to the duty, whose rows change it. Here the robot follows what its
//! parent tells: the way to an access point, as a path vector ([`Lineage`](super::Lineage)).

use crate::{TransitionTable, from, transitions, vocabulary};

vocabulary! {
    /// Whether a robot's post belongs to a tree.
    pub enum Attachment: Location {
        /// No way to an access point is known from its post.
        Detached = "detached",
        /// A way to an access point is known from its post.
        Attached = "attached",
    }

    /// What changes a robot's place in the tree.
    pub enum AttachmentEvent: Event {
        /// Its parent tells a way.
        WayFound = "way found",
        /// Its parent tells another way, or it has another parent.
        WayChanged = "way changed",
        /// Its post has no parent, its way would lead through its own post, or it holds the post of
        /// another robot now.
        WayLost = "way lost",
    }
}

/// The table of a robot's place in the tree.
pub const ATTACHMENT: TransitionTable<Attachment, AttachmentEvent> = {
    use Attachment::{Attached, Detached};
    use AttachmentEvent as On;
    transitions![Attachment, AttachmentEvent;
        from(Detached).on(On::WayFound).to(Attached),
        from(Attached).on(On::WayLost).to(Detached),
        from(Attached).on(On::WayChanged).to(Attached).priority(1),
    ]
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_deterministic_and_both_locations_are_reached() {
        assert!(ATTACHMENT.is_deterministic());
        assert_eq!(ATTACHMENT.unreachable_from(Attachment::Detached), vec![]);
        assert_eq!(ATTACHMENT.unreachable_from(Attachment::Attached), vec![]);
    }
}
