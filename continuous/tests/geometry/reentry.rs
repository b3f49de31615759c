//! Points slightly outside the free space.

use pleach_continuous::geometry::{FreeSpace, HalfPlane, Segment, Workspace, convex_region};
use pleach_continuous::{Point, Vector};
use proptest::prelude::*;

use super::environments::{CLEARANCE, Environment, environment, place, ring};
use super::plain;

/// Rounding of a few operations on coordinates of order one.
const ROUNDING: f64 = 1e-12;

/// A point outside the planning set, at a share of the reach from the middle of one of its edges
/// or from one of its corners.
fn strayed(environment: &Environment, pick: usize, angle: f64, share: f64) -> Option<Point> {
    let space = &environment.free_space;
    let outline: Vec<(Point, Point)> = plain::edges(space.outline());
    let (from, to) = outline[pick % outline.len()];
    let start = if pick.is_multiple_of(2) { from } else { nalgebra::center(&from, &to) };
    let point = start + Vector::new(angle.cos(), angle.sin()) * (share * space.reach());
    (!space.contains(point)).then_some(point)
}

fn square_room() -> FreeSpace {
    let boundary = ring(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)]);
    FreeSpace::new(&Workspace::new(boundary, vec![]).unwrap(), 0.1).unwrap()
}

#[test]
fn a_millionth_outside_is_not_lost() {
    let space = square_room();
    let (out, goal) = (Point::new(0.7, 0.1 - 1e-6), Point::new(1.5, 0.6));
    assert!(!space.contains(out));
    let path = space.geodesic(out, goal).unwrap();
    assert!((path.length - (goal - out).norm()).abs() < 1e-5);
    assert_eq!(space.geodesic_to(out, &space.destination(goal)), Some(path));
    assert!((space.distance(goal, out) - space.distance(out, goal)).abs() < ROUNDING);
    assert!(space.sees(out, goal) && space.sees(out, out));
    assert!(!space.sees(goal, out), "no robot is sent out");
    assert_eq!(space.distance(out, out), 0.0);
    // A robot beside a wall that is in range keeps it, and may go along it.
    let region = convex_region(&space, out, Point::new(1.5, out.y), 0.2);
    let admits = |x: f64, y: f64| region.iter().all(|plane| plane.contains(Point::new(x, y)));
    assert!(admits(out.x, out.y) && admits(0.8, 0.11) && !admits(0.8, 0.1 - 1e-6));
}

#[test]
fn the_reach_is_a_parameter() {
    let space = square_room();
    let out = |depth: f64| Point::new(0.7, 0.1 - depth);
    let goal = Point::new(1.5, 0.6);
    assert!(
        space.geodesic(out(0.049), goal).is_some() && space.geodesic(out(0.051), goal).is_none()
    );
    let space = space.with_reach(0.09).unwrap();
    assert!(
        space.geodesic(out(0.089), goal).is_some() && space.geodesic(out(0.091), goal).is_none()
    );
    assert!(space.destination(out(0.091)).goal() == out(0.091));
    assert_eq!(space.distance_to(goal, &space.destination(out(0.091))), f64::INFINITY);
    for reach in [-1e-9, 0.11, f64::NAN, f64::INFINITY] {
        assert!(space.clone().with_reach(reach).is_err(), "{reach}");
    }
    let strict = space.with_reach(0.0).unwrap();
    assert_eq!(strict.geodesic(out(1e-5), goal), None);
}

/// The smallest margin of a region; infinite without half-planes.
fn margin(region: &[HalfPlane], point: Point) -> f64 {
    region.iter().map(|plane| plane.margin(point)).fold(f64::INFINITY, f64::min)
}

