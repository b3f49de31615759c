use pleach_continuous::geometry::{
    FreeSpace, HalfPlane, Workspace, convex_region, voronoi_half_planes,
};
use pleach_continuous::{Point, Vector};
use proptest::prelude::*;

use super::environments::{CLEARANCE, environment, place, ring, room_with_hole};
use super::plain;

fn admit(region: &[HalfPlane], point: Point) -> bool {
    region.iter().all(|plane| plane.contains(point))
}

/// Smallest margin; infinite without half-planes.
fn margin(region: &[HalfPlane], point: Point) -> f64 {
    region.iter().map(|plane| plane.margin(point)).fold(f64::INFINITY, f64::min)
}

/// Places spread over a region within a disc: in many directions from its centre, up to where the
/// region or the disc ends, and the corners of the region.
fn spread(region: &[HalfPlane], center: Point, radius: f64) -> Vec<Point> {
    let mut places = Vec::new();
    for direction in 0..64 {
        let angle = f64::from(direction) * std::f64::consts::TAU / 64.0;
        let ray = Vector::new(angle.cos(), angle.sin());
        let reach = region
            .iter()
            .filter(|plane| plane.normal.dot(&ray) > 0.0)
            .map(|plane| plane.margin(center) / plane.normal.dot(&ray))
            .fold(radius, f64::min);
        places.extend([0.25, 0.5, 1.0].map(|part| center + ray * (reach * part)));
    }
    for (index, one) in region.iter().enumerate() {
        for other in &region[..index] {
            let determinant = one.normal.perp(&other.normal);
            let corner = Point::new(
                one.offset * other.normal.y - other.offset * one.normal.y,
                other.offset * one.normal.x - one.offset * other.normal.x,
            ) / determinant;
            let is_in_disc = (corner - center).norm() <= radius;
            if determinant.abs() > 1e-6 && is_in_disc && margin(region, corner) >= -1e-9 {
                places.push(corner);
            }
        }
    }
    places
}

#[test]
fn ways_may_touch_corners_of_the_sight_set() {
    let workspace = room_with_hole();
    let free_space = FreeSpace::new(&workspace, 0.125).unwrap();
    let edges = plain::edges(workspace.polygons());
    let sight_offset = 0.125 + free_space.tolerance() / 2.0;
    let mut touching = 0;
    let gaps = [0.0, 2e-16, 1e-15, 1e-13, 1e-9, 1e-6, 5e-4].into_iter();
    for (step, gap) in (1..60).zip(gaps.cycle()) {
        let corner = Point::new(1.0 - sight_offset - gap, 1.0 - sight_offset - gap);
        let slope = f64::from(step % 7 + 1) / 4.0;
        let along = Vector::new(-1.0, slope).normalize() * (f64::from(step) * 0.003);
        for (at, waypoint) in [(corner + along, corner - along), (corner - along, corner + along)] {
            let region = convex_region(&free_space, at, waypoint, 0.2);
            if free_space.sees(at, waypoint) {
                touching += 1;
                assert!(margin(&region, nalgebra::center(&at, &waypoint)) >= -1e-12);
            }
            for place in spread(&region, at, 0.2) {
                assert!(plain::winds_around(&edges, place), "{place} from {at} to {waypoint}");
                assert!(plain::distance(&edges, place) >= 0.125 - 1e-12, "{place} from {at}");
            }
        }
    }
    assert!(touching > 10, "{touching}");
}

/// A wide room, and how far from its lower wall the planning set begins.
fn room() -> (FreeSpace, f64) {
    let boundary = ring(&[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)]);
    let free_space = FreeSpace::new(&Workspace::new(boundary, vec![]).unwrap(), CLEARANCE).unwrap();
    let border = free_space.nearest(Point::new(1.5, 0.0)).y;
    (free_space, border)
}

/// Beside a wall that is parallel to the way, all that belongs to the planning set is admitted.
#[test]
fn a_region_ends_where_the_planning_set_does() {
    let (free_space, border) = room();
    for height in [0.0, 0.01, 0.1, 0.19] {
        let at = Point::new(1.5, border + height);
        let region = convex_region(&free_space, at, Point::new(2.5, at.y), 0.2);
        assert_eq!(region.len(), 1, "{height}");
        assert!((margin(&region, at) - height).abs() < 1e-12, "{height}: {}", margin(&region, at));
    }
    let in_the_middle = Point::new(1.5, 1.5);
    assert!(convex_region(&free_space, in_the_middle, in_the_middle, 0.2).is_empty());
}

/// Before the corner of a hole both of its walls bound the region by their own lines.
#[test]
fn walls_bound_the_region_by_their_own_lines() {
    let workspace = room_with_hole();
    let free_space = FreeSpace::new(&workspace, 0.1).unwrap();
    let at = Point::new(0.85, 0.85);
    let region = convex_region(&free_space, at, at, 0.3);
    assert!(admit(&region, Point::new(0.85, 0.89)) && admit(&region, Point::new(0.89, 0.85)));
    assert!(!admit(&region, Point::new(0.7, 0.91)) && !admit(&region, Point::new(0.91, 0.7)));
}

/// A wall that only just gets into the disc bounds the region, too.
#[test]
fn walls_at_the_edge_of_the_disc_bound_the_region() {
    let (free_space, border) = room();
    for share in [0.01, 0.5, 0.99, 1.01, 1.4] {
        let at = Point::new(1.5, border + 0.2 - share * free_space.tolerance());
        let region = convex_region(&free_space, at, Point::new(2.5, at.y), 0.2);
        assert!(!admit(&region, Point::new(1.5, at.y - 0.2)), "{share}");
    }
}

proptest! {
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
                for point in spread(&region, at, radius) {
                    prop_assert!(plain::winds_around(&edges, point));
                    prop_assert!(plain::distance(&edges, point) >= CLEARANCE - 1e-12, "{point} seen from {at} on the way to {waypoint}");
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
            for point in spread(&region, at, radius) {
                prop_assert!(plain::winds_around(&edges, point));
                prop_assert!(plain::distance(&edges, point) >= CLEARANCE - 1e-12);
            }
        }
    }
}
