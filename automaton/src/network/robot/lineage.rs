//! The automaton of the robot's place in the tree: its way to an access point, from what its parent
//! tells.

use std::borrow::Cow;
use std::sync::Arc;

use pleach_discrete::network::{ATTACHMENT, Anchor, Attachment, AttachmentEvent, Lineage};

use crate::located::{Current, Holds};
use crate::network::guards::attachment as guards;
use crate::{Automaton, BuildError, Transfer, TransitionError};

use super::Robot;

/// The automaton of a robot's place in the tree.
pub type AttachmentAutomaton = Automaton<Attachment, AttachmentEvent, Robot>;

crate::places_of! {
    /// A robot's place in the tree, with its way to an access point.
    pub enum PlaceInTree: Attachment {
        /// No way is known.
        Detached(Detached),
        /// A way is known.
        Attached(Attached),
    }
}

/// The data of [`Attachment::Detached`]: none.
#[derive(Clone, Debug, PartialEq)]
pub struct Detached;

/// The data of [`Attachment::Attached`].
#[derive(Clone, Debug, PartialEq)]
pub struct Attached {
    /// The posts from its own up to the access point.
    pub way: Arc<Lineage>,
}

impl Holds<PlaceInTree> for Robot {
    type Effects = ();

    fn current(&self) -> &Current<PlaceInTree> {
        self.tree.current()
    }

    fn current_mut(&mut self) -> &mut Current<PlaceInTree> {
        self.tree.current_mut()
    }

    fn carry_out(&mut self, (): ()) {
        self.tree.displace(false);
    }
}

/// What a robot hears of the way to an access point from the parent of its post.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HeardWay {
    /// Nothing: its post has no parent, or that is not heard and the robot itself is gone by the roll.
    NoParent,
    /// Nothing: its parent is not heard, or knows no way.
    Silence,
    /// A way that leads through its own post.
    Cycle,
    /// The way that it tells itself.
    Known,
    /// Another way.
    Other,
}

impl Robot {
    /// The way from its post to an access point, if it knows one.
    pub(super) fn lineage(&self) -> Option<&Arc<Lineage>> {
        self.tree.lineage()
    }

    /// Takes the transitions of its place in the tree that can be taken.
    pub(super) fn trace_lineage(&mut self) -> Result<(), TransitionError> {
        let site = Arc::clone(&self.site);
        loop {
            let way = self.way_heard();
            self.tree.hear_way(way);
            if site.automata.attachment.step_in_place::<PlaceInTree>(self)?.is_none() {
                self.tree.displace(false);
                return Ok(());
            }
        }
    }

    fn way_heard(&self) -> HeardWay {
        let (Some(post), Some(anchor)) = (self.duty.post(), self.anchor()) else {
            return HeardWay::NoParent;
        };
        match (self.lineage_of(anchor), self.lineage()) {
            (None, _) if self.membership.is_gone(self.id) => HeardWay::NoParent,
            (None, _) => HeardWay::Silence,
            (Some(way), Some(own)) if own.extends(&way, post.id) => HeardWay::Known,
            (Some(way), _) if way.contains(post.id) => HeardWay::Cycle,
            _ => HeardWay::Other,
        }
    }

    /// The lineage of a parent, if it is heard and knows one. A parent that is on its way along Σ is heard
    /// again when it has arrived.
    fn lineage_of(&self, parent: Anchor) -> Option<Cow<'_, Lineage>> {
        match parent {
            Anchor::Access(access) => Some(Cow::Owned(Lineage::of_access_point(access))),
            Anchor::Post(parent) => {
                self.holder(parent)?.beacon.lineage.as_deref().map(Cow::Borrowed)
            }
        }
    }
}

/// The way of its parent, and its own post before it.
fn follow_parent<A>(_: &A, robot: &Robot, (): &mut ()) -> Option<Attached> {
    let way = robot.lineage_of(robot.anchor()?)?.extended_by(robot.duty.post()?.id)?;
    Some(Attached { way: Arc::new(way) })
}

fn detach(_: &Attached, _: &Robot, (): &mut ()) -> Detached {
    Detached
}

/// The automaton of a robot's place in the tree.
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(in crate::network) fn attachment_automaton() -> Result<AttachmentAutomaton, BuildError> {
    use AttachmentEvent as On;
    let name = "way of the parent, own post first";
    Automaton::builder(ATTACHMENT, Attachment::Detached)
        .observing()
        .at_most_one(&["hears_other_way", "hears_cycle"])
        .carried_out(Transfer::where_known(
            On::WayFound,
            guards::way_found(),
            name,
            follow_parent::<Detached>,
        ))
        .carried_out(Transfer::where_known(
            On::WayChanged,
            guards::way_changed(),
            name,
            follow_parent::<Attached>,
        ))
        .carried_out(Transfer::new(On::WayLost, guards::way_lost(), "forget the way", detach))
        .build()
}
