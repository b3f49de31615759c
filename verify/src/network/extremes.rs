//! The extremes of a mission, for its summary.

use super::violation::Instant;

/// An extreme value, when it occurred and which robots it concerns.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// When.
    pub instant: Instant,
    /// The robots concerned.
    pub robots: Vec<usize>,
}

/// How near a mission came to its bounds; `None` where nothing was there to be measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extremes {
    /// The smallest distance of two robots, to be compared with 2ρ.
    pub pair_distance: Option<Extreme>,
    /// The smallest distance of a robot to the walls, to be compared with ρ.
    pub clearance: Option<Extreme>,
    /// The smallest residual, to be compared with −c_min.
    pub residual: Option<Extreme>,
    /// The largest load, to be compared with 1.
    pub load: Option<Extreme>,
}

/// Keeps the smaller of two extremes, the earlier one when they are equal.
pub(super) fn keep_smaller(kept: &mut Option<Extreme>, candidate: Option<Extreme>) {
    keep(kept, candidate, |candidate, kept| candidate < kept);
}

/// Keeps the larger of two extremes, the earlier one when they are equal.
pub(super) fn keep_larger(kept: &mut Option<Extreme>, candidate: Option<Extreme>) {
    keep(kept, candidate, |candidate, kept| candidate > kept);
}

fn keep(
    kept: &mut Option<Extreme>,
    candidate: Option<Extreme>,
    is_better: impl Fn(f64, f64) -> bool,
) {
    if let Some(candidate) = candidate
        && kept.as_ref().is_none_or(|kept| is_better(candidate.value, kept.value))
    {
        *kept = Some(candidate);
    }
}