proptest! {
    #[test]
    fn paths_from_outside_begin_with_the_way_in(
        environment in environment(), pick in 0..1000_usize, angle in 0.0..6.3_f64,
        share in 0.0..1.0_f64, goal in place(),
    ) {
        let space = &environment.free_space;
        let Some(out) = strayed(&environment, pick, angle, share) else { return Ok(()) };
        let entry = space.entry(out).unwrap();
        prop_assert_eq!(entry, space.nearest(out));
        prop_assert!((entry - out).norm() <= space.reach() + ROUNDING);
        let goal = space.nearest(goal);
        let Some(path) = space.geodesic(out, goal) else {
            prop_assert_eq!(space.geodesic(entry, goal), None);
            return Ok(());
        };
        prop_assert_eq!(path.waypoints[0], entry);
        let inside = space.distance(entry, goal);
        prop_assert!((path.length - (entry - out).norm() - inside).abs() < ROUNDING);
        let total: f64 = path.segments(out).map(|part| part.length()).sum();
        prop_assert!((path.length - total).abs() < ROUNDING);
        // The other ways of asking, and the way back.
        let told = space.geodesic_to(out, &space.destination(goal)).unwrap();
        prop_assert_eq!(told.waypoints[0], entry);
        prop_assert!((told.length - path.length).abs() < 4.0 * space.tolerance());
        let back = space.geodesic_to(goal, &space.destination(out)).unwrap();
        prop_assert!((back.length - path.length).abs() < 4.0 * space.tolerance());
        prop_assert_eq!(back.waypoints.last(), Some(&out));
        let detour = space.detour(out, goal, &[]).unwrap();
        prop_assert_eq!(detour, path);
    }

    /// The way in stays in the workspace, and on it the clearance does not fall.
    #[test]
    fn the_way_in_keeps_the_clearance_that_is_left(
        environment in environment(), pick in 0..1000_usize, angle in 0.0..6.3_f64,
        share in 0.0..1.0_f64,
    ) {
        let space = environment.free_space.clone().with_reach(0.99 * CLEARANCE).unwrap();
        let environment = Environment { free_space: space.clone(), ..environment };
        let Some(out) = strayed(&environment, pick, angle, share) else { return Ok(()) };
        let entry = space.entry(out).unwrap();
        let depth = (entry - out).norm();
        let edges = plain::edges(environment.workspace.polygons());
        for step in 0..=20 {
            let place = Segment::new(out, entry).at(f64::from(step) / 20.0);
            let left = depth * (1.0 - f64::from(step) / 20.0);
            prop_assert!(plain::winds_around(&edges, place));
            prop_assert!(plain::distance(&edges, place) >= CLEARANCE - left - ROUNDING);
        }
    }

    #[test]
    fn what_is_seen_from_outside_is_approached_steadily(
        environment in environment(), pick in 0..1000_usize, angle in 0.0..6.3_f64,
        share in 0.0..1.0_f64, goal in place(), sideways in (-1.0..1.0_f64, -1.0..1.0_f64),
    ) {
        let space = &environment.free_space;
        let Some(out) = strayed(&environment, pick, angle, share) else { return Ok(()) };
        let depth = (space.nearest(out) - out).norm();
        let aside = out + Vector::new(sideways.0, sideways.1) * space.reach();
        for to in [space.nearest(goal), aside] {
            if !space.sees(out, to) { continue }
            let end = (space.nearest(to) - to).norm();
            prop_assert!(end <= depth + ROUNDING);
            for step in 0..=20 {
                let share = f64::from(step) / 20.0;
                let place = Segment::new(out, to).at(share);
                let away = (space.nearest(place) - place).norm();
                let allowed = depth * (1.0 - share) + end * share + space.tolerance();
                prop_assert!(away <= allowed, "{away} at {share}, {depth} {end}");
            }
        }
    }

    /// The region of a robot outside is not smaller than that of its entry: it admits what lies in the
    /// latter, up to the radius.
    #[test]
    fn regions_from_outside_admit_what_the_entry_admits(
        environment in environment(), pick in 0..1000_usize, angle in 0.0..6.3_f64,
        share in 0.0..1.0_f64, goal in place(), radius in 0.02..0.3_f64,
        probes in prop::collection::vec((0.0..6.3_f64, 0.0..1.0_f64), 60),
    ) {
        let space = &environment.free_space;
        let Some(out) = strayed(&environment, pick, angle, share) else { return Ok(()) };
        let entry = space.entry(out).unwrap();
        let ahead = space.nearest(goal) - entry;
        let waypoint = entry + ahead * (radius / ahead.norm().max(radius));
        // The region of the entry looks as far as the square of the hull reaches.
        let half_side = radius + (out - entry).norm();
        let inner = convex_region(space, entry, waypoint, half_side * std::f64::consts::SQRT_2);
        let region = convex_region(space, out, waypoint, radius);
        for &(angle, share) in &probes {
            let probe = entry + Vector::new(angle.cos(), angle.sin()) * (share * half_side);
            if margin(&inner, probe) >= 0.0 {
                prop_assert!(margin(&region, probe) >= -ROUNDING, "{probe} from {out}");
            }
        }
    }

    /// The region of a robot outside admits where it is, its entry and the way ahead, and nothing
    /// that is farther out.
    #[test]
    fn regions_from_outside_lead_in(
        environment in environment(), pick in 0..1000_usize, angle in 0.0..6.3_f64,
        share in 0.0..1.0_f64, goal in place(), radius in 0.02..0.3_f64,
        probes in prop::collection::vec((0.0..6.3_f64, 0.0..1.0_f64), 60),
    ) {
        let space = &environment.free_space;
        let Some(out) = strayed(&environment, pick, angle, share) else { return Ok(()) };
        let entry = space.entry(out).unwrap();
        let depth = (entry - out).norm();
        let goal = space.nearest(goal);
        let onward = space.geodesic(entry, goal).map_or(entry, |path| path.waypoints[0]);
        let edges = plain::edges(environment.workspace.polygons());
        for waypoint in [entry, onward, goal] {
            let region = convex_region(space, out, waypoint, radius);
            prop_assert!(margin(&region, out) >= -ROUNDING);
            prop_assert!(margin(&region, entry) >= -ROUNDING, "{}", margin(&region, entry));
            let ahead = waypoint - entry;
            if space.sees(entry, waypoint) && ahead.norm() > 0.0 {
                let way = entry + ahead * (radius / ahead.norm()).min(1.0);
                prop_assert!(margin(&region, way) >= -ROUNDING, "{}", margin(&region, way));
            }
            for &(angle, share) in &probes {
                let ray = Vector::new(angle.cos(), angle.sin());
                let reach = region
                    .iter()
                    .filter(|plane| plane.normal.dot(&ray) > 0.0)
                    .map(|plane| plane.margin(out) / plane.normal.dot(&ray))
                    .fold(radius, f64::min);
                let probe = out + ray * (reach * share);
                let away = (space.nearest(probe) - probe).norm();
                prop_assert!(away <= depth + space.tolerance(), "{probe} from {out}: {away} {depth}");
                prop_assert!(plain::winds_around(&edges, probe));
                prop_assert!(plain::distance(&edges, probe) >= CLEARANCE - depth - ROUNDING);
            }
        }
    }
}
