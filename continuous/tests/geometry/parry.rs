//! Distances and neighbours against the shapes and queries of parry: clearance, separation, neighbours. Of parry, the
//! package itself uses the hierarchy of boxes alone, whose answers its unit tests compare with a scan.

use super::environments::{environment, place};
use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::{Pose, Vector as Arrow};
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy};
use parry2d_f64::query::{self, PointQuery};
use parry2d_f64::shape::{Capsule as Pill, Polyline, Segment as Line, Shape};
use pleach_continuous::Point;
use pleach_continuous::geometry::{Capsule, Neighbours, Segment, Workspace};
use proptest::prelude::*;

/// The accuracy of parry for the distance of two shapes; that of a point is exact to rounding.
const ACCURACY: f64 = 1e-6;

fn arrow(point: Point) -> Arrow {
    Arrow::new(point.x, point.y)
}

fn line(segment: &Segment) -> Line {
    Line::new(arrow(segment.from), arrow(segment.to))
}

fn pill(capsule: &Capsule) -> Pill {
    Pill::new(arrow(capsule.axis.from), arrow(capsule.axis.to), capsule.radius)
}

fn boundary(workspace: &Workspace) -> Polyline {
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for ring in workspace.polygons() {
        let (first, count) = (vertices.len() as u32, ring.len() as u32);
        vertices.extend(ring.iter().copied().map(arrow));
        indices.extend((0..count).map(|at| [first + at, first + (at + 1) % count]));
    }
    Polyline::new(vertices, Some(indices))
}

fn distance(one: &dyn Shape, other: &dyn Shape) -> f64 {
    let here = Pose::IDENTITY;
    query::distance(&here, one, &here, other).unwrap().distance
}

fn segment() -> impl Strategy<Value = Segment> {
    (place(), place()).prop_map(|(from, to)| Segment::new(from, to))
}

proptest! {
    #[test]
    fn parry_agrees_on_the_clearance_of_points(environment in environment(), places in prop::collection::vec(place(), 50)) {
        let workspace = &environment.workspace;
        let boundary = boundary(workspace);
        for place in places {
            let theirs = boundary.distance_to_local_point(arrow(place), true);
            prop_assert!((workspace.clearance(place).abs() - theirs).abs() < 1e-12);
        }
    }

    #[test]
    fn parry_agrees_on_the_clearance_of_segments(environment in environment(), paths in prop::collection::vec(segment(), 10)) {
        let workspace = &environment.workspace;
        let boundary = boundary(workspace);
        for path in paths {
            let ours = workspace.segment_clearance(path.from, path.to);
            let theirs = distance(&line(&path), &boundary);
            prop_assert!(ours <= 0.0 || (ours - theirs).abs() < ACCURACY, "{path:?}: {ours} {theirs}");
            // What is no more than a tenth of a millionth is in doubt for parry.
            if ours < -ACCURACY && workspace.contains(path.from) {
                prop_assert!(theirs < ACCURACY, "{path:?} leaves the workspace");
            }
        }
    }

    #[test]
    fn parry_agrees_on_the_separation_of_moves(
        one in segment(), other in segment(), radii in (0.0..0.2_f64, 0.0..0.2_f64),
    ) {
        let theirs = distance(&line(&one), &line(&other));
        prop_assert!((one.distance_to(&other) - theirs).abs() < ACCURACY);
        let [one, other] = [(one, radii.0), (other, radii.1)].map(|(axis, radius)| Capsule { axis, radius });
        let theirs = distance(&pill(&one), &pill(&other));
        prop_assert!((one.gap(&other).max(0.0) - theirs).abs() < ACCURACY, "{} {theirs}", one.gap(&other));
    }

    #[test]
    fn parry_agrees_on_neighbours(points in prop::collection::vec(place(), 1..80), radius in 0.0..1.0_f64) {
        let boxes: Vec<Aabb> = points.iter().map(|&point| Aabb::new(arrow(point), arrow(point))).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let neighbours = Neighbours::new(&points, radius);
        for &center in &points {
            let reach = Arrow::new(radius, radius);
            let around = Aabb::new(arrow(center) - reach, arrow(center) + reach);
            let mut theirs: Vec<usize> = tree
                .intersect_aabb(&around)
                .map(|index| index as usize)
                .filter(|&index| (points[index] - center).norm() <= radius)
                .collect();
            theirs.sort_unstable();
            // parry's boxes are rounded: a point on the rim of the disc may be missed.
            let ours = neighbours.within(center, radius);
            let missed = ours.iter().filter(|index| !theirs.contains(index));
            prop_assert!(theirs.iter().all(|index| ours.contains(index)));
            for &index in missed {
                prop_assert!((points[index] - center).norm() > radius * (1.0 - 1e-12));
            }
        }
    }
}
