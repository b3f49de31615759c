//! The guards of a robot's attendance, as an access point knows it.

use pleach_guards::{Guard, Predicate, proposition, variable};

fn is_missed() -> Predicate {
    variable("silence").more_than(variable("patience"))
}

/// It has not been heard of for too long.
pub(crate) fn missed() -> Guard {
    Guard::new("missed", is_missed())
}

/// It has been heard of lately.
pub(crate) fn heard_again() -> Guard {
    Guard::new("heard again", !is_missed())
}

/// It has been heard of again while no valid roll calls it gone.
pub(crate) fn heard_in_time() -> Guard {
    Guard::new("heard in time", !is_missed() & (!proposition("recalled")).or(rolls_have_expired()))
}

fn rolls_have_expired() -> Predicate {
    variable("age").more_than(variable("validity"))
}

/// It has not been heard of again before the rolls expired that let it move.
pub(crate) fn rolls_expired() -> Guard {
    Guard::new("rolls expired", is_missed() & rolls_have_expired())
}

/// The rolls that called it gone have expired.
pub(crate) fn readmitted() -> Guard {
    Guard::new("readmitted", !is_missed() & rolls_have_expired())
}
