//! The guards of the control period, and what must hold while time passes in it (Algorithm 5).

use crate::{Guard, Predicate, always, proposition, variable};

/// τ = Δt.
pub fn sample_due() -> Guard {
    Guard::new("sample due", variable("clock").at_least(variable("period")))
}

fn last_round() -> Predicate {
    variable("round").at_least(variable("rounds"))
}

/// The last round of beacons is over.
pub fn rounds_over() -> Guard {
    Guard::new("rounds over", last_round())
}

/// Another round of beacons follows.
pub fn next_round() -> Guard {
    Guard::new("next round", variable("round").less_than(variable("rounds")))
}

/// The last round of beacons is over, and routes begin with multipliers.
pub fn routes_due() -> Guard {
    Guard::new("routes due", last_round().and(!proposition("adal")))
}

/// The last round of beacons is over, and ADAL begins with the flows of the period before.
pub fn old_flows_due() -> Guard {
    Guard::new("old flows due", last_round().and(proposition("adal")))
}

/// Another iteration of the routes follows.
pub fn next_iteration() -> Guard {
    Guard::new("next iteration", variable("iteration").less_than(variable("iterations")))
}

/// The last iteration of the routes is over.
pub fn sweep_due() -> Guard {
    Guard::new("sweep due", variable("iteration").at_least(variable("iterations")))
}

/// Another sweep may follow.
pub fn sweep_over() -> Guard {
    Guard::new("sweep over", variable("sweep").less_than(variable("sweeps")))
}

/// The last sweep is over.
pub fn routes_done() -> Guard {
    Guard::new("routes done", variable("sweep").at_least(variable("sweeps")))
}

/// Moves are judged once more.
pub fn next_attempt() -> Guard {
    Guard::new("next attempt", variable("attempt").less_than(variable("attempts")))
}

/// Moves have been judged as often as they are.
pub fn move_certified() -> Guard {
    Guard::new("move certified", variable("attempt").at_least(variable("attempts")))
}

/// Every neighbour has spoken: the clock calls.
pub fn heard() -> Guard {
    Guard::new("heard", always())
}

/// While an access point or the user waits: the next sample is not over.
pub fn waiting() -> Predicate {
    variable("clock").at_most(variable("period"))
}

/// While the robot moves: the next sample is not over, and the robot is in the region that the
/// motion problem (21) has given it at the last sample: cell, trust region and links of the tree.
pub fn moving() -> Predicate {
    waiting().and(variable("outside").at_most(variable("rounding")))
}
