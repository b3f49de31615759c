//! The distances of Fig. 11: between the closest robots, and from a robot to the closest wall.

use pleach_automaton::network::scenario::WorkspaceOutline;

use super::plan::sides;

/// The sides of boundary and holes.
#[derive(Clone, Debug)]
pub(crate) struct Walls {
    sides: Vec<([f64; 2], [f64; 2])>,
}

impl Walls {
    /// The walls of a workspace.
    pub(crate) fn new(workspace: &WorkspaceOutline) -> Walls {
        let loops = std::iter::once(&workspace.boundary).chain(&workspace.holes);
        Walls { sides: loops.flat_map(|corners| sides(corners)).collect() }
    }

    /// The smallest distance of two of the points, and of a point to a wall; infinite where there
    /// is none.
    pub(crate) fn distances(&self, points: &[[f64; 2]]) -> [f64; 2] {
        [smallest_pair_distance(points), smallest_clearance(points, &self.sides)]
    }
}

/// The smallest distance between two points, by a sweep along x; infinite for fewer than two.
fn smallest_pair_distance(points: &[[f64; 2]]) -> f64 {
    let mut sorted = points.to_vec();
    sorted.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let mut smallest = f64::INFINITY;
    for (index, one) in sorted.iter().enumerate() {
        for other in &sorted[index + 1..] {
            if (other[0] - one[0]).powi(2) >= smallest {
                break;
            }
            smallest = smallest.min(squared([other[0] - one[0], other[1] - one[1]]));
        }
    }
    smallest.sqrt()
}

fn squared([x, y]: [f64; 2]) -> f64 {
    x * x + y * y
}

/// The smallest distance from a point to a segment; infinite when there are none.
fn smallest_clearance(points: &[[f64; 2]], walls: &[([f64; 2], [f64; 2])]) -> f64 {
    let distances = points
        .iter()
        .flat_map(|point| walls.iter().map(move |(from, to)| to_segment(*point, *from, *to)));
    distances.fold(f64::INFINITY, f64::min).sqrt()
}

/// The square of the distance from a point to a segment.
fn to_segment(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let run = [to[0] - from[0], to[1] - from[1]];
    let way = [point[0] - from[0], point[1] - from[1]];
    let length_squared = squared(run);
    let share = if length_squared > 0.0 {
        ((way[0] * run[0] + way[1] * run[1]) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    squared([way[0] - share * run[0], way[1] - share * run[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(cases::usually(64))]
        #[test]
        fn the_sweep_agrees_with_all_pairs(
            points in prop::collection::vec([-1.0..1.0_f64, -1.0..1.0_f64], 0..40),
        ) {
            let mut smallest = f64::INFINITY;
            for (index, one) in points.iter().enumerate() {
                for other in &points[..index] {
                    smallest = smallest.min((one[0] - other[0]).hypot(one[1] - other[1]));
                }
            }
            let found = smallest_pair_distance(&points);
            prop_assert!(found == smallest || (found - smallest).abs() <= 1e-15, "{found} {smallest}");
        }
    }

    #[test]
    fn clearance_is_measured_to_sides_and_ends() {
        let wall = [([0.0, 0.0], [2.0, 0.0])];
        assert_eq!(smallest_clearance(&[[1.0, 0.5]], &wall), 0.5);
        assert_eq!(smallest_clearance(&[[5.0, 4.0]], &wall), 5.0);
    }
}
