//! The guards of a robot's place in the tree.

use pleach_guards::{Guard, proposition};

/// The parent of its post tells a way to an access point.
pub(crate) fn way_found() -> Guard {
    Guard::new("way found", proposition("hears_other_way"))
}

/// The parent of its post tells another way than it has told so far.
pub(crate) fn way_changed() -> Guard {
    Guard::new("way changed", proposition("hears_other_way"))
}

/// Its post has no parent, the way of its parent leads through its post, or it has been given the
/// post of another robot. A parent that is not heard may be on its way along Σ: then the robot waits,
/// unless it is gone.
pub(crate) fn way_lost() -> Guard {
    let has_no_way = (!proposition("names_parent")).or(proposition("hears_cycle"));
    Guard::new("way lost", proposition("displaced").or(has_no_way))
}
