//! The way of a secondary team along Σ (Sec. V-B and V-C).

use std::ops::Range;

/// A secondary team at work: the path Σ, its break points and subgroups.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Walk {
    /// The robots of Σ when it was announced, by which events name them.
    pub announced: Vec<usize>,
    /// The robot in each place of Σ now: robots that exchange duties exchange places.
    pub path: Vec<usize>,
    /// The places of the break points 𝓑, ascending.
    pub break_points: Vec<usize>,
    /// How many subgroups have arrived.
    pub arrived: usize,
    /// Whether the next subgroup is on its way.
    pub is_under_way: bool,
}

impl Walk {
    /// Subgroup S_β = [b_β, b_{β+1}) as places of Σ, eq. (26) and Sec. V-B2.
    pub(super) fn subgroup(&self, number: usize) -> Option<Range<usize>> {
        Some(*self.break_points.get(number)?..*self.break_points.get(number + 1)?)
    }

    /// The members of the subgroup that moves or is the next to move; no one after the last.
    pub(super) fn next_team(&self) -> &[usize] {
        self.subgroup(self.arrived).map_or(&[], |places| &self.path[places])
    }

    /// The robots that wait on Σ or move along it: from the subgroup whose turn it is to the last
    /// break point.
    pub(super) fn remaining(&self) -> &[usize] {
        match (self.break_points.get(self.arrived), self.break_points.last()) {
            (Some(&first), Some(&last)) => &self.path[first..=last],
            _ => &[],
        }
    }

    pub(super) fn has_arrived(&self) -> bool {
        self.arrived + 1 == self.break_points.len()
    }
}
