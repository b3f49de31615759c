//! The closest pair among many simultaneous motions, without looking at all pairs.

use std::cmp::Ordering;

use pleach_continuous::geometry::Segment;

use super::motion::{Approach, closest_approach};

/// The pair of robots that come nearest to each other during a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ClosestPair {
    /// The robot with the lower number.
    pub first: usize,
    /// The other robot.
    pub second: usize,
    /// How near they come, and when.
    pub approach: Approach,
}

/// The closest pair over the whole period; `None` with fewer than two robots.
///
/// Motions whose closest approach is at most `reach` have their midpoints within `reach` plus
/// the longest motion of each other. So the midpoints are sorted into square cells of that
/// side, and only neighbouring cells are compared. If no pair is that near, `reach` is doubled:
/// then all robots are more than the old `reach` apart and few share a cell, so every round
/// costs O(N log N), and O(log(extent / reach)) rounds suffice. Ties go to the lower numbers.
pub(super) fn closest_pair(motions: &[Segment], reach: f64) -> Option<ClosestPair> {
    if motions.len() < 2 {
        return None;
    }
    let longest = motions.iter().map(Segment::length).fold(0.0, f64::max);
    let extent = extent(motions);
    let mut reach = reach.max(extent * SMALLEST_REACH);
    loop {
        let pair = Grid::new(motions, reach + longest).closest_pair(motions);
        let is_found = pair.is_some_and(|pair| pair.approach.distance <= reach);
        let is_exhaustive = reach.partial_cmp(&extent).is_none_or(Ordering::is_ge);
        if is_found || is_exhaustive {
            return pair;
        }
        reach *= 2.0;
    }
}

/// The first `reach`, as a share of the extent, when the caller's is smaller: it bounds the
/// number of doublings by 20.
const SMALLEST_REACH: f64 = 1e-6;

/// A length that no distance between two places of the motions exceeds.
fn extent(motions: &[Segment]) -> f64 {
    let places = || motions.iter().flat_map(|motion| [motion.from, motion.to]);
    let spread = |coordinate: usize| {
        let values = || places().map(|place| place[coordinate]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    spread(0) + spread(1)
}

/// Robots sorted by the cell of their motion's midpoint, row by row.
struct Grid {
    /// (row, column, robot), ascending.
    entries: Vec<(i64, i64, usize)>,
}

impl Grid {
    fn new(motions: &[Segment], side: f64) -> Self {
        let cell = |coordinate: f64| (coordinate / side).floor() as i64;
        let mut entries: Vec<_> = motions
            .iter()
            .enumerate()
            .map(|(robot, motion)| {
                let middle = motion.at(0.5);
                (cell(middle.y), cell(middle.x), robot)
            })
            .collect();
        entries.sort_unstable();
        Grid { entries }
    }

    /// The closest pair among robots of the same or of neighbouring cells.
    fn closest_pair(&self, motions: &[Segment]) -> Option<ClosestPair> {
        let mut closest: Option<ClosestPair> = None;
        for (place, &(row, column, robot)) in self.entries.iter().enumerate() {
            // Each pair once: the rest of this row, then the row above.
            let same_row = self.entries[place + 1..]
                .iter()
                .take_while(|entry| entry.0 == row && entry.1 <= column.saturating_add(1));
            let next_row = self.row_from(row.saturating_add(1), column.saturating_sub(1));
            let next_row = next_row
                .iter()
                .take_while(|entry| entry.0 == row.saturating_add(1))
                .take_while(|entry| entry.1 <= column.saturating_add(1))
                .filter(|entry| entry.0 != row);
            for &(_, _, other) in same_row.chain(next_row) {
                let (first, second) = (robot.min(other), robot.max(other));
                let approach = closest_approach(&motions[first], &motions[second]);
                let pair = ClosestPair { first, second, approach };
                if closest.is_none_or(|best| comes_before(&pair, &best)) {
                    closest = Some(pair);
                }
            }
        }
        closest
    }

    /// The entries from a cell on.
    fn row_from(&self, row: i64, column: i64) -> &[(i64, i64, usize)] {
        let start = self.entries.partition_point(|entry| (entry.0, entry.1) < (row, column));
        &self.entries[start..]
    }
}

/// The order of pairs: by distance, then by numbers.
fn comes_before(pair: &ClosestPair, other: &ClosestPair) -> bool {
    pair.approach
        .distance
        .total_cmp(&other.approach.distance)
        .then((pair.first, pair.second).cmp(&(other.first, other.second)))
        .is_lt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::point;
    use proptest::prelude::*;

    fn by_brute_force(motions: &[Segment]) -> f64 {
        let mut closest = f64::INFINITY;
        for first in 0..motions.len() {
            for second in 0..first {
                let approach = closest_approach(&motions[first], &motions[second]);
                closest = closest.min(approach.distance);
            }
        }
        closest
    }

    fn motion() -> impl Strategy<Value = Segment> {
        (-3.0..3.0, -3.0..3.0, -0.4..0.4, -0.4..0.4)
            .prop_map(|(x, y, dx, dy)| Segment { from: point![x, y], to: point![x + dx, y + dy] })
    }

    proptest! {
        #[test]
        fn the_grid_finds_what_all_pairs_find(
            motions in prop::collection::vec(motion(), 2..40),
            reach in prop::sample::select(vec![0.0, 0.01, 0.3, 10.0]),
        ) {
            let pair = closest_pair(&motions, reach).unwrap();
            prop_assert_eq!(pair.approach.distance, by_brute_force(&motions));
            prop_assert!(pair.first < pair.second);
        }
    }

    #[test]
    fn one_robot_has_no_pair() {
        assert_eq!(closest_pair(&[Segment::still(point![0.0, 0.0])], 1.0), None);
    }

    #[test]
    fn robots_at_one_place_are_a_pair() {
        let motions = [Segment::still(point![1.0, 1.0]); 3];
        let pair = closest_pair(&motions, 0.0).unwrap();
        assert_eq!((pair.first, pair.second, pair.approach.distance), (0, 1, 0.0));
    }
}
