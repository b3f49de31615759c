//! The guards of the control period, and what must hold while time passes in it (Algorithm 5).

use pleach_guards::{Guard, Predicate, always, proposition, variable};

/// τ = Δt, or another node has begun the next control period.
pub(crate) fn sample_due() -> Guard {
    let is_over = variable("clock").at_least(variable("period"));
    Guard::new("sample due", is_over.or(proposition("behind")))
}

fn last_round() -> Predicate {
    variable("round").at_least(variable("rounds"))
}

/// The last round of beacons is over.
pub(crate) fn rounds_over() -> Guard {
    Guard::new("rounds over", last_round())
}

/// Another round of beacons follows.
pub(crate) fn next_round() -> Guard {
    Guard::new("next round", variable("round").less_than(variable("rounds")))
}

/// The last round of beacons is over, and routes begin with multipliers.
pub(crate) fn routes_due() -> Guard {
    Guard::new("routes due", last_round().and(!proposition("adal")))
}

/// The last round of beacons is over, and ADAL begins with the flows of the period before.
pub(crate) fn old_flows_due() -> Guard {
    Guard::new("old flows due", last_round().and(proposition("adal")))
}

/// The multipliers of an iteration of the routes have been told.
pub(crate) fn multipliers_heard() -> Guard {
    Guard::new("multipliers heard", proposition("hears_multipliers"))
}

/// The flows of an iteration of the routes have been told, and another one follows.
pub(crate) fn next_iteration() -> Guard {
    let last = proposition("last_iteration");
    Guard::new("next iteration", (!proposition("hears_multipliers")).and(!last))
}

/// The last iteration of the routes is over.
pub(crate) fn sweep_due() -> Guard {
    let last = proposition("last_iteration");
    Guard::new("sweep due", (!proposition("hears_multipliers")).and(last))
}

/// Demands have gone up the tree.
pub(crate) fn demands_heard() -> Guard {
    Guard::new("demands heard", proposition("hears_demands"))
}

/// A sweep is over, and another one may follow.
pub(crate) fn sweep_over() -> Guard {
    Guard::new("sweep over", proposition("hears_flows").and(!proposition("last_sweep")))
}

/// The last sweep is over.
pub(crate) fn sweeps_over() -> Guard {
    Guard::new("sweeps over", proposition("hears_flows").and(proposition("last_sweep")))
}

/// Requests that have not been answered are made again.
pub(crate) fn grants_heard() -> Guard {
    Guard::new("grants heard", !proposition("last_answers"))
}

/// The last answers to requests have arrived.
pub(crate) fn routes_done() -> Guard {
    Guard::new("routes done", proposition("last_answers"))
}

/// Shortages have been told from robot to robot.
pub(crate) fn shortages_heard() -> Guard {
    Guard::new("shortages heard", proposition("hears_shortages"))
}

/// Flows have been taken back from robots that cannot pass them on.
pub(crate) fn reliefs_heard() -> Guard {
    let others =
        ["hears_demands", "hears_flows", "hears_shortages"].map(|round| !proposition(round));
    let [demands, flows, shortages] = others;
    Guard::new("reliefs heard", demands.and(flows).and(shortages))
}

/// Proposals are judged.
pub(crate) fn proposals_heard() -> Guard {
    Guard::new("proposals heard", proposition("hears_proposals"))
}

/// Objections are heard, and moves are judged once more.
pub(crate) fn next_attempt() -> Guard {
    let last = proposition("last_attempt");
    Guard::new("next attempt", (!proposition("hears_proposals")).and(!last))
}

/// The last attempt is over.
pub(crate) fn move_certified() -> Guard {
    let last = proposition("last_attempt");
    Guard::new("move certified", (!proposition("hears_proposals")).and(last))
}

/// All messages of the round have arrived: the clock is due.
pub(crate) fn heard() -> Guard {
    Guard::new("heard", always())
}

/// While an access point or the user waits: the next sample is not over.
pub(crate) fn waiting() -> Predicate {
    variable("clock").at_most(variable("period"))
}

/// While the robot moves: the next sample is not over, and the robot is in the region that the
/// motion problem (21) has given it at the last sample: cell, trust region and links of the tree.
pub(crate) fn moving() -> Predicate {
    waiting().and(variable("outside").at_most(variable("rounding")))
}
