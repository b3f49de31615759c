//! The closest that robots came to each other and to the walls, between instants too.

use crate::automaton::network::scenario::{Scenario, WorkspaceOutline};
use nalgebra::Point2;

/// The smallest value of something that was measured, and where it was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smallest<W> {
    /// The value.
    pub value: f64,
    /// Who was concerned.
    pub who: W,
    /// The control period in which it was met.
    pub step: usize,
}

/// Keeps the smaller of what is known and what was just measured.
pub(super) fn keep_smaller<W>(known: &mut Option<Smallest<W>>, measured: Smallest<W>) {
    if known.as_ref().is_none_or(|known| measured.value < known.value) {
        *known = Some(measured);
    }
}

/// A segment from one point to another; a robot that stands still has both the same.
pub(super) type Segment = [Point2<f64>; 2];

/// The smallest distance between two robots that go along their segments in the same period,
/// both at constant speed: their difference moves on a segment too.
pub(super) fn passing_distance(first: Segment, second: Segment) -> f64 {
    let before = Point2::from(second[0] - first[0]);
    let after = Point2::from(second[1] - first[1]);
    distance_to_segment(Point2::origin(), [before, after])
}

/// The distance between a segment and the nearest wall, which it does not cross.
pub(super) fn wall_distance(walls: &[Segment], path: Segment) -> f64 {
    let apart = |wall: &Segment| {
        let ends_to_wall = path.map(|end| distance_to_segment(end, *wall));
        let corners_to_path = wall.map(|corner| distance_to_segment(corner, path));
        ends_to_wall.into_iter().chain(corners_to_path).fold(f64::INFINITY, f64::min)
    };
    walls.iter().map(apart).fold(f64::INFINITY, f64::min)
}

/// The edges of the boundary and of the holes.
pub(super) fn walls(scenario: &Scenario) -> Vec<Segment> {
    let WorkspaceOutline { boundary, holes } = &scenario.workspace;
    (std::iter::once(boundary).chain(holes))
        .flat_map(|polygon| polygon.iter().zip(polygon.iter().cycle().skip(1)))
        .map(|(&from, &to)| [Point2::from(from), Point2::from(to)])
        .collect()
}

fn distance_to_segment(point: Point2<f64>, [from, to]: Segment) -> f64 {
    let along = to - from;
    let length_squared = along.norm_squared();
    let fraction = if length_squared > 0.0 {
        ((point - from).dot(&along) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    nalgebra::distance(&point, &(from + along * fraction))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(from: [f64; 2], to: [f64; 2]) -> Segment {
        [from.into(), to.into()]
    }

    #[test]
    fn robots_that_cross_are_closest_between_the_instants() {
        let east = segment([0.0, 0.0], [2.0, 0.0]);
        let west = segment([2.0, 1.0], [0.0, 1.0]);
        assert_eq!(passing_distance(east, west), 1.0);
        assert_eq!(passing_distance(east, east), 0.0);
    }

    #[test]
    fn a_corner_beside_the_path_counts() {
        let path = segment([0.0, 0.0], [2.0, 0.0]);
        let tip = [segment([1.0, 0.25], [1.0, 3.0])];
        assert_eq!(wall_distance(&tip, path), 0.25);
    }
}
