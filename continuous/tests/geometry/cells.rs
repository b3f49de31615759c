use pleach_continuous::geometry::{HalfPlane, convex_region, voronoi_half_planes};
use pleach_continuous::{Point, Vector};
use proptest::prelude::*;

use crate::environments::{CLEARANCE, environment, place};
use crate::plain;

fn admit(region: &[HalfPlane], point: Point) -> bool {
    region.iter().all(|plane| plane.contains(point))
}

/// Smallest margin; infinite without half-planes.
fn margin(region: &[HalfPlane], point: Point) -> f64 {
    region.iter().map(|plane| plane.margin(point)).fold(f64::INFINITY, f64::min)
}

/// Points of a disc: rings of directions.
fn disc(center: Point, radius: f64) -> impl Iterator<Item = Point> {
    (0..=12).flat_map(move |ring| {
        (0..48).map(move |direction| {
            let angle = f64::from(direction) * std::f64::consts::TAU / 48.0;
            center + Vector::new(angle.cos(), angle.sin()) * (radius * f64::from(ring) / 12.0)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn voronoi_half_planes_are_cells_shrunk(
        robots in prop::collection::vec(place(), 2..8),
        probes in prop::collection::vec(place(), 60),
    ) {
        let others: Vec<Vec<Point>> = (0..robots.len())
            .map(|own| robots.iter().enumerate().filter(|(i, _)| *i != own).map(|(_, p)| *p).collect())
            .collect();
        let spaced = (0..robots.len()).all(|own| {
            others[own].iter().all(|other| (other - robots[own]).norm() >= 2.0 * CLEARANCE)
        });
        prop_assume!(spaced);
        for (own, robot) in robots.iter().enumerate() {
            let cell = voronoi_half_planes(*robot, &others[own], CLEARANCE);
            prop_assert!(margin(&cell, *robot) >= -1e-12);
            for probe in &probes {
                let nearest = others[own].iter().all(|other| (probe - robot).norm() <= (probe - other).norm());
                if admit(&cell, *probe) {
                    prop_assert!(nearest);
                }
                // The distance to the bisector of the nearest rival.
                let deepest = others[own].iter().map(|other| {
                    let n = (other - robot).normalize();
                    n.dot(&(nalgebra::center(robot, other) - probe))
                }).fold(f64::INFINITY, f64::min);
                prop_assert!((margin(&cell, *probe) - (deepest - CLEARANCE)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn robots_too_near_may_stay_but_not_approach(robot in place(), angle in 0.0..6.3_f64, gap in 0.01..2.0) {
        let towards = Vector::new(angle.cos(), angle.sin());
        let neighbour = robot + towards * gap * CLEARANCE;
        let cell = voronoi_half_planes(robot, &[neighbour], CLEARANCE);
        prop_assert!(margin(&cell, robot) >= 0.0);
        prop_assert!(!admit(&cell, robot + towards * 1e-6));
        prop_assert!(voronoi_half_planes(robot, &[robot], CLEARANCE).is_empty());
    }

    /// A robot walks along geodesics; wherever it stands, its region is free and leaves it its way.
    #[test]
    fn regions_are_free_and_admit_the_way(
        environment in environment(),
        start in place(),
        goals in prop::collection::vec(place(), 3),
        radius in 0.05..0.3_f64,
        sideways in -0.5..0.5_f64,
    ) {
        let free_space = &environment.free_space;
        let edges = plain::edges(environment.workspace.polygons());
        let mut at = free_space.nearest(start);
        for (goal, drifts) in goals.into_iter().zip([true, false, false]) {
            let destination = free_space.destination(free_space.nearest(goal));
            let Some(path) = free_space.geodesic_to(at, &destination) else { break };
            let steps = path.length / radius + path.waypoints.len() as f64 + 2.0;
            for _ in 0..steps as usize {
                let Some(path) = free_space.geodesic_to(at, &destination) else { break };
                let waypoint = path.waypoints[0];
                let way = waypoint - at;
                if way.norm() == 0.0 { break }
                let end = at + way * (radius / way.norm()).min(1.0);
                let region = convex_region(free_space, at, waypoint, radius);
                prop_assert!(margin(&region, at) >= -1e-12);
                prop_assert!(margin(&region, end) >= -1e-12, "{at} to {end}: {}", margin(&region, end));
                for point in disc(at, radius).filter(|point| admit(&region, *point)) {
                    prop_assert!(plain::winds_around(&edges, point));
                    prop_assert!(plain::distance(&edges, point) >= CLEARANCE, "{point} seen from {at} on the way to {waypoint}");
                }
                let aside = end + Vector::new(-way.y, way.x).normalize() * (radius * sideways);
                at = if drifts && (aside - at).norm() <= radius && admit(&region, aside) { aside } else { end };
            }
            if !drifts {
                prop_assert_eq!(at, destination.goal());
            }
        }
    }

    /// Where the waypoint is out of sight, and where there is none, regions are free all the same.
    #[test]
    fn regions_are_free_whatever_the_waypoint(
        environment in environment(),
        at in place(),
        waypoint in place(),
        radius in 0.05..0.5,
    ) {
        let free_space = &environment.free_space;
        let edges = plain::edges(environment.workspace.polygons());
        let at = free_space.nearest(at);
        for waypoint in [waypoint, at] {
            let region = convex_region(free_space, at, waypoint, radius);
            prop_assert!(margin(&region, at) >= -1e-12);
            for point in disc(at, radius).filter(|point| admit(&region, *point)) {
                prop_assert!(plain::winds_around(&edges, point));
                prop_assert!(plain::distance(&edges, point) >= CLEARANCE);
            }
        }
    }
}
